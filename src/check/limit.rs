//! How many findings are too many: `MAS002>1%`, `SIM>10`.

use std::fmt;
use std::str::FromStr;

use super::selector::Selector;

/// Findings of some rules are errors only where there are more than this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    pub selector: Selector,
    pub most: Most,
}

/// More than so many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Most {
    Count(usize),
    /// Of the models that were checked, 0 to 100.
    Percent(f64),
}

impl Limit {
    /// Whether `found` out of `models` is too many.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "counts of models")]
    pub fn is_exceeded(&self, found: usize, models: usize) -> bool {
        match self.most {
            Most::Count(most) => found > most,
            Most::Percent(most) => found > 0 && found as f64 * 100.0 > most * models as f64,
        }
    }
}

impl FromStr for Limit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected a limit as MAS002>1% or SIM>10, found {text:?}");
        let (selector, most) = text.split_once('>').ok_or_else(wrong)?;
        let selector = selector.parse()?;
        let most = most.trim();
        let most = match most.strip_suffix('%') {
            Some(percent) => {
                let percent: f64 = percent.trim().parse().map_err(|_| wrong())?;
                if !(0.0..=100.0).contains(&percent) {
                    return Err(wrong());
                }
                Most::Percent(percent)
            }
            None => Most::Count(most.parse().map_err(|_| wrong())?),
        };
        Ok(Self { selector, most })
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.most {
            Most::Count(most) => write!(f, "{}>{most}", self.selector),
            Most::Percent(most) => write!(f, "{}>{most}%", self.selector),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_shares_are_read_and_held() {
        let share: Limit = "MAS002 > 1%".parse().expect("a limit");
        assert!(!share.is_exceeded(2, 200) && share.is_exceeded(3, 200));
        let count: Limit = "SIM>2".parse().expect("a limit");
        assert!(!count.is_exceeded(2, 5) && count.is_exceeded(3, 5));
        let none: Limit = "all>0%".parse().expect("a limit");
        assert!(!none.is_exceeded(0, 0) && none.is_exceeded(1, 10));
        for wrong in ["MAS002", "MAS002>", "MAS002>x", "MAS002>-1", "MAS002>120%", "NIL001>1"] {
            assert!(wrong.parse::<Limit>().is_err(), "{wrong}");
        }
        assert_eq!(share.to_string(), "MAS002>1%");
    }
}
