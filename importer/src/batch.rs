//! Imports a whole folder: in parallel, only what changed, one bad file never harming another.

mod alone;
mod folder;
mod gate;
mod journal;
mod shard;
mod stamp;

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use crate::catalogue::{Catalogue, CatalogueError, Failure, ModelRecord, ModelRow, Stamp};
use crate::{AssetKey, ImportError, Options, asset_of, read};
use folder::{Folder, Job};
use gate::Gate;
use journal::Journal;
use stamp::{are_unchanged, dependencies_of};

pub use alone::{Alone, Answer};
pub use shard::{Shard, in_shard};

/// Bytes of the files in work at once; a mesh in work takes several times its file.
const BYTES_IN_WORK: u64 = 128 << 20;

/// Convex decomposition recurses; the default of a spawned thread is a quarter of the main thread's.
const STACK_BYTES: usize = 16 << 20;

/// What a batch did about a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Measured and stored.
    Imported,
    /// Nothing to do: imported or refused before, and unchanged since. The row tells which.
    Cached,
    /// Refused just now.
    Failed,
}

/// Hears how far a batch is; called from many threads.
pub trait Progress: Sync {
    /// The number of models, once, before the first is done.
    fn total(&self, models: usize);
    /// A model is done.
    fn done(&self, model: &str, outcome: Outcome);
}

/// Nobody listens.
impl Progress for () {
    fn total(&self, _: usize) {}
    fn done(&self, _: &str, _: Outcome) {}
}

/// Imports every model under `root`, or the one that it is, into the catalogue; returns their rows, sorted by
/// model.
///
/// A model whose file, and the files it refers to, have the stamps they had, and which was imported or refused
/// under the same options, is not opened. Equal bytes under two paths are measured once. A refusal is a row
/// with a [`Failure`]; one that may pass by itself (`io`, `missing-file`) is tried again by every batch. Models
/// of this root that are gone are forgotten, and assets that no model holds are dropped.
///
/// Once `stop` is set no further model is begun, and the rows of those that are done are returned. Rows are on
/// disk within a second of being done, whatever happens to the process. `threads` of 0 means one a core.
///
/// # Errors
/// Where the root cannot be listed or the catalogue cannot be read or written; never for a model's sake.
pub fn import_folder(
    root: &Path,
    catalogue: &Catalogue,
    options: &Options,
    threads: usize,
    progress: &dyn Progress,
    stop: &AtomicBool,
) -> Result<Vec<ModelRow>, CatalogueError> {
    import_shard(root, catalogue, options, Shard::WHOLE, threads, progress, stop)
}

/// As [`import_folder`], for a share of the models: what all shards come to, merged, is what one whole batch
/// comes to.
///
/// # Errors
/// As [`import_folder`].
pub fn import_shard(
    root: &Path,
    catalogue: &Catalogue,
    options: &Options,
    shard: Shard,
    threads: usize,
    progress: &dyn Progress,
    stop: &AtomicBool,
) -> Result<Vec<ModelRow>, CatalogueError> {
    let folder = Folder::list(root)?;
    let mut jobs: Vec<&Job> = folder.jobs.iter().filter(|job| shard.holds(&job.model)).collect();
    // Large ones first: one left for the end would keep the other threads waiting.
    jobs.sort_by(|a, b| b.bytes().cmp(&a.bytes()).then_with(|| a.model.cmp(&b.model)));
    progress.total(jobs.len());

    let batch = Batch {
        root: &folder.root,
        catalogue,
        options,
        fingerprint: options.fingerprint(),
        progress,
        stop,
        gate: Gate::new(BYTES_IN_WORK),
        journal: Journal::open(catalogue.path()),
        claims: Mutex::default(),
        rows: Mutex::default(),
        fault: Mutex::default(),
    };
    let threads = match threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let twins = batch.run(&jobs, threads, OnTwin::Wait);
    batch.run(&twins, threads, OnTwin::Import);

    let fault = batch.fault.into_inner().unwrap_or_else(PoisonError::into_inner);
    fault.map_or(Ok(()), Err)?;
    if folder.is_whole && !stop.load(Ordering::Relaxed) {
        let present = folder.jobs.iter().map(|job| job.model.clone()).collect();
        catalogue.forget_missing(&folder.root, present)?;
        catalogue.prune()?;
    }
    catalogue.flush()?;
    let mut rows = batch.rows.into_inner().unwrap_or_else(PoisonError::into_inner);
    rows.sort_by(|a, b| a.model.cmp(&b.model));
    Ok(rows)
}

/// What to do about a model whose bytes another thread is working on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OnTwin {
    Wait,
    Import,
}

