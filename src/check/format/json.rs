//! The whole report as one JSON object, or a line a finding.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::{Style, shown};
use crate::check::report::Report;
use crate::check::severity::Severity;

/// Raised when a field changes its meaning; new fields raise nothing.
const VERSION: u32 = 1;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, hidden) = shown(report, Style { show: Severity::Info, ..style });
    let findings: Vec<_> = findings.into_iter().map(|finding| finding.record()).collect();
    let mut value = summary(report, hidden);
    value["findings"] = serde_json::to_value(findings)?;
    serde_json::to_writer_pretty(&mut *out, &value)?;
    writeln!(out)
}

pub(super) fn write_lines(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, hidden) = shown(report, Style { show: Severity::Info, ..style });
    for finding in findings {
        serde_json::to_writer(&mut *out, &finding.record())?;
        writeln!(out)?;
    }
    serde_json::to_writer(&mut *out, &json!({ "summary": summary(report, hidden) }))?;
    writeln!(out)
}

fn summary(report: &Report, hidden: usize) -> Value {
    let by_code: serde_json::Map<String, Value> =
        report.by_code().into_iter().map(|(rule, _, count)| (rule.code.to_owned(), count.into())).collect();
    json!({
        "version": VERSION,
        "tool": { "name": "physique", "version": env!("CARGO_PKG_VERSION") },
        "models": report.models.len(),
        "layers": report.layers.written().split(", ").collect::<Vec<_>>(),
        "profile": report.profile,
        "changed_since": report.changed_since,
        "fail_on": report.fail_on,
        "failed": report.failing() > 0,
        "errors": report.count(Severity::Error),
        "warnings": report.count(Severity::Warning),
        "infos": report.count(Severity::Info),
        "suppressed": report.suppressed,
        "accepted": report.accepted,
        "not_shown": hidden,
        "limits_exceeded": report.exceeded.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "simulated": report.runtime.simulated,
        "unchanged": report.runtime.unchanged,
        "not_simulated": report.runtime.left_out,
        "by_code": by_code,
        "stopped": report.stopped,
    })
}
