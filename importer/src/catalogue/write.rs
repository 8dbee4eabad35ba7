//! The one writer: a thread that gathers rows and commits them in batches.
//!
//! Rows wait in memory, not in an open transaction, so that the lock is held for milliseconds and two runs can
//! share a catalogue.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rusqlite::{Connection, TransactionBehavior};

use super::encode::EncodedAsset;
use super::error::CatalogueError;
use super::merge;
use super::row::{FailureRow, ModelRecord, StageRow};
use super::statements::Statements;

/// Rows in a transaction at most.
const BATCH_ROWS: usize = 500;

/// Time a row waits at most before it is committed.
const BATCH_TIME: Duration = Duration::from_secs(1);

/// Memory that waiting rows take at most, about.
const BATCH_BYTES: usize = 32 << 20;

/// Messages in the channel at most: who is faster than the disk waits.
pub(super) const QUEUE: usize = 64;

/// Something to be written.
pub(super) enum Row {
    Model { record: Box<ModelRecord>, asset: Option<Box<EncodedAsset>> },
    Failure(FailureRow),
    FailureCleared { model: String, stage: String },
    Stage(StageRow),
}

impl Row {
    fn bytes(&self) -> usize {
        match self {
            Self::Model { asset: Some(asset), .. } => asset.bytes(),
            Self::Stage(stage) => stage.result.len(),
            _ => 256,
        }
    }
}

/// What the writer is asked. An answer is sent once everything given before is committed.
pub(super) enum Message {
    Put(Row),
    Flush(SyncSender<Result<(), CatalogueError>>),
    /// Drops the models of `root` that are not in `present`.
    Forget {
        root: String,
        present: BTreeSet<String>,
        answer: SyncSender<Result<usize, CatalogueError>>,
    },
    /// Drops the assets that no model holds.
    Prune(SyncSender<Result<usize, CatalogueError>>),
    Merge {
        other: PathBuf,
        answer: SyncSender<Result<(), CatalogueError>>,
    },
}

pub(super) struct Writer {
    pub path: PathBuf,
    pub connection: Arc<Mutex<Connection>>,
    /// The first error. It stays: rows are lost, so every later call must hear of it.
    pub fault: Arc<Mutex<Option<CatalogueError>>>,
}

impl Writer {
    /// Runs until every sender is gone, then commits what is left.
    pub fn run(self, messages: &Receiver<Message>) {
        let mut waiting = Vec::new();
        let mut bytes = 0;
        let mut due = Instant::now();
        loop {
            let message = if waiting.is_empty() {
                messages.recv().map_err(|_| RecvTimeoutError::Disconnected)
            } else {
                messages.recv_timeout(due.saturating_duration_since(Instant::now()))
            };
            match message {
                Ok(Message::Put(row)) => {
                    if waiting.is_empty() {
                        due = Instant::now() + BATCH_TIME;
                    }
                    bytes += row.bytes();
                    waiting.push(row);
                    if waiting.len() < BATCH_ROWS && bytes < BATCH_BYTES && Instant::now() < due {
                        continue;
                    }
                    self.commit(&mut waiting);
                }
                Ok(request) => {
                    self.commit(&mut waiting);
                    self.answer(request);
                }
                Err(RecvTimeoutError::Timeout) => self.commit(&mut waiting),
                Err(RecvTimeoutError::Disconnected) => {
                    self.commit(&mut waiting);
                    return;
                }
            }
            bytes = 0;
        }
    }

    /// Writes the waiting rows, or keeps the reason why not. They are gone either way: the next run makes
    /// them again.
    fn commit(&self, waiting: &mut Vec<Row>) {
        let rows = std::mem::take(waiting);
        if rows.is_empty() || self.fault().is_some() {
            return;
        }
        let outcome = self.in_transaction("storing rows", |connection| {
            let mut statements = Statements::prepare(connection)?;
            rows.iter().try_for_each(|row| statements.write(row))
        });
        if let Err(error) = outcome {
            self.keep(error);
        }
    }

