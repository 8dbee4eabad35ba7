//! An observation that the policy in force makes a finding.

use serde::Serialize;

use super::observation::Observation;
use super::place::Place;
use super::rule::{Bound, Rule, written};
use super::severity::Severity;
use crate::pipeline::Key;

/// What a report shows.
#[derive(Clone, Debug)]
pub struct Finding {
    pub rule: &'static Rule,
    pub severity: Severity,
    /// Empty for what belongs to no model.
    pub model: String,
    /// The model's file, for reports that need one to point at.
    pub model_file: Option<String>,
    pub category: String,
    pub place: Option<Place>,
    pub message: String,
    pub value: Option<f64>,
    /// The bound in force for this model.
    pub bound: Option<Bound>,
    pub way_out: String,
    pub cause: String,
    pub label: String,
}

/// A finding as JSON has it.
#[derive(Clone, Debug, Serialize)]
pub struct Record<'a> {
    code: &'static str,
    name: &'static str,
    layer: &'static str,
    severity: Severity,
    model: Option<&'a str>,
    category: Option<&'a str>,
    file: Option<&'a str>,
    line: Option<u32>,
    column: Option<u32>,
    message: &'a str,
    measured: Option<f64>,
    bound: Option<f64>,
    unit: Option<&'static str>,
    way_out: &'a str,
    cause: Option<&'a str>,
    fingerprint: String,
}

impl Finding {
    #[must_use]
    pub fn new(
        observation: Observation,
        rule: &'static Rule,
        severity: Severity,
        bound: Option<Bound>,
    ) -> Self {
        let Observation { model, place, value, message, way_out, cause, label, .. } = observation;
        Self {
            rule,
            severity,
            model,
            model_file: None,
            category: String::new(),
            place,
            message,
            value,
            bound,
            way_out: if way_out.is_empty() { rule.way_out.to_owned() } else { way_out },
            cause,
            label,
        }
    }

    /// Who this finding is, whatever lines move: its code, its model and what caused it; for what belongs to no
    /// model the file and the words without their numbers of lines.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let key = Key::new("finding").with(self.rule.code).with(&self.model);
        let key = if self.model.is_empty() {
            let file = self.place.as_ref().map_or("", |place| &place.file);
            key.with(file).with(without_lines(&self.message))
        } else if self.rule.bound.is_some() {
            key
        } else {
            key.with(&self.cause).with(without_lines(&self.message))
        };
        key.finish()[..16].to_owned()
    }

    /// `measured 3.1 % of its size, at most 1`; empty where nothing was measured.
    #[must_use]
    pub fn measure(&self) -> String {
        match (self.value, self.bound) {
            (Some(value), Some(Bound::Most(bound))) => {
                format!("measured {}, at most {}", self.rule.quantity(value), written(bound))
            }
            (Some(value), Some(Bound::Least(bound))) => {
                format!("measured {}, at least {}", self.rule.quantity(value), written(bound))
            }
            _ => String::new(),
        }
    }

    /// The message with the measure behind it.
    #[must_use]
    pub fn sentence(&self) -> String {
        match self.measure() {
            measure if measure.is_empty() => self.message.clone(),
            measure => format!("{} ({measure})", self.message),
        }
    }

    /// The place to point at: in the YAML, else the model's own file.
    #[must_use]
    pub fn pointed_at(&self) -> Option<Place> {
        match (&self.place, &self.model_file) {
            (Some(place), _) if !place.built_in => Some(place.clone()),
            (_, Some(file)) => Some(Place { file: file.clone(), line: 0, column: 0, built_in: false }),
            (place, None) => place.clone(),
        }
    }

    #[must_use]
    pub fn record(&self) -> Record<'_> {
        let some = |text: &'static str| Some(text).filter(|text| !text.is_empty());
        let at = self.place.as_ref().filter(|place| place.line > 0);
        Record {
            code: self.rule.code,
            name: self.rule.name,
            layer: self.rule.layer.name(),
            severity: self.severity,
            model: Some(self.model.as_str()).filter(|model| !model.is_empty()),
            category: Some(self.category.as_str()).filter(|category| !category.is_empty()),
            file: self.place.as_ref().map(|place| place.file.as_str()).or(self.model_file.as_deref()),
            line: at.map(|place| place.line),
            column: at.map(|place| place.column).filter(|column| *column > 0),
            message: &self.message,
            measured: self.value.filter(|value| value.is_finite()),
            bound: self.bound.map(Bound::value),
            unit: some(self.rule.unit),
            way_out: &self.way_out,
            cause: Some(self.cause.as_str()).filter(|cause| !cause.is_empty()),
            fingerprint: self.fingerprint(),
        }
    }

    /// By model, then family and number, then place: the order of every report.
    #[must_use]
    pub fn order(&self) -> (&str, &'static str, Option<&Place>, &str) {
        (&self.model, self.rule.code, self.place.as_ref(), &self.message)
    }
}

/// `catalog.yaml:12:5` becomes `catalog.yaml`: a place is no part of what a sentence says.
fn without_lines(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        if letter == ':' && letters.peek().is_some_and(char::is_ascii_digit) {
            while letters.peek().is_some_and(char::is_ascii_digit) {
                letters.next();
            }
        } else {
            kept.push(letter);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(message: &str, line: u32) -> Finding {
        let rule = Rule::find("MAP008").expect("a rule");
        let observation = Observation::fact("MAP008", message).at(Some(Place::at("catalog.yaml", line, 3)));
        Finding::new(observation, rule, Severity::Warning, None)
    }

    #[test]
    fn a_fingerprint_survives_moved_lines_and_nothing_else() {
        let one = finding("\"mug\" is claimed at catalog.yaml:12:4 and at catalog.yaml:90", 12);
        let moved = finding("\"mug\" is claimed at catalog.yaml:14:4 and at catalog.yaml:99", 14);
        let other = finding("\"cup\" is claimed at catalog.yaml:12:4 and at catalog.yaml:90", 12);
        assert_eq!(one.fingerprint(), moved.fingerprint());
        assert_ne!(one.fingerprint(), other.fingerprint());
    }

    #[test]
    fn what_is_built_in_is_shown_but_not_pointed_at() {
        let mut finding = finding("x", 3);
        finding.model = "a/mug.glb".to_owned();
        finding.model_file = Some("models/a/mug.glb".to_owned());
        finding.place = finding.place.map(|place| Place { built_in: true, ..place });
        assert_eq!(finding.pointed_at().map(|place| place.written()), Some("models/a/mug.glb".to_owned()));
        assert_eq!(
            finding.place.map(|place| place.to_string()),
            Some("catalog.yaml:3:3 (built in)".to_owned())
        );
    }
}
