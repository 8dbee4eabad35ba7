//! Rotation without torque: the cheapest model that is right for the body.
//!
//! Between contacts the angular momentum `L = R I Rᵀ ω` is constant in the world, and so is the energy
//! `E = ω·L / 2`. How R follows from that depends on the principal moments:
//!
//! | moments | motion | method |
//! |---|---|---|
//! | all equal | ω constant | exponential map, exact |
//! | two equal, `I₁ = I₂` across the axis a, `I₃` along it | regular precession: `R(t) = exp(t L/I₁) R(0) exp(t (1 - I₃/I₁) ω₃ a)` | closed form, exact |
//! | all different | tumbling | Runge and Kutta's fourth order on `q' = ω q / 2`, `ω = R I⁻¹ Rᵀ L`, in turns of at most [`MAX_TURN_RAD`], with E brought back along its gradient |
//!
//! Rejected: implicit Euler on ω, the games' choice, which damps the tumbling away; explicit Euler, which pumps it.

use crate::math::{Mat3, Quat, Quaternion, Vec3, rotated};

/// Principal moments that differ by less than this share of the largest count as equal.
const EQUAL: f64 = 1e-9;
/// rad up to which the midpoint rule is within 1e-12 of the truth.
const SLOW_TURN_RAD: f64 = 1e-4;
/// And up to which it is within 1e-6.
const SHORT_TURN_RAD: f64 = 0.02;
/// rad, longest turn of one Runge-Kutta step: its error, about turn⁵ / 120, stays below 1e-9.
const MAX_TURN_RAD: f64 = 0.05;
/// Runge-Kutta steps a call, at most; reached above 3 rad a substep.
const MAX_STEPS: f64 = 64.0;

/// How a body turns while nothing touches it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rotor {
    /// All principal moments equal: the inertia tensor is the same in every frame.
    Isotropic,
    /// Two principal moments equal: a regular precession.
    Symmetric {
        /// Unit vector along the figure axis, body frame.
        axis: Vec3,
        /// kg m², about every axis across it.
        across: f64,
        /// kg m², about it.
        along: f64,
    },
    Asymmetric,
}

impl Rotor {
    /// The cheapest model that is right for a body-frame inertia tensor, kg m².
    pub(crate) fn of(inertia: &Mat3) -> Self {
        let (moments, axes) = principal(inertia);
        let largest = moments.iter().copied().fold(0.0, f64::max);
        let equal = |i: usize, j: usize| (moments[i] - moments[j]).abs() <= EQUAL * largest;
        let symmetric = |along: usize, i: usize, j: usize| Self::Symmetric {
            axis: axes.column(along).into(),
            across: 0.5 * (moments[i] + moments[j]),
            along: moments[along],
        };
        match [equal(0, 1), equal(1, 2), equal(0, 2)] {
            [true, true, _] | [true, _, true] | [_, true, true] => Self::Isotropic,
            [true, false, false] => symmetric(2, 0, 1),
            [false, true, false] => symmetric(0, 1, 2),
            [false, false, true] => symmetric(1, 0, 2),
            [false, false, false] => Self::Asymmetric,
        }
    }

    /// Rotation and spin (rad/s, world) after `h` seconds without torque. `inertia` and its inverse are in the body
    /// frame.
    pub(crate) fn turned(
        &self,
        [inertia, inv_inertia]: [&Mat3; 2],
        rotation: &Quat,
        spin: &Vec3,
        h: f64,
    ) -> (Quat, Vec3) {
        match self {
            Self::Isotropic => (rotated(rotation, &(spin * h)), *spin),
            Self::Symmetric { axis, across, along } => {
                let figure = rotation * axis;
                let own = (1.0 - along / across) * spin.dot(&figure);
                // L / I₁ is the spin less the share that the figure axis turns by on its own.
                let precession = spin - figure * own;
                // exp(t L/I₁) R exp(t own a) = exp(t L/I₁) exp(t own R a) R.
                let end = rotated(&rotated(rotation, &(figure * (own * h))), &(precession * h));
                (end, precession + (end * axis) * own)
            }
            Self::Asymmetric => {
                let momentum = rotation * (inertia * (rotation.inverse() * spin));
                tumbled(inv_inertia, &momentum, rotation, spin, h, SLOW_TURN_RAD)
            }
        }
    }

