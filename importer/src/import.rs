//! Read, measure, make collider candidates.

use std::path::Path;

use crate::asset::{Asset, Mesh, Part, Source, SourcePart};
use crate::measure::{Measures, Welded, measure, weld};
use crate::{ImportError, Options, collider, guard, read};

/// Reads a model file and works out what it is: measures and colliders of the whole, and of each part where
/// there are from two to [`Options::part_ladders`] of them.
///
/// # Errors
/// As [`crate::read`]; a panic inside a library is [`ImportError::Panic`].
pub fn import(path: &Path, options: &Options) -> Result<Asset, ImportError> {
    let source = read(path, options)?;
    asset_of(&source, options).map_err(|error| error.in_file(path))
}

/// The asset of a model that is already read.
///
/// # Errors
/// [`ImportError::Panic`] where a library panics.
pub fn asset_of(source: &Source, options: &Options) -> Result<Asset, ImportError> {
    let with_ladders = (2..=options.part_ladders).contains(&source.parts.len());
    let mut parts = Vec::with_capacity(source.parts.len());
    if let [only] = source.parts.as_slice() {
        let (measures, ladder) = measured(&only.mesh, only.dropped, true, options)?;
        parts.push(part(only, measures.clone(), Vec::new()));
        return Ok(asset(source, measures, ladder, parts));
    }
    for piece in &source.parts {
        let (measures, ladder) = measured(&piece.mesh, piece.dropped, with_ladders, options)?;
        parts.push(part(piece, measures, ladder));
    }
    let dropped = source.parts.iter().map(|piece| piece.dropped).sum();
    let (measures, ladder) = measured(&source.merged(), dropped, true, options)?;
    Ok(asset(source, measures, ladder, parts))
}

fn measured(
    mesh: &Mesh,
    dropped: u64,
    with_ladder: bool,
    options: &Options,
) -> Result<(Measures, Vec<collider::Candidate>), ImportError> {
    let (welded, measures) = guard::catch("measure", || {
        let welded: Welded = weld(mesh);
        let mut measures = measure(&welded);
        measures.triangles += dropped;
        Ok((welded, measures))
    })?;
    let ladder = if with_ladder {
        guard::catch("colliders", || Ok(collider::ladder(&welded.mesh, &measures, options)))?
    } else {
        Vec::new()
    };
    Ok((measures, ladder))
}

fn part(piece: &SourcePart, measures: Measures, ladder: Vec<collider::Candidate>) -> Part {
    Part { name: piece.name.clone(), materials: piece.materials.clone(), measures, ladder }
}

fn asset(source: &Source, measures: Measures, ladder: Vec<collider::Candidate>, parts: Vec<Part>) -> Asset {
    Asset {
        key: source.key,
        format: source.format,
        frame: source.frame,
        measures,
        ladder,
        parts,
        names: source.names.clone(),
        notes: source.notes.clone(),
    }
}
