//! What is a file unit worth? The file's word, unless the thing would be absurd in it.

use std::sync::Arc;

use crate::attribute::round;
use crate::facts::ModelFacts;
use crate::mapped::Scale;
use crate::rules::category::Range;
use crate::rules::settings::LENGTH_UNITS;
use crate::text::article::with_article;

/// How many times outside its category's range a size is still taken as stated: the ranges are those of
/// ordinary things, and there are small bottles and large chairs.
pub(crate) const SLACK: f64 = 2.0;

/// How far outside the range a size may be in a unit that nobody stated.
const SLACK_GUESSED: f64 = 1.35;

/// How surely a conversion done twice must explain a size before it is believed: too small is also what miniatures are.
const SURE: f64 = 0.6;

/// What a file unit may be worth besides what the file says, with how often files are found so.
///
/// Three are the common units; the other three undo a conversion done twice (metres written into a file and read as
/// millimetres are a thousand times too small). Feet explain a size only where the file states no unit: no program
/// assumes them.
const EXPLANATIONS: [(&str, f64, f64); 7] = [
    ("cm", 0.01, 0.30),
    ("mm", 0.001, 0.30),
    ("in", 0.0254, 0.20),
    ("ft", 0.3048, 0.05),
    ("m as cm", 100.0, 0.20),
    ("m as mm", 1000.0, 0.10),
    ("m as in", 39.37, 0.05),
];

/// Share of wrong sizes that follow no unit, spread over six powers of ten.
const ARBITRARY: f64 = 0.15;
const ARBITRARY_SPREAD: f64 = 13.8;

/// A size that no thing of the kind has in this unit: five and a half times from the middle of what is usual, and well
/// outside it. Of a thing that nobody knows: longer than a car, or smaller than a walnut, which few that are
/// modelled one by one are.
#[must_use]
pub(crate) fn gross(longest_m: f64, range: Option<&Range>) -> bool {
    let Some(range) = range else { return !(0.03..=4.0).contains(&longest_m) };
    let middle = range.middle();
    (longest_m / middle).max(middle / longest_m) > 5.5 && range.excess(longest_m) > 2.0
}

/// Infers the unit from what the file states and the size that the category has in reality.
#[must_use]
pub(crate) fn infer(facts: &ModelFacts, range: Option<&Range>, what: &str) -> Scale {
    let stated = |reason: String, suspect: bool| Scale {
        metres_per_unit: facts.metres_per_unit,
        unit: unit_name(facts.metres_per_unit),
        reason,
        suspect,
        inferred: false,
    };
    let Some(longest) = facts.longest() else {
        return stated("no extent is known".to_owned(), false);
    };
    let Some(range) = range else {
        return without_category(facts, longest);
    };
    let size = round(longest);
    let a_thing = with_article(what);
    let as_stated = range.excess(longest * facts.metres_per_unit);
    let own = unit_name(facts.metres_per_unit);
    if facts.unit_stated && as_stated <= SLACK {
        return stated(format!("stated by the file; {size} {own} fits {a_thing}"), false);
    }
    if !facts.unit_stated && as_stated <= SLACK_GUESSED {
        return stated(format!("not stated; {size} {own} fits {a_thing}"), false);
    }
    let absurd = !facts.unit_stated || gross(longest * facts.metres_per_unit, Some(range));
    if let Some((name, metres)) = explanation(facts, longest, range).filter(|_| absurd) {
        let claim = if facts.unit_stated { "stated" } else { "not stated" };
        let reason = format!(
            "{claim} {own}, but {size} {own} is no {what} ({} to {} m); {size} {name} is",
            round(range.low),
            round(range.high)
        );
        return Scale { metres_per_unit: metres, unit: name.into(), reason, suspect: false, inferred: true };
    }
    if as_stated <= SLACK {
        return stated(format!("not stated; {size} {own} is near {a_thing}"), false);
    }
    let target = if longest * facts.metres_per_unit < range.low { range.low } else { range.high };
    let reason = format!(
        "{size} file units are no {what} ({} to {} m) in any plain unit; fitted to {} m",
        round(range.low),
        round(range.high),
        round(target)
    );
    Scale { metres_per_unit: target / longest, unit: "fitted".into(), reason, suspect: true, inferred: true }
}

