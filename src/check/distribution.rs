//! How a measured value is spread over real models: what a bound is chosen from.

use std::fmt::Write as _;

use super::report::Report;
use super::rule::{Bound, Rule};

/// Measured on the 351 downloaded models that the project was developed with, hard cases among them; `physique check MODELS --distribution
/// FILE` writes such a table for yours.
const SHIPPED: &str = include_str!("distributions.csv");

const HEADER: &str = "code,unit,models,least,p05,median,p95,p99,most,beyond";

/// One measured quantity over many models, in the rule's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    pub code: String,
    pub models: usize,
    /// Least, 5 %, median, 95 %, 99 %, most.
    pub quantiles: [f64; 6],
    /// Models beyond the default bound.
    pub beyond: usize,
}

impl Distribution {
    fn of(rule: &Rule, values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a rank below the number of values"
        )]
        let at = |share: f64| sorted[(share * last as f64).round() as usize];
        let beyond =
            values.iter().filter(|value| rule.bound.is_some_and(|bound| bound.is_crossed(**value))).count();
        Some(Self {
            code: rule.code.to_owned(),
            models: sorted.len(),
            quantiles: [0.0, 0.05, 0.5, 0.95, 0.99, 1.0].map(at),
            beyond,
        })
    }

    /// The one of a rule that the project ships; `None` for a rule without a bound, or never met.
    #[must_use]
    pub fn shipped(code: &str) -> Option<Self> {
        let line = SHIPPED.lines().find(|line| line.split(',').next() == Some(code))?;
        let fields: Vec<&str> = line.split(',').collect();
        let mut quantiles = [0.0; 6];
        for (quantile, field) in quantiles.iter_mut().zip(fields.get(3..9)?) {
            *quantile = field.parse().ok()?;
        }
        Some(Self {
            code: code.to_owned(),
            models: fields.get(2)?.parse().ok()?,
            quantiles,
            beyond: fields.get(9)?.parse().ok()?,
        })
    }
}

/// The table of everything that a report measured, as CSV.
#[must_use]
pub fn distributions(report: &Report) -> String {
    let mut text = format!("{HEADER}\n");
    for rule in Rule::all().filter(|rule| rule.bound.is_some()) {
        let values = report.measured.get(rule.code).map(Vec::as_slice).unwrap_or_default();
        let Some(spread) = Distribution::of(rule, values) else { continue };
        // Adding zero leaves no negative one.
        let quantiles = spread
            .quantiles
            .map(|value| value + 0.0)
            .map(|value| if value.is_finite() { format!("{value:.4e}") } else { value.to_string() });
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{}",
            rule.code,
            rule.unit,
            spread.models,
            quantiles.join(","),
            spread.beyond
        );
    }
    text
}

/// As the rule's page shows it.
#[must_use]
pub fn table(rule: &Rule) -> Option<String> {
    let spread = Distribution::shipped(rule.code)?;
    let cell =
        |value: f64| if value.is_finite() { super::rule::written(value) } else { "without end".to_owned() };
    let [least, low, median, high, higher, most] = spread.quantiles.map(cell);
    let side = match rule.bound? {
        Bound::Most(_) => "above",
        Bound::Least(_) => "below",
    };
    Some(format!(
        "| values | least | 5 % | median | 95 % | 99 % | most | {side} the bound |\n|---|---|---|---|---|---|---|---|\n\
         | {} | {least} | {low} | {median} | {high} | {higher} | {most} | {} |\n",
        spread.models, spread.beyond
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_that_were_measured() {
        let rule = Rule::find("SIM004").expect("a rule");
        let values: Vec<f64> = (0..=100).map(|value| f64::from(value) / 50.0).collect();
        let spread = Distribution::of(rule, &values).expect("some");
        assert_eq!(spread.quantiles, [0.0, 0.1, 1.0, 1.9, 1.98, 2.0]);
        assert_eq!((spread.models, spread.beyond), (101, 50));
        assert_eq!(Distribution::of(rule, &[]), None);
    }

    #[test]
    fn every_line_of_the_shipped_table_is_understood() {
        assert_eq!(SHIPPED.lines().next(), Some(HEADER));
        for line in SHIPPED.lines().skip(1) {
            let code = line.split(',').next().unwrap_or_default();
            let rule = Rule::find(code).unwrap_or_else(|| panic!("{code} is no rule"));
            assert!(rule.bound.is_some() && Distribution::shipped(code).is_some(), "{line}");
            assert!(table(rule).is_some());
        }
    }
}
