//! One contact point between a body and what stands still.

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::math::{Mat2, Mat3, Vec2, Vec3};
use crate::shape::Collider;
use crate::solve::friction::Friction;
use crate::solve::micro_collision::MicroCollision;

use super::motion::Interval;
use super::rim::Rim;

/// Turns of the direction of sliding in one step of Gauss and Seidel.
const MAX_TURNS: u32 = 12;
/// Share of the stiffness K_nn of a point that friction must leave for it to slide.
const SLIDES: f64 = 0.05;

/// A contact point. Vectors of three along its axes are `[normal, tangent, tangent]`.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Pair, manifold and point in the contact cache.
    pub(super) at: (usize, usize, usize),
    /// Normal towards the body, and tangents, world.
    axes: [Vec3; 3],
    /// What of the arm turns with the body, body frame, and what does not, world.
    core: Vec3,
    offset: Vec3,
    /// Of which the point is the lowest.
    rim: Option<Rim>,
    /// Friction acts where the way from here, body frame, to the point has gone by this share.
    middle: Vec3,
    share: f64,
    friction: f64,
    /// m, now and at the end of the interval under trial.
    pub(super) gap: f64,
    pub(super) next_gap: f64,
    /// Its surfaces are together; and they do not slip.
    pub(super) closed: bool,
    pub(super) sticks: bool,
    /// m/s without the changes of the sweep under way.
    pub(super) speed: Vec3,
    /// N s on the body over the present interval, over the last one, from which the next starts, and over the whole step.
    pub(super) impulse: Vec3,
    pub(super) kept: Vec3,
    pub(super) total: Vec3,
    /// N s of it that rolling resistance has been taken from.
    pub(super) resisted: f64,
    /// N s, the least that the normal impulse may be.
    pub(super) least: f64,
    /// Arm × axis, and the same through the inverse inertia tensor.
    levers: [Vec3; 3],
    turns: [Vec3; 3],
    /// The Delassus matrix K, and of it K⁻¹, 1 / K_nn, K_tn, and its tangential block.
    delassus: Mat3,
    mass: Mat3,
    normal_mass: f64,
    coupling: Vec2,
    tangential: Friction,
}

impl Row {
    /// Point `index` of a manifold; `on_b` tells which side the body is.
    pub(super) fn new(
        at: (usize, usize, usize),
        pairs: &[Pair],
        bodies: &[Body],
        on_b: bool,
        friction: f64,
    ) -> Self {
        let pair = &pairs[at.0];
        let manifold = &pair.manifolds[at.1];
        let point = &manifold.points[at.2];
        let sign = if on_b { 1.0 } else { -1.0 };
        let anchor = if on_b { &point.anchor_b } else { &point.anchor_a };
        let frames = [pair.a, pair.b].map(|i| bodies[i as usize].frame());
        Self {
            at,
            axes: [manifold.normal, manifold.tangents[0], manifold.tangents[1]].map(|axis| axis * sign),
            core: anchor.core,
            offset: anchor.offset,
            rim: None,
            middle: Vec3::zeros(),
            share: 1.0,
            friction,
            gap: manifold.separation(point, &frames[0], &frames[1]),
            next_gap: 0.0,
            closed: false,
            sticks: false,
            speed: Vec3::zeros(),
            impulse: Vec3::zeros(),
            kept: Vec3::new(point.normal_impulse, point.tangent_impulse.x, point.tangent_impulse.y),
            total: Vec3::zeros(),
            resisted: 0.0,
            least: 0.0,
            levers: [Vec3::zeros(); 3],
            turns: [Vec3::zeros(); 3],
            delassus: Mat3::zeros(),
            mass: Mat3::zeros(),
            normal_mass: 0.0,
            coupling: Vec2::zeros(),
            tangential: Friction::new(&Mat2::identity()),
        }
    }

    /// Follows the lowest point of the rim of `shape` from here on, if it lies on one.
    pub(super) fn follow_rim(&mut self, shape: &Collider, axes: &Mat3) {
        self.rim = Rim::of(shape, &self.core);
        self.gap += self.axes[0].dot(&(axes * (self.core_at(axes) - self.core)));
    }

    /// Stays on the point of its rim that is lowest when the body's axes are `axes`.
    pub(super) fn leave_rim(&mut self, axes: &Mat3) {
        self.core = self.core_at(axes);
        self.rim = None;
    }

    /// What of the arm turns with the body, as of when its axes are `axes`; body frame.
    fn core_at(&self, axes: &Mat3) -> Vec3 {
        self.rim.and_then(|rim| rim.lowest(axes, &self.axes[0])).unwrap_or(self.core)
    }

    /// Its region of contact.
    pub(super) fn region(&self) -> (usize, usize) {
        (self.at.0, self.at.1)
    }

    pub(super) fn core(&self) -> Vec3 {
        self.core
    }

    pub(super) fn has_rim(&self) -> bool {
        self.rim.is_some()
    }

    /// Nothing rubs.
    pub(super) fn is_smooth(&self) -> bool {
        self.friction == 0.0
    }

