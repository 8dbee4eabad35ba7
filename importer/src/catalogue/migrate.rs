//! Brings a file to the present schema, or says why it cannot be one.

use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use rusqlite::{Connection, ErrorCode, OpenFlags, TransactionBehavior};

use super::error::CatalogueError;

/// The schema's version, in `PRAGMA user_version`.
pub(super) const VERSION: i32 = 2;

/// "PHYS", in `PRAGMA application_id`: tells a catalogue from any other SQLite file.
pub(super) const APPLICATION_ID: i32 = 0x5048_5953;

const SCHEMA: &str = include_str!("schema.sql");

/// Steps from one version to the next: the first brings version 1 to version 2.
const STEPS: &[&str] = &[include_str!("step_2.sql")];

/// How long one process waits for another's transaction, which lasts milliseconds.
const BUSY_TIMEOUT: Duration = Duration::from_secs(60);

/// Opens for writing, making or migrating the file.
///
/// # Errors
/// Where the file cannot be opened, is no catalogue, or is newer than this release.
pub(super) fn open_for_writing(path: &Path) -> Result<Connection, CatalogueError> {
    // No URI flag: a path that begins with "file:" is a path.
    let flags =
        OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut connection = Connection::open_with_flags(path, flags).map_err(|error| refused(path, &error))?;
    prepare(&mut connection, path)?;
    Ok(connection)
}

/// Opens a catalogue that [`open_for_writing`] has made ready, for reading alone.
pub(super) fn open_for_reading(path: &Path) -> Result<Connection, CatalogueError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags).map_err(|error| refused(path, &error))?;
    connection.busy_timeout(BUSY_TIMEOUT).map_err(|error| refused(path, &error))?;
    Ok(connection)
}

/// Sets an open connection up and brings its schema to the present.
pub(super) fn prepare(connection: &mut Connection, path: &Path) -> Result<(), CatalogueError> {
    let refused = |error: rusqlite::Error| refused(path, &error);
    connection.busy_timeout(BUSY_TIMEOUT).map_err(refused)?;
    check_identity(connection, path)?;
    switch_to_wal(connection).map_err(refused)?;
    connection.pragma_update(None, "synchronous", "NORMAL").map_err(refused)?;
    connection.pragma_update(None, "foreign_keys", true).map_err(refused)?;
    bring_to(connection, path, VERSION, SCHEMA, STEPS)
}

/// Refuses before anything is changed.
fn check_identity(connection: &Connection, path: &Path) -> Result<(), CatalogueError> {
    let (id, version, tables) = identity(connection).map_err(|error| refused(path, &error))?;
    match (id, version, tables) {
        (APPLICATION_ID, version, _) if version > VERSION => {
            Err(CatalogueError::Newer { path: path.to_path_buf(), found: version, supported: VERSION })
        }
        (APPLICATION_ID, ..) | (0, 0, 0) => Ok(()),
        _ => Err(CatalogueError::Foreign { path: path.to_path_buf(), found: id }),
    }
}

/// Application id, version and number of tables, of one moment: another process may be making the file.
fn identity(connection: &Connection) -> rusqlite::Result<(i32, i32, i32)> {
    let moment = connection.unchecked_transaction()?;
    let number = |sql: &str| moment.query_row(sql, [], |row| row.get::<_, i32>(0));
    let tables = number("SELECT count(*) FROM sqlite_schema")?;
    Ok((number("PRAGMA application_id")?, number("PRAGMA user_version")?, tables))
}

/// The busy timeout does not cover this pragma where two processes open a new file at once.
fn switch_to_wal(connection: &Connection) -> rusqlite::Result<()> {
    let mut tries_left = 500;
    loop {
        match connection.query_row("PRAGMA journal_mode = WAL", [], |_| Ok(())) {
            Err(error)
                if tries_left > 0
                    && matches!(
                        error.sqlite_error_code(),
                        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked)
                    ) =>
            {
                tries_left -= 1;
                sleep(Duration::from_millis(20));
            }
            done => return done,
        }
    }
}

