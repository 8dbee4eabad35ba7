//! Speed against error, for colliders: what stands for a model, how wrong it is, and what it costs a step.
//!
//! Each model is measured with Physique's own choice and with parry's V-HACD at its defaults, by one ruler, on the
//! model as it is read, with all its parts as one.

mod page;
mod picture;
mod pieces;
mod pile;
mod summary;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use importer::collider::{self, Candidate, ColliderError};
use importer::{Measures, Mesh, Options};
use serde::Serialize;

use crate::bench::cpu_time;

pub use page::write_page;
pub use summary::write_summary;

/// Whose collider.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Tool {
    Physique,
    Parry,
}

/// One model with one tool's collider.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub model: String,
    pub triangles: usize,
    pub closed: bool,
    pub tool: Tool,
    /// Sphere, box, decomposition, …
    pub shape: &'static str,
    pub pieces: usize,
    pub vertices: u64,
    /// Shares of the diagonal.
    pub error: ColliderError,
    /// The largest error both ways in file units.
    pub worst_file_units: f64,
    /// How far beyond the tolerance, as a factor: at most one where it keeps to it.
    pub excess: f64,
    /// CPU time, one thread: to make it and everything cheaper that was tried before it.
    pub seconds: f64,
    /// The estimate by which candidates are compared: 1 for a sphere.
    pub cost: f64,
    /// Mean of a step of [`COPIES`] copies falling into a pile, ms; only for some models.
    pub pile_ms: Option<f64>,
    pub note: Option<String>,
}

/// Copies in a pile.
pub const COPIES: usize = 20;

/// What is measured of which models.
#[derive(Clone, Debug)]
pub struct Plan {
    pub models: PathBuf,
    pub options: Options,
    /// For how many models, spread evenly, a pile is stepped.
    pub piles: usize,
    /// Where `pictures/` and `pieces/` go, if anywhere; both folders are there.
    pub out: Option<PathBuf>,
}

/// Measures every model of the folder that can be read, in order of path; `done` hears of each.
///
/// # Errors
/// The folder cannot be listed, or a picture cannot be written.
pub fn measure(plan: &Plan, stop: &AtomicBool, mut done: impl FnMut(&[Row])) -> Result<Vec<Row>> {
    let paths = importer::discover(&plan.models)?;
    let stride = paths.len().checked_div(plan.piles).map_or(usize::MAX, |stride| stride.max(1));
    let mut piles = 0;
    let mut rows = Vec::new();
    for (i, path) in paths.iter().enumerate() {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let Ok(source) = importer::read(path, &plan.options) else { continue };
        let welded = importer::weld(&source.merged());
        let name = path.strip_prefix(&plan.models).unwrap_or(path).to_string_lossy().into_owned();
        let subject = Subject { name, measures: importer::measure(&welded), mesh: welded.mesh };
        // Where a model that was due cannot be read, the next one that can takes its place.
        let piled = piles < plan.piles && i >= piles * stride + stride / 2;
        piles += usize::from(piled);
        let of_model = subject.rows(plan, piled)?;
        done(&of_model);
        rows.extend(of_model);
    }
    Ok(rows)
}

/// A model, read and measured.
struct Subject {
    name: String,
    mesh: Mesh,
    measures: Measures,
}

impl Subject {
    fn rows(&self, plan: &Plan, piled: bool) -> Result<Vec<Row>> {
        let tolerance = plan.options.collider_tolerance;
        let begun = cpu_time();
        let ladder = collider::ladder(&self.mesh, &self.measures, &plan.options);
        let seconds = (cpu_time() - begun).as_secs_f64();
        let mut rows = Vec::new();
        if let Some(chosen) = collider::cheapest(&ladder, tolerance) {
            rows.push(self.row(Tool::Physique, chosen, seconds, tolerance, piled));
            if let Some(folder) = &plan.out {
                let file = folder.join("pictures").join(file_name(&self.name, "png"));
                picture::write(&file, &self.mesh, &chosen.shapes)
                    .with_context(|| format!("cannot write {}", file.display()))?;
                pieces::write(&folder.join("pieces").join(file_name(&self.name, "json")), &chosen.shapes)?;
            }
        }
        let begun = cpu_time();
        let parry = collider::parry_decomposition(&self.mesh, &self.measures, &plan.options, 64, 0.01);
        let seconds = (cpu_time() - begun).as_secs_f64();
        if let Some(made) = parry {
            if let Some(folder) = &plan.out {
                let file = file_name(&self.name, "parry.json");
                pieces::write(&folder.join("pieces").join(file), &made.shapes)?;
            }
            rows.push(self.row(Tool::Parry, &made, seconds, tolerance, piled));
        }
        Ok(rows)
    }

    fn row(&self, tool: Tool, candidate: &Candidate, seconds: f64, tolerance: f64, piled: bool) -> Row {
        let error = candidate.error;
        Row {
            model: self.name.clone(),
            triangles: self.mesh.triangles.len(),
            closed: self.measures.closed,
            tool,
            shape: candidate.rung.name(),
            pieces: candidate.shapes.len(),
            vertices: candidate.vertices,
            error,
            worst_file_units: error.surface_max.max(error.growth_max) * self.measures.diagonal(),
            excess: error.excess(tolerance),
            seconds,
            cost: candidate.cost,
            pile_ms: piled.then(|| pile::step_ms(&candidate.shapes, &self.measures)).flatten(),
            note: candidate.fallback.clone(),
        }
    }
}

/// Name of a model's file in a folder that holds one for each.
fn file_name(model: &str, extension: &str) -> String {
    format!("{}.{extension}", model.replace(['/', '\\'], "__"))
}

/// Rows as CSV; lengths in % of the diagonal.
///
/// # Errors
/// The file cannot be written.
pub fn write_csv(path: &Path, rows: &[Row]) -> Result<()> {
    let mut text = String::from(
        "model,tool,shape,triangles,closed,pieces,vertices,surface_p95_pct,surface_max_pct,growth_p95_pct,\
         growth_max_pct,worst_file_units,outside_share_pct,volume_ratio,seconds,cost,pile_ms,excess,note\n",
    );
    for row in rows {
        let e = &row.error;
        let pct = |share: f64| format!("{:.4}", share * 100.0);
        let maybe = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
        let fields = [
            quoted(&row.model),
            format!("{:?}", row.tool).to_lowercase(),
            row.shape.to_owned(),
            row.triangles.to_string(),
            row.closed.to_string(),
            row.pieces.to_string(),
            row.vertices.to_string(),
            pct(e.surface_p95),
            pct(e.surface_max),
            pct(e.growth_p95),
            pct(e.growth_max),
            format!("{:.6e}", row.worst_file_units),
            pct(e.outside_share),
            maybe(e.volume_ratio),
            format!("{:.4}", row.seconds),
            format!("{:.1}", row.cost),
            maybe(row.pile_ms),
            format!("{:.3}", row.excess),
            quoted(row.note.as_deref().unwrap_or("")),
        ];
        text.push_str(&fields.join(","));
        text.push('\n');
    }
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
