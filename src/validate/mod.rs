//! The same scene in rapier, and what the two engines agree on.

#[cfg(feature = "validate")]
mod rapier;
mod verdict;

use serde::{Deserialize, Serialize};

use crate::settle::Outcome;

#[cfg(feature = "validate")]
pub use rapier::{Baseline, parameters, run_rapier};
pub use verdict::{Verdict, judge};

/// One setting as both engines have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Parameter {
    pub name: String,
    pub ours: String,
    pub rapier: String,
}

/// One model's drop in rapier, and what came of comparing it with ours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    pub verdict: Verdict,
    pub rapier: Outcome,
}
