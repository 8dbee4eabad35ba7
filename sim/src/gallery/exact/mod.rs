//! Motions with a closed form, each judged against it.

mod impact;
mod spin;
mod travel;

use super::Exhibit;
use super::criterion::Criterion;
use super::track::Track;

/// m/s²
const G: f64 = 9.81;

pub(super) const EXHIBITS: [&[Exhibit]; 3] = [travel::EXHIBITS, spin::EXHIBITS, impact::EXHIBITS];

const fn error(
    figure: &'static str,
    unit: &'static str,
    limit: f64,
    measure: fn(&Track) -> f64,
) -> Criterion {
    Criterion { figure, unit, limit, measure }
}