/// The unit in which a size is most likely that of the kind, by Bayes' rule over [`EXPLANATIONS`], if it fits the kind:
/// sizes are spread log-normally, nine in ten inside the range.
fn explanation(facts: &ModelFacts, longest: f64, range: &Range) -> Option<(&'static str, f64)> {
    let stated = facts.metres_per_unit;
    let deviation = ((range.high / range.low).ln() / 3.29).max(0.15);
    let density = |metres: f64| {
        let off = (longest * metres / range.middle()).ln() / deviation;
        (-0.5 * off * off).exp() / (deviation * std::f64::consts::TAU.sqrt())
    };
    let known = EXPLANATIONS
        .iter()
        .filter(|(name, metres, _)| *metres != stated && !(facts.unit_stated && *name == "ft"));
    let likely = known.map(|(name, metres, often)| (*name, *metres, often * density(*metres)));
    let total: f64 = likely.clone().map(|(.., weight)| weight).sum::<f64>() + ARBITRARY / ARBITRARY_SPREAD;
    let best = likely.reduce(|best, next| if next.2 > best.2 { next } else { best })?;
    let fits = range.excess(longest * best.1) <= SLACK_GUESSED;
    (fits && (best.1 < stated || best.2 > SURE * total)).then_some((best.0, best.1))
}

fn without_category(facts: &ModelFacts, longest: f64) -> Scale {
    let unit = unit_name(facts.metres_per_unit);
    let as_is = Scale {
        metres_per_unit: facts.metres_per_unit,
        reason: if facts.unit_stated { "stated by the file" } else { "not stated; taken as it stands" }
            .to_owned(),
        unit,
        suspect: false,
        inferred: false,
    };
    // Printed and machined parts are drawn in millimetres; an unknown thing is rather small than 20 m long.
    if !facts.unit_stated && longest > 15.0 && longest <= 2000.0 {
        let reason = format!("not stated; {} would be large in m, parts are drawn in mm", round(longest));
        return Scale { metres_per_unit: 0.001, unit: "mm".into(), reason, suspect: false, inferred: true };
    }
    as_is
}

fn unit_name(metres: f64) -> Arc<str> {
    LENGTH_UNITS
        .iter()
        .find(|(_, worth)| *worth == metres)
        .map_or_else(|| format!("{metres} m").into(), |(name, _)| (*name).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attribute::{Layer, Provenance};

    fn facts(longest: f64, unit_stated: bool) -> ModelFacts {
        ModelFacts {
            model: "x.obj".to_owned(),
            title: None,
            tags: Vec::new(),
            names: Vec::new(),
            materials: Vec::new(),
            extents: [Some(longest), Some(longest / 2.0), None],
            metres_per_unit: 1.0,
            unit_stated,
            shape: None,
            parts: Vec::new(),
            stated: Vec::new(),
        }
    }

    fn range(low: f64, high: f64) -> Range {
        let place = Provenance {
            layer: Layer::Subcategory,
            file: "t".into(),
            line: 1,
            column: 1,
            by: "t".into(),
            cites: None,
        };
        Range { low, high, place }
    }

    #[test]
    fn the_unit_is_the_one_in_which_the_thing_has_its_size() {
        let chair = range(0.7, 1.2);
        for (size, stated, unit) in [
            (0.9, true, "m"),
            (0.9, false, "m"),
            (90.0, true, "cm"),
            (900.0, true, "mm"),
            (900.0, false, "mm"),
            (36.0, false, "in"),
            (1.9, true, "m"),
            (3.1, false, "ft"),
        ] {
            let scale = infer(&facts(size, stated), Some(&chair), "chair");
            assert_eq!((&*scale.unit, scale.suspect), (unit, false), "{size}: {}", scale.reason);
        }
    }

    #[test]
    fn a_size_that_no_unit_explains_is_fitted_and_suspect() {
        let scale = infer(&facts(10.0, true), Some(&range(0.7, 1.2)), "chair");
        assert_eq!((&*scale.unit, scale.suspect), ("fitted", true));
        assert!((scale.metres_per_unit * 10.0 - 1.2).abs() < 1e-12);
        let scale = infer(&facts(0.0001, true), Some(&range(0.7, 1.2)), "chair");
        assert!(scale.suspect && (scale.metres_per_unit * 0.0001 - 0.7).abs() < 1e-12);
    }
}
