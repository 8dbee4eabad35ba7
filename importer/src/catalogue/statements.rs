//! The writer's SQL, prepared once a batch.

use rusqlite::types::Null;
use rusqlite::{Connection, Statement, ToSql, params};
use serde::Serialize;

use super::encode::EncodedAsset;
use super::row::{Dependency, Failure, ModelRecord, StageRow};
use super::write::Row;
use crate::{AssetKey, BodyVolume, Note};

/// The import's name in the failures table.
pub(super) const IMPORT: &str = "import";

pub(super) struct Statements<'c> {
    asset: Statement<'c>,
    drop_notes: Statement<'c>,
    note: Statement<'c>,
    drop_bodies: Statement<'c>,
    body: Statement<'c>,
    drop_parts: Statement<'c>,
    drop_colliders: Statement<'c>,
    part: Statement<'c>,
    collider: Statement<'c>,
    model: Statement<'c>,
    drop_dependencies: Statement<'c>,
    dependency: Statement<'c>,
    failure: Statement<'c>,
    drop_failure: Statement<'c>,
    stage: Statement<'c>,
}

impl<'c> Statements<'c> {
    pub fn prepare(connection: &'c Connection) -> rusqlite::Result<Self> {
        Ok(Self {
            asset: connection.prepare(
                "INSERT INTO asset (key, options, format, metres_per_unit, unit_stated, up, up_stated, triangles,
                     vertices_welded, closed, wound, bodies, volume, volume_method, area, size_x, size_y, size_z,
                     parts, notes, facts, geometry, volume_error, volume_confidence)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19,
                     ?20, ?21, ?22, ?23, ?24)
                 ON CONFLICT (key) DO UPDATE SET
                     options = excluded.options, format = excluded.format,
                     metres_per_unit = excluded.metres_per_unit, unit_stated = excluded.unit_stated,
                     up = excluded.up, up_stated = excluded.up_stated, triangles = excluded.triangles,
                     vertices_welded = excluded.vertices_welded, closed = excluded.closed,
                     wound = excluded.wound, bodies = excluded.bodies, volume = excluded.volume,
                     volume_method = excluded.volume_method, area = excluded.area, size_x = excluded.size_x,
                     size_y = excluded.size_y, size_z = excluded.size_z, parts = excluded.parts,
                     notes = excluded.notes, facts = excluded.facts, geometry = excluded.geometry,
                     volume_error = excluded.volume_error, volume_confidence = excluded.volume_confidence",
            )?,
            drop_notes: connection.prepare("DELETE FROM note WHERE asset = ?1")?,
            note: connection.prepare(
                "INSERT INTO note (asset, note, code, place, message) VALUES (?1, ?2, ?3, ?4, ?5)",
            )?,
            drop_bodies: connection.prepare("DELETE FROM body WHERE asset = ?1")?,
            body: connection.prepare(
                "INSERT INTO body (asset, body, role, triangles, volume, method, error, confidence)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
            )?,
            drop_parts: connection.prepare("DELETE FROM part WHERE asset = ?1")?,
            drop_colliders: connection.prepare("DELETE FROM collider WHERE asset = ?1")?,
            part: connection.prepare(
                "INSERT INTO part (asset, part, name, triangles, closed, volume, facts)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)",
            )?,
            collider: connection.prepare(
                "INSERT INTO collider (asset, part, step, rung, surface_max, surface_p95, growth_max,
                     outside_share, volume_ratio, pieces, vertices, cost, facts, shapes, geometry)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15)",
            )?,
            // An asset that another run has dropped in the meantime leaves the model to do.
            model: connection.prepare(
                "INSERT INTO model (model, root, bytes, modified_ns, content, options, asset)
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, (SELECT key FROM asset WHERE key = ?7))
                 ON CONFLICT (model) DO UPDATE SET
                     root = excluded.root, bytes = excluded.bytes, modified_ns = excluded.modified_ns,
                     content = excluded.content, options = excluded.options, asset = excluded.asset",
            )?,
            drop_dependencies: connection.prepare("DELETE FROM dependency WHERE model = ?1")?,
            dependency: connection.prepare(
                "INSERT INTO dependency (model, path, bytes, modified_ns) VALUES (?1, ?2, ?3, ?4)
                 ON CONFLICT (model, path) DO UPDATE SET
                     bytes = excluded.bytes, modified_ns = excluded.modified_ns",
            )?,
            failure: connection.prepare(
                "INSERT INTO failure (model, stage, code, place, reason, way_out) VALUES (?1, ?2, ?3, ?4, ?5, ?6)
                 ON CONFLICT (model, stage) DO UPDATE SET
                     code = excluded.code, place = excluded.place, reason = excluded.reason,
                     way_out = excluded.way_out",
            )?,
            drop_failure: connection.prepare("DELETE FROM failure WHERE model = ?1 AND stage = ?2")?,
            stage: connection.prepare(
                "INSERT INTO stage (model, stage, input_key, status, result) VALUES (?1, ?2, ?3, ?4, ?5)
                 ON CONFLICT (model, stage) DO UPDATE SET
                     input_key = excluded.input_key, status = excluded.status, result = excluded.result",
            )?,
        })
    }

    pub fn write(&mut self, row: &Row) -> rusqlite::Result<()> {
        match row {
            Row::Model { record, asset } => {
                if let Some(asset) = asset {
                    self.write_asset(asset, &record.options)?;
                }
                self.write_model(record)
            }
            Row::Failure(row) => self.write_failure(&row.model, &row.stage, &row.failure),
            Row::FailureCleared { model, stage } => self.drop_failure.execute([model, stage]).map(drop),
            Row::Stage(StageRow { model, stage, input_key, status, result }) => {
                self.stage.execute([model, stage, input_key, status, result]).map(drop)
            }
        }
    }

    fn write_model(&mut self, record: &ModelRecord) -> rusqlite::Result<()> {
        let row = &record.row;
        self.model.execute(params![
            row.model,
            row.root.to_string_lossy(),
            whole(record.stamp.bytes),
            record.stamp.modified_ns,
            blob(record.content.as_ref()),
            record.options,
            blob(row.key.as_ref()),
        ])?;
        self.drop_dependencies.execute([&row.model])?;
        for Dependency { path, stamp } in &record.dependencies {
            self.dependency.execute(params![row.model, path, whole(stamp.bytes), stamp.modified_ns])?;
        }
        match &row.failure {
            Some(failure) => self.write_failure(&row.model, IMPORT, failure),
            None => self.drop_failure.execute([row.model.as_str(), IMPORT]).map(drop),
        }
    }

    fn write_failure(&mut self, model: &str, stage: &str, failure: &Failure) -> rusqlite::Result<()> {
        let Failure { code, place, reason, way_out } = failure;
        self.failure.execute([model, stage, code, place, reason, way_out]).map(drop)
    }

    fn write_notes(&mut self, key: &[u8], notes: &[Note]) -> rusqlite::Result<()> {
        self.drop_notes.execute([key])?;
        for (index, note) in (0_i64..).zip(notes) {
            self.note.execute(params![key, index, note.code, note.place, note.message])?;
        }
        Ok(())
    }

    fn write_bodies(&mut self, key: &[u8], bodies: &[BodyVolume]) -> rusqlite::Result<()> {
        self.drop_bodies.execute([key])?;
        for (index, body) in (0_i64..).zip(bodies) {
            self.body.execute(params![
                key,
                index,
                name_of(body.role),
                whole(body.triangles),
                body.volume,
                body.method.and_then(name_of),
                body.error,
                body.confidence,
            ])?;
        }
        Ok(())
    }

    fn write_asset(&mut self, encoded: &EncodedAsset, options: &str) -> rusqlite::Result<()> {
        let EncodedAsset { asset, facts, parts, colliders } = encoded;
        let key = asset.key.0.as_slice();
        let measures = &asset.measures;
        let [size_x, size_y, size_z] = measures.size();
        self.asset.execute(params![
            key,
            options,
            name_of(asset.format),
            asset.frame.metres_per_unit,
            asset.frame.unit_stated,
            name_of(asset.frame.up),
            asset.frame.up_stated,
            whole(measures.triangles),
            whole(measures.vertices_welded),
            measures.closed,
            measures.wound_consistently,
            whole(measures.bodies),
            measures.solid.map(|solid| solid.measure),
            measures.solid_method.and_then(name_of),
            measures.shell.measure,
            size_x,
            size_y,
            size_z,
            whole(parts.len() as u64),
            whole(asset.notes.len() as u64),
            facts,
            name_of(asset.geometry),
            measures.solid_error,
            measures.solid_confidence,
        ])?;
        self.write_notes(key, &asset.notes)?;
        self.write_bodies(key, &measures.body_volumes)?;
        self.drop_parts.execute([key])?;
        self.drop_colliders.execute([key])?;
        for (index, part) in (0_i64..).zip(parts) {
            let measures = &part.part.measures;
            self.part.execute(params![
                key,
                index,
                part.part.name,
                whole(measures.triangles),
                measures.closed,
                measures.solid.map(|solid| solid.measure),
                part.facts,
            ])?;
        }
        for collider in colliders {
            let candidate = &collider.candidate;
            let error = &candidate.error;
            self.collider.execute(params![
                key,
                collider.part,
                collider.step,
                name_of(candidate.rung),
                error.surface_max,
                error.surface_p95,
                error.growth_max,
                error.outside_share,
                error.volume_ratio,
                whole(collider.pieces as u64),
                whole(candidate.vertices),
                candidate.cost,
                collider.facts,
                collider.shapes,
                collider.geometry,
            ])?;
        }
        Ok(())
    }
}

/// SQLite's integers are signed; no count or size comes near the limit.
fn whole(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

fn blob(key: Option<&AssetKey>) -> &dyn ToSql {
    match key {
        Some(key) => &key.0,
        None => &Null,
    }
}

/// The name serde gives a variant, so that columns and `facts` agree.
fn name_of(variant: impl Serialize) -> Option<String> {
    serde_json::to_value(variant).ok()?.as_str().map(str::to_owned)
}