    fn answer(&self, request: Message) {
        // A caller that no longer listens has lost interest in the answer.
        match request {
            Message::Put(_) => {}
            Message::Flush(answer) => drop(answer.send(self.unless_faulty(|| self.sync()))),
            Message::Forget { root, present, answer } => drop(answer.send(self.unless_faulty(|| {
                self.in_transaction("forgetting models", |connection| forget(connection, &root, &present))
            }))),
            Message::Prune(answer) => drop(answer.send(self.unless_faulty(|| {
                self.in_transaction("dropping assets", |connection| {
                    connection.execute(
                        "DELETE FROM asset WHERE key NOT IN (SELECT asset FROM model WHERE asset IS NOT NULL)",
                        [],
                    )
                })
            }))),
            Message::Merge { other, answer } => drop(answer.send(self.unless_faulty(|| {
                let connection = &mut *self.connection.lock().unwrap_or_else(PoisonError::into_inner);
                merge::merge(connection, &self.path, &other)
            }))),
        }
    }

    /// These requests are one transaction each: where one fails nothing is lost, so only its caller hears of it.
    fn unless_faulty<T>(
        &self,
        work: impl FnOnce() -> Result<T, CatalogueError>,
    ) -> Result<T, CatalogueError> {
        if let Some(fault) = self.fault() {
            return Err(fault);
        }
        work()
    }

    /// With `synchronous = NORMAL` a commit outlives the process; a checkpoint makes it outlive the power.
    fn sync(&self) -> Result<(), CatalogueError> {
        let connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        connection
            .query_row("PRAGMA wal_checkpoint(PASSIVE)", [], |_| Ok(()))
            .map_err(|error| CatalogueError::from_sqlite(&self.path, "syncing", &error))
    }

    fn in_transaction<T>(
        &self,
        doing: &'static str,
        work: impl FnOnce(&Connection) -> rusqlite::Result<T>,
    ) -> Result<T, CatalogueError> {
        let mut connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        (|| {
            let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let outcome = work(&transaction)?;
            transaction.commit()?;
            Ok(outcome)
        })()
        .map_err(|error| CatalogueError::from_sqlite(&self.path, doing, &error))
    }

    fn fault(&self) -> Option<CatalogueError> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn keep(&self, error: CatalogueError) {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

fn forget(connection: &Connection, root: &str, present: &BTreeSet<String>) -> rusqlite::Result<usize> {
    let mut stored = connection.prepare("SELECT model FROM model WHERE root = ?1")?;
    let stored: Vec<String> = stored.query_map([root], |row| row.get(0))?.collect::<Result<_, _>>()?;
    let mut drop_model = connection.prepare("DELETE FROM model WHERE model = ?1")?;
    stored
        .iter()
        .filter(|model| !present.contains(*model))
        .try_fold(0, |gone, model| Ok(gone + drop_model.execute([model])?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Catalogue;

    fn stage(index: usize) -> StageRow {
        StageRow {
            model: format!("m{index:04}"),
            stage: "map".to_owned(),
            input_key: "k".to_owned(),
            status: "done".to_owned(),
            result: format!("{:?}", "x".repeat(2_000)),
        }
    }

    #[test]
    fn a_full_disk_is_told_to_every_caller_and_harms_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.sqlite");
        let catalogue = Catalogue::open(&path).unwrap();
        (0..50).for_each(|index| catalogue.put_stage(stage(index)).unwrap());
        catalogue.flush().unwrap();
        // SQLite reports a page limit with the same code as a disk without room.
        catalogue.on_writer(|connection| {
            let pages: i64 = connection.query_row("PRAGMA page_count", [], |row| row.get(0)).unwrap();
            let limit = format!("PRAGMA max_page_count = {}", pages + 4);
            connection.query_row(&limit, [], |row| row.get::<_, i64>(0)).unwrap();
        });
        (50..250).for_each(|index| drop(catalogue.put_stage(stage(index))));
        let full = CatalogueError::Full { path: path.clone() };
        assert_eq!(catalogue.flush(), Err(full.clone()));
        assert_eq!(catalogue.put_stage(stage(0)), Err(full.clone()));
        assert_eq!(catalogue.flush(), Err(full));
        drop(catalogue);

        let catalogue = Catalogue::open(&path).unwrap();
        assert_eq!(catalogue.check(), Ok(Vec::new()));
        assert_eq!(catalogue.stages("map").unwrap(), (0..50).map(stage).collect::<Vec<_>>());
        catalogue.put_stage(stage(50)).unwrap();
        catalogue.flush().unwrap();
        assert_eq!(catalogue.stages("map").unwrap().len(), 51);
    }
}
