//! `physique merge`: the catalogues of shards become one.

use std::fs;

use anyhow::{Context, Result, bail};
use importer::Catalogue;
use serde_json::json;

use super::End;
use super::args::{Format, Global, MergeArgs};
use super::{job, output};

/// # Errors
/// A catalogue is not there, is no catalogue, or cannot be written. Those before it are merged whole.
pub(super) fn merge(global: &Global, args: &MergeArgs) -> Result<End> {
    let into = job::db(global);
    let from: Vec<_> = args
        .from
        .iter()
        .map(|path| if path.is_dir() { path.join("catalogue.db") } else { path.clone() })
        .collect();
    // Before anything is made: a wrong name must not leave an empty catalogue behind.
    if let Some(missing) = from.iter().find(|path| !path.is_file()) {
        bail!(
            "{}: no such catalogue; name a file, or a folder of results with a catalogue.db",
            missing.display()
        );
    }
    if let Some(folder) = into.parent() {
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let catalogue = Catalogue::open(&into)?;
    for other in &from {
        catalogue.merge_from(other)?;
    }
    catalogue.flush()?;
    let (models, failures) = (catalogue.models()?.len(), catalogue.failures()?.len());
    let merged = from.len();
    if global.format == Format::Json {
        let into = into.display().to_string();
        output::json(
            &json!({ "merged": merged, "models": models, "failures": failures, "catalogue": into }),
        )?;
    } else {
        output::result(|out| {
            writeln!(out, "{merged} catalogues merged: {models} models, {failures} failures")?;
            writeln!(out, "  catalogue  {}", into.display())
        })?;
    }
    Ok(End::Clean)
}
