//! What the gate found out.

use std::collections::BTreeMap;

use super::finding::Finding;
use super::layer_set::Layers;
use super::limit::Limit;
use super::severity::Severity;

/// How the runtime layer went.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runtime {
    /// Models that were simulated just now, and those whose results were known.
    pub simulated: usize,
    pub unchanged: usize,
    /// Models that were not simulated, by reason.
    pub left_out: BTreeMap<&'static str, usize>,
}

/// Everything that a report is written from.
#[derive(Clone, Debug)]
pub struct Report {
    /// Sorted.
    pub findings: Vec<Finding>,
    /// Models that were looked at, with their categories.
    pub models: Vec<Looked>,
    pub layers: Layers,
    pub profile: String,
    pub fail_on: Severity,
    pub suppressed: usize,
    pub accepted: usize,
    /// Limits that were exceeded.
    pub exceeded: Vec<Limit>,
    pub runtime: Runtime,
    /// Every value that was measured, by code, whether beyond its bound or not.
    pub measured: BTreeMap<&'static str, Vec<f64>>,
    /// Only what changed since this git reference.
    pub changed_since: Option<String>,
    /// Text of the built-in catalogue, for places in it.
    pub built_in: Option<String>,
    pub seconds_a_layer: Vec<(&'static str, f64)>,
    pub seconds: f64,
    /// By an interrupt.
    pub stopped: bool,
}

/// A model that was looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Looked {
    pub model: String,
    /// Its file, as seen from here.
    pub file: String,
    pub category: String,
    /// Whether it was simulated.
    pub proven: bool,
}

impl Report {
    #[must_use]
    pub fn count(&self, severity: Severity) -> usize {
        self.findings.iter().filter(|finding| finding.severity == severity).count()
    }

    /// Findings at or above the level at which the gate fails.
    #[must_use]
    pub fn failing(&self) -> usize {
        self.findings.iter().filter(|finding| finding.severity >= self.fail_on).count()
    }

    /// Findings by code, the most frequent first, with the worst severity.
    #[must_use]
    pub fn by_code(&self) -> Vec<(&'static super::Rule, Severity, usize)> {
        let mut counts: BTreeMap<&str, (&'static super::Rule, Severity, usize)> = BTreeMap::new();
        for finding in &self.findings {
            let entry = counts.entry(finding.rule.code).or_insert((finding.rule, finding.severity, 0));
            entry.1 = entry.1.max(finding.severity);
            entry.2 += 1;
        }
        let mut rows: Vec<_> = counts.into_values().collect();
        rows.sort_by(|a, b| (b.1, b.2, a.0.code).cmp(&(a.1, a.2, b.0.code)));
        rows
    }

    /// `3 errors, 12 warnings, 40 infos`
    #[must_use]
    pub fn counts(&self) -> String {
        let plural = |severity: Severity| {
            let count = self.count(severity);
            if count == 1 { format!("1 {severity}") } else { format!("{count} {severity}s") }
        };
        [Severity::Error, Severity::Warning, Severity::Info].map(plural).join(", ")
    }

    /// What else is to be said, a note a line.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.suppressed > 0 {
            notes.push(format!("{} suppressed", self.suppressed));
        }
        if self.accepted > 0 {
            notes.push(format!("{} accepted by the baseline", self.accepted));
        }
        notes.extend(self.exceeded.iter().map(|limit| format!("limit exceeded: {limit}")));
        notes
    }

    /// One sentence on what was looked at.
    #[must_use]
    pub fn scope(&self) -> String {
        let models = match self.models.len() {
            0 => "no models".to_owned(),
            1 => "1 model".to_owned(),
            count => format!("{count} models"),
        };
        let since =
            self.changed_since.as_ref().map_or_else(String::new, |since| format!(", changed since {since}"));
        let runtime = if self.layers.holds(super::Layer::Runtime) {
            let Runtime { simulated, unchanged, left_out } = &self.runtime;
            let left: Vec<String> = left_out.iter().map(|(why, count)| format!("{count} {why}")).collect();
            let left =
                if left.is_empty() { String::new() } else { format!("; not simulated: {}", left.join(", ")) };
            format!("; {simulated} simulated, {unchanged} known from before{left}")
        } else {
            String::new()
        };
        let stopped = if self.stopped { "; interrupted before all was looked at" } else { "" };
        format!(
            "{models}{since}; layers {}; profile {}{runtime}{stopped}",
            self.layers.written(),
            self.profile
        )
    }
}
