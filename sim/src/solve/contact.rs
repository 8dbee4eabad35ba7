//! Contacts as soft constraints, solved by sequential impulses in small steps.
//!
//! Symbols follow Catto's papers: `r` arm from the centre of mass, `K` the Delassus block of a contact (inverse
//! effective mass), `λ` impulse. For a contact normal n the row is J = (-n, -r_A × n, n, r_B × n).

use crate::body::Body;
use crate::collide::manifold::Manifold;
use crate::collide::pair::Pair;
use crate::math::{Mat2, Mat3, Vec2, Vec3};
use crate::solve::friction::Friction;
use crate::solve::softness::Softness;

/// What a substep needs to know of one contact point. Arms and masses are frozen for the step: it moves too
/// little for them to change, and accumulated impulses keep their meaning.
pub(crate) struct PointConstraint {
    /// World, from the centres of mass.
    arm_a: Vec3,
    arm_b: Vec3,
    /// kg
    normal_mass: f64,
    tangent: Friction,
    /// Index into the manifold's points.
    index: usize,
}

/// One manifold, ready to be solved.
pub(crate) struct ContactConstraint {
    pub(crate) pair: usize,
    pub(crate) manifold: usize,
    a: usize,
    b: usize,
    inv_mass: [f64; 2],
    inv_inertia: [Mat3; 2],
    softness: Softness,
    /// Whether its points have friction rows.
    rubs: bool,
    points: Vec<PointConstraint>,
}

/// Whether a pass pushes overlaps apart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pass {
    /// With position bias: velocities that also remove overlap.
    Bias,
    /// Without: takes out the speed that the bias put in, so that it never becomes energy.
    Relax,
}

/// What all constraints of a substep share.
#[derive(Clone, Copy)]
pub(crate) struct SubstepContext {
    /// s
    pub(crate) h: f64,
    /// m/s
    pub(crate) max_push_speed: f64,
    /// m/s²
    pub(crate) gravity: Vec3,
}

impl ContactConstraint {
    pub(crate) fn new(
        at: (usize, usize),
        pair: &Pair,
        bodies: &[Body],
        soft: [Softness; 2],
        rubs: bool,
    ) -> Self {
        let (a, b) = (pair.a as usize, pair.b as usize);
        let (body_a, body_b) = (&bodies[a], &bodies[b]);
        // A sleeping body stands as still as the ground until it is woken.
        let side = |body: &Body| {
            if body.is_awake() { (body.inv_mass, body.world_inv_inertia()) } else { (0.0, Mat3::zeros()) }
        };
        let ((inv_a, inv_inertia_a), (inv_b, inv_inertia_b)) = (side(body_a), side(body_b));
        let manifold = &pair.manifolds[at.1];
        let inv_mass = inv_a + inv_b;
        let points = manifold.points.iter().enumerate().map(|(index, point)| {
            let (arm_a, arm_b) = (point.anchor_a.arm(&body_a.frame()), point.anchor_b.arm(&body_b.frame()));
            let delassus = |u: &Vec3, v: &Vec3| {
                inv_mass * u.dot(v)
                    + arm_a.cross(u).dot(&(inv_inertia_a * arm_a.cross(v)))
                    + arm_b.cross(u).dot(&(inv_inertia_b * arm_b.cross(v)))
            };
            let [u, v] = &manifold.tangents;
            let off = delassus(u, v);
            let tangent = Mat2::new(delassus(u, u), off, off, delassus(v, v));
            PointConstraint {
                arm_a,
                arm_b,
                normal_mass: 1.0 / delassus(&manifold.normal, &manifold.normal),
                tangent: Friction::new(&tangent),
                index,
            }
        });
        Self {
            pair: at.0,
            manifold: at.1,
            a,
            b,
            inv_mass: [inv_a, inv_b],
            inv_inertia: [inv_inertia_a, inv_inertia_b],
            softness: soft[usize::from(inv_a == 0.0 || inv_b == 0.0)],
            rubs,
            points: points.collect(),
        }
    }

    /// Points with a friction row.
    pub(crate) fn friction_points(&self) -> u64 {
        if self.rubs { self.points.len() as u64 } else { 0 }
    }

    fn apply(&self, bodies: &mut [Body], point: &PointConstraint, impulse: &Vec3) {
        if self.inv_mass[0] > 0.0 {
            let body = &mut bodies[self.a];
            body.velocity -= impulse * self.inv_mass[0];
            body.spin -= self.inv_inertia[0] * point.arm_a.cross(impulse);
        }
        if self.inv_mass[1] > 0.0 {
            let body = &mut bodies[self.b];
            body.velocity += impulse * self.inv_mass[1];
            body.spin += self.inv_inertia[1] * point.arm_b.cross(impulse);
        }
    }

    fn relative_velocity(&self, bodies: &[Body], point: &PointConstraint) -> Vec3 {
        bodies[self.b].velocity_at(&point.arm_b) - bodies[self.a].velocity_at(&point.arm_a)
    }

    /// Starts from the impulses of the substep before.
    pub(crate) fn warm_start(&self, bodies: &mut [Body], manifold: &Manifold) {
        for constraint in &self.points {
            let point = &manifold.points[constraint.index];
            let impulse = manifold.normal * point.normal_impulse
                + manifold.tangents[0] * point.tangent_impulse.x
                + manifold.tangents[1] * point.tangent_impulse.y;
            self.apply(bodies, constraint, &impulse);
        }
    }

