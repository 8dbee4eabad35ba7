//! The run as a person reads it.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::{Concern, Line, Summary};

/// Entries of a list that are shown; the rest is counted.
const SHOWN: usize = 12;

/// Writes the summary; `how_to_look` are the closing lines: files, and the command that opens the recording.
///
/// # Errors
/// The output cannot be written.
pub fn write_text(
    out: &mut dyn Write,
    summary: &Summary,
    how_to_look: &[(String, String)],
) -> io::Result<()> {
    let s = summary;
    writeln!(out, "{} in {}", plural(s.found, "model"), s.models)?;
    writeln!(out)?;
    row(out, "imported", s.imported, &note(s.failed, "failed"))?;
    if !s.notes.is_empty() {
        let mut notes: Vec<(&String, &u64)> = s.notes.iter().collect();
        notes.sort_by(|a, b| b.1.cmp(a.1));
        let told: Vec<String> = notes.iter().map(|(code, count)| format!("{code} {count}")).collect();
        writeln!(out, "  of the assets: {}", told.join(", "))?;
    }
    if s.seconds_a_stage.contains_key("map") {
        let anew =
            if s.mapped_anew < s.mapped { format!("; {} mapped anew", s.mapped_anew) } else { String::new() };
        let mapped = format!(
            "{} rigid, {} soft, {} fluid; {} uncategorized{anew}",
            s.rigid, s.soft, s.fluid, s.uncategorized
        );
        row(out, "mapped", s.mapped, &mapped)?;
    }
    if s.seconds_a_stage.contains_key("drop") {
        let left_out = note(s.anchored, "rigid but fixed in place, not dropped");
        row(out, "dropped", s.simulated, &left_out)?;
        row(out, "came to rest", s.settled, &share(s.settled, s.simulated))?;
        if let Some(agree) = s.agree_with_rapier {
            let bounce = match s.agree_without_restitution {
                Some(without) if without > agree => format!(", {without} agree where nothing bounces"),
                _ => String::new(),
            };
            let rapier = share(agree, s.simulated);
            let rapier = format!("{rapier} ({} come to rest in rapier{bounce})", s.settled_in_rapier);
            row(out, "agree with rapier", agree, &rapier)?;
            if s.corners_lost_in_rapier > 0 {
                let why = "tip over in rapier, which keeps four corners of the face they stand on";
                row(out, "", s.corners_lost_in_rapier, why)?;
            }
        }
        if s.soft + s.fluid > 0 {
            writeln!(
                out,
                "\n{} ({} soft, {} fluid) mapped and stored only: soft bodies and fluids are not simulated yet.",
                plural(s.soft + s.fluid, "model"),
                s.soft,
                s.fluid
            )?;
        }
    }
    if s.attributes > 0 {
        writeln!(
            out,
            "\n{} of {} attribute values are built-in defaults{}.",
            s.attributes_by_default,
            s.attributes,
            sizes(s)
        )?;
    }
    failures(out, s)?;
    concerns(out, "Break a law of the drop", &s.breaches)?;
    concerns(out, "Differ from rapier", &s.differences_from_rapier)?;
    if s.stopped {
        writeln!(out, "\nStopped before the end. What is done is kept: the same command goes on from here.")?;
    }
    let stages: Vec<String> = s
        .seconds_a_stage
        .iter()
        .filter_map(|(stage, seconds)| Some(format!("{stage} {:.1}", seconds.as_f64()?)))
        .collect();
    writeln!(out, "\n{:.1} s ({})", s.seconds, stages.join(", "))?;
    if !how_to_look.is_empty() {
        writeln!(out)?;
    }
    let width = how_to_look.iter().map(|(what, _)| what.len()).max().unwrap_or(0);
    for (what, where_to) in how_to_look {
        writeln!(out, "  {what:<width$}  {where_to}")?;
    }
    Ok(())
}

fn row(out: &mut dyn Write, what: &str, count: usize, remark: &str) -> io::Result<()> {
    writeln!(out, "{}", format!("  {what:<18}{count:>6}  {remark}").trim_end())
}

fn note(count: usize, what: &str) -> String {
    if count == 0 { String::new() } else { format!("{count} {what}") }
}

fn share(part: usize, whole: usize) -> String {
    if whole == 0 { String::new() } else { format!("{:.1} %", 100.0 * part as f64 / whole as f64) }
}

fn failures(out: &mut dyn Write, summary: &Summary) -> io::Result<()> {
    let failures = &summary.failures;
    if failures.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nFailed: {}", failures.len())?;
    for failure in failures.iter().take(SHOWN) {
        let place = if failure.place.is_empty() { String::new() } else { format!(" at {}", failure.place) };
        writeln!(out, "  {}", failure.file)?;
        writeln!(
            out,
            "    {} [{}]{place}: {}. {}",
            failure.stage, failure.code, failure.reason, failure.way_out
        )?;
    }
    rest(out, failures.len())
}

fn concerns(out: &mut dyn Write, title: &str, concerns: &[Concern]) -> io::Result<()> {
    if concerns.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{title}: {}", concerns.len())?;
    for concern in concerns.iter().take(SHOWN) {
        writeln!(out, "  {}: {}", concern.file, concern.what)?;
    }
    rest(out, concerns.len())
}

fn rest(out: &mut dyn Write, count: usize) -> io::Result<()> {
    if count > SHOWN {
        writeln!(out, "  and {} more, in summary.json", count - SHOWN)?;
    }
    Ok(())
}

/// `1 model`, `2 models`.
#[must_use]
pub fn plural(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The first page of the recording, as Markdown.
#[must_use]
pub fn recording_summary(lines: &[Line]) -> String {
    let count = |wanted: &dyn Fn(&Line) -> bool| lines.iter().filter(|line| wanted(line)).count();
    let mut text = format!(
        "# {}\n\n{} dropped, {} came to rest, {} agree with rapier.\n\nRed: active. Green: wants to sleep. Grey: asleep. \
         Pale blue: not simulated (soft, fluid, or fixed in place).\n",
        plural(lines.len(), "model"),
        count(&|line| line.dropped.is_some()),
        count(&Line::settled),
        count(&Line::agrees),
    );
    for line in lines.iter().filter(|line| !line.breaches().is_empty()).take(SHOWN) {
        // Writing to a string cannot fail.
        let _ = write!(text, "\n- {}: {}", line.model, line.breaches().join("; "));
    }
    text
}

/// What became of units and sizes.
fn sizes(s: &Summary) -> String {
    let mut told = String::new();
    if s.units_inferred > 0 {
        told += &format!("; the unit of {} follows from its size", plural(s.units_inferred, "model"));
    }
    if s.suspect_scale > 0 {
        told += &format!("; the size of {} fits no unit", plural(s.suspect_scale, "model"));
    }
    told
}
