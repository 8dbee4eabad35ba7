//! Rolling resistance: what opposes the turning of something round over a surface.
//!
//! A pair of surfaces with coefficient c holds the relative spin in the plane of contact with a moment of at most
//! `c r λ_n`, where r is the rolling radius (`1/r = 1/r_A + 1/r_B`, a flat surface having none) and λ_n the normal
//! impulse: Coulomb's law on spins instead of slips, and solved as such. A sphere of radius R on a slope θ then
//! rolls with `a = 5/7 g (sin θ - c cos θ)`, and stands where `tan θ ≤ c`. A corner has no rolling radius, so
//! boxes have no rolling resistance.

use crate::body::Body;
use crate::collide::anchor::Anchor;
use crate::collide::manifold::{Manifold, Point};
use crate::collide::pair::Pair;
use crate::math::{Mat2, Mat3, Vec2, Vec3};
use crate::plan::Plan;
use crate::solve::friction::Friction;

/// Rolling resistance at one contact point over one step.
#[derive(Clone, Debug)]
pub(crate) struct RollingConstraint {
    /// Pair, manifold and point within this step.
    at: [usize; 3],
    /// Bodies, manifold key and feature: the same point in the next step.
    key: (u32, u32, (u32, u32, u32), u64),
    inv_inertia: [Mat3; 2],
    tangents: [Vec3; 2],
    friction: Friction,
    /// Coefficient times rolling radius, m.
    arm: f64,
    /// N m s on B along the tangents; the next substep starts from it.
    impulse: Vec2,
}

/// Rolling radius at a point, m; `None` where neither surface is round.
fn rolling_radius(point: &Point) -> Option<f64> {
    let curvature = |anchor: &Anchor| {
        let radius = if anchor.rim > 0.0 { anchor.rim } else { anchor.offset.norm() };
        if radius > 0.0 { 1.0 / radius } else { 0.0 }
    };
    let sum = curvature(&point.anchor_a) + curvature(&point.anchor_b);
    (sum > 0.0).then(|| 1.0 / sum)
}

/// Puts the constraints of every round contact point whose surfaces resist rolling into `found`, in the order of
/// `pairs`. Impulses are taken over from `old`, which is in the same order.
pub(crate) fn prepare(
    plan: &Plan,
    pairs: &[Pair],
    bodies: &[Body],
    old: &[RollingConstraint],
    found: &mut Vec<RollingConstraint>,
) {
    found.clear();
    for (p, pair) in pairs.iter().enumerate() {
        let (a, b) = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
        if !a.is_awake() && !b.is_awake() {
            continue;
        }
        for (m, manifold) in pair.manifolds.iter().enumerate() {
            let coefficient = coefficient(a, b, manifold);
            if plan.resists_rolling(coefficient) {
                for (i, point) in manifold.points.iter().enumerate() {
                    let Some(radius) = rolling_radius(point) else { continue };
                    let key = (pair.a, pair.b, manifold.key, point.feature);
                    let mut constraint =
                        RollingConstraint::new([p, m, i], key, manifold, [a, b], coefficient * radius);
                    if let Ok(before) = old.binary_search_by(|old| old.key.cmp(&key)) {
                        constraint.inherit(&old[before]);
                    }
                    found.push(constraint);
                }
            }
        }
    }
    found.sort_unstable_by_key(|constraint| constraint.key);
}

/// Of a corner of body `i`, which is `distance` metres from its centre of mass: what is faceted or rocks rolls about that.
/// `None` where nothing resists, and for what is round, which [`prepare`] has found.
pub(crate) fn at_corner(
    plan: &Plan,
    (pairs, bodies): (&[Pair], &[Body]),
    at: (usize, usize, usize),
    distance: f64,
) -> Option<RollingConstraint> {
    let pair = &pairs[at.0];
    let manifold = &pair.manifolds[at.1];
    let point = &manifold.points[at.2];
    let (a, b) = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
    let coefficient = coefficient(a, b, manifold);
    (plan.resists_rolling(coefficient) && rolling_radius(point).is_none()).then(|| {
        let key = (pair.a, pair.b, manifold.key, point.feature);
        RollingConstraint::new([at.0, at.1, at.2], key, manifold, [a, b], coefficient * distance)
    })
}

