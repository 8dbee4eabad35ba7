//! Takes over the rows of another catalogue, so that shards made apart become one.

use std::path::Path;

use rusqlite::{Connection, TransactionBehavior};

use super::error::CatalogueError;
use super::migrate;

/// Whole tables, parents first. Where both hold a row, the other's wins.
const TAKE_OVER: &str = "
    DELETE FROM part WHERE asset IN (SELECT key FROM other.asset);
    DELETE FROM collider WHERE asset IN (SELECT key FROM other.asset);
    DELETE FROM note WHERE asset IN (SELECT key FROM other.asset);
    DELETE FROM body WHERE asset IN (SELECT key FROM other.asset);
    INSERT INTO asset SELECT * FROM other.asset WHERE true
        ON CONFLICT (key) DO UPDATE SET
            options = excluded.options, format = excluded.format, metres_per_unit = excluded.metres_per_unit,
            unit_stated = excluded.unit_stated, up = excluded.up, up_stated = excluded.up_stated,
            triangles = excluded.triangles, vertices_welded = excluded.vertices_welded,
            closed = excluded.closed, wound = excluded.wound, bodies = excluded.bodies,
            volume = excluded.volume, volume_method = excluded.volume_method, area = excluded.area,
            size_x = excluded.size_x, size_y = excluded.size_y, size_z = excluded.size_z,
            parts = excluded.parts, notes = excluded.notes, facts = excluded.facts,
            geometry = excluded.geometry, volume_error = excluded.volume_error,
            volume_confidence = excluded.volume_confidence;
    INSERT INTO part SELECT * FROM other.part;
    INSERT INTO collider SELECT * FROM other.collider;
    INSERT INTO note SELECT * FROM other.note;
    INSERT INTO body SELECT * FROM other.body;
    DELETE FROM dependency WHERE model IN (SELECT model FROM other.model);
    DELETE FROM failure WHERE stage = 'import' AND model IN (SELECT model FROM other.model);
    INSERT INTO model SELECT * FROM other.model WHERE true
        ON CONFLICT (model) DO UPDATE SET
            root = excluded.root, bytes = excluded.bytes, modified_ns = excluded.modified_ns,
            content = excluded.content, options = excluded.options, asset = excluded.asset;
    INSERT INTO dependency SELECT * FROM other.dependency;
    INSERT INTO failure SELECT * FROM other.failure WHERE true
        ON CONFLICT (model, stage) DO UPDATE SET
            code = excluded.code, place = excluded.place, reason = excluded.reason, way_out = excluded.way_out;
    INSERT INTO stage SELECT * FROM other.stage WHERE true
        ON CONFLICT (model, stage) DO UPDATE SET
            input_key = excluded.input_key, status = excluded.status, result = excluded.result;
";

/// Merges the catalogue at `other` into the one behind `connection`, whole or not at all.
pub(super) fn merge(connection: &mut Connection, path: &Path, other: &Path) -> Result<(), CatalogueError> {
    let cannot =
        |error: std::io::Error| CatalogueError::Open { path: other.to_path_buf(), reason: error.to_string() };
    let real = other.canonicalize().map_err(cannot)?;
    if path.canonicalize().is_ok_and(|path| path == real) {
        return Err(CatalogueError::MergeItself { path: path.to_path_buf() });
    }
    // Checks that it is a catalogue and brings it to our version, so that the columns are the same.
    drop(migrate::open_for_writing(other)?);
    let failed = |error: rusqlite::Error| CatalogueError::from_sqlite(path, "merging", &error);
    connection.execute("ATTACH DATABASE ?1 AS other", [real.to_string_lossy()]).map_err(failed)?;
    let outcome = (|| {
        let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        transaction.execute_batch(TAKE_OVER)?;
        transaction.commit()
    })();
    let detached = connection.execute_batch("DETACH DATABASE other");
    outcome.and(detached).map_err(failed)
}
