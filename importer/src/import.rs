//! Read, measure, make collider candidates.

mod refine;

use std::path::Path;

use crate::asset::{Asset, Mesh, Note, Part, Source};
use crate::measure::{Measures, VolumeMethod, Welded, measure, weld};
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
    for piece in &source.parts {
        let with_ladder = with_ladders || source.parts.len() == 1;
        let (mut measures, ladder) = measured(&piece.mesh, piece.dropped, with_ladder, options)?;
        refine::part(&mut measures, piece, source.geometry);
        parts.push(Part { name: piece.name.clone(), materials: piece.materials.clone(), measures, ladder });
    }
    if let [only] = parts.as_mut_slice() {
        // One part is the whole: its ladder is the asset's.
        let (measures, ladder) = (only.measures.clone(), std::mem::take(&mut only.ladder));
        return Ok(asset(source, measures, ladder, parts));
    }
    let dropped = source.parts.iter().map(|piece| piece.dropped).sum();
    let (mut measures, ladder) = measured(&source.merged(), dropped, true, options)?;
    refine::whole(&mut measures, source, &parts);
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
    let ladder = if with_ladder && options.with_colliders {
        guard::catch("colliders", || Ok(collider::ladder(&welded.mesh, &measures, options)))?
    } else {
        Vec::new()
    };
    Ok((measures, ladder))
}

fn asset(source: &Source, measures: Measures, ladder: Vec<collider::Candidate>, parts: Vec<Part>) -> Asset {
    let mut notes = source.notes.clone();
    notes.extend(told(&measures));
    Asset {
        key: source.key,
        format: source.format,
        geometry: source.geometry,
        frame: source.frame,
        measures,
        ladder,
        parts,
        names: source.names.clone(),
        stated: source.stated.clone(),
        notes,
    }
}

/// What had to be repaired or guessed to come to a volume.
fn told(measures: &Measures) -> Option<Note> {
    let (method, error) = measures.solid_method.zip(measures.solid_error)?;
    let percent = 100.0 * error;
    let (code, message) = match method {
        VolumeMethod::Closed | VolumeMethod::Exact => return None,
        VolumeMethod::Oriented => (
            "winding-repaired",
            "faces or bodies turned, or rims welded, until the surface is closed".to_owned(),
        ),
        VolumeMethod::Capped => (
            "holes-filled",
            format!(
                "{} open edges: the holes are filled, the volume is within {percent:.3} %",
                measures.boundary_edges
            ),
        ),
        VolumeMethod::Winding => (
            "volume-by-winding",
            format!("no closed surface: counted by winding number, within {percent:.1} %"),
        ),
        VolumeMethod::Hull => {
            ("volume-by-hull", "the surface encloses nothing: the convex hull is an upper bound".to_owned())
        }
    };
    Some(Note { code: code.to_owned(), place: String::new(), message })
}