    /// The spin after `h` seconds without torque, where contacts take over from there: they undo more than the midpoint rule
    /// errs by in a short turn.
    pub(crate) fn spun(
        &self,
        [inertia, inv_inertia]: [&Mat3; 2],
        rotation: &Quat,
        spin: &Vec3,
        h: f64,
    ) -> Vec3 {
        if *self != Self::Asymmetric {
            return self.turned([inertia, inv_inertia], rotation, spin, h).1;
        }
        let momentum = rotation * (inertia * (rotation.inverse() * spin));
        tumbled(inv_inertia, &momentum, rotation, spin, h, SHORT_TURN_RAD).1
    }
}

/// Rotation and spin after a turn by the midpoint rule.
fn halfway(spin_at: impl Fn(&Quat) -> Vec3, start: &Quat, spin: &Vec3, h: f64) -> (Quat, Vec3) {
    let middle = rotated(start, &(spin * (0.5 * h)));
    let end = rotated(start, &(spin_at(&middle) * h));
    (end, spin_at(&end))
}

/// Asymmetric rotation under a constant angular momentum.
///
/// Turns below `slow` rad go by the midpoint rule.
fn tumbled(
    inv_inertia: &Mat3,
    momentum: &Vec3,
    start: &Quat,
    spin: &Vec3,
    h: f64,
    slow: f64,
) -> (Quat, Vec3) {
    let spin_at = |rotation: &Quat| rotation * (inv_inertia * (rotation.inverse() * momentum));
    let turn = spin.norm() * h;
    if turn < slow {
        return halfway(spin_at, start, spin, h);
    }
    let steps = (turn / MAX_TURN_RAD).ceil().clamp(1.0, MAX_STEPS);
    let h = h / steps;
    let rate = |q: &Quat| Quaternion::from_imag(spin_at(q) * 0.5) * q.quaternion();
    let mut end = *start;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most MAX_STEPS")]
    for _ in 0..steps as u32 {
        let moved = |rate: &Quaternion, h: f64| Quat::from_quaternion(end.quaternion() + rate * h);
        let k1 = rate(&end);
        let k2 = rate(&moved(&k1, 0.5 * h));
        let k3 = rate(&moved(&k2, 0.5 * h));
        let k4 = rate(&moved(&k3, h));
        end = moved(&(k1 + (k2 + k3) * 2.0 + k4), h / 6.0);
    }
    // Turning by θ changes the energy by θ · (ω × L): the shortest way back to where it was. Where ω and L are
    // nearly parallel the energy has no slope, and no error of first order either.
    let new = spin_at(&end);
    let slope = new.cross(momentum);
    let excess = 0.5 * (new - spin).dot(momentum);
    if slope.norm_squared() > 1e-12 * new.norm_squared() * momentum.norm_squared() {
        end = rotated(&end, &(slope * (-excess / slope.norm_squared())));
    }
    (end, spin_at(&end))
}