    /// Lets friction act at `share` of the way from `middle`, body frame, to the point.
    pub(super) fn grips_at(&mut self, middle: Vec3, share: f64) {
        (self.middle, self.share) = (middle, share);
    }

    /// From the centre of mass to where the normal impulse acts and to where friction does, when the body's axes are
    /// `axes`.
    pub(super) fn arms(&self, axes: &Mat3) -> [Vec3; 2] {
        let core = self.core_at(axes);
        let arm = axes * core + self.offset;
        if self.share == 1.0 {
            return [arm; 2];
        }
        let grip = self.middle + (core - self.middle) * self.share;
        [arm, axes * grip + self.offset]
    }

    /// The moment of its impulse about the centre of mass.
    pub(super) fn moment(&self, arms: &[Vec3; 2]) -> Vec3 {
        let tangent = self.axes[1] * self.impulse.y + self.axes[2] * self.impulse.z;
        arms[0].cross(&(self.axes[0] * self.impulse.x)) + arms[1].cross(&tangent)
    }

    /// The velocity of the point along its axes.
    pub(super) fn velocity(&self, linear: &Vec3, spin: &Vec3, arms: &[Vec3; 2]) -> Vec3 {
        let [touch, grip] = arms.map(|arm| linear + spin.cross(&arm));
        Vec3::new(self.axes[0].dot(&touch), self.axes[1].dot(&grip), self.axes[2].dot(&grip))
    }

    /// Takes the speed by which an interval of `span` seconds is judged: twice the mean, which answers an impulse as the
    /// velocity at the end does, so that the gap and what sticks are met in their places; what slips, by the velocity at the
    /// end. Unless `patient`, the normal speed too is that of the end, and closes the gap no more than all of it.
    pub(super) fn judge(&mut self, interval: &Interval, span: f64, patient: bool) {
        let mean = self.velocity(
            &(interval.mean_velocity * 2.0),
            &(interval.mean_spin * 2.0),
            &self.arms(&interval.mean_axes()),
        );
        let end = self.velocity(&interval.end.velocity, &interval.end.spin, &self.arms(&interval.end_axes));
        let gap = self.gap.max(0.0) / span;
        // On a rim another point is the lowest at the end: the gap opens by more than the mean speed says.
        let opened = match self.rim {
            Some(_) => {
                let way = interval.mean_velocity * span;
                self.opened(&way, &interval.start_axes, &interval.end_axes) * 2.0 / span
            }
            None => mean.x,
        };
        let normal = if patient { opened + 2.0 * gap } else { end.x + gap };
        let slip = if self.sticks { mean.yz() } else { end.yz() };
        self.speed = Vec3::new(normal, slip.x, slip.y);
    }

    /// How much the gap grows while the body moves by `way` and its axes turn.
    pub(super) fn opened(&self, way: &Vec3, before: &Mat3, after: &Mat3) -> f64 {
        let turned = match self.rim {
            Some(_) => after * self.core_at(after) - before * self.core_at(before),
            None => (after - before) * self.core,
        };
        self.axes[0].dot(&(way + turned))
    }

    /// Along the tangents.
    pub(super) fn across(&self, v: &Vec3) -> Vec2 {
        Vec2::new(self.axes[1].dot(v), self.axes[2].dot(v))
    }

    /// The impulse in the world.
    pub(super) fn world_impulse(&self) -> Vec3 {
        self.axes[0] * self.impulse.x + self.axes[1] * self.impulse.y + self.axes[2] * self.impulse.z
    }

    /// Brings the Delassus matrix up to the arms and the inverse inertia tensor, world.
    pub(super) fn weigh(&mut self, inv_mass: f64, inv_inertia: &Mat3, [touch, grip]: &[Vec3; 2]) {
        let [n, u, v] = &self.axes;
        self.levers = [touch.cross(n), grip.cross(u), grip.cross(v)];
        self.turns = self.levers.map(|lever| inv_inertia * lever);
        let mut k = Mat3::from_fn(|i, j| self.levers[i].dot(&self.turns[j]));
        (0..3).for_each(|i| k[(i, i)] += inv_mass);
        self.normal_mass = 1.0 / k.m11;
        self.coupling = Vec2::new(k.m21, k.m31);
        self.delassus = k;
        if self.friction > 0.0 {
            self.mass = k.try_inverse().unwrap_or_else(Mat3::zeros);
            self.tangential = Friction::new(&Mat2::new(k.m22, k.m23, k.m32, k.m33));
        }
    }

    /// One step of Gauss and Seidel on Signorini's and Coulomb's laws: changes the impulse, and with it the velocities in
    /// `change`; returns by how much the speed at the point changes, m/s.
    pub(super) fn solve(&mut self, inv_mass: f64, change: &mut [Vec3; 2]) -> f64 {
        let mut speed = self.speed;
        for axis in 0..3 {
            speed[axis] += self.axes[axis].dot(&change[0]) + self.levers[axis].dot(&change[1]);
        }
        let new = self.respond(&speed);
        let by = new - self.impulse;
        self.add(&by, inv_mass, change);
        by.norm() / self.normal_mass
    }

