//! Reading connections, each used by one thread at a time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use rusqlite::{Connection, OptionalExtension, Row};

use super::encode::{WHOLE, decode_candidate};
use super::error::CatalogueError;
use super::migrate;
use super::row::{Dependency, Failure, FailureRow, ModelRecord, ModelRow, StageRow, Stamp, Summary};
use crate::{Asset, AssetKey, Part};

/// Connections kept open while nobody reads.
const IDLE: usize = 8;

/// Where readers find a connection.
pub(super) enum Readers {
    /// A file: as many connections as there are readers at once.
    Pool { path: PathBuf, idle: Mutex<Vec<Connection>> },
    /// A catalogue in memory has one connection, the writer's.
    Shared(Arc<Mutex<Connection>>),
}

impl Readers {
    pub fn path(&self) -> &Path {
        match self {
            Self::Pool { path, .. } => path,
            Self::Shared(_) => Path::new(":memory:"),
        }
    }

    pub fn with<T>(
        &self,
        doing: &'static str,
        work: impl FnOnce(&Connection) -> Result<T, ReadError>,
    ) -> Result<T, CatalogueError> {
        let outcome = match self {
            Self::Shared(connection) => work(&connection.lock().unwrap_or_else(PoisonError::into_inner)),
            Self::Pool { path, idle } => {
                let ready = idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
                let connection = ready.map_or_else(|| migrate::open_for_reading(path), Ok)?;
                let outcome = work(&connection);
                let mut idle = idle.lock().unwrap_or_else(PoisonError::into_inner);
                if idle.len() < IDLE {
                    idle.push(connection);
                }
                outcome
            }
        };
        outcome.map_err(|error| match error {
            ReadError::Sqlite(error) => CatalogueError::from_sqlite(self.path(), doing, &error),
            ReadError::Row { what, reason } => {
                CatalogueError::Corrupt { path: self.path().to_path_buf(), what, reason }
            }
        })
    }

    /// The writer must be the last to close the file: only it can fold the log into it.
    pub fn close(&self) {
        if let Self::Pool { idle, .. } = self {
            idle.lock().unwrap_or_else(PoisonError::into_inner).clear();
        }
    }
}

/// What can go wrong between a query and a value.
pub(super) enum ReadError {
    Sqlite(rusqlite::Error),
    Row { what: String, reason: String },
}

impl From<rusqlite::Error> for ReadError {
    fn from(error: rusqlite::Error) -> Self {
        Self::Sqlite(error)
    }
}

const MODEL_ROW: &str = "
    SELECT m.model, m.root, m.asset, f.code, f.place, f.reason, f.way_out,
           m.bytes, m.modified_ns, m.content, m.options
    FROM model AS m LEFT JOIN failure AS f ON f.model = m.model AND f.stage = 'import'";

pub(super) fn models(connection: &Connection) -> Result<Vec<ModelRow>, ReadError> {
    let mut statement = connection.prepare(&format!("{MODEL_ROW} ORDER BY m.model"))?;
    Ok(statement.query_map([], model_row)?.collect::<Result<_, _>>()?)
}

pub(super) fn record(connection: &Connection, model: &str) -> Result<Option<ModelRecord>, ReadError> {
    let mut statement = connection.prepare(&format!("{MODEL_ROW} WHERE m.model = ?1"))?;
    let record = statement.query_row([model], |row| {
        Ok(ModelRecord {
            row: model_row(row)?,
            stamp: Stamp { bytes: count(row, 7)?, modified_ns: row.get(8)? },
            dependencies: Vec::new(),
            content: row.get::<_, Option<[u8; 32]>>(9)?.map(AssetKey),
            options: row.get(10)?,
        })
    });
    let Some(mut record) = record.optional()? else {
        return Ok(None);
    };
    let mut statement = connection
        .prepare("SELECT path, bytes, modified_ns FROM dependency WHERE model = ?1 ORDER BY path")?;
    record.dependencies = statement
        .query_map([model], |row| {
            Ok(Dependency {
                path: row.get(0)?,
                stamp: Stamp { bytes: count(row, 1)?, modified_ns: row.get(2)? },
            })
        })?
        .collect::<Result<_, _>>()?;
    Ok(Some(record))
}

