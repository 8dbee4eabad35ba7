//! A line a finding: `catalog.yaml:812:9: MAS002 warning: … [kitchen/mug.glb]`, as compilers and editors have it.

use std::io::{self, Write};

use super::{Style, shown};
use crate::check::report::Report;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, hidden) = shown(report, style);
    for finding in findings {
        let place = finding.place.clone().or_else(|| finding.pointed_at());
        let place = place.map_or_else(|| "physique".to_owned(), |place| place.written());
        let model = if finding.model.is_empty() { String::new() } else { format!(" [{}]", finding.model) };
        writeln!(out, "{place}: {} {}: {}{model}", finding.rule.code, finding.severity, finding.sentence())?;
    }
    summary(out, report, hidden)
}

/// The last lines of a report for people.
pub(super) fn summary(out: &mut dyn Write, report: &Report, hidden: usize) -> io::Result<()> {
    writeln!(out, "{} in {}", report.counts(), report.scope())?;
    let mut notes = Vec::new();
    if hidden > 0 {
        notes.push(format!("{hidden} not shown (--show info shows all, --max-issues limits)"));
    }
    if report.suppressed > 0 {
        notes.push(format!("{} suppressed", report.suppressed));
    }
    if report.accepted > 0 {
        notes.push(format!("{} accepted by the baseline", report.accepted));
    }
    for limit in &report.exceeded {
        notes.push(format!("limit exceeded: {limit}"));
    }
    for note in notes {
        writeln!(out, "{note}")?;
    }
    Ok(())
}
