//! What a run found out, a line a model, and how it is told.

mod attributes;
pub mod colliders;
mod summary;
mod text;
mod validation;

use std::path::{Path, PathBuf};

use importer::{Failure, ModelRow};
use mapper::{Kind, Mapped};
use serde::Serialize;

use crate::pipeline::{Dropped, Key, Remapped, Settings};
use crate::settle::{MAX_ENERGY_RISE_SHARE, penetration_limit_m};
use crate::validate::Comparison;

pub use attributes::write_attributes;
pub use summary::{FailedModel, Summary};
pub use text::{plural, recording_summary, write_text};
pub use validation::write_validation;

/// What is known of one model; small, since a run holds one for each.
#[derive(Clone, Debug)]
pub struct Line {
    pub model: String,
    pub imported: bool,
    /// The first stage that failed, and why.
    pub failure: Option<(&'static str, Failure)>,
    pub standing: Option<Standing>,
    pub remapped: Option<Remapped>,
    pub dropped: Option<Dropped>,
    pub comparison: Option<Comparison>,
}

/// What a model was mapped to, in short.
#[derive(Clone, Debug)]
pub struct Standing {
    pub category: Option<String>,
    pub preset: Option<String>,
    pub kind: Kind,
    pub anchored: bool,
    pub attributes: usize,
    /// Of them, those whose value is a built-in default.
    pub defaults: usize,
    /// Its size fits no unit.
    pub suspect: bool,
    /// Its unit is the one that fits what it is, and not the one that its file states or is taken to have.
    pub unit_inferred: bool,
    /// Hash of what the simulation depends on, and of everything with its provenance.
    pub physics: String,
    pub whole: String,
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct Report {
    pub models: PathBuf,
    pub drop: Settings,
    pub lines: Vec<Line>,
    /// Assets by what was assumed, left out or repaired in them.
    pub notes: std::collections::BTreeMap<String, u64>,
    pub recording: Option<PathBuf>,
    pub seconds_a_stage: Vec<(&'static str, f64)>,
    pub seconds: f64,
    /// By an interrupt, before everything was done.
    pub stopped: bool,
}

/// Something about a drop that calls for a look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Concern {
    pub file: String,
    pub what: String,
}

impl Line {
    #[must_use]
    pub fn imported(row: &ModelRow) -> Self {
        Self {
            model: row.model.clone(),
            imported: row.key.is_some(),
            failure: row.failure.clone().map(|failure| ("import", failure)),
            standing: None,
            remapped: None,
            dropped: None,
            comparison: None,
        }
    }

    /// The same with a failure; the first one stays.
    #[must_use]
    pub fn failed(&self, stage: &'static str, failure: Failure) -> Self {
        let mut line = self.clone();
        line.failure.get_or_insert((stage, failure));
        line
    }

    #[must_use]
    pub fn settled(&self) -> bool {
        self.dropped.as_ref().is_some_and(|dropped| dropped.outcome.settled())
    }

    #[must_use]
    pub fn agrees(&self) -> bool {
        self.comparison.as_ref().is_some_and(|comparison| comparison.verdict.agrees)
    }

    /// What breaks a law of the drop: it does not rest, gains energy, or sinks in.
    #[must_use]
    pub fn breaches(&self) -> Vec<String> {
        let Some(dropped) = &self.dropped else { return Vec::new() };
        let outcome = &dropped.outcome;
        let mut breaches = Vec::new();
        if !outcome.settled() {
            breaches.push(format!("does not come to rest within {:.1} s", outcome.time_s));
        }
        if let Some(share) = outcome.energy_rise_share.filter(|&share| share > MAX_ENERGY_RISE_SHARE) {
            breaches.push(format!(
                "its energy rises by {:.2} % of its fall (limit {} %)",
                share * 100.0,
                MAX_ENERGY_RISE_SHARE * 100.0
            ));
        }
        for body in &outcome.bodies {
            let limit = penetration_limit_m(body.smallest_side_m);
            if body.rest_penetration_m > limit {
                breaches.push(format!(
                    "rests {:.2} mm deep in the floor (limit {:.2} mm)",
                    body.rest_penetration_m * 1e3,
                    limit * 1e3
                ));
            }
        }
        breaches
    }
}

impl Standing {
    #[must_use]
    pub fn of(mapped: &Mapped) -> Self {
        let values: Vec<_> = mapped
            .attributes
            .iter()
            .map(|attribute| (&attribute.name, attribute.part, &attribute.value))
            .collect();
        let physics = serde_json::to_vec(&(
            mapped.kind,
            mapped.mass_model,
            mapped.anchored,
            mapped.scale.metres_per_unit,
            &mapped.preset,
            values,
        ));
        let hash = |name: &str, bytes: Result<Vec<u8>, _>| {
            // What was read from JSON can be written as JSON.
            Key::new(name)
                .with(bytes.unwrap_or_else(|error: serde_json::Error| error.to_string().into_bytes()))
                .finish()
        };
        Self {
            category: mapped.category.as_deref().map(str::to_owned),
            preset: mapped.preset.as_deref().map(str::to_owned),
            kind: mapped.kind,
            anchored: mapped.anchored,
            attributes: mapped.attributes.len(),
            defaults: mapped.defaults_used(),
            suspect: mapped.scale.suspect,
            unit_inferred: mapped.scale.inferred && !mapped.scale.suspect,
            physics: hash("physics", physics),
            whole: hash("mapping", serde_json::to_vec(mapped)),
        }
    }
}

impl Report {
    #[must_use]
    pub fn new(models: &Path, drop: &Settings) -> Self {
        Self {
            models: models.to_path_buf(),
            drop: drop.clone(),
            lines: Vec::new(),
            notes: std::collections::BTreeMap::new(),
            recording: None,
            seconds_a_stage: Vec::new(),
            seconds: 0.0,
            stopped: false,
        }
    }
}
