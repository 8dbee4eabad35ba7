//! Did it come to rest, where, on which side, and did it break a law on the way?

mod trace;

pub use trace::{Outcome, Rest, Trace, angle_deg};

/// Largest rise of energy that a drop may show, as a share of the energy of its fall.
pub const MAX_ENERGY_RISE_SHARE: f64 = 1e-3;

/// Deepest a resting body may sink in, m: half a millimetre, or 1 % of its smallest side.
#[must_use]
pub fn penetration_limit_m(smallest_side_m: f64) -> f64 {
    (0.01 * smallest_side_m).max(0.5e-3)
}
