//! The stage that says what a model is and which physics it has.

use std::fs;
use std::path::Path;

use anyhow::Result;
use importer::catalogue::StageRow;
use importer::{Asset, AssetKey, Catalogue, Failure, ModelRow, catch_panic};
use mapper::{Mapped, ModelFacts, Sidecar, sidecar_path};
use serde::de::DeserializeOwned;

use super::key::Key;
use super::stage::{self, staged};
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

/// What became of a model's mapping in this run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remapped {
    /// Nothing that it rests on has changed.
    Kept,
    /// The same answer; its reasons stand on other lines now.
    Moved,
    /// Made anew.
    Anew,
}

/// The stored key of a mapping: of every text whole, and of those entries of rules and overrides that this model's
/// answer rests on (see [`mapper::Reach`]). Where the first is the same nothing is read; where it is not, the second
/// tells whether the change reaches the model.
struct Keys {
    whole: String,
    content: String,
    places: String,
}

impl Keys {
    fn joined(&self) -> String {
        [&*self.whole, &*self.content, &*self.places].join(".")
    }

    fn of_row(key: &str) -> Option<Self> {
        let mut parts = key.split('.').map(str::to_owned);
        Some(Self { whole: parts.next()?, content: parts.next()?, places: parts.next()? })
    }
}

/// The model's line with what it was mapped to, or with the failure.
///
/// # Errors
/// The catalogue cannot be read or written.
pub(super) fn map(job: &Job<'_>, catalogue: &Catalogue, row: &ModelRow, line: &Line) -> Result<Line> {
    let Some(asset_key) = row.key else { return Ok(line.clone()) };
    let sidecar = sidecar_text(&row.path());
    let own = || {
        let mut key = Key::new(STAGE)
            .with(asset_key.0)
            .with(job.options.fingerprint())
            .with(&row.model)
            .with(sidecar.as_deref().unwrap_or_default());
        for text in &job.inputs.sets {
            key = key.with(text);
        }
        for tag in job.mapper.tags().of(&row.model) {
            key = key.with("tag").with(tag);
        }
        key
    };
    let mut whole = own().with(&job.inputs.rules);
    for text in &job.inputs.overrides {
        whole = whole.with(text);
    }
    let whole = whole.finish();
    let stored = catalogue.stage(&row.model, STAGE)?;
    let before = stored.as_ref().and_then(|row| Keys::of_row(&row.input_key));
    let unchanged = stored.as_ref().filter(|_| before.as_ref().is_some_and(|before| before.whole == whole));
    if let Some(same) = unchanged.and_then(stage::read) {
        return Ok(finished(line, same, Remapped::Kept));
    }
    let read = catch_panic(|| facts(job, catalogue, row, &asset_key, sidecar.as_deref()))
        .unwrap_or_else(|panic| Err(failure::of_panic(STAGE, &panic)));
    let (facts, sidecar) = match read {
        Ok(read) => read,
        Err(failure) => {
            // Not known how far the fault reaches: it stands for these very texts.
            let key = Keys { whole, content: String::new(), places: String::new() }.joined();
            let failed = staged::<Mapped>(catalogue, &row.model, STAGE, &key, || Err(failure))?;
            return Ok(finished(line, failed, Remapped::Anew));
        }
    };
    let consulted = job.mapper.consult(&facts, sidecar.as_ref(), &job.sets);
    let reach = consulted.reach();
    let key = |of: String| own().with(of).finish();
    let now = Keys { whole, content: key(reach.content), places: key(reach.places) };
    let same_content = before.as_ref().is_some_and(|before| before.content == now.content);
    let same_places = before.as_ref().is_some_and(|before| before.places == now.places);
    let kept = stored.filter(|_| same_content && same_places);
    if let Some((row, Ok(mapped))) = kept.and_then(|row| stage::read(&row).map(|result| (row, result))) {
        catalogue.put_stage(StageRow { input_key: now.joined(), ..row })?;
        return Ok(finished(line, Ok(mapped), Remapped::Kept));
    }
    let anew = staged(catalogue, &row.model, STAGE, &now.joined(), || Ok(consulted.answer()))?;
    Ok(finished(line, anew, if same_content { Remapped::Moved } else { Remapped::Anew }))
}

fn finished(line: &Line, staged: Result<Mapped, Failure>, remapped: Remapped) -> Line {
    match staged {
        Ok(mapped) => {
            Line { standing: Some(Standing::of(&mapped)), remapped: Some(remapped), ..line.clone() }
        }
        Err(failure) => line.failed(STAGE, failure),
    }
}

/// All that the mapping needs of the model.
fn facts(
    job: &Job<'_>,
    catalogue: &Catalogue,
    row: &ModelRow,
    key: &AssetKey,
    sidecar: Option<&str>,
) -> Result<(ModelFacts, Option<Sidecar>), Failure> {
    let asset = catalogue
        .asset_with_hull(key)
        .map_err(|error| failure::of_catalogue(&error))?
        .ok_or_else(failure::missing_asset)?;
    let sidecar = sidecar
        .map(|text| Sidecar::parse(&name_of(&sidecar_path(&row.path())), text, job.mapper.rules()))
        .transpose()
        .map_err(|error| failure::of_map(&error))?;
    Ok((ModelFacts::new(&row.model, &asset), sidecar))
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