/// Principal moments and axes (columns) of a symmetric matrix, by cyclic Jacobi rotations: square roots alone, so
/// that every machine finds the same bits.
fn principal(matrix: &Mat3) -> (Vec3, Mat3) {
    let mut a = *matrix;
    let mut axes = Mat3::identity();
    for _ in 0..16 {
        let off = a.m12 * a.m12 + a.m13 * a.m13 + a.m23 * a.m23;
        if off <= 1e-32 * a.diagonal().norm_squared() {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[(p, q)] == 0.0 {
                continue;
            }
            let theta = 0.5 * (a[(q, q)] - a[(p, p)]) / a[(p, q)];
            let t = if theta >= 0.0 { 1.0 } else { -1.0 } / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cos = 1.0 / (t * t + 1.0).sqrt();
            let sin = t * cos;
            let mut turn = Mat3::identity();
            turn[(p, p)] = cos;
            turn[(q, q)] = cos;
            turn[(p, q)] = sin;
            turn[(q, p)] = -sin;
            a = turn.transpose() * a * turn;
            axes *= turn;
        }
    }
    (a.diagonal(), axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(moments: [f64; 3]) -> Mat3 {
        Mat3::from_diagonal(&Vec3::from(moments))
    }

    fn tilted(moments: [f64; 3]) -> Mat3 {
        let tilt = Quat::from_scaled_axis(Vec3::new(0.3, -0.8, 0.5)).to_rotation_matrix();
        tilt.matrix() * diagonal(moments) * tilt.matrix().transpose()
    }

    /// Runge and Kutta's fourth order with 2,000 steps, without any correction.
    fn reference(inertia: &Mat3, spin: &Vec3, time: f64) -> (Quat, Vec3) {
        let inv = inertia.try_inverse().unwrap();
        let momentum = inertia * spin;
        let spin_at = |q: &Quat| q * (inv * (q.inverse() * momentum));
        let mut q = Quat::identity();
        let h = time / 2000.0;
        for _ in 0..2000 {
            let rate = |q: &Quat| Quaternion::from_imag(spin_at(q) * 0.5) * q.quaternion();
            let moved = |rate: &Quaternion, h: f64| Quat::from_quaternion(q.quaternion() + rate * h);
            let k1 = rate(&q);
            let k2 = rate(&moved(&k1, 0.5 * h));
            let k3 = rate(&moved(&k2, 0.5 * h));
            let k4 = rate(&moved(&k3, h));
            q = moved(&(k1 + (k2 + k3) * 2.0 + k4), h / 6.0);
        }
        (q, spin_at(&q))
    }

    #[test]
    fn principal_moments_rebuild_the_tensor() {
        for tensor in [diagonal([1.0, 2.0, 3.0]), tilted([1.0, 2.0, 2.5]), tilted([4.0, 4.0, 7.0])] {
            let (moments, axes) = principal(&tensor);
            let again = axes * Mat3::from_diagonal(&moments) * axes.transpose();
            assert!((again - tensor).norm() < 1e-13, "{again} for {tensor}");
        }
    }

    #[test]
    fn the_model_follows_from_the_moments() {
        assert_eq!(Rotor::of(&tilted([2.0, 2.0, 2.0])), Rotor::Isotropic);
        assert_eq!(Rotor::of(&tilted([1.0, 2.0, 2.5])), Rotor::Asymmetric);
        for moments in [[1.0, 1.0, 1.8], [1.8, 1.0, 1.0], [1.0, 1.8, 1.0]] {
            let Rotor::Symmetric { across, along, .. } = Rotor::of(&tilted(moments)) else {
                panic!("{moments:?}")
            };
            assert!((across - 1.0).abs() < 1e-12 && (along - 1.8).abs() < 1e-12);
        }
    }

    #[test]
    fn symmetric_rotation_is_the_regular_precession_in_one_step() {
        for (inertia, spin) in [
            (diagonal([1.0, 1.0, 1.7]), Vec3::new(1.0, 0.5, 4.0)),
            (tilted([2.0, 2.0, 0.3]), Vec3::new(-3.0, 1.0, 2.0)),
        ] {
            let rotor = Rotor::of(&inertia);
            let inv = inertia.try_inverse().unwrap();
            let (q, w) = rotor.turned([&inertia, &inv], &Quat::identity(), &spin, 3.0);
            let (q_true, w_true) = reference(&inertia, &spin, 3.0);
            assert!(q.angle_to(&q_true) < 1e-8 && (w - w_true).norm() < 1e-8, "{w:?}, expected {w_true:?}");
            let momentum = q * (inertia * (q.inverse() * w));
            assert!((momentum - inertia * spin).norm() < 1e-13 * momentum.norm());
        }
    }

    #[test]
    fn tumbling_keeps_momentum_and_energy_at_any_speed() {
        let inertia = tilted([1.0, 2.0, 2.9]);
        let inv = inertia.try_inverse().unwrap();
        for speed in [1e-3, 1.0, 30.0, 400.0] {
            let spin = Vec3::new(0.1, 1.0, -0.2) * speed;
            let (mut q, mut w) = (Quat::identity(), spin);
            for _ in 0..2000 {
                (q, w) = Rotor::Asymmetric.turned([&inertia, &inv], &q, &w, 1.0 / 480.0);
            }
            let momentum = q * (inertia * (q.inverse() * w));
            let drift = (momentum - inertia * spin).norm() / momentum.norm();
            let energy = w.dot(&momentum) / spin.dot(&(inertia * spin)) - 1.0;
            assert!(drift < 1e-11 && energy.abs() < 1e-11, "at {speed} rad/s: L {drift:e}, E {energy:e}");
        }
    }

    #[test]
    fn tumbling_agrees_with_a_finer_integration() {
        let inertia = diagonal([1.0, 2.0, 3.0]);
        let inv = inertia.try_inverse().unwrap();
        let spin = Vec3::new(0.5, 5.0, 0.2);
        let (mut q, mut w) = (Quat::identity(), spin);
        for _ in 0..480 {
            (q, w) = Rotor::Asymmetric.turned([&inertia, &inv], &q, &w, 1.0 / 480.0);
        }
        let (q_true, w_true) = reference(&inertia, &spin, 1.0);
        assert!(q.angle_to(&q_true) < 1e-7 && (w - w_true).norm() < 1e-6, "{w:?}, expected {w_true:?}");
    }
}
