//! GitLab's code quality report: an array of issues in the form of Code Climate.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::{Style, shown};
use crate::check::finding::Finding;
use crate::check::report::Report;
use crate::check::severity::Severity;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, _) = shown(report, Style { show: Severity::Info, ..style });
    let mut issues: Vec<Value> = findings.into_iter().map(issue).collect();
    // GitLab takes equal fingerprints for one issue; the first is kept.
    let mut seen = std::collections::BTreeSet::new();
    issues.retain(|issue| seen.insert(issue["fingerprint"].to_string()));
    serde_json::to_writer_pretty(&mut *out, &issues)?;
    writeln!(out)
}

fn issue(finding: &Finding) -> Value {
    let place = finding.pointed_at();
    let severity = match finding.severity {
        Severity::Error => "major",
        Severity::Warning => "minor",
        Severity::Info => "info",
    };
    let line = place.as_ref().map_or(1, |place| place.line.max(1));
    let model = if finding.model.is_empty() { String::new() } else { format!("{}: ", finding.model) };
    json!({
        "type": "issue",
        "check_name": finding.rule.code,
        "description": format!("{model}{}. {}", finding.sentence(), finding.way_out),
        "categories": ["Bug Risk"],
        "severity": severity,
        "fingerprint": finding.fingerprint(),
        "location": {
            "path": place.as_ref().map_or("physique.yaml", |place| place.file.as_str()),
            "lines": { "begin": line, "end": line },
        },
    })
}
