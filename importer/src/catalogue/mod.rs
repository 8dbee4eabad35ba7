//! What is known of every model, on disk: one SQLite file, derived from the models and deletable.
//!
//! One thread writes; rows are gathered and committed every 500 rows or every second. Killed at any moment, a
//! run loses at most the rows in flight, and the next one makes them again. Readers see what is committed: call
//! [`Catalogue::flush`] first to read back what was just given.

mod encode;
mod error;
mod merge;
mod migrate;
mod read;
mod row;
mod statements;
mod write;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use rusqlite::Connection;

use crate::{Asset, AssetKey};
use encode::EncodedAsset;
use read::{Colliders, Readers};
use write::{Message, Row, Writer};

pub use error::CatalogueError;
pub use row::{Dependency, Failure, FailureRow, ModelRecord, ModelRow, StageRow, Stamp, Summary};

/// A handle on a catalogue. Clones share one writer; when the last is dropped, what was given is committed.
#[derive(Clone)]
pub struct Catalogue {
    inner: Arc<Inner>,
}

struct Inner {
    readers: Readers,
    fault: Arc<Mutex<Option<CatalogueError>>>,
    /// Taken when the last handle goes, which ends the writer.
    sender: Option<SyncSender<Message>>,
    writer: Option<JoinHandle<()>>,
    #[cfg(test)]
    connection: Arc<Mutex<Connection>>,
}

impl Drop for Inner {
    fn drop(&mut self) {
        self.readers.close();
        self.sender.take();
        if let Some(writer) = self.writer.take() {
            // A writer that panicked has nobody left to tell.
            drop(writer.join());
        }
    }
}

impl Catalogue {
    /// Opens the catalogue at `path`, making it where there is none and migrating it where it is old.
    ///
    /// # Errors
    /// Where the file cannot be opened, is not SQLite, belongs to another program, or was written by a newer
    /// release.
    pub fn open(path: &Path) -> Result<Self, CatalogueError> {
        let connection = Arc::new(Mutex::new(migrate::open_for_writing(path)?));
        let readers = Readers::Pool { path: path.to_path_buf(), idle: Mutex::new(Vec::new()) };
        Self::start(connection, readers)
    }

    /// A catalogue that is gone when its last handle is.
    ///
    /// # Errors
    /// Where SQLite has no memory.
    pub fn open_in_memory() -> Result<Self, CatalogueError> {
        let path = Path::new(":memory:");
        let mut connection = Connection::open_in_memory()
            .map_err(|error| CatalogueError::from_sqlite(path, "opening", &error))?;
        migrate::prepare(&mut connection, path)?;
        let connection = Arc::new(Mutex::new(connection));
        let readers = Readers::Shared(Arc::clone(&connection));
        Self::start(connection, readers)
    }

    fn start(connection: Arc<Mutex<Connection>>, readers: Readers) -> Result<Self, CatalogueError> {
        let (sender, messages) = sync_channel(write::QUEUE);
        let fault = Arc::new(Mutex::new(None));
        let path = readers.path().to_path_buf();
        #[cfg(test)]
        let shared = Arc::clone(&connection);
        let writer = Writer { path: path.clone(), connection, fault: Arc::clone(&fault) };
        let writer = thread::Builder::new()
            .name("catalogue".to_owned())
            .spawn(move || writer.run(&messages))
            .map_err(|error| CatalogueError::Open { path, reason: error.to_string() })?;
        let inner = Inner {
            readers,
            fault,
            sender: Some(sender),
            writer: Some(writer),
            #[cfg(test)]
            connection: shared,
        };
        Ok(Self { inner: Arc::new(inner) })
    }