/// In one transaction, so that it happens whole or not at all, and once however many processes try.
fn bring_to(
    connection: &mut Connection,
    path: &Path,
    target: i32,
    schema: &str,
    steps: &[&str],
) -> Result<(), CatalogueError> {
    let failed =
        |error: rusqlite::Error| CatalogueError::from_sqlite(path, "bringing the schema up to date", &error);
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate).map_err(failed)?;
    let found: i32 = transaction.query_row("PRAGMA user_version", [], |row| row.get(0)).map_err(failed)?;
    if found == target {
        return Ok(());
    }
    if found == 0 {
        transaction.execute_batch(schema).map_err(failed)?;
        transaction.pragma_update(None, "application_id", APPLICATION_ID).map_err(failed)?;
        transaction
            .execute(
                "INSERT INTO meta (name, value) VALUES ('tool', 'physique'), ('made_by', ?1)",
                [env!("CARGO_PKG_VERSION")],
            )
            .map_err(failed)?;
    } else {
        let done = usize::try_from(found - 1).unwrap_or(0);
        for step in steps.iter().skip(done) {
            transaction.execute_batch(step).map_err(failed)?;
        }
    }
    transaction.pragma_update(None, "user_version", target).map_err(failed)?;
    transaction.commit().map_err(failed)
}

fn refused(path: &Path, error: &rusqlite::Error) -> CatalogueError {
    CatalogueError::from_sqlite(path, "opening", error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(connection: &Connection) -> Vec<String> {
        let mut statement =
            connection.prepare("SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY name").unwrap();
        statement.query_map([], |row| row.get(0)).unwrap().collect::<Result<_, _>>().unwrap()
    }

    #[test]
    fn every_version_but_the_first_has_its_step() {
        assert_eq!(STEPS.len() + 1, usize::try_from(VERSION).unwrap());
    }

    fn columns(connection: &Connection) -> Vec<String> {
        let sql = "SELECT t.name || '.' || c.cid || ' ' || c.name || ' ' || c.type || ' ' || c.\"notnull\" || ' ' || c.pk
             FROM sqlite_schema t, pragma_table_info(t.name) c WHERE t.type = 'table' ORDER BY 1";
        let mut statement = connection.prepare(sql).unwrap();
        statement.query_map([], |row| row.get(0)).unwrap().collect::<Result<_, _>>().unwrap()
    }

    #[test]
    fn the_first_version_comes_to_the_present_columns() {
        let path = Path::new("test");
        let mut old = Connection::open_in_memory().unwrap();
        bring_to(&mut old, path, 1, include_str!("../../tests/data/schema-1.sql"), &[]).unwrap();
        bring_to(&mut old, path, VERSION, SCHEMA, STEPS).unwrap();
        let mut new = Connection::open_in_memory().unwrap();
        bring_to(&mut new, path, VERSION, SCHEMA, STEPS).unwrap();
        assert_eq!(columns(&old), columns(&new));
    }

    #[test]
    fn steps_run_once_and_keep_the_rows() {
        let path = Path::new("test");
        let meta = "CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT);";
        let steps = ["CREATE TABLE second (n INTEGER);", "CREATE TABLE third (n INTEGER);"];
        let mut old = Connection::open_in_memory().unwrap();
        bring_to(&mut old, path, 1, meta, &[]).unwrap();
        bring_to(&mut old, path, 2, meta, &steps[..1]).unwrap();
        old.execute("INSERT INTO second VALUES (7)", []).unwrap();
        bring_to(&mut old, path, 3, meta, &steps).unwrap();
        bring_to(&mut old, path, 3, meta, &steps).unwrap();
        assert_eq!(old.query_row("SELECT n FROM second", [], |row| row.get::<_, i32>(0)).unwrap(), 7);

        let mut new = Connection::open_in_memory().unwrap();
        bring_to(&mut new, path, 3, &format!("{meta}{}{}", steps[0], steps[1]), &[]).unwrap();
        assert_eq!(shape(&old), shape(&new));
    }

    #[test]
    fn a_step_that_fails_leaves_the_old_version() {
        let path = Path::new("test");
        let mut connection = Connection::open_in_memory().unwrap();
        bring_to(&mut connection, path, 1, "CREATE TABLE meta (name TEXT, value TEXT);", &[]).unwrap();
        let before = shape(&connection);
        let step = ["CREATE TABLE second (n INTEGER); CREATE TABLE second (n INTEGER);"];
        assert!(bring_to(&mut connection, path, 2, "", &step).is_err());
        assert_eq!(shape(&connection), before);
        let version: i32 = connection.query_row("PRAGMA user_version", [], |row| row.get(0)).unwrap();
        assert_eq!(version, 1);
    }
}