    /// The impulse that answers the speed, all else unchanged: Signorini's law along the normal, Coulomb's cone across it.
    fn respond(&self, speed: &Vec3) -> Vec3 {
        let old = self.impulse;
        if self.friction == 0.0 {
            return Vec3::new((old.x - speed.x * self.normal_mass).max(self.least), 0.0, 0.0);
        }
        // Without any impulse of this point.
        let bare = speed - self.delassus * old;
        let least = self.rub(&bare, self.least);
        if bare.x + self.least / self.normal_mass + self.coupling.dot(&least.yz()) >= 0.0 {
            return least;
        }
        let held = -(self.mass * bare);
        if held.x >= self.least && held.yz().norm() <= self.friction * held.x {
            return held;
        }
        self.slide(&bare).unwrap_or_else(|| self.by_turns(speed))
    }

    /// Normal first, then tangent: each right while the other stays.
    fn by_turns(&self, speed: &Vec3) -> Vec3 {
        let old = self.impulse;
        let normal = (old.x - speed.x * self.normal_mass).max(self.least);
        let slip = speed.yz() + self.coupling * (normal - old.x);
        let (tangent, _) = self.tangential.solve(&old.yz(), &slip, self.friction * normal);
        Vec3::new(normal, tangent.x, tangent.y)
    }

    /// Coulomb's law where the normal impulse is known.
    fn rub(&self, bare: &Vec3, normal: f64) -> Vec3 {
        let mut tangent = if normal > 0.0 { self.impulse.yz() } else { Vec2::zeros() };
        for _ in 0..if normal > 0.0 { MAX_TURNS } else { 0 } {
            let slip = bare.yz() + self.coupling * normal + self.delassus.fixed_view::<2, 2>(1, 1) * tangent;
            let (next, _) = self.tangential.solve(&tangent, &slip, self.friction * normal);
            let by = (next - tangent).norm();
            tangent = next;
            if by < 1e-9 * self.friction * normal {
                break;
            }
        }
        Vec3::new(normal, tangent.x, tangent.y)
    }

    /// The impulse on the rim of the cone, against the slip that it leaves. Normal and tangent go together: one after the
    /// other they chase each other where friction presses or lifts by more than the normal impulse itself. `None` where no
    /// direction is found.
    fn slide(&self, bare: &Vec3) -> Option<Vec3> {
        let block = self.delassus.fixed_view::<2, 2>(1, 1);
        let rim = |way: Vec2| way * (self.friction / way.norm().max(f64::MIN_POSITIVE));
        // Tangent over normal impulse; at first as before, or against the slip.
        let old = self.impulse.yz();
        let mut share = rim(if old == Vec2::zeros() { -bare.yz() } else { old });
        for _ in 0..MAX_TURNS {
            let stiffness = 1.0 / self.normal_mass + self.coupling.dot(&share);
            if stiffness * self.normal_mass < SLIDES {
                return None;
            }
            let normal = -bare.x / stiffness;
            let tangent = share * normal;
            let slip = bare.yz() + self.coupling * normal + block * tangent;
            // Friction that drives the slip is on the wrong side, and small steps along the rim would not leave it.
            let drives = slip.dot(&share) > 0.0;
            let next = rim(if drives { -slip } else { tangent - slip * self.tangential.step() });
            let turned = (next - share).norm();
            share = next;
            if turned < 1e-9 * self.friction {
                return (normal >= self.least).then(|| Vec3::new(normal, tangent.x, tangent.y));
            }
        }
        None
    }

    /// The point meets what it stands on alone: a plastic micro-collision.
    pub(super) fn strike(&mut self, inv_mass: f64, change: &mut [Vec3; 2]) {
        let impact = MicroCollision {
            delassus: &self.delassus,
            normal: Vec3::x(),
            velocity: self.speed,
            friction: self.friction,
            restitution: 0.0,
        };
        let (by, _) = impact.impulse(false);
        self.add(&by, inv_mass, change);
    }

    fn add(&mut self, by: &Vec3, inv_mass: f64, change: &mut [Vec3; 2]) {
        self.impulse += by;
        for axis in 0..3 {
            change[0] += self.axes[axis] * (by[axis] * inv_mass);
            change[1] += self.turns[axis] * by[axis];
        }
    }

    /// One step of Gauss and Seidel on a displacement `way` of the body that opens the gap by `wanted` at least; `push` is
    /// what it has been pushed so far, kg m.
    pub(super) fn push_apart(&self, inv_mass: f64, wanted: f64, push: &mut f64, way: &mut [Vec3; 2]) {
        let opened = self.axes[0].dot(&way[0]) + self.levers[0].dot(&way[1]);
        let by = ((wanted - opened) * self.normal_mass).max(-*push);
        *push += by;
        way[0] += self.axes[0] * (by * inv_mass);
        way[1] += self.turns[0] * by;
    }
}
