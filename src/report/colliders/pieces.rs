//! The chosen pieces as points, for whoever wants to use or measure them with other tools.

use std::path::Path;

use anyhow::{Context, Result};
use importer::collider::{Shape, surface};

/// A JSON list with one list of `[x, y, z]` points a piece, in file units and the file's axes; a piece is the convex
/// hull of its points. Round primitives are written in facets.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(path: &Path, shapes: &[Shape]) -> Result<()> {
    let pieces: Vec<Vec<[f64; 3]>> = shapes
        .iter()
        .map(|shape| match shape {
            Shape::Hull { points } => points.clone(),
            other => surface(other).0,
        })
        .collect();
    let text = serde_json::to_string(&pieces).context("cannot write points as JSON")?;
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
