//! The one source of every rule's page: a table a family.

mod att;
mod col;
mod geo;
mod imp;
mod lck;
mod map;
mod mas;
mod sim;

use super::rule::{Bound, Layer, Rule};
use super::severity::Severity;

pub(super) const ALL: [&[Rule]; 8] =
    [map::RULES, att::RULES, geo::RULES, mas::RULES, col::RULES, sim::RULES, imp::RULES, lck::RULES];

/// A rule whose finding is that something is there at all.
const fn fact(
    code: &'static str,
    name: &'static str,
    layer: Layer,
    severity: Severity,
    texts: [&'static str; 3],
    simready: &'static [&'static str],
) -> Rule {
    let [says, why, way_out] = texts;
    Rule { code, name, layer, severity, bound: None, unit: "", says, why, way_out, simready }
}

/// A rule whose finding is a measured value beyond its bound.
const fn measured(
    code: &'static str,
    name: &'static str,
    (layer, severity): (Layer, Severity),
    (bound, unit): (Bound, &'static str),
    texts: [&'static str; 3],
    simready: &'static [&'static str],
) -> Rule {
    let [says, why, way_out] = texts;
    Rule { code, name, layer, severity, bound: Some(bound), unit, says, why, way_out, simready }
}
