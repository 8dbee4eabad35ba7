//! `attributes.json`: the whole result of the mapping, a model a line, sorted by path.

use std::io::{self, Write};

use importer::Catalogue;
use mapper::Mapped;
use serde::Serialize;

use super::Line;
use crate::pipeline;

/// Writes a JSON array with one object a mapped model: its category, kind, scale, mass model and attributes, each
/// with its provenance and what it overrode. One model is held at a time.
///
/// # Errors
/// The catalogue cannot be read or `out` not written.
pub fn write_attributes(out: &mut dyn Write, catalogue: &Catalogue, lines: &[Line]) -> anyhow::Result<()> {
    #[derive(Serialize)]
    struct Record<'a> {
        model: &'a str,
        #[serde(flatten)]
        mapped: &'a Mapped,
    }
    out.write_all(b"[")?;
    let mut separator = "\n";
    for line in lines.iter().filter(|line| line.standing.is_some()) {
        let Some(mapped) = pipeline::mapped(catalogue, &line.model)? else { continue };
        let record = Record { model: &line.model, mapped: &mapped };
        out.write_all(separator.as_bytes())?;
        serde_json::to_writer(&mut *out, &record).map_err(io::Error::from)?;
        separator = ",\n";
    }
    out.write_all(b"\n]\n")?;
    Ok(())
}