fn model_row(row: &Row<'_>) -> rusqlite::Result<ModelRow> {
    let failure = row.get::<_, Option<String>>(3)?.map(|code| failure(row, code, 4)).transpose()?;
    Ok(ModelRow {
        model: row.get(0)?,
        root: PathBuf::from(row.get::<_, String>(1)?),
        key: row.get::<_, Option<[u8; 32]>>(2)?.map(AssetKey),
        failure,
    })
}

fn failure(row: &Row<'_>, code: String, from: usize) -> rusqlite::Result<Failure> {
    Ok(Failure { code, place: row.get(from)?, reason: row.get(from + 1)?, way_out: row.get(from + 2)? })
}

pub(super) fn has_asset(connection: &Connection, key: &AssetKey, options: &str) -> Result<bool, ReadError> {
    let mut statement =
        connection.prepare("SELECT EXISTS (SELECT 1 FROM asset WHERE key = ?1 AND options = ?2)")?;
    Ok(statement.query_row((key.0, options), |row| row.get(0))?)
}

/// Which colliders of an asset are read: they are most of its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colliders {
    All,
    /// The convex hull of the whole.
    Hull,
}

impl Colliders {
    fn query(self) -> &'static str {
        match self {
            Self::All => {
                "SELECT part, facts, shapes, geometry FROM collider WHERE asset = ?1 ORDER BY part, step"
            }
            Self::Hull => {
                "SELECT part, facts, shapes, geometry FROM collider WHERE asset = ?1 AND part = -1 AND rung = 'hull'"
            }
        }
    }
}

pub(super) fn asset(
    connection: &Connection,
    key: &AssetKey,
    colliders: Colliders,
) -> Result<Option<Asset>, ReadError> {
    // One snapshot for the three tables, whatever the writer does meanwhile.
    let _snapshot = connection.unchecked_transaction()?;
    let facts: Option<String> = connection
        .query_row("SELECT facts FROM asset WHERE key = ?1", [key.0], |row| row.get(0))
        .optional()?;
    let Some(facts) = facts else {
        return Ok(None);
    };
    let broken =
        |what: &str, reason: String| ReadError::Row { what: format!("{what} of asset {key}"), reason };
    let mut asset: Asset =
        serde_json::from_str(&facts).map_err(|error| broken("facts", error.to_string()))?;

    let mut statement = connection.prepare("SELECT facts FROM part WHERE asset = ?1 ORDER BY part")?;
    let mut rows = statement.query([key.0])?;
    while let Some(row) = rows.next()? {
        let part: Part = serde_json::from_str(row.get_ref(0)?.as_str().map_err(rusqlite::Error::from)?)
            .map_err(|error| broken("a part", error.to_string()))?;
        asset.parts.push(part);
    }

    let mut statement = connection.prepare(colliders.query())?;
    let mut rows = statement.query([key.0])?;
    while let Some(row) = rows.next()? {
        let part: i64 = row.get(0)?;
        let facts = row.get_ref(1)?.as_str().map_err(rusqlite::Error::from)?;
        let shapes = row.get_ref(2)?.as_str().map_err(rusqlite::Error::from)?;
        let geometry = row.get_ref(3)?.as_blob().map_err(rusqlite::Error::from)?;
        let candidate =
            decode_candidate(facts, shapes, geometry).map_err(|reason| broken("a collider", reason))?;
        let ladder = if part == WHOLE {
            &mut asset.ladder
        } else {
            let index = usize::try_from(part).unwrap_or(usize::MAX);
            let part = asset.parts.get_mut(index);
            &mut part.ok_or_else(|| broken("a collider", format!("there is no part {index}")))?.ladder
        };
        ladder.push(candidate);
    }
    Ok(Some(asset))
}