/// The pair's coefficient, of the two child shapes that meet.
fn coefficient(a: &Body, b: &Body, manifold: &Manifold) -> f64 {
    let surface = |body: &Body, child: u32| body.colliders.get(child as usize).map(|child| child.surface);
    match (surface(a, manifold.key.0), surface(b, manifold.key.1)) {
        (Some(a), Some(b)) => crate::material::pair_rolling_resistance(&a, &b),
        _ => 0.0,
    }
}

impl RollingConstraint {
    fn new(
        at: [usize; 3],
        key: (u32, u32, (u32, u32, u32), u64),
        manifold: &Manifold,
        bodies: [&Body; 2],
        arm: f64,
    ) -> Self {
        let inv_inertia =
            bodies.map(|body| if body.is_awake() { body.world_inv_inertia() } else { Mat3::zeros() });
        let sum = inv_inertia[0] + inv_inertia[1];
        let tangents = manifold.tangents;
        let [u, v] = &tangents;
        let off = u.dot(&(sum * v));
        let block = Mat2::new(u.dot(&(sum * u)), off, off, v.dot(&(sum * v)));
        Self { at, key, inv_inertia, tangents, friction: Friction::new(&block), arm, impulse: Vec2::zeros() }
    }

    /// Takes over the impulse of the step before, as a world vector on the tangents of today.
    fn inherit(&mut self, old: &Self) {
        let world = old.tangents[0] * old.impulse.x + old.tangents[1] * old.impulse.y;
        self.impulse = Vec2::new(world.dot(&self.tangents[0]), world.dot(&self.tangents[1]));
    }

    /// Pair, manifold and point within this step.
    pub(crate) fn at(&self) -> [usize; 3] {
        self.at
    }

    /// Its bodies, A and B.
    pub(crate) fn bodies(&self) -> [u32; 2] {
        [self.key.0, self.key.1]
    }

    /// Whether it may hold anything.
    pub(crate) fn resists(&self) -> bool {
        self.arm > 0.0
    }

    fn apply(&self, spins: &mut [Vec3; 2], impulse: &Vec2) {
        let moment = self.tangents[0] * impulse.x + self.tangents[1] * impulse.y;
        spins[0] -= self.inv_inertia[0] * moment;
        spins[1] += self.inv_inertia[1] * moment;
    }

    /// Starts from the impulse of the substep before.
    pub(crate) fn warm_start(&self, spins: &mut [Vec3; 2]) {
        self.apply(spins, &self.impulse);
    }

    /// For body `i` alone, which touches what stands still: takes from its spin what a normal impulse since the last time
    /// allows.
    pub(crate) fn brake(&mut self, i: usize, spin: &mut Vec3, normal_impulse: f64) {
        let side = usize::from(self.key.1 as usize == i);
        let mut spins = [Vec3::zeros(); 2];
        spins[side] = *spin;
        self.impulse = Vec2::zeros();
        self.solve(&mut spins, normal_impulse);
        *spin = spins[side];
    }

    /// One sweep, after the contacts', whose normal impulse is the limit.
    pub(crate) fn solve(&mut self, spins: &mut [Vec3; 2], normal_impulse: f64) {
        let spin = spins[1] - spins[0];
        let [u, v] = &self.tangents;
        let turning = Vec2::new(spin.dot(u), spin.dot(v));
        let (new, _) = self.friction.solve(&self.impulse, &turning, self.arm * normal_impulse);
        let change = new - self.impulse;
        self.impulse = new;
        self.apply(spins, &change);
    }
}
