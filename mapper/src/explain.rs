//! The answer for one model as people read it: every value with its place and what it beat.

use std::fmt::Write;

use crate::attribute::{Provenance, Value, round};
use crate::facts::ModelFacts;
use crate::mapped::Mapped;

/// A plain text table, no colour.
#[must_use]
pub fn explain(model: &str, mapped: &Mapped, facts: &ModelFacts) -> String {
    let mut out = String::new();
    // Writing into a String cannot fail.
    let _ = write(&mut out, model, mapped, facts);
    out
}

fn write(out: &mut String, model: &str, mapped: &Mapped, facts: &ModelFacts) -> std::fmt::Result {
    writeln!(out, "{model}")?;
    let category = match (&mapped.category, &mapped.subcategory) {
        (Some(category), Some(subcategory)) => format!("{category} / {subcategory}"),
        (Some(category), None) => category.to_string(),
        _ => "uncategorized".to_owned(),
    };
    let synset = mapped.synset.as_ref().map_or_else(String::new, |synset| format!(", {synset}"));
    writeln!(out, "  category    {category}{synset}, confidence {:.2}", mapped.confidence)?;
    writeln!(out, "  kind        {}{}", mapped.kind, if mapped.anchored { ", fixed in place" } else { "" })?;
    if let (Some(preset), Some(by)) = (&mapped.preset, &mapped.preset_by) {
        writeln!(out, "  preset      {preset}, by {} at {}", by.by, by.place())?;
    }
    writeln!(
        out,
        "  mass model  {}, by {} at {}",
        mapped.mass_model,
        mapped.mass_model_by.by,
        mapped.mass_model_by.place()
    )?;
    if let Some(contents) = &mapped.contents {
        let share = round(contents.fill * 100.0);
        writeln!(
            out,
            "  contents    {} to {share} %, by {} at {}",
            contents.preset,
            contents.by.by,
            contents.by.place()
        )?;
    }
    let scale = &mapped.scale;
    writeln!(out, "  unit        {} = {} m: {}", scale.unit, round(scale.metres_per_unit), scale.reason)?;
    if let [Some(x), Some(y), Some(z)] =
        facts.extents.map(|side| side.map(|side| round(side * scale.metres_per_unit)))
    {
        writeln!(out, "  size        {x} x {y} x {z} m{}", if scale.suspect { ", suspect" } else { "" })?;
    }
    writeln!(out, "\nattributes")?;
    table(out, mapped, facts)?;
    if !mapped.trace.is_empty() {
        writeln!(out, "\nwhat it could be")?;
    }
    for trace in &mapped.trace {
        let verdict = if trace.won { "won".to_owned() } else { format!("lost: {}", trace.lost_because) };
        let name = trace.subcategory.as_deref().unwrap_or("category alone");
        writeln!(
            out,
            "  {:<24} {:.2}  {} ({} at {}) - {verdict}",
            name,
            trace.confidence,
            trace.because,
            trace.by.by,
            trace.by.place()
        )?;
    }
    if !mapped.findings.is_empty() {
        writeln!(out, "\nfindings")?;
    }
    for finding in &mapped.findings {
        let place = finding.place.as_ref().map_or_else(String::new, |place| format!(" ({})", place.place()));
        writeln!(out, "  {} {}{place}", finding.code, finding.message)?;
    }
    Ok(())
}

fn table(out: &mut String, mapped: &Mapped, facts: &ModelFacts) -> std::fmt::Result {
    let mut rows: Vec<[String; 4]> = Vec::new();
    for attribute in &mapped.attributes {
        let part = attribute.part.map_or_else(String::new, |part| {
            let name = facts.parts.get(part as usize).map_or("", |part| part.name.as_str());
            format!("[{part} {name}] ")
        });
        rows.push([
            format!("{part}{}", attribute.name),
            value(&attribute.value, &attribute.unit),
            source(&attribute.provenance),
            String::new(),
        ]);
        for (beaten, by) in &attribute.overrode {
            rows.push([
                String::new(),
                String::new(),
                String::new(),
                format!("over {} from {}", value(beaten, &attribute.unit), source(by)),
            ]);
        }
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let (names, values) = (width(0), width(1));
    for row in &rows {
        if row[3].is_empty() {
            writeln!(out, "  {:<names$}  {:<values$}  {}", row[0], row[1], row[2])?;
        } else {
            writeln!(out, "  {:<names$}  {:<values$}    {}", "", "", row[3])?;
        }
    }
    Ok(())
}

fn value(value: &Value, unit: &str) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    match value {
        Value::Number(number) => {
            let rounded = round(*number);
            if rounded.abs() >= 1e6 || (rounded != 0.0 && rounded.abs() < 1e-3) {
                return format!("{rounded:e}{unit}");
            }
            format!("{rounded}{unit}")
        }
        Value::Text(text) => format!("{text}{unit}"),
    }
}

fn source(by: &Provenance) -> String {
    let cites = by.cites.as_ref().map_or_else(String::new, |cites| format!(", after {cites}"));
    format!("{} ({}, {}{cites})", by.place(), by.layer, by.by)
}