pub(super) fn stage(
    connection: &Connection,
    model: &str,
    stage: &str,
) -> Result<Option<StageRow>, ReadError> {
    let mut statement = connection.prepare(
        "SELECT model, stage, input_key, status, result FROM stage WHERE model = ?1 AND stage = ?2",
    )?;
    Ok(statement.query_row([model, stage], stage_row).optional()?)
}

pub(super) fn stages(connection: &Connection, stage: &str) -> Result<Vec<StageRow>, ReadError> {
    let mut statement = connection.prepare(
        "SELECT model, stage, input_key, status, result FROM stage WHERE stage = ?1 ORDER BY model",
    )?;
    Ok(statement.query_map([stage], stage_row)?.collect::<Result<_, _>>()?)
}

fn stage_row(row: &Row<'_>) -> rusqlite::Result<StageRow> {
    Ok(StageRow {
        model: row.get(0)?,
        stage: row.get(1)?,
        input_key: row.get(2)?,
        status: row.get(3)?,
        result: row.get(4)?,
    })
}

pub(super) fn failures(connection: &Connection) -> Result<Vec<FailureRow>, ReadError> {
    let mut statement = connection
        .prepare("SELECT model, stage, code, place, reason, way_out FROM failure ORDER BY model, stage")?;
    let rows = statement.query_map([], |row| {
        Ok(FailureRow { model: row.get(0)?, stage: row.get(1)?, failure: failure(row, row.get(2)?, 3)? })
    })?;
    Ok(rows.collect::<Result<_, _>>()?)
}

pub(super) fn summary(connection: &Connection) -> Result<Summary, ReadError> {
    let number = |sql: &str| connection.query_row(sql, [], |row| count(row, 0));
    let by_name = |sql: &str| -> rusqlite::Result<_> {
        let mut counts = BTreeMap::<String, BTreeMap<String, u64>>::new();
        let mut statement = connection.prepare(sql)?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            counts.entry(row.get(0)?).or_default().insert(row.get(1)?, count(row, 2)?);
        }
        Ok(counts)
    };
    Ok(Summary {
        models: number("SELECT count(*) FROM model")?,
        imported: number("SELECT count(*) FROM model WHERE asset IS NOT NULL")?,
        assets: number("SELECT count(*) FROM asset")?,
        failures: by_name("SELECT stage, code, count(*) FROM failure GROUP BY stage, code")?,
        notes: by_name("SELECT '', code, count(DISTINCT asset) FROM note GROUP BY code")?
            .remove("")
            .unwrap_or_default(),
        stages: by_name("SELECT stage, status, count(*) FROM stage GROUP BY stage, status")?,
    })
}

/// SQLite's own check of the file, and of the references between its tables.
pub(super) fn check(connection: &Connection) -> Result<Vec<String>, ReadError> {
    let mut faults: Vec<String> = connection
        .prepare("PRAGMA integrity_check")?
        .query_map([], |row| row.get(0))?
        .collect::<Result<_, _>>()?;
    faults.retain(|fault| fault != "ok");
    let dangling: Vec<String> = connection
        .prepare("PRAGMA foreign_key_check")?
        .query_map([], |row| {
            Ok(format!(
                "{} refers to a missing row of {}",
                row.get::<_, String>(0)?,
                row.get::<_, String>(2)?
            ))
        })?
        .collect::<Result<_, _>>()?;
    faults.extend(dangling);
    Ok(faults)
}

/// Counts and sizes are stored signed and never negative.
fn count(row: &Row<'_>, column: usize) -> rusqlite::Result<u64> {
    row.get::<_, i64>(column).map(|number| u64::try_from(number).unwrap_or(0))
}
