//! Which rules are meant: a code, a family, `warnings` or `all`.

use std::fmt;
use std::str::FromStr;

use super::rule::{Family, Rule};
use super::severity::Severity;

/// Names rules on the command line and in the configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Selector {
    All,
    /// Whatever is a warning by then.
    Warnings,
    Family(Family),
    Code(&'static str),
}

impl Selector {
    /// Whether a rule that stands at `severity` is meant.
    #[must_use]
    pub fn matches(self, rule: &Rule, severity: Severity) -> bool {
        match self {
            Self::All => true,
            Self::Warnings => severity == Severity::Warning,
            Self::Family(family) => rule.family() == family,
            Self::Code(code) => rule.code == code,
        }
    }

    /// The more specific has the last word.
    #[must_use]
    pub const fn specificity(self) -> u8 {
        match self {
            Self::All => 0,
            Self::Warnings => 1,
            Self::Family(_) => 2,
            Self::Code(_) => 3,
        }
    }

    /// The rules that it can mean.
    pub fn rules(self) -> impl Iterator<Item = &'static Rule> {
        Rule::all().filter(move |rule| self.matches(rule, rule.severity))
    }
}

impl FromStr for Selector {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("all") {
            return Ok(Self::All);
        }
        if text.eq_ignore_ascii_case("warnings") {
            return Ok(Self::Warnings);
        }
        if let Some(family) = Family::ALL.into_iter().find(|family| family.code().eq_ignore_ascii_case(text))
        {
            return Ok(Self::Family(family));
        }
        if let Some(rule) = Rule::find(text) {
            return Ok(Self::Code(rule.code));
        }
        let by_name = Rule::all().find(|rule| rule.name == text);
        by_name.map(|rule| Self::Code(rule.code)).ok_or_else(|| {
            if let Some(rule) = Rule::nearest(text) {
                return format!("no rule is called {text:?}; did you mean {} ({})?", rule.code, rule.name);
            }
            let families = Family::ALL.map(Family::code).join(", ");
            format!(
                "no rule is called {text:?}; expected a code (MAS002), a rule's name, a family ({families}), `warnings` or \
                 `all`; `physique explain rules` lists them"
            )
        })
    }
}

impl fmt::Display for Selector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::All => "all",
            Self::Warnings => "warnings",
            Self::Family(family) => family.code(),
            Self::Code(code) => code,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_families_and_names_are_read_in_any_case() {
        assert_eq!("mas002".parse(), Ok(Selector::Code("MAS002")));
        assert_eq!("no-rest".parse(), Ok(Selector::Code("SIM002")));
        assert_eq!(" sim ".parse(), Ok(Selector::Family(Family::Sim)));
        assert_eq!("Warnings".parse(), Ok(Selector::Warnings));
        assert!("NIX999".parse::<Selector>().is_err_and(|error| error.contains("a code (MAS002)")));
        assert!("no-rust".parse::<Selector>().is_err_and(|error| error.contains("did you mean SIM002")));
    }
}
