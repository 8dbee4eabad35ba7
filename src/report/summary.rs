//! The run in numbers: what `--format json` prints and `summary.json` keeps.

use mapper::Kind;
use serde::Serialize;

use super::{Concern, Line, Report, Standing};
use crate::pipeline::Remapped;
use crate::validate::Parameter;

/// One model that a stage could not work on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FailedModel {
    pub file: String,
    /// `import`, `map`, `drop` or `validate`.
    pub stage: String,
    pub code: String,
    /// Inside the file; empty for the whole.
    pub place: String,
    pub reason: String,
    pub way_out: String,
}

/// Counts of models, unless a field says otherwise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    pub models: String,
    pub found: usize,
    pub imported: usize,
    /// A stage could not work on it: one entry each in `failures`.
    pub failed: usize,
    pub mapped: usize,
    /// Of them, those that this run mapped anew: what they rest on is new or has changed.
    pub mapped_anew: usize,
    pub uncategorized: usize,
    pub rigid: usize,
    /// Mapped and stored, not simulated yet.
    pub soft: usize,
    pub fluid: usize,
    /// Rigid and fixed in place (a building, a tree): nothing to drop.
    pub anchored: usize,
    pub simulated: usize,
    pub settled: usize,
    pub settled_in_rapier: usize,
    /// Absent where the comparison was left out.
    pub agree_with_rapier: Option<usize>,
    /// Those that agree, and those that would if nothing bounced.
    pub agree_without_restitution: Option<usize>,
    /// Those that tip over in rapier because it keeps four corners of the face they stand on.
    pub corners_lost_in_rapier: usize,
    /// Attributes, and those of them whose value is a built-in default.
    pub attributes: usize,
    pub attributes_by_default: usize,
    pub suspect_scale: usize,
    /// Assets by what was assumed, left out or repaired in them: `unit-assumed`, `holes-filled`, `winding-repaired` …
    pub notes: std::collections::BTreeMap<String, u64>,
    /// Their unit is neither stated nor usual for the format: it is the one in which they have the size of their kind.
    pub units_inferred: usize,
    /// Failures and broken laws: what makes the exit code 1. A difference from rapier is told and is none: which
    /// way a bottle tips is chance in either engine.
    pub findings: usize,
    pub stopped: bool,
    pub seconds: f64,
    pub seconds_a_stage: serde_json::Map<String, serde_json::Value>,
    pub failures: Vec<FailedModel>,
    /// Drops that break a law: no rest, more energy, too deep.
    pub breaches: Vec<Concern>,
    pub differences_from_rapier: Vec<Concern>,
    /// Settings of both engines where they do not depend on the model.
    pub parameters: Vec<Parameter>,
    pub files: serde_json::Map<String, serde_json::Value>,
}

impl Summary {
    /// `files`: what was written, by what it is.
    #[must_use]
    pub fn of(report: &Report, files: &[(&str, String)]) -> Self {
        let lines = &report.lines;
        let count = |wanted: &dyn Fn(&Line) -> bool| lines.iter().filter(|line| wanted(line)).count();
        let standing =
            |wanted: &dyn Fn(&Standing) -> bool| count(&|line| line.standing.as_ref().is_some_and(wanted));
        let failures: Vec<FailedModel> = lines.iter().filter_map(failed).collect();
        let breaches: Vec<Concern> = lines.iter().flat_map(breaches).collect();
        let differences: Vec<Concern> = lines.iter().filter_map(difference).collect();
        Self {
            models: report.models.display().to_string(),
            found: lines.len(),
            imported: count(&|line| line.imported),
            failed: failures.len(),
            mapped: standing(&|_| true),
            mapped_anew: count(&|line| line.remapped == Some(Remapped::Anew)),
            uncategorized: standing(&|standing| standing.category.is_none()),
            rigid: standing(&|standing| standing.kind == Kind::Rigid),
            soft: standing(&|standing| standing.kind == Kind::Soft),
            fluid: standing(&|standing| standing.kind == Kind::Fluid),
            anchored: standing(&|standing| standing.kind == Kind::Rigid && standing.anchored),
            simulated: count(&|line| line.dropped.is_some()),
            settled: count(&Line::settled),
            settled_in_rapier: count(&|line| line.comparison.as_ref().is_some_and(|c| c.rapier.settled())),
            agree_with_rapier: report.drop.validate.then(|| count(&Line::agrees)),
            agree_without_restitution: report.drop.validate.then(|| {
                let without = |line: &Line| {
                    line.comparison.as_ref().is_some_and(|c| c.agrees_without_restitution == Some(true))
                };
                count(&|line| line.agrees() || without(line))
            }),
            corners_lost_in_rapier: count(&|line| {
                line.comparison.as_ref().is_some_and(crate::validate::Comparison::rapier_lost_corners)
            }),
            attributes: lines.iter().filter_map(|line| line.standing.as_ref()).map(|s| s.attributes).sum(),
            attributes_by_default: lines
                .iter()
                .filter_map(|line| line.standing.as_ref())
                .map(|s| s.defaults)
                .sum(),
            suspect_scale: standing(&|standing| standing.suspect),
            notes: report.notes.clone(),
            units_inferred: standing(&|standing| standing.unit_inferred),
            findings: failures.len() + breaches.len(),
            stopped: report.stopped,
            seconds: report.seconds,
            seconds_a_stage: report
                .seconds_a_stage
                .iter()
                .map(|&(stage, seconds)| (stage.to_owned(), seconds.into()))
                .collect(),
            failures,
            breaches,
            differences_from_rapier: differences,
            parameters: parameters(report),
            files: files.iter().map(|(what, path)| ((*what).to_owned(), path.clone().into())).collect(),
        }
    }
}

fn failed(line: &Line) -> Option<FailedModel> {
    let (stage, failure) = line.failure.as_ref()?;
    Some(FailedModel {
        file: line.model.clone(),
        stage: (*stage).to_owned(),
        code: failure.code.clone(),
        place: failure.place.clone(),
        reason: failure.reason.clone(),
        way_out: failure.way_out.clone(),
    })
}

fn breaches(line: &Line) -> Vec<Concern> {
    line.breaches().into_iter().map(|what| Concern { file: line.model.clone(), what }).collect()
}

/// A drop that ours does not bring to rest is a breach already.
fn difference(line: &Line) -> Option<Concern> {
    let comparison = line.comparison.as_ref()?;
    let is_difference = !comparison.verdict.agrees && comparison.verdict.ours.settled;
    is_difference.then(|| Concern { file: line.model.clone(), what: comparison.difference() })
}

#[cfg(feature = "validate")]
fn parameters(report: &Report) -> Vec<Parameter> {
    if report.drop.validate { crate::validate::parameters(None, &report.drop.solver) } else { Vec::new() }
}

#[cfg(not(feature = "validate"))]
fn parameters(_: &Report) -> Vec<Parameter> {
    Vec::new()
}
