//! Coulomb's law at one point, for contacts and impacts alike.

use crate::math::{Mat2, Vec2};

/// The tangential side of a contact point: slip velocity u, impulse λ, Delassus block K of the two tangents.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction {
    /// K⁻¹, kg
    mass: Mat2,
    /// 1 / largest eigenvalue of K, kg: the longest step of a projection that still converges.
    step: f64,
}

impl Friction {
    pub(crate) fn new(delassus: &Mat2) -> Self {
        let half_trace = 0.5 * delassus.trace();
        let half_gap = 0.5 * (delassus.m11 - delassus.m22);
        let largest = half_trace + (half_gap * half_gap + delassus.m12 * delassus.m12).sqrt();
        Self { mass: delassus.try_inverse().unwrap_or_else(Mat2::zeros), step: 1.0 / largest }
    }

    /// 1 / largest eigenvalue of K, kg.
    pub(crate) fn step(&self) -> f64 {
        self.step
    }

    /// The impulse after one sweep, from impulse `old` at slip velocity `slip`, N s, at most `limit`; and whether
    /// it slides.
    ///
    /// Sticking takes the whole block. Sliding takes a scalar step before the projection: only then is the fixed
    /// point a λ opposite to u, as maximum dissipation asks. Cutting the sticking impulse down to the cone turns
    /// it by the off-diagonals of K, which at the corners of a sliding box loses 7 % of the friction.
    pub(crate) fn solve(&self, old: &Vec2, slip: &Vec2, limit: f64) -> (Vec2, bool) {
        let sticking = old - self.mass * slip;
        if sticking.norm() <= limit {
            return (sticking, false);
        }
        let sliding = old - slip * self.step;
        let size = sliding.norm();
        if size > limit { (sliding * (limit / size), true) } else { (sliding, true) }
    }
}
