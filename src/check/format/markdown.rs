//! For a job's summary: what counts first, then the findings by rule.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::{Style, shown};
use crate::check::finding::Finding;
use crate::check::report::Report;
use crate::check::severity::Severity;

/// Findings that are listed a rule; a summary is read, not searched.
const LISTED: usize = 20;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let mark = if report.failing() > 0 { "❌" } else { "✅" };
    writeln!(out, "## {mark} physique check: {}\n\n{}.\n", report.counts(), cell(&report.scope()))?;
    for note in report.notes() {
        writeln!(out, "{}.\n", cell(&note))?;
    }
    let rows = report.by_code();
    if rows.is_empty() {
        return writeln!(out, "Nothing was found.");
    }
    writeln!(out, "| rule | severity | findings | what |\n|---|---|---:|---|")?;
    for (rule, severity, count) in &rows {
        writeln!(out, "| `{}` {} | {severity} | {count} | {} |", rule.code, rule.name, cell(rule.says))?;
    }
    categories(out, report)?;
    let (findings, _) = shown(report, style);
    for (rule, severity, _) in rows.iter().filter(|(_, severity, _)| *severity >= style.show) {
        let own: Vec<&&Finding> = findings.iter().filter(|finding| finding.rule.code == rule.code).collect();
        if own.is_empty() {
            continue;
        }
        let open = if *severity == Severity::Error { " open" } else { "" };
        writeln!(
            out,
            "\n<details{open}><summary><code>{}</code> {} ({})</summary>\n",
            rule.code,
            rule.name,
            own.len()
        )?;
        writeln!(out, "| model | place | what |\n|---|---|---|")?;
        for finding in own.iter().take(LISTED) {
            let place = finding.place.as_ref().map_or_else(String::new, ToString::to_string);
            writeln!(out, "| {} | {} | {} |", cell(&finding.model), cell(&place), cell(&finding.sentence()))?;
        }
        if own.len() > LISTED {
            writeln!(out, "| and {} more | | |", own.len() - LISTED)?;
        }
        writeln!(out, "\n{}\n\n</details>", rule.way_out)?;
    }
    Ok(())
}

/// Where the errors and warnings are.
fn categories(out: &mut dyn Write, report: &Report) -> io::Result<()> {
    let mut counts: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for finding in report.findings.iter().filter(|finding| !finding.category.is_empty()) {
        let entry = counts.entry(&finding.category).or_default();
        match finding.severity {
            Severity::Error => entry[0] += 1,
            Severity::Warning => entry[1] += 1,
            Severity::Info => {}
        }
    }
    let mut rows: Vec<_> =
        counts.into_iter().filter(|(_, counts)| counts.iter().sum::<usize>() > 0).collect();
    rows.sort_by(|a, b| (b.1, a.0).cmp(&(a.1, b.0)));
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n| category | errors | warnings |\n|---|---:|---:|")?;
    for (category, [errors, warnings]) in rows.into_iter().take(10) {
        writeln!(out, "| {} | {errors} | {warnings} |", cell(category))?;
    }
    Ok(())
}

/// Inside a table: no pipes, no line breaks, no markup.
fn cell(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '|' | '\\' | '`' | '*' | '_' | '[' | ']' => safe.extend(['\\', letter]),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '&' => safe.push_str("&amp;"),
            '\n' | '\r' => safe.push(' '),
            letter => safe.push(letter),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_cell_holds_no_markup() {
        assert_eq!(super::cell("a|b*c <d>\ne"), "a\\|b\\*c &lt;d&gt; e");
    }
}
