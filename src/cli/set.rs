//! `physique set` and `physique get`: single values of a model, written beside it and read back.

use std::fs;
use std::io;
use std::path::Path;

use anyhow::{Context, Result, bail};
use mapper::{Attribute, Mapped, MassModel, Overrides, SetValue, Sidecar, Value, edit, sidecar_path};
use serde_json::json;

use super::End;
use super::args::{Format, GetArgs, Global, SetArgs};
use super::one::{One, one};
use super::{explain, job, output};

/// # Errors
/// A value does not fit its name, the model is not there, or the file cannot be written; then nothing is.
pub(super) fn set(global: &Global, args: &SetArgs) -> Result<End> {
    let rules = job::rules(global)?;
    let file = match &args.project {
        Some(project) => project.clone(),
        None => {
            if !args.model.is_file() {
                bail!("{}: no such model; name a model file", args.model.display());
            }
            sidecar_path(&args.model)
        }
    };
    let name = file.display().to_string();
    let mut text = match fs::read_to_string(&file) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
        Err(error) => return Err(error).with_context(|| format!("cannot read {name}")),
    };
    let selector = args.project.as_ref().map(|_| selector(args));
    for assignment in &args.values {
        SetValue::parse(assignment, &rules)?;
        let Some((key, value)) = assignment.split_once('=') else {
            bail!("{assignment:?} sets nothing: write NAME=VALUE, as mass=2.4kg");
        };
        if key.trim().starts_with("part.") {
            bail!("{assignment:?}: values of parts are written by hand, below `parts:` in {name}");
        }
        text = edit::set(&name, &text, selector.as_deref(), key.trim(), value.trim())?;
    }
    // Nothing is written that the next run would refuse.
    if selector.is_some() {
        Overrides::parse(&name, &text, &rules)?;
    } else {
        Sidecar::parse(&name, &text, &rules)?;
    }
    output::file(&file, |to| Ok(to.write_all(text.as_bytes())?))?;
    if !global.quiet {
        output::notice(&format!("written: {name}"));
    }
    Ok(End::Clean)
}

/// The glob of the entry in a project file: as given, else the model's path below the file's folder.
fn selector(args: &SetArgs) -> String {
    if let Some(glob) = &args.glob {
        return glob.clone();
    }
    let folder = args.project.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    let below = args.model.strip_prefix(folder).unwrap_or(&args.model);
    below.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// # Errors
/// The model is refused, the rules are not right, or it has no value of that name.
pub(super) fn get(global: &Global, args: &GetArgs) -> Result<End> {
    let overrides_from = explain::root_of(args.root.as_deref(), &args.model);
    let (mapper, _, sets) = job::mapping(global, &args.mapping, &overrides_from)?;
    let One { mapped, .. } = one(&args.model, args.root.as_deref(), &job::db(global), &mapper, &sets)?;
    let mut rows = rows(&mapped);
    if let Some(wanted) = &args.name {
        let known: Vec<String> = rows.iter().map(|row| row.name.clone()).collect();
        rows.retain(|row| row.name == *wanted);
        if rows.is_empty() {
            let near = mapper::nearest(wanted, known.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!(" (did you mean {near:?}?)"));
            bail!("{} has no value {wanted:?}{near}; it has {}", args.model.display(), known.join(", "));
        }
    }
    if global.format == Format::Json {
        let values: Vec<_> = rows
            .iter()
            .map(|row| json!({ "name": row.name, "value": row.value, "unit": row.unit, "place": row.place }))
            .collect();
        output::json(&values)?;
        return Ok(End::Clean);
    }
    output::result(|out| {
        for row in &rows {
            let value = match &row.value {
                serde_json::Value::String(text) => text.clone(),
                // As people write it: 5, not 5.0.
                other => other.as_f64().map_or_else(|| other.to_string(), |number| number.to_string()),
            };
            // One name asked for: the value first, for scripts that cut at the blank.
            if args.name.is_none() {
                write!(out, "{:20} ", row.name)?;
            }
            writeln!(out, "{value} {}  {}", row.unit, row.place)?;
        }
        Ok(())
    })?;
    Ok(End::Clean)
}

struct Row {
    name: String,
    value: serde_json::Value,
    /// SI, `1` for a pure number, `-` for a word.
    unit: String,
    /// `catalog.yaml:120 by preset:oak`
    place: String,
}

fn rows(mapped: &Mapped) -> Vec<Row> {
    let placed = |place: String, by: &str| format!("{place} by {by}");
    let word = |name: &str, value: String, place: String| Row {
        name: name.to_owned(),
        value: value.into(),
        unit: "-".to_owned(),
        place,
    };
    let decided = mapped.trace.first().filter(|trace| trace.won);
    let decided =
        decided.map_or_else(|| "nothing says so".to_owned(), |trace| placed(trace.by.place(), &trace.by.by));
    let mut rows = vec![
        word("category", mapped.category.as_deref().unwrap_or("uncategorized").to_owned(), decided.clone()),
        word("subcategory", mapped.subcategory.as_deref().unwrap_or("none").to_owned(), decided.clone()),
        word("kind", mapped.kind.to_string(), decided),
    ];
    if let (Some(preset), Some(by)) = (&mapped.preset, &mapped.preset_by) {
        rows.push(word("preset", preset.to_string(), placed(by.place(), &by.by)));
    }
    let by = &mapped.mass_model_by;
    rows.push(word("mass_model", written(mapped.mass_model), placed(by.place(), &by.by)));
    rows.push(word("unit", mapped.scale.unit.to_string(), mapped.scale.reason.clone()));
    rows.extend(mapped.attributes.iter().map(row));
    rows
}

fn row(attribute: &Attribute) -> Row {
    let by = &attribute.provenance;
    let part = attribute.part.map_or_else(String::new, |part| format!("part.{part}."));
    Row {
        name: format!("{part}{}", attribute.name),
        value: match &attribute.value {
            Value::Number(number) => json!(number),
            Value::Text(text) => json!(**text),
        },
        unit: attribute.unit.to_string(),
        place: format!("{} by {}", by.place(), by.by),
    }
}

/// As an override file would have it.
fn written(model: MassModel) -> String {
    match model {
        MassModel::Solid => "solid".to_owned(),
        MassModel::Shell { thickness_m } => format!("{{ shell: {thickness_m} m }}"),
        MassModel::Fill { fraction } => format!("{{ fill: {fraction} }}"),
        MassModel::Fixed { mass_kg } => format!("{{ fixed: {mass_kg} kg }}"),
    }
}
