//! One recording of all drops, side by side, written while they are simulated.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use importer::{Catalogue, ModelRow, StageRow};
use viewer::{Gallery, Output, Slot};

use super::drop::{self, Sink, Stage};
use super::key::Key;
use super::{Job, Progress, visual};
use crate::report::{Line, recording_summary};
use importer::catch_panic;

/// This stage's name in the catalogue. Its row stands for the recording's file and not for a model.
const STAGE: &str = "record";

/// Most models in one recording: beyond this a viewer no longer loads it in a moment. Larger databases are
/// sampled evenly.
const MOST_MODELS: usize = 600;

/// A recording under way.
pub(super) struct Recorder<'a> {
    catalogue: &'a Catalogue,
    gallery: Gallery,
    /// Place in the gallery of every model that is shown.
    slots: BTreeMap<String, usize>,
    file: Option<PathBuf>,
    key: String,
    options: importer::Options,
}

impl<'a> Recorder<'a> {
    /// `None` where no recording is wanted, or where the one that is there was made from the same inputs.
    ///
    /// # Errors
    /// The file or the viewer cannot be opened.
    pub(super) fn open(
        job: &Job<'_>,
        catalogue: &'a Catalogue,
        stage: &Stage<'_>,
        rows: &[ModelRow],
        lines: &[Line],
        progress: &dyn Progress,
    ) -> Result<Option<Self>> {
        if job.record == super::RecordTo::default() {
            return Ok(None);
        }
        let key = key(stage, rows, lines);
        if !job.record.view && job.record.file.as_ref().is_some_and(|file| is_current(catalogue, file, &key))
        {
            return Ok(None);
        }
        let shown = shown(lines);
        let mapped = lines.iter().filter(|line| line.standing.is_some()).count();
        if shown.len() < mapped {
            progress.notice(&format!("the recording shows {} of {mapped} models, evenly taken", shown.len()));
        }
        if let Some(folder) = job.record.file.as_deref().and_then(Path::parent) {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        let output = Output { file: job.record.file.clone(), view: job.record.view, connect: None };
        let title = format!("physique: {}", job.models.display());
        let slots = shown.iter().map(|(_, slot)| slot.clone()).collect();
        let gallery = Gallery::open(output, title, String::new(), slots)?;
        for notice in gallery.notices() {
            progress.notice(notice);
        }
        let slots = shown.into_iter().enumerate().map(|(index, (model, _))| (model, index)).collect();
        Ok(Some(Self {
            catalogue,
            gallery,
            slots,
            file: job.record.file.clone(),
            key,
            options: job.options.clone(),
        }))
    }

    /// Where the drop of this model goes. A model that is not dropped is put on its pad as it is.
    pub(super) fn sink(&self, row: &ModelRow, line: &Line, progress: &dyn Progress) -> Option<Sink> {
        let slot = *self.slots.get(&row.model)?;
        let standing = line.standing.as_ref()?;
        let shown = catch_panic(|| {
            let (asset, mapped) = drop::stored(self.catalogue, row).map_err(|failure| failure.reason)?;
            let source = importer::read(&row.path(), &self.options).map_err(|error| error.to_string())?;
            let placement =
                mapper::scene::placement(&row.model, &asset, &mapped).map_err(|error| error.reason())?;
            let meshes = visual::meshes(&source, mapped.preset.as_deref(), &placement);
            Ok::<_, String>((meshes, visual::info(&row.model, &mapped)))
        });
        let (meshes, info) = match shown.unwrap_or_else(Err) {
            Ok(shown) => shown,
            Err(reason) => {
                progress.notice(&format!("{}: not shown in the recording: {reason}", row.model));
                return None;
            }
        };
        if !standing.is_dropped() {
            self.gallery.still(slot, meshes, info);
            return None;
        }
        let visuals = vec![viewer::Visual { entity: 1, meshes }];
        Some(Box::new(self.gallery.sink(slot, visuals, info)))
    }

    /// Closes the file and notes that it is whole, unless the job was stopped.
    ///
    /// # Errors
    /// The file could not be written to its end.
    pub(super) fn finish(self, job: &Job<'_>, catalogue: &Catalogue, lines: &[Line]) -> Result<()> {
        self.gallery.set_summary(recording_summary(lines));
        let written = self.gallery.finish()?;
        if let Some(file) = self.file.filter(|_| !job.stopped()) {
            catalogue.put_stage(StageRow {
                model: marker(&file),
                stage: STAGE.to_owned(),
                input_key: self.key,
                status: "done".to_owned(),
                result: serde_json::json!({ "bytes": written.bytes, "frames": written.frames }).to_string(),
            })?;
        }
        Ok(())
    }
}

/// All that the recording shows: every model's mapping and drop.
fn key(stage: &Stage<'_>, rows: &[ModelRow], lines: &[Line]) -> String {
    let mut key = Key::new(STAGE);
    for (row, line) in rows.iter().zip(lines) {
        let Some(standing) = &line.standing else { continue };
        key = key
            .with(&row.model)
            .with(row.key.map(|key| key.0).unwrap_or_default())
            .with(&standing.whole)
            .with(stage.key(row, line).unwrap_or_default());
    }
    key.finish()
}

/// Whether the file is there as it was left, and was made from the same inputs.
fn is_current(catalogue: &Catalogue, file: &Path, key: &str) -> bool {
    let Ok(Some(row)) = catalogue.stage(&marker(file), STAGE) else { return false };
    let bytes = serde_json::from_str::<serde_json::Value>(&row.result)
        .ok()
        .and_then(|result| result["bytes"].as_u64());
    row.input_key == key && fs::metadata(file).is_ok_and(|there| Some(there.len()) == bytes)
}

/// The recording's name in the catalogue: no model is called so, since models' paths are relative.
fn marker(file: &Path) -> String {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
    format!("/{}", absolute.display())
}

/// The models of the recording with their slots, by category and then by path; no two slots are named alike.
fn shown(lines: &[Line]) -> Vec<(String, Slot)> {
    let mut mapped: Vec<(&str, &str)> = lines
        .iter()
        .filter_map(|line| {
            Some((
                line.standing.as_ref()?.category.as_deref().unwrap_or("uncategorized"),
                line.model.as_str(),
            ))
        })
        .collect();
    mapped.sort_unstable();
    let count = mapped.len().min(MOST_MODELS);
    let mut shown: Vec<(String, Slot)> = Vec::with_capacity(count);
    let mut taken: BTreeMap<(String, String), u32> = BTreeMap::new();
    for index in 0..count {
        let (category, model) = mapped[index * mapped.len() / count];
        let stem = model.rsplit('/').next().unwrap_or(model);
        let stem = stem.split_once('.').map_or(stem, |(stem, _)| stem);
        let times = taken.entry((category.to_owned(), stem.to_owned())).or_default();
        *times += 1;
        let name = if *times == 1 { stem.to_owned() } else { format!("{stem} ({times})") };
        shown.push((model.to_owned(), Slot { category: category.to_owned(), name }));
    }
    shown
}
