//! From a folder of models to their physics: import → map → drop → compare → record.
//!
//! Every stage keeps its results in the catalogue under a key of all it depends on, so that a second run does
//! only what changed; one model's failure is a row and never stops the others. What a run holds in memory at once
//! is a line a model; assets, mappings and meshes are read one model a thread.

mod drop;
mod failure;
mod key;
mod map;
#[cfg(feature = "viewer")]
mod record;
mod stage;
#[cfg(feature = "viewer")]
pub mod visual;

pub(crate) use stage::staged;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use anyhow::{Context, Result};
use importer::{Catalogue, ModelRow, Shard};
use mapper::{Mapper, SetValue};
use rayon::prelude::*;

use crate::report::{Line, Report};

pub use drop::{Dropped, Settings};
pub(crate) use failure::{missing_asset, of_catalogue};
pub use failure::{of_map, of_placing, of_scene};
pub use key::Key;
pub(crate) use map::stored_part as mapped_part;
pub use map::{Inputs, Remapped, stored as mapped};

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Upto {
    Import,
    Map,
    Drop,
}

/// Where the recording goes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordTo {
    /// `None`: nothing is written.
    pub file: Option<PathBuf>,
    /// Also to a viewer, opened for it.
    pub view: bool,
}

/// What to do, on which models, with which rules.
pub struct Job<'a> {
    pub models: PathBuf,
    pub db: PathBuf,
    pub options: importer::Options,
    pub mapper: Mapper,
    /// The texts that the mapper was made from.
    pub inputs: Inputs,
    pub sets: Vec<SetValue>,
    pub drop: Settings,
    pub record: RecordTo,
    /// Which share of the models.
    pub shard: Shard,
    /// 0: one a core.
    pub threads: usize,
    pub upto: Upto,
    /// Set by an interrupt: no further model is begun.
    pub stop: &'a AtomicBool,
}

/// Hears how the work goes on; called from many threads.
pub trait Progress: importer::Progress {
    /// A stage after the import begins on so many models.
    fn begin(&self, stage: &'static str, models: usize);
    /// A model is done.
    fn advance(&self);
    /// Something the user should know, in one line.
    fn notice(&self, text: &str);
}

/// Does the job.
///
/// # Errors
/// Only what leaves nothing to do for any model: the folder cannot be listed, the catalogue or the recording
/// cannot be written, the rules have no such floor. A model's own trouble is a line of the report.
pub fn run(job: &Job<'_>, progress: &dyn Progress) -> Result<Report> {
    let start = Instant::now();
    let catalogue = open(job)?;
    let mut report = Report::new(&job.models, &job.drop);
    let mut lap = start;
    let mut clock = |report: &mut Report, stage: &'static str| {
        report.seconds_a_stage.push((stage, lap.elapsed().as_secs_f64()));
        lap = Instant::now();
    };

    let rows = import(job, &catalogue, progress)?;
    report.lines = rows.iter().map(Line::imported).collect();
    report.notes = catalogue.summary()?.notes;
    clock(&mut report, "import");

    if job.upto >= Upto::Map && !job.stopped() {
        report.lines = each(job, &rows, &report.lines, ("map", progress), |row, line| {
            map::map(job, &catalogue, row, line)
        })?;
        catalogue.flush()?;
        clock(&mut report, "map");
    }
    if job.upto >= Upto::Drop && !job.stopped() {
        let stage = drop::Stage::new(job, &catalogue)?;
        report.lines = drop_all(job, &catalogue, &stage, &rows, &report, progress)?;
        catalogue.flush()?;
        clock(&mut report, "drop");
        #[cfg(feature = "viewer")]
        {
            report.recording.clone_from(&job.record.file);
        }
    }
    report.stopped = job.stopped();
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

#[cfg(feature = "viewer")]
fn drop_all(
    job: &Job<'_>,
    catalogue: &Catalogue,
    stage: &drop::Stage<'_>,
    rows: &[ModelRow],
    report: &Report,
    progress: &dyn Progress,
) -> Result<Vec<Line>> {
    let recorder = record::Recorder::open(job, catalogue, stage, rows, &report.lines, progress)?;
    let lines = each(job, rows, &report.lines, ("drop", progress), |row, line| {
        let sink = recorder.as_ref().and_then(|recorder| recorder.sink(row, line, progress));
        stage.drop(row, line, sink)
    })?;
    if let Some(recorder) = recorder {
        recorder.finish(job, catalogue, &lines)?;
    }
    Ok(lines)
}

#[cfg(not(feature = "viewer"))]
fn drop_all(
    job: &Job<'_>,
    _: &Catalogue,
    stage: &drop::Stage<'_>,
    rows: &[ModelRow],
    report: &Report,
    progress: &dyn Progress,
) -> Result<Vec<Line>> {
    each(job, rows, &report.lines, ("drop", progress), |row, line| stage.drop(row, line, None))
}

/// Imports and maps, as far as anything changed; or maps what the catalogue has, where `import` is false. A line a
/// model, in the order of their names.
///
/// # Errors
/// As [`run`].
pub fn mapped_lines(
    job: &Job<'_>,
    catalogue: &Catalogue,
    import_models: bool,
    progress: &dyn Progress,
) -> Result<Vec<(ModelRow, Line)>> {
    let rows = if import_models { import(job, catalogue, progress)? } else { catalogue.models()? };
    let lines: Vec<Line> = rows.iter().map(Line::imported).collect();
    let lines = each(job, &rows, &lines, ("map", progress), |row, line| map::map(job, catalogue, row, line))?;
    catalogue.flush()?;
    Ok(rows.into_iter().zip(lines).collect())
}

/// The catalogue of a job, its folder made where it is missing.
///
/// # Errors
/// The folder cannot be made or the file not opened.
pub fn open(job: &Job<'_>) -> Result<Catalogue> {
    if let Some(folder) = job.db.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder {} for the catalogue", folder.display()))?;
    }
    Ok(Catalogue::open(&job.db)?)
}

fn import(job: &Job<'_>, catalogue: &Catalogue, progress: &dyn Progress) -> Result<Vec<ModelRow>> {
    let progress: &dyn importer::Progress = progress;
    let Job { models, options, shard, threads, stop, .. } = job;
    Ok(importer::import_shard(models, catalogue, options, *shard, *threads, progress, stop)?)
}

/// One line a model through `work`, on all threads, in the order of the rows. Once the job is stopped the
/// remaining lines stay as they are.
fn each(
    job: &Job<'_>,
    rows: &[ModelRow],
    lines: &[Line],
    (stage, progress): (&'static str, &dyn Progress),
    work: impl Fn(&ModelRow, &Line) -> Result<Line> + Sync,
) -> Result<Vec<Line>> {
    progress.begin(stage, rows.len());
    rows.par_iter()
        .zip(lines)
        // A task a model: their times differ by a factor of a thousand.
        .with_max_len(1)
        .map(|(row, line)| {
            if job.stopped() {
                return Ok(line.clone());
            }
            let line = work(row, line);
            progress.advance();
            line
        })
        .collect()
}

impl Job<'_> {
    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
