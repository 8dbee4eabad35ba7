//! A contact as a damped spring, in a form that is stable at any stiffness.
//!
//! A spring of angular frequency ω and damping ratio ζ on an effective mass m, integrated implicitly over a
//! step h, is the velocity constraint `v + bias_rate * c = 0` with softened impulses (Catto, "Soft Constraints",
//! GDC 2011, and "Solver2D", 2024):
//!
//! ```text
//! bias_rate     = ω / (2ζ + h ω)                 1/s
//! mass_scale    = h ω (2ζ + h ω) / (1 + h ω (2ζ + h ω))
//! impulse_scale = 1 / (1 + h ω (2ζ + h ω))       so that mass_scale + impulse_scale = 1
//! λ            := λ - mass_scale * m * (v + bias_rate * c) - impulse_scale * λ
//! ```
//!
//! ω → ∞ is the rigid constraint with full correction in one step, bias_rate → 1/h. At rest under a load W a
//! contact overlaps by `W / (m ω²)`, whatever the number of substeps.

/// Coefficients of a soft constraint for one substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness {
    /// 1/s
    pub(crate) bias_rate: f64,
    pub(crate) mass_scale: f64,
    pub(crate) impulse_scale: f64,
}

impl Softness {
    /// Of a spring of `hertz` and `damping_ratio` over a substep of `h` seconds.
    pub(crate) fn new(hertz: f64, damping_ratio: f64, h: f64) -> Self {
        let omega = std::f64::consts::TAU * hertz;
        let damping = 2.0 * damping_ratio + h * omega;
        let stiffness = h * omega * damping;
        let impulse_scale = 1.0 / (1.0 + stiffness);
        Self { bias_rate: omega / damping, mass_scale: stiffness * impulse_scale, impulse_scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_sum_to_one_and_stiff_is_rigid() {
        for hertz in [1.0, 30.0, 120.0] {
            let soft = Softness::new(hertz, 10.0, 1.0 / 480.0);
            assert!((soft.mass_scale + soft.impulse_scale - 1.0).abs() < 1e-15);
        }
        let stiff = Softness::new(1e9, 1.0, 1.0 / 480.0);
        assert!((stiff.bias_rate - 480.0).abs() < 1e-3 && stiff.impulse_scale < 1e-9);
    }
}
