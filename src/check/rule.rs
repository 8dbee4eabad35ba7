//! What is looked for: every rule with its code, and the registry of all.

use std::fmt;

use mapper::nearest;
use serde::Serialize;

use super::rules;
use super::severity::Severity;

/// What a rule is about; the first three letters of its code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Family {
    Map,
    Att,
    Geo,
    Mas,
    Col,
    Sim,
    Imp,
    Lck,
}

/// What a rule needs to see, in the order of cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Layer {
    /// The rules and overrides alone: milliseconds.
    Static,
    /// The catalogue: what was measured and mapped.
    Data,
    /// Simulated scenes.
    Runtime,
}

/// Where a measured value becomes a finding, in the rule's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase", tag = "side", content = "value")]
pub enum Bound {
    /// Found above it.
    Most(f64),
    /// Found below it.
    Least(f64),
}

/// One thing that can be found.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Three letters of the family and three digits; never given to anything else.
    pub code: &'static str,
    /// Kebab-case.
    pub name: &'static str,
    pub layer: Layer,
    /// Unless flags, profile or configuration say otherwise.
    pub severity: Severity,
    /// `None`: to be there at all is the fault.
    pub bound: Option<Bound>,
    /// Of the measured value and its bound: `%`, `mm`, `x`, `deg`; empty without a bound.
    pub unit: &'static str,
    /// What is found, in a sentence.
    pub says: &'static str,
    /// What goes wrong downstream if it stays.
    pub why: &'static str,
    /// What to do about it.
    pub way_out: &'static str,
    /// Requirements of NVIDIA SimReady Foundation 2026.08 about the same thing.
    pub simready: &'static [&'static str],
}

impl Rule {
    /// Every rule, by family and number.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        rules::ALL.iter().copied().flatten()
    }

    /// The rule with this code, in any case of letters.
    #[must_use]
    pub fn find(code: &str) -> Option<&'static Self> {
        Self::all().find(|rule| rule.code.eq_ignore_ascii_case(code))
    }

    /// The rule whose code or name is most like this text, if any is like it.
    #[must_use]
    pub fn nearest(text: &str) -> Option<&'static Self> {
        let upper = text.to_uppercase();
        let by_code = nearest(&upper, Self::all().map(|rule| rule.code)).and_then(Self::find);
        by_code.or_else(|| {
            let name = nearest(text, Self::all().map(|rule| rule.name))?;
            Self::all().find(|rule| rule.name == name)
        })
    }

    #[must_use]
    pub fn family(&self) -> Family {
        Family::ALL
            .into_iter()
            .find(|family| self.code.starts_with(family.code()))
            // The test of the registry holds that every code has a family.
            .unwrap_or(Family::Map)
    }

    /// A value and its unit as people read them.
    #[must_use]
    pub fn quantity(&self, value: f64) -> String {
        if value == f64::INFINITY {
            return "without end".to_owned();
        }
        let text = written(value);
        if self.unit.is_empty() { text } else { format!("{text} {}", self.unit) }
    }
}

/// Four significant digits, without an exponent where that is readable.
#[must_use]
pub fn written(value: f64) -> String {
    if value == 0.0 {
        // Negative zero is none to people.
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let magnitude = value.abs();
    if !(1e-4..1e7).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    #[expect(clippy::cast_possible_truncation, reason = "between -4 and 7")]
    let digits = usize::try_from(3 - magnitude.log10().floor() as i32).unwrap_or(0);
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl Bound {
    #[must_use]
    pub const fn value(self) -> f64 {
        match self {
            Self::Most(value) | Self::Least(value) => value,
        }
    }

    /// The same side at another value.
    #[must_use]
    pub const fn moved(self, value: f64) -> Self {
        match self {
            Self::Most(_) => Self::Most(value),
            Self::Least(_) => Self::Least(value),
        }
    }

    /// Whether this value is one to find. What is not a number is.
    #[must_use]
    pub fn is_crossed(self, value: f64) -> bool {
        match self {
            Self::Most(bound) => value.is_nan() || value > bound,
            Self::Least(bound) => value.is_nan() || value < bound,
        }
    }
}

impl Family {
    pub const ALL: [Self; 8] =
        [Self::Map, Self::Att, Self::Geo, Self::Mas, Self::Col, Self::Sim, Self::Imp, Self::Lck];

    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Map => "MAP",
            Self::Att => "ATT",
            Self::Geo => "GEO",
            Self::Mas => "MAS",
            Self::Col => "COL",
            Self::Sim => "SIM",
            Self::Imp => "IMP",
            Self::Lck => "LCK",
        }
    }

    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Map => "Mapping",
            Self::Att => "Attributes",
            Self::Geo => "Geometry",
            Self::Mas => "Mass properties",
            Self::Col => "Colliders",
            Self::Sim => "Simulation",
            Self::Imp => "Import",
            Self::Lck => "Lock and baseline",
        }
    }
}

impl Layer {
    pub const ALL: [Self; 3] = [Self::Static, Self::Data, Self::Runtime];

    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Static => "static",
            Self::Data => "data",
            Self::Runtime => "runtime",
        }
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_sorted_and_of_a_family() {
        let codes: Vec<&str> = Rule::all().map(|rule| rule.code).collect();
        for family in Family::ALL {
            let own: Vec<&&str> = codes.iter().filter(|code| code.starts_with(family.code())).collect();
            assert!(own.len() >= 5, "{family:?}");
            assert!(own.is_sorted(), "{own:?}");
        }
        let known: std::collections::BTreeSet<&str> = codes.iter().copied().collect();
        assert_eq!(known.len(), codes.len());
        for rule in Rule::all() {
            assert!(rule.code.len() == 6 && rule.code[3..].bytes().all(|digit| digit.is_ascii_digit()));
            assert!(Family::ALL.iter().any(|family| rule.code.starts_with(family.code())), "{}", rule.code);
            assert_eq!(
                rule.bound.is_some(),
                !rule.unit.is_empty(),
                "{}: bound and unit go together",
                rule.code
            );
            for text in [rule.says, rule.why, rule.way_out] {
                assert!(text.ends_with('.') && text.len() > 20, "{}: {text:?}", rule.code);
            }
            assert!(!rule.name.contains([' ', '_']) && rule.name == rule.name.to_lowercase());
        }
        let names: std::collections::BTreeSet<&str> = Rule::all().map(|rule| rule.name).collect();
        assert_eq!(names.len(), codes.len(), "a name stands for one rule");
    }

    #[test]
    fn values_are_written_to_four_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (2.5, "2.5"),
            (1234.56, "1235"),
            (0.01234, "0.01234"),
            (3.0e9, "3.000e9"),
        ];
        for (value, text) in cases {
            assert_eq!(written(value), text);
        }
    }

    #[test]
    fn a_bound_is_crossed_on_its_own_side_alone() {
        assert!(Bound::Most(2.0).is_crossed(2.1) && !Bound::Most(2.0).is_crossed(2.0));
        assert!(Bound::Least(2.0).is_crossed(1.9) && !Bound::Least(2.0).is_crossed(2.0));
        assert!(Bound::Most(2.0).is_crossed(f64::NAN) && Bound::Least(2.0).moved(9.0).is_crossed(f64::NAN));
    }
}
