//! The equations of motion by Lagrange's method, down to what the code computes.
//!
//! The 2013 paper writes its dynamics as Lagrange's equations with multipliers (its eq. 2) and its impacts as an
//! integration against the normal impulse (its eq. 3). This page derives both for the bodies of this crate, with the
//! symbols of the code, and [`Residual`] evaluates what is left of the equations along a recorded trajectory:
//! `sim/tests/lagrange.rs` holds it near zero.
//!
//! # Coordinates and energies
//!
//! A rigid body has the position x ∈ R³ of its centre of mass and a unit quaternion p ∈ R⁴ that turns body axes to
//! world axes; q = (x, p). Quaternion products write as matrices: with p = (v, w) let
//!
//! ```text
//! E(p) = [ w I - [v]×   -v ]  3 × 4,     E(p) p = 0,     E(p) E(p)ᵀ = |p|² I
//! ```
//!
//! so that the spin in body axes is `Ω = 2 E(p) ṗ`, and `Ω = -2 E(ṗ) p` as well, since `E(p) ṗ = -E(ṗ) p`. With
//! mass m, body inertia tensor I and gravity g
//!
//! ```text
//! T = ½ m |ẋ|² + ½ Ωᵀ I Ω        V = -m g·x        L = T - V
//! ```
//!
//! `Metrics::kinetic_j` and `Metrics::potential_j` are T and V.
//!
//! # Lagrange's equations (the paper's eq. 2)
//!
//! ```text
//! d/dt ∂L/∂q̇ - ∂L/∂q = Q + Jᵀ λ
//! ```
//!
//! Q are the generalized forces that have no potential, J = ∂c/∂q the rows of the constraints c(q), λ their
//! multipliers: the constraint forces.
//!
//! **Translation.** `m ẍ = m g + Σ f`. Without contact the solution is the parabola `x₀ + v₀ t + ½ g t²`, which
//! `flight.rs` evaluates as it stands.
//!
//! **Rotation.** `∂L/∂ṗ = 2 E(p)ᵀ I Ω` and `∂L/∂p = -2 E(ṗ)ᵀ I Ω`. The constraint |p|² = 1 has the row pᵀ; multiplying by
//! ½ E(p), which annihilates it, leaves three equations without its multiplier:
//!
//! ```text
//! ½ E(p) [ d/dt (2 E(p)ᵀ I Ω) + 2 E(ṗ)ᵀ I Ω ] = I Ω̇ + 2 E(p) Ė(p)ᵀ I Ω = I Ω̇ + Ω × I Ω = τ
//! ```
//!
//! Euler's equations, τ the moment in body axes. In world axes, with R the matrix of p and ω = R Ω, they say that the
//! angular momentum `R I Rᵀ ω` changes by the moment alone. That is the form of `rotation.rs`: without moment it keeps
//! `R I Rᵀ ω` and asks only how R turns.
//!
//! # Contacts
//!
//! A contact between bodies A and B at the point with arms r_A, r_B from their centres, with unit normal n from A to
//! B, has the gap `c(q) ≥ 0`. Its rate is `ċ = J u` for the twist u = (v_A, ω_A, v_B, ω_B) and
//!
//! ```text
//! J = (-n, -(r_A × n), n, r_B × n)            M = diag(m_A, I_A, m_B, I_B)
//! ```
//!
//! Signorini's law says when its multiplier acts, `0 ≤ λ ⟂ ċ ≥ 0` where c = 0; Coulomb's law bounds the multipliers of
//! the two tangents, `|λ_t| ≤ μ λ_n`, against the slip where they slide. Over a small step of length h Lagrange's
//! equations integrate to impulses:
//!
//! ```text
//! M (u' - u) = h (Q - ∂V/∂q) + Jᵀ λ
//! J u' = J u + h J M⁻¹ (Q - ∂V/∂q) + K λ,        K = J M⁻¹ Jᵀ
//! ```
//!
//! K is the Delassus matrix; for one row `K = (1/m_A + 1/m_B) + (r_A × n)·I_A⁻¹(r_A × n) + (r_B × n)·I_B⁻¹(r_B × n)`,
//! whose inverse is the effective mass `m_eff`. The contact solver goes through the rows, `λ := max(0, λ - m_eff J u')`,
//! and applies every change of λ by `M⁻¹ Jᵀ` (`apply`), until the laws hold. `ContactPoint::normal_impulse_n_s` is λ_n over
//! a step; `ContactPoint::friction_impulse_n_s` is λ_t as a world vector on B.
//!
//! **Rolling resistance** is a row on the relative spin, `J = (0, -t, 0, t)` for the tangents t, with `|λ| ≤ c r λ_n`
//! (`solve/rolling.rs`).
//!
//! # Impacts (the paper's eq. 3)
//!
//! Within the instant of an impact q and all finite forces stand still. With dp the increment of the normal impulse
//! and f the friction impulse per normal impulse the second line above becomes, for the three rows of one point,
//!
//! ```text
//! du/dp = K (f, 1)
//! ```
//!
//! with u now the relative velocity at the point: `solve/micro_collision.rs`, where its end is set by the work that the
//! normal impulse has done.

use crate::math::{Frame3, Mat3, Vec3, Vec4, quaternion, symmetric};
use crate::scene::{Mass, Pose};

/// What Lagrange's equations leave over along a recorded trajectory, from poses alone.
///
/// Velocities and the rates of momenta are central differences of fourth order over nine poses, so the residual of an
/// exact trajectory falls with the fourth power of the time between poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// d/dt ∂L/∂ẋ - ∂L/∂x, world, N: the sum of all forces but gravity that the motion implies.
    pub force_n: [f64; 3],
    /// ½ E(p) (d/dt ∂L/∂ṗ - ∂L/∂p), turned to world axes, N m: the moment about the centre of mass that it implies.
    pub moment_n_m: [f64; 3],
}