    /// The file, or `:memory:`.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.inner.readers.path()
    }

    // Writing. Everything given before a call that returns an answer is committed when it returns.

    /// Stores a model and, where it was imported just now, its asset with it, in one transaction.
    ///
    /// # Errors
    /// Where a number in the asset is not finite, or an earlier write failed.
    pub fn put_model(&self, record: ModelRecord, asset: Option<Asset>) -> Result<(), CatalogueError> {
        let asset = asset
            .map(|asset| {
                let key = asset.key;
                EncodedAsset::new(asset)
                    .map(Box::new)
                    .map_err(|reason| CatalogueError::Unstorable { key: key.to_string(), reason })
            })
            .transpose()?;
        self.send(Message::Put(Row::Model { record: Box::new(record), asset }))
    }

    /// Stores why `stage` could not do its work on a model; a model's import failure goes with its record.
    ///
    /// # Errors
    /// Where an earlier write failed.
    pub fn put_failure(&self, row: FailureRow) -> Result<(), CatalogueError> {
        self.send(Message::Put(Row::Failure(row)))
    }

    /// Takes a failure back: the stage has done its work since.
    ///
    /// # Errors
    /// Where an earlier write failed.
    pub fn clear_failure(&self, model: &str, stage: &str) -> Result<(), CatalogueError> {
        let row = Row::FailureCleared { model: model.to_owned(), stage: stage.to_owned() };
        self.send(Message::Put(row))
    }

    /// Stores a stage's result over the one it had.
    ///
    /// # Errors
    /// Where an earlier write failed.
    pub fn put_stage(&self, row: StageRow) -> Result<(), CatalogueError> {
        self.send(Message::Put(Row::Stage(row)))
    }

    /// Drops the models of `root` that are not among `present`, with their failures and stage results; returns
    /// how many.
    ///
    /// # Errors
    /// Where this or an earlier write failed.
    pub fn forget_missing(&self, root: &Path, present: BTreeSet<String>) -> Result<usize, CatalogueError> {
        let root = root.to_string_lossy().into_owned();
        self.ask(|answer| Message::Forget { root, present, answer })
    }

    /// Drops the assets that no model holds; returns how many.
    ///
    /// # Errors
    /// Where this or an earlier write failed.
    pub fn prune(&self) -> Result<usize, CatalogueError> {
        self.ask(Message::Prune)
    }

    /// Takes over every row of the catalogue at `other`, whose rows win; whole or not at all.
    ///
    /// # Errors
    /// Where `other` cannot be opened or is no catalogue, is this one, or a write failed.
    pub fn merge_from(&self, other: &Path) -> Result<(), CatalogueError> {
        let other = other.to_path_buf();
        self.ask(|answer| Message::Merge { other, answer })
    }

    /// Waits until everything given is on the disk, safe from a loss of power. Costs a sync: not for every row.
    ///
    /// # Errors
    /// The first error the writer met, on this call and every later one.
    pub fn flush(&self) -> Result<(), CatalogueError> {
        self.ask(Message::Flush)
    }

    // Reading.

    /// Every model, sorted by name.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn models(&self) -> Result<Vec<ModelRow>, CatalogueError> {
        self.inner.readers.with("reading models", read::models)
    }

    /// One model.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn model(&self, model: &str) -> Result<Option<ModelRow>, CatalogueError> {
        Ok(self.record(model)?.map(|record| record.row))
    }

    /// One model with its stamps.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn record(&self, model: &str) -> Result<Option<ModelRecord>, CatalogueError> {
        self.inner.readers.with("reading a model", |connection| read::record(connection, model))
    }

    /// The asset under a key, bit for bit as it was stored, whatever options it was made under.
    ///
    /// # Errors
    /// Where the file cannot be read or a row of it makes no sense.
    pub fn asset(&self, key: &AssetKey) -> Result<Option<Asset>, CatalogueError> {
        self.asset_with(key, Colliders::All)
    }

    /// The same without its colliders but for the convex hull of the whole: all that a mapping asks for, and a
    /// hundredth of the bytes.
    ///
    /// # Errors
    /// As of [`Catalogue::asset`].
    pub fn asset_with_hull(&self, key: &AssetKey) -> Result<Option<Asset>, CatalogueError> {
        self.asset_with(key, Colliders::Hull)
    }

    fn asset_with(&self, key: &AssetKey, colliders: Colliders) -> Result<Option<Asset>, CatalogueError> {
        self.inner.readers.with("reading an asset", |connection| read::asset(connection, key, colliders))
    }

    /// Whether there is an asset under this key, made under options with this fingerprint.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn has_asset(&self, key: &AssetKey, fingerprint: &str) -> Result<bool, CatalogueError> {
        self.inner
            .readers
            .with("looking for an asset", |connection| read::has_asset(connection, key, fingerprint))
    }

    /// A stage's result for a model.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn stage(&self, model: &str, stage: &str) -> Result<Option<StageRow>, CatalogueError> {
        self.inner.readers.with("reading a result", |connection| read::stage(connection, model, stage))
    }

    /// A stage's results, sorted by model.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn stages(&self, stage: &str) -> Result<Vec<StageRow>, CatalogueError> {
        self.inner.readers.with("reading results", |connection| read::stages(connection, stage))
    }

    /// Every failure, sorted by model and stage.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn failures(&self) -> Result<Vec<FailureRow>, CatalogueError> {
        self.inner.readers.with("reading failures", read::failures)
    }

    /// Counts for a summary.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn summary(&self) -> Result<Summary, CatalogueError> {
        self.inner.readers.with("counting", read::summary)
    }

    /// Faults in the file itself; none in a sound one.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn check(&self) -> Result<Vec<String>, CatalogueError> {
        self.inner.readers.with("checking", read::check)
    }

    fn send(&self, message: Message) -> Result<(), CatalogueError> {
        if let Some(fault) = self.inner.fault.lock().unwrap_or_else(PoisonError::into_inner).clone() {
            return Err(fault);
        }
        let gone = || CatalogueError::WriterGone { path: self.path().to_path_buf() };
        self.inner.sender.as_ref().ok_or_else(gone)?.send(message).map_err(|_| gone())
    }

    fn ask<T>(
        &self,
        message: impl FnOnce(SyncSender<Result<T, CatalogueError>>) -> Message,
    ) -> Result<T, CatalogueError> {
        let (answer, answered) = sync_channel(1);
        self.send(message(answer))?;
        let gone = || CatalogueError::WriterGone { path: self.path().to_path_buf() };
        answered.recv().unwrap_or_else(|_| Err(gone()))
    }

    /// Lets a test set limits on the writer's own connection.
    #[cfg(test)]
    fn on_writer<T>(&self, work: impl FnOnce(&Connection) -> T) -> T {
        work(&self.inner.connection.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
