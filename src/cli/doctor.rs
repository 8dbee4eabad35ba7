//! `physique doctor`: what is here and what is missing.

use std::thread;

use anyhow::Result;
use serde_json::json;

use super::End;
use super::args::{Format, Global};
use super::{job, output};

/// # Errors
/// The rules named by `--catalog` are not right, or stdout cannot be written.
pub(super) fn doctor(global: &Global) -> Result<End> {
    let rules = job::rules(global)?;
    let stats = rules.stats();
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let db = job::db(global);
    let catalogue = match (db.is_file(), importer_counts(&db)) {
        (false, _) => "not there yet: a run makes it".to_owned(),
        (true, Ok((models, failures))) => format!("{models} models, {failures} failures"),
        (true, Err(error)) => format!("cannot be read: {error}"),
    };
    let (viewer, advice) = viewer();
    let rules_of = global.catalog.as_ref().map_or("built in".to_owned(), |file| file.display().to_string());
    let presets = stats.presets_rigid + stats.presets_soft + stats.presets_fluid;
    if global.format == Format::Json {
        output::json(&json!({
            "physique": env!("CARGO_PKG_VERSION"),
            "features": { "viewer": cfg!(feature = "viewer"), "validate": cfg!(feature = "validate") },
            "cores": cores,
            "rules": {
                "from": rules_of, "categories": stats.categories, "subcategories": stats.subcategories,
                "presets": presets, "rules": stats.rules,
            },
            "viewer": viewer,
            "viewer_advice": advice,
            "catalogue": { "file": db.display().to_string(), "state": catalogue },
        }))?;
        return Ok(End::Clean);
    }
    let on = |flag| if flag { "on" } else { "off" };
    output::result(|out| {
        writeln!(out, "physique   {}", env!("CARGO_PKG_VERSION"))?;
        writeln!(
            out,
            "features   viewer {}, validate {}",
            on(cfg!(feature = "viewer")),
            on(cfg!(feature = "validate"))
        )?;
        writeln!(out, "cores      {cores} (no GPU is needed)")?;
        writeln!(
            out,
            "rules      {rules_of}: {} categories, {} subcategories, {presets} presets",
            stats.categories, stats.subcategories
        )?;
        writeln!(out, "viewer     {viewer}")?;
        if !advice.is_empty() {
            writeln!(out, "           {advice}")?;
        }
        writeln!(out, "catalogue  {}: {catalogue}", db.display())
    })?;
    Ok(End::Clean)
}

fn importer_counts(db: &std::path::Path) -> Result<(u64, u64)> {
    if !db.is_file() {
        return Ok((0, 0));
    }
    let summary = importer::Catalogue::open(db)?.summary()?;
    Ok((summary.models, summary.failures.values().flat_map(|codes| codes.values()).sum()))
}

/// What there is of a viewer, and what to do about it.
#[cfg(feature = "viewer")]
fn viewer() -> (String, String) {
    let wanted = viewer::RERUN_VERSION;
    match viewer::viewer_version() {
        Some(found) if found == wanted => (format!("rerun {found}"), String::new()),
        Some(found) => (
            format!("rerun {found}, but recordings are written by {wanted}"),
            format!("if they do not open: {}", viewer::INSTALL_HINT),
        ),
        None => {
            ("not found; recordings are written all the same".to_owned(), viewer::INSTALL_HINT.to_owned())
        }
    }
}

#[cfg(not(feature = "viewer"))]
fn viewer() -> (String, String) {
    ("not in this build".to_owned(), String::new())
}
