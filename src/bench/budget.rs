//! Which settings to use where an error or a time is given.

use super::engine::Engine;
use super::run::{Row, Sheet};

/// What a user can spend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// m: overlap at the end, or the scene's own error where that is a length.
    Error(f64),
    /// ms of CPU a step.
    Time(f64),
}

impl Budget {
    /// `1mm`, `0.5 mm`, `2 cm`, `0.001 m`; `2ms`, `0.5 s`.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("expected a length or a time above 0, as 1mm or 2ms, found {text:?}");
        let text = text.trim();
        let split = text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(wrong)?;
        let (value, unit) = text.split_at(split);
        let value: f64 = value.trim().parse().map_err(|_| wrong())?;
        if !(value > 0.0 && value.is_finite()) {
            return Err(wrong());
        }
        match unit {
            "um" => Ok(Self::Error(value * 1e-6)),
            "mm" => Ok(Self::Error(value * 1e-3)),
            "cm" => Ok(Self::Error(value * 1e-2)),
            "m" => Ok(Self::Error(value)),
            "us" => Ok(Self::Time(value * 1e-3)),
            "ms" => Ok(Self::Time(value)),
            "s" => Ok(Self::Time(value * 1e3)),
            _ => Err(wrong()),
        }
    }

    /// The setup of `engine` that keeps to the budget: the fastest that is right enough, or the most right that is
    /// fast enough.
    #[must_use]
    pub fn choose<'a>(&self, sheet: &'a Sheet, engine: Engine) -> Option<&'a Row> {
        let rows = sheet.rows.iter().filter(|row| row.setup.engine == engine && row.ms.is_some());
        let ms = |row: &Row| row.ms.map_or(f64::INFINITY, |ms| ms.mean);
        match *self {
            Self::Error(most) => rows
                .filter(|row| length_m(row).is_some_and(|error| error <= most))
                .min_by(|a, b| ms(a).total_cmp(&ms(b))),
            Self::Time(most) => {
                let error = |row: &Row| length_m(row).unwrap_or(f64::INFINITY);
                rows.filter(|row| ms(row) <= most).min_by(|a, b| error(a).total_cmp(&error(b)))
            }
        }
    }
}

/// The error of a row as a length, m.
#[must_use]
pub fn length_m(row: &Row) -> Option<f64> {
    let errors = row.errors.as_ref()?;
    let own = errors.figures.first().filter(|figure| figure.unit == "m").map(|figure| figure.value);
    Some(own.unwrap_or(errors.depth_end_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_are_lengths_or_times() {
        for (text, expected) in [
            ("1mm", Budget::Error(1e-3)),
            ("2 ms", Budget::Time(2.0)),
            ("0.001 m", Budget::Error(1e-3)),
            ("0.5s", Budget::Time(500.0)),
        ] {
            assert_eq!(Budget::parse(text), Ok(expected), "{text}");
        }
        for text in ["", "1", "mm", "-1mm", "1 kg", "inf m"] {
            assert!(Budget::parse(text).is_err(), "{text}");
        }
    }
}
