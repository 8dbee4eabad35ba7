//! The same scene in rapier, and what the two engines agree on.

#[cfg(feature = "validate")]
mod rapier;
mod verdict;

use serde::{Deserialize, Serialize};
use sim::Scene;

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
    /// Where they differ: whether they agree once no surface bounces. Which way a tall thing tips after landing
    /// on several points at once is where engines differ most.
    pub agrees_without_restitution: Option<bool>,
}

impl Comparison {
    /// What differs, in a line; empty where nothing does.
    #[must_use]
    pub fn difference(&self) -> String {
        let bounce = match self.agrees_without_restitution {
            Some(true) => "; alike where nothing bounces",
            Some(false) => "; also where nothing bounces",
            None => "",
        };
        if self.verdict.agrees { String::new() } else { format!("{}{bounce}", self.verdict.remark) }
    }
}

/// The same scene with every restitution 0.
#[must_use]
pub fn without_restitution(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for child in scene.entities.iter_mut().flat_map(|entity| &mut entity.shapes) {
        child.surface.restitution = 0.0;
    }
    scene
}