    /// One sweep over the points: normal first, so that friction knows its limit.
    pub(crate) fn solve(
        &self,
        bodies: &mut [Body],
        manifold: &mut Manifold,
        pass: Pass,
        context: SubstepContext,
    ) {
        for _ in 0..self.sweeps() {
            for constraint in &self.points {
                self.solve_normal(bodies, manifold, constraint, pass, context);
            }
            if self.rubs {
                for constraint in &self.points {
                    self.solve_friction(bodies, manifold, constraint, pass);
                }
            }
        }
    }

    /// Sweeps over the points of one manifold. Four corners settle in one a pass; a ring of many shares its load in
    /// endless ways, and with one sweep a slender prism on it rocks for ever.
    fn sweeps(&self) -> usize {
        let count = self.points.len();
        if count <= 4 { 1 } else { count }
    }

    /// Signorini's law at the velocity level, λ ≥ 0 ⟂ v + bias ≥ 0.
    fn solve_normal(
        &self,
        bodies: &mut [Body],
        manifold: &mut Manifold,
        constraint: &PointConstraint,
        pass: Pass,
        context: SubstepContext,
    ) {
        let normal = manifold.normal;
        let separation = manifold.points[constraint.index].separation;
        if pass == Pass::Relax && separation > 0.0 && manifold.points[constraint.index].normal_impulse <= 0.0
        {
            // Nothing to take back, and the next substep decides whether and how it closes the gap.
            return;
        }
        let (bias, soft) = if separation > 0.0 {
            // Not touching yet: it may close the gap within the substep, no more. What flies moves by the mean of
            // its speeds before and after, so half of what gravity adds does not count.
            let falls = |index: usize| if bodies[index].flies { context.gravity } else { Vec3::zeros() };
            let lag = 0.5 * context.h * (falls(self.b) - falls(self.a)).dot(&normal);
            (separation / context.h - lag, Softness::RIGID)
        } else if pass == Pass::Bias {
            let push = (self.softness.bias_rate * separation).max(-context.max_push_speed);
            (push, self.softness)
        } else {
            (0.0, Softness::RIGID)
        };
        let speed = self.relative_velocity(bodies, constraint).dot(&normal);
        let point = &mut manifold.points[constraint.index];
        let old = point.normal_impulse;
        let change = -constraint.normal_mass * soft.mass_scale * (speed + bias) - soft.impulse_scale * old;
        point.normal_impulse = (old + change).max(0.0);
        let impulse = normal * (point.normal_impulse - old);
        self.apply(bodies, constraint, &impulse);
    }

    /// Coulomb's law, |λ_t| ≤ μ λ_n against the slip, both tangents at once so that the cone is round.
    ///
    /// Where it sticks, what it has slipped is pulled back like an overlap: velocities alone would let a stack
    /// creep by the residual of every substep.
    fn solve_friction(
        &self,
        bodies: &mut [Body],
        manifold: &mut Manifold,
        constraint: &PointConstraint,
        pass: Pass,
    ) {
        let [u, v] = manifold.tangents;
        let relative = self.relative_velocity(bodies, constraint);
        let velocity = Vec2::new(relative.dot(&u), relative.dot(&v));
        let point = &mut manifold.points[constraint.index];
        let limit = manifold.friction * point.normal_impulse;
        if limit <= 0.0 && point.tangent_impulse == Vec2::zeros() {
            point.slip = Vec2::zeros();
            return;
        }
        let bias = if pass == Pass::Bias { point.slip * self.softness.bias_rate } else { Vec2::zeros() };
        let (allowed, slides) = constraint.tangent.solve(&point.tangent_impulse, &(velocity + bias), limit);
        let change = allowed - point.tangent_impulse;
        point.tangent_impulse = allowed;
        let impulse = u * change.x + v * change.y;
        self.apply(bodies, constraint, &impulse);
        if slides && pass == Pass::Relax {
            manifold.points[constraint.index].slip = Vec2::zeros();
        }
    }

    /// Adds up how far friction lets the surfaces slip, with the velocities that move the bodies.
    pub(crate) fn track_slip(&self, bodies: &[Body], manifold: &mut Manifold, h: f64) {
        let [u, v] = manifold.tangents;
        for constraint in &self.points {
            if manifold.points[constraint.index].normal_impulse > 0.0 {
                let relative = self.relative_velocity(bodies, constraint);
                manifold.points[constraint.index].slip += Vec2::new(relative.dot(&u), relative.dot(&v)) * h;
            }
        }
    }

    /// Brings the separations up to the bodies' poses: once a motion, not once a pass.
    pub(crate) fn measure(&self, bodies: &[Body], manifold: &mut Manifold) {
        let (a, b) = (bodies[self.a].frame(), bodies[self.b].frame());
        for index in 0..manifold.points.len() {
            manifold.points[index].separation = manifold.separation(&manifold.points[index], &a, &b);
        }
    }

    /// Whether any of its points carries load.
    pub(crate) fn carries(&self, manifold: &Manifold) -> bool {
        manifold.points.iter().any(|point| point.normal_impulse > 0.0)
    }

    /// Indices of its bodies.
    pub(crate) fn bodies(&self) -> [usize; 2] {
        [self.a, self.b]
    }
}
