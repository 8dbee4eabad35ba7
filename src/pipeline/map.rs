//! The stage that says what a model is and which physics it has.

use std::fs;
use std::path::Path;

use anyhow::Result;
use importer::{Asset, AssetKey, Catalogue, Failure, ModelRow};
use mapper::{Mapped, ModelFacts, Sidecar, sidecar_path};
use serde::de::DeserializeOwned;

use super::key::Key;
use super::stage::staged;
use super::{Job, failure};
use crate::report::{Line, Standing};

/// This stage's name in the catalogue.
pub(super) const STAGE: &str = "map";

/// The texts that decide every mapping, for the key.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    pub rules: String,
    /// Of every project override file, in order.
    pub overrides: Vec<String>,
    /// `--set` as given.
    pub sets: Vec<String>,
}

/// The model's line with what it was mapped to, or with the failure.
///
/// # Errors
/// The catalogue cannot be read or written.
pub(super) fn map(job: &Job<'_>, catalogue: &Catalogue, row: &ModelRow, line: &Line) -> Result<Line> {
    let Some(asset_key) = row.key else { return Ok(line.clone()) };
    let sidecar = sidecar_text(&row.path());
    let mut key = Key::new(STAGE)
        .with(asset_key.0)
        .with(job.options.fingerprint())
        .with(&row.model)
        .with(&job.inputs.rules)
        .with(sidecar.as_deref().unwrap_or_default());
    for text in job.inputs.overrides.iter().chain(&job.inputs.sets) {
        key = key.with(text);
    }
    for tag in job.mapper.tags().of(&row.model) {
        key = key.with("tag").with(tag);
    }
    let staged = staged(catalogue, &row.model, STAGE, &key.finish(), || {
        let asset = asset(catalogue, &asset_key)?;
        let sidecar = sidecar
            .map(|text| Sidecar::parse(&name_of(&sidecar_path(&row.path())), &text, job.mapper.rules()))
            .transpose()
            .map_err(|error| failure::of_map(&error))?;
        let facts = ModelFacts::new(&row.model, &asset);
        Ok(job.mapper.map_with_sidecar(&facts, sidecar.as_ref(), &job.sets))
    })?;
    Ok(match staged {
        Ok(mapped) => Line { standing: Some(Standing::of(&mapped)), ..line.clone() },
        Err(failure) => line.failed(STAGE, failure),
    })
}

/// What this stage made of a model earlier.
///
/// # Errors
/// The catalogue cannot be read.
pub fn stored(catalogue: &Catalogue, model: &str) -> Result<Option<Mapped>> {
    stored_part(catalogue, model)
}

/// A part of it: what `T` names of the mapping, without reading the rest.
///
/// # Errors
/// The catalogue cannot be read.
pub(crate) fn stored_part<T: DeserializeOwned>(catalogue: &Catalogue, model: &str) -> Result<Option<T>> {
    let row = catalogue.stage(model, STAGE)?;
    Ok(row.and_then(|row| serde_json::from_str(&row.result).ok()))
}

pub(super) fn asset(catalogue: &Catalogue, key: &AssetKey) -> Result<Asset, Failure> {
    catalogue.asset(key).map_err(|error| failure::of_catalogue(&error))?.ok_or_else(failure::missing_asset)
}

/// `None` without a sidecar. One that cannot be read as text becomes a failure of the mapping, by its replacement
/// characters.
fn sidecar_text(model: &Path) -> Option<String> {
    let bytes = fs::read(sidecar_path(model)).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

fn name_of(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}
