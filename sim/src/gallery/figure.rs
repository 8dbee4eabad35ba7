//! Criteria that many scenes share.

use super::criterion::Criterion;
use super::track::Track;

/// Deepest overlap in the last second, after everything has had its time to come apart.
pub(super) const fn end_depth(limit: f64) -> Criterion {
    Criterion { figure: "depth at the end", unit: "m", limit, measure: Track::end_depth_m }
}

/// How far a thing that should stand has sunk.
pub(super) const fn sink(limit: f64) -> Criterion {
    Criterion { figure: "sink", unit: "m", limit, measure: Track::sink_m }
}

/// How far a thing that should stand has moved sideways.
pub(super) const fn drift(limit: f64) -> Criterion {
    Criterion { figure: "drift", unit: "m", limit, measure: Track::drift_m }
}

/// Largest rise of the energy over what the run has seen move: the range of the energy, or the largest kinetic
/// energy. Physics gives 0.
pub(super) const fn energy_rise(limit: f64) -> Criterion {
    Criterion { figure: "energy rise", unit: "", limit, measure: energy_rise_share }
}

/// Largest change of the energy over its start: for what loses none.
pub(super) const fn energy_change(limit: f64) -> Criterion {
    Criterion { figure: "energy change", unit: "", limit, measure: energy_change_share }
}

fn energy_rise_share(track: &Track) -> f64 {
    let lowest = track.energy_j.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = track.energy_j.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let scale = (highest - lowest).max(track.kinetic_max_j);
    if scale > 0.0 { track.energy_rise_j / scale } else { track.energy_rise_j }
}

fn energy_change_share(track: &Track) -> f64 {
    let start = track.energy_j[0];
    track.energy_j.iter().map(|energy| (energy / start - 1.0).abs()).fold(0.0, f64::max)
}
