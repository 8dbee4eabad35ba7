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
    if hidden > 0 {
        writeln!(out, "{hidden} not shown (--show info shows all, --max-issues limits)")?;
    }
    for note in report.notes() {
        writeln!(out, "{note}")?;
    }
    Ok(())
}
