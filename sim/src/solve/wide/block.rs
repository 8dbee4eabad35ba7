//! Eight contact manifolds side by side, as the kernels read them.
//!
//! Arms, masses and inertias are frozen for the step: most bodies move too little in it for them to change, and
//! accumulated impulses keep their meaning. What moves is followed as a displacement since the step began. What
//! whips round alone is not solved here (see [`crate::solve::lone`]).

use crate::body::Body;
use crate::collide::manifold::{Manifold, Point};
use crate::math::{Mat3, Vec2, Vec3};
use crate::solve::softness::Softness;

use super::lanes::{Eight, Scalar, WIDTH};

/// Row 0 of the bodies: everything that does not move.
pub(crate) const GROUND: u32 = 0;

/// What eight manifolds share with their points.
#[derive(Clone, Default)]
pub(crate) struct Block<S> {
    /// Rows of bodies A and B.
    pub(crate) bodies: [[u32; WIDTH]; 2],
    /// Where its points begin, and how many each manifold has.
    pub(crate) first: usize,
    pub(crate) count: usize,
    /// Some manifold of it carries nothing yet.
    pub(crate) fresh: bool,
    pub(crate) normal: [Eight<S>; 3],
    /// The first tangent; the second is normal × first.
    pub(crate) tangent: [Eight<S>; 3],
    pub(crate) inv_mass: [Eight<S>; 2],
    /// World, `[xx, yy, zz, xy, xz, yz]`.
    pub(crate) inv_inertia: [[Eight<S>; 6]; 2],
    /// m, along the normal: the part of the arms that does not turn with the body (a sphere's radius).
    pub(crate) offset: [Eight<S>; 2],
    pub(crate) friction: Eight<S>,
    pub(crate) bias_rate: Eight<S>,
    pub(crate) mass_scale: Eight<S>,
    pub(crate) impulse_scale: Eight<S>,
}

/// One contact point of each of eight manifolds.
#[derive(Clone, Copy, Default)]
pub(crate) struct PointRow<S> {
    /// World, from the centres of mass.
    pub(crate) arm: [[Eight<S>; 3]; 2],
    /// m, when the step began.
    pub(crate) separation: Eight<S>,
    /// kg: 1 / nᵀKn.
    pub(crate) normal_mass: Eight<S>,
    /// 1/kg: tᵀKn of both tangents.
    pub(crate) coupling: [Eight<S>; 2],
    /// kg: inverse of the tangents' Delassus block, `[uu, uv, vv]`, and the longest step of a sliding projection.
    pub(crate) tangent_mass: [Eight<S>; 3],
    pub(crate) sliding_step: Eight<S>,
    /// N s
    pub(crate) normal_impulse: Eight<S>,
    pub(crate) tangent_impulse: [Eight<S>; 2],
    /// m, slip since it last stuck, less the displacement since the step began.
    pub(crate) slip: [Eight<S>; 2],
    /// m, as of the last motion: the gap, and how far it has slid since the step began.
    pub(crate) gap: Eight<S>,
    pub(crate) slid: [Eight<S>; 2],
    /// N s, over the step, along the normal and the tangents.
    pub(crate) step_impulse: Eight<S>,
    pub(crate) step_friction: [Eight<S>; 2],
}

/// What the solver takes of a body: nothing where it does not move.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(crate) row: u32,
    pub(crate) inv_mass: f64,
    pub(crate) inv_inertia: Mat3,
}

impl<S: Scalar> Block<S> {
    /// Puts `manifold` into lane `lane` of this block and of its points.
    pub(crate) fn fill(
        &mut self,
        points: &mut [PointRow<S>],
        lane: usize,
        manifold: &Manifold,
        friction: f64,
        bodies: [(&Body, &Side); 2],
        softness: &Softness,
    ) {
        let set = |to: &mut Eight<S>, x: f64| to.0[lane] = S::of(x);
        let set3 = |to: &mut [Eight<S>; 3], v: &Vec3| {
            to.iter_mut().zip(v.iter()).for_each(|(to, x)| to.0[lane] = S::of(*x))
        };
        self.fresh |= manifold.points.iter().all(|point| point.normal_impulse == 0.0);
        set3(&mut self.normal, &manifold.normal);
        set3(&mut self.tangent, &manifold.tangents[0]);
        set(&mut self.friction, friction);
        set(&mut self.bias_rate, softness.bias_rate);
        set(&mut self.mass_scale, softness.mass_scale);
        set(&mut self.impulse_scale, softness.impulse_scale);
        let frames = bodies.map(|(body, _)| body.frame());
        let sides = bodies.map(|(_, side)| side);
        for (side, &Side { row, inv_mass, inv_inertia: i }) in sides.into_iter().enumerate() {
            self.bodies[side][lane] = row;
            set(&mut self.inv_mass[side], inv_mass);
            let entries = [i.m11, i.m22, i.m33, i.m12, i.m13, i.m23];
            for (to, x) in self.inv_inertia[side].iter_mut().zip(entries) {
                set(to, x);
            }
            let anchor =
                manifold.points.first().map(|point| if side == 0 { point.anchor_a } else { point.anchor_b });
            set(&mut self.offset[side], anchor.map_or(0.0, |anchor| anchor.offset.dot(&manifold.normal)));
        }
        let between = frames[1].position - frames[0].position;
        for (row, point) in points.iter_mut().zip(&manifold.points) {
            let arms = [point.anchor_a.arm(&frames[0]), point.anchor_b.arm(&frames[1])];
            row.fill(lane, &manifold.normal, point, &arms, &between);
        }
    }
}

impl<S: Scalar> PointRow<S> {
    fn fill(&mut self, lane: usize, normal: &Vec3, point: &Point, arms: &[Vec3; 2], between: &Vec3) {
        let set = |to: &mut Eight<S>, x: f64| to.0[lane] = S::of(x);
        for (to, arm) in self.arm.iter_mut().zip(arms) {
            for (to, x) in to.iter_mut().zip(arm.iter()) {
                set(to, *x);
            }
        }
        let separation = (between + arms[1] - arms[0]).dot(normal);
        set(&mut self.separation, separation);
        set(&mut self.gap, separation);
        set(&mut self.normal_impulse, point.normal_impulse);
        for axis in 0..2 {
            set(&mut self.tangent_impulse[axis], point.tangent_impulse[axis]);
            set(&mut self.slip[axis], point.slip[axis]);
        }
    }

    /// Hands the impulses back to the contact cache.
    pub(crate) fn keep(&self, lane: usize, point: &mut Point, slip: Vec2) {
        let get = |from: &Eight<S>| from.0[lane].wide();
        point.normal_impulse = get(&self.normal_impulse);
        point.tangent_impulse = Vec2::new(get(&self.tangent_impulse[0]), get(&self.tangent_impulse[1]));
        point.step_impulse += get(&self.step_impulse);
        point.step_friction += Vec2::new(get(&self.step_friction[0]), get(&self.step_friction[1]));
        point.slip = Vec2::new(get(&self.slip[0]), get(&self.slip[1])) + slip;
    }
}