/// How far the first model with some bytes is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Claim {
    InWork,
    Stored,
}

struct Batch<'a> {
    root: &'a Path,
    catalogue: &'a Catalogue,
    options: &'a Options,
    fingerprint: String,
    progress: &'a dyn Progress,
    stop: &'a AtomicBool,
    gate: Gate,
    journal: Journal,
    claims: Mutex<BTreeMap<AssetKey, Claim>>,
    rows: Mutex<Vec<ModelRow>>,
    /// The first error of the catalogue; it ends the batch.
    fault: Mutex<Option<CatalogueError>>,
}

impl Batch<'_> {
    /// Works through the jobs; returns those that wait for a twin.
    fn run<'j>(&self, jobs: &[&'j Job], threads: usize, on_twin: OnTwin) -> Vec<&'j Job> {
        let next = AtomicUsize::new(0);
        let twins = Mutex::new(Vec::new());
        let work = || {
            while !self.stop.load(Ordering::Relaxed) && lock(&self.fault).is_none() {
                let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                match self.look_at(job, on_twin) {
                    Ok(Some((row, outcome))) => {
                        self.progress.done(&row.model, outcome);
                        lock(&self.rows).push(row);
                    }
                    Ok(None) => lock(&twins).push(*job),
                    Err(error) => drop(lock(&self.fault).get_or_insert(error)),
                }
            }
        };
        thread::scope(|scope| {
            let spawn = || thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work);
            let spawned = (0..threads.min(jobs.len())).take_while(|_| spawn().is_ok()).count();
            if spawned == 0 {
                work();
            }
        });
        twins.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// `None` where the model waits for its twin.
    fn look_at(&self, job: &Job, on_twin: OnTwin) -> Result<Option<(ModelRow, Outcome)>, CatalogueError> {
        let stamp = match &job.stamp {
            Ok(stamp) if job.is_named_by_utf8 => *stamp,
            Ok(stamp) => return self.refuse(job, *stamp, None, name_failure()).map(Some),
            Err(error) => {
                let source = io::Error::new(error.kind(), error.to_string());
                let error = ImportError::Io { file: job.path.clone(), source };
                let stamp = Stamp { bytes: 0, modified_ns: None };
                return self.refuse(job, stamp, None, Failure::from(&error)).map(Some);
            }
        };
        let known = self.catalogue.record(&job.model)?.filter(|known| known.options == self.fingerprint);
        if let Some(known) = &known
            && stamp.is_unchanged_since(&known.stamp)
            && are_unchanged(&known.dependencies, &job.path)
            && self.is_settled(&known.row)?
        {
            return self.keep(known.clone()).map(|row| Some((row, Outcome::Cached)));
        }

        let _pass = self.gate.enter(stamp.bytes);
        // Before reading, for the same reason as the stamp.
        let record = self.record(job, stamp);
        if let Some(alone) = self.options.alone.as_ref().filter(|_| self.journal.suspects(&job.model)) {
            return self.import_alone(job, record, alone).map(Some);
        }
        self.journal.begin(&job.model);
        let outcome = self.import_here(job, record, known, on_twin);
        self.journal.end(&job.model);
        outcome
    }

    fn import_alone(
        &self,
        job: &Job,
        mut record: ModelRecord,
        alone: &Alone,
    ) -> Result<(ModelRow, Outcome), CatalogueError> {
        let outcome = match alone.import(&job.path) {
            Answer::Asset(asset) => self.store(ModelRecord { content: Some(asset.key), ..record }, *asset),
            Answer::Failure(failure) => {
                record.row.failure = Some(failure);
                self.put(record, Outcome::Failed)
            }
        };
        self.journal.end(&job.model);
        outcome
    }

    fn import_here(
        &self,
        job: &Job,
        record: ModelRecord,
        known: Option<ModelRecord>,
        on_twin: OnTwin,
    ) -> Result<Option<(ModelRow, Outcome)>, CatalogueError> {
        let source = match read(&job.path, self.options) {
            Ok(source) => source,
            Err(error) => return self.refuse_record(record, &error).map(Some),
        };
        let record = ModelRecord { content: Some(source.key), ..record };
        if let Some(known) = known
            && known.content == record.content
            && known.row.failure.is_some()
        {
            let row = ModelRow { failure: known.row.failure, ..record.row };
            return self.put(ModelRecord { row, ..record }, Outcome::Cached).map(Some);
        }
        if self.is_stored(&source.key)? {
            let row = ModelRow { key: Some(source.key), ..record.row };
            return self.put(ModelRecord { row, ..record }, Outcome::Cached).map(Some);
        }
        if !self.claim(source.key) && on_twin == OnTwin::Wait {
            return Ok(None);
        }
        match asset_of(&source, self.options) {
            Ok(asset) => {
                drop(source);
                self.store(record, asset).map(Some)
            }
            Err(error) => self.refuse_record(record, &error.in_file(&job.path)).map(Some),
        }
    }

    /// Imported under these options, or refused.
    fn is_settled(&self, row: &ModelRow) -> Result<bool, CatalogueError> {
        match &row.key {
            Some(key) => self.catalogue.has_asset(key, &self.fingerprint),
            None => Ok(row.failure.is_some()),
        }
    }

    /// On disk, or on its way there.
    fn is_stored(&self, key: &AssetKey) -> Result<bool, CatalogueError> {
        if lock(&self.claims).get(key) == Some(&Claim::Stored) {
            return Ok(true);
        }
        self.catalogue.has_asset(key, &self.fingerprint)
    }

    /// False where another thread has it.
    fn claim(&self, key: AssetKey) -> bool {
        let mut claims = lock(&self.claims);
        let is_new = !claims.contains_key(&key);
        claims.entry(key).or_insert(Claim::InWork);
        is_new
    }

    fn record(&self, job: &Job, stamp: Stamp) -> ModelRecord {
        let dependencies = dependencies_of(&job.path, self.options.max_file_bytes);
        ModelRecord {
            row: ModelRow {
                model: job.model.clone(),
                root: self.root.to_path_buf(),
                key: None,
                failure: None,
            },
            stamp: Stamp { modified_ns: stamp.modified_ns.filter(|_| dependencies.is_some()), ..stamp },
            dependencies: dependencies.unwrap_or_default(),
            content: None,
            options: self.fingerprint.clone(),
        }
    }

    /// A model that is as it was; its root may have moved.
    fn keep(&self, mut known: ModelRecord) -> Result<ModelRow, CatalogueError> {
        if known.row.root != self.root {
            known.row.root = self.root.to_path_buf();
            self.catalogue.put_model(known.clone(), None)?;
        }
        Ok(known.row)
    }

    fn put(&self, record: ModelRecord, outcome: Outcome) -> Result<(ModelRow, Outcome), CatalogueError> {
        let row = record.row.clone();
        self.catalogue.put_model(record, None)?;
        Ok((row, outcome))
    }

    fn store(
        &self,
        mut record: ModelRecord,
        asset: crate::Asset,
    ) -> Result<(ModelRow, Outcome), CatalogueError> {
        let key = asset.key;
        record.row.key = Some(key);
        match self.catalogue.put_model(record.clone(), Some(asset)) {
            Ok(()) => {
                lock(&self.claims).insert(key, Claim::Stored);
                Ok((record.row, Outcome::Imported))
            }
            Err(CatalogueError::Unstorable { reason, .. }) => {
                record.row.key = None;
                record.row.failure = Some(Failure {
                    code: "not-finite".to_owned(),
                    place: String::new(),
                    reason,
                    way_out: "Scale the model to sizes that can be squared, or leave it out".to_owned(),
                });
                self.put(record, Outcome::Failed)
            }
            Err(error) => Err(error),
        }
    }

    fn refuse_record(
        &self,
        mut record: ModelRecord,
        error: &ImportError,
    ) -> Result<(ModelRow, Outcome), CatalogueError> {
        // What is wrong lies outside the file, and may be put right without changing it.
        if matches!(error, ImportError::Io { .. } | ImportError::MissingFile { .. }) {
            record.stamp.modified_ns = None;
        }
        record.row.failure = Some(Failure::from(error));
        self.put(record, Outcome::Failed)
    }

    fn refuse(
        &self,
        job: &Job,
        stamp: Stamp,
        content: Option<AssetKey>,
        failure: Failure,
    ) -> Result<(ModelRow, Outcome), CatalogueError> {
        let row = ModelRow {
            model: job.model.clone(),
            root: self.root.to_path_buf(),
            key: None,
            failure: Some(failure),
        };
        let record = ModelRecord {
            row,
            stamp: Stamp { modified_ns: None, ..stamp },
            dependencies: Vec::new(),
            content,
            options: self.fingerprint.clone(),
        };
        self.put(record, Outcome::Failed)
    }
}

fn name_failure() -> Failure {
    Failure {
        code: "path-not-utf8".to_owned(),
        place: String::new(),
        reason: "the file's path is not UTF-8, which the catalogue needs".to_owned(),
        way_out: "Rename the file or its folder".to_owned(),
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