/// Poses that a residual needs, the one it is taken at in their middle.
pub const RESIDUAL_POSES: usize = 9;

/// Weights of the central difference of fourth order, of the values at -2, -1, 1 and 2 steps.
const DIFFERENCE: [(usize, f64); 4] = [(0, 1.0 / 12.0), (1, -8.0 / 12.0), (3, 8.0 / 12.0), (4, -1.0 / 12.0)];

/// E(p)ᵀ a.
fn transposed(p: &Vec4, a: &Vec3) -> Vec4 {
    let v = p.xyz();
    // [v]× is skew: (w I - [v]×)ᵀ a = w a + v × a.
    (a * p.w + v.cross(a)).push(-v.dot(a))
}

/// E(p) b.
fn times(p: &Vec4, b: &Vec4) -> Vec3 {
    let v = p.xyz();
    b.xyz() * p.w - v.cross(&b.xyz()) - v * b.w
}

impl Residual {
    /// At the middle one of `poses`, which are `dt_s` seconds apart, for a body of `mass` under `gravity` (m/s²).
    #[must_use]
    pub fn at(poses: &[Pose; RESIDUAL_POSES], mass: &Mass, gravity: [f64; 3], dt_s: f64) -> Self {
        let inertia = symmetric(mass.inertia_kg_m2);
        let frames = poses.map(|pose| Frame3::from(&pose));
        // A quaternion and its negative are one rotation: follow one of them.
        let mut p: [Vec4; RESIDUAL_POSES] = poses.map(|pose| quaternion(pose.rotation).coords);
        for i in 1..RESIDUAL_POSES {
            if p[i].dot(&p[i - 1]) < 0.0 {
                p[i] = -p[i];
            }
        }
        let momenta: [(Vec3, Vec4); 5] = std::array::from_fn(|i| {
            // Momenta at the five middle poses, each from the five poses about it.
            let (mut v, mut rate) = (Vec3::zeros(), Vec4::zeros());
            for (k, weight) in DIFFERENCE {
                v += frames[i + k].position * (weight / dt_s);
                rate += p[i + k] * (weight / dt_s);
            }
            (v * mass.mass_kg, momentum(&p[i + 2], &rate, &inertia))
        });
        let (mut force, mut generalized, mut rate) = (Vec3::zeros(), Vec4::zeros(), Vec4::zeros());
        for (k, weight) in DIFFERENCE {
            force += momenta[k].0 * (weight / dt_s);
            generalized += momenta[k].1 * (weight / dt_s);
            rate += p[k + 2] * (weight / dt_s);
        }
        let spin = times(&p[4], &rate) * 2.0;
        let moment = times(&p[4], &(generalized + transposed(&rate, &(inertia * spin)) * 2.0)) * 0.5;
        Self {
            force_n: (force - Vec3::from(gravity) * mass.mass_kg).into(),
            moment_n_m: (frames[4].rotation * moment).into(),
        }
    }
}

/// ∂L/∂ṗ = 2 E(p)ᵀ I Ω.
fn momentum(p: &Vec4, rate: &Vec4, inertia: &Mat3) -> Vec4 {
    transposed(p, &(inertia * (times(p, rate) * 2.0))) * 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Quat, rotated};

    #[test]
    fn spin_is_twice_e_times_the_rate() {
        let start = Quat::from_scaled_axis(Vec3::new(0.4, -1.0, 0.3));
        let spin = Vec3::new(1.0, 2.0, -0.5);
        let h = 1e-5;
        let rate = (rotated(&start, &(spin * h)).coords - rotated(&start, &(spin * -h)).coords) / (2.0 * h);
        let p = start.coords;
        let body = start.inverse() * spin;
        assert!((times(&p, &rate) * 2.0 - body).norm() < 1e-9);
        assert!((times(&rate, &p) * -2.0 - body).norm() < 1e-9);
        assert!((times(&p, &p)).norm() < 1e-15);
        // E and Eᵀ are each other's transpose.
        let (a, b) = (Vec3::new(0.3, 0.1, -2.0), Vec4::new(1.0, 0.5, -0.2, 0.7));
        assert!((times(&p, &b).dot(&a) - b.dot(&transposed(&p, &a))).abs() < 1e-15);
    }

    #[test]
    fn steady_turning_under_a_moment_shows_that_moment() {
        // A body held to turn about a fixed axis that is not principal needs ω × I ω.
        let mass = Mass { mass_kg: 2.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.1, 0.0, -0.2] };
        let spin = Vec3::new(0.6, -0.8, 1.5);
        let dt = 1e-3;
        let poses: [Pose; RESIDUAL_POSES] = std::array::from_fn(|i| {
            let t = (i as f64 - 4.0) * dt;
            let rotation = rotated(&Quat::identity(), &(spin * t));
            Pose { position: [0.0, 0.5 * t * t, 0.0], rotation: rotation.coords.into() }
        });
        let residual = Residual::at(&poses, &mass, [0.0, -10.0, 0.0], dt);
        let expected = spin.cross(&(symmetric(mass.inertia_kg_m2) * spin));
        assert!((Vec3::from(residual.moment_n_m) - expected).norm() < 1e-7, "{residual:?}, not {expected:?}");
        assert!((Vec3::from(residual.force_n) - Vec3::new(0.0, 22.0, 0.0)).norm() < 1e-7, "{residual:?}");
    }
}
