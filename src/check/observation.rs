//! What a look at a model or a file showed, before any policy: kept in the catalogue, so that another bound is no
//! reason to look again.

use serde::{Deserialize, Serialize};

use super::place::Place;
use super::rule::Rule;

/// One look at one rule.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// Of the [`Rule`].
    pub code: String,
    /// Empty for what belongs to no model.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub model: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<Place>,
    /// What was measured, in the rule's unit; absent for a rule without a bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// In words, without code and place.
    pub message: String,
    /// Better than the rule's own, where there is one.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub way_out: String,
    /// The rule, preset, subcategory or override that the value comes from: `subcategory:mug`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub cause: String,
    /// Words of the source for the caret; empty where the place says enough.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
}

impl Observation {
    /// Something that is there and should not be.
    #[must_use]
    pub fn fact(code: &str, message: impl Into<String>) -> Self {
        Self {
            code: code.to_owned(),
            model: String::new(),
            place: None,
            value: None,
            message: message.into(),
            way_out: String::new(),
            cause: String::new(),
            label: String::new(),
        }
    }

    /// A measured value, whether it is beyond its bound or not.
    #[must_use]
    pub fn measured(code: &str, value: f64, message: impl Into<String>) -> Self {
        Self { value: Some(value), ..Self::fact(code, message) }
    }

    #[must_use]
    pub fn of(mut self, model: &str) -> Self {
        model.clone_into(&mut self.model);
        self
    }

    #[must_use]
    pub fn at(mut self, place: Option<Place>) -> Self {
        self.place = place;
        self
    }

    #[must_use]
    pub fn because(mut self, cause: &str) -> Self {
        cause.clone_into(&mut self.cause);
        self
    }

    #[must_use]
    pub fn help(mut self, way_out: impl Into<String>) -> Self {
        self.way_out = way_out.into();
        self
    }

    /// The rule; an observation of a code that no rule has is of no use.
    #[must_use]
    pub fn rule(&self) -> Option<&'static Rule> {
        Rule::find(&self.code)
    }
}
