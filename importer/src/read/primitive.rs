//! One glTF primitive: corners in the order of its mode, made triangles.

use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use crate::ImportError;

use super::accessor::Accessors;
use super::attributes::Attributes;
use super::notes::Notes;
use super::skin::Bond;

/// Positions in the mesh's own frame.
#[derive(Debug)]
pub(super) struct Piece {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// Per vertex, where there are any: the joints it hangs on.
    pub bonds: Result<Vec<Bond>, String>,
}

/// `None`, with a note, for what is no surface.
pub(super) fn read(
    primitive: &Primitive,
    accessors: &Accessors<'_>,
    place: &str,
    notes: &mut Notes,
) -> Result<Option<Piece>, ImportError> {
    let Some(mode) = surface_mode(primitive, place, notes) else { return Ok(None) };
    let attributes = Attributes::open(primitive, accessors, place, notes)?;
    let Some(positions) = attributes.vectors::<3>(&Semantic::Positions)? else {
        notes.add("no-position", place, "a primitive without POSITION has no geometry");
        return Ok(None);
    };
    if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
        notes.add("morph-ignored", place, "morph targets are left out: the base shape is read");
    }
    let triangles = match attributes.packed_triangles() {
        Some(triangles) => triangles,
        None => {
            let corners = attributes.corners(positions.len())?;
            if mode == Mode::Triangles && corners.len() % 3 != 0 {
                let message =
                    format!("{} corners do not make whole triangles: the rest is left out", corners.len());
                notes.add("faces-dropped", place, message);
            }
            triangles_of(mode, &corners)
        }
    };
    // A broken skin costs the skin, not the mesh.
    let bonds = super::skin::bonds(&attributes, positions.len(), place);
    let bonds = bonds.map_err(|error| format!("{}: {}", error.place(), error.reason()));
    Ok(Some(Piece { positions, triangles, bonds }))
}

fn surface_mode(primitive: &Primitive, place: &str, notes: &mut Notes) -> Option<Mode> {
    match primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => Some(mode),
        Checked::Valid(Mode::Points) => {
            notes.add("points-ignored", place, "points are no surface");
            None
        }
        Checked::Valid(Mode::Lines | Mode::LineLoop | Mode::LineStrip) => {
            notes.add("lines-ignored", place, "lines are no surface");
            None
        }
        Checked::Invalid => {
            notes.add("primitive-ignored", place, "expected a mode of 0 to 6, found another");
            None
        }
    }
}

fn triangles_of(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            corners
                .windows(3)
                .enumerate()
                .map(|(at, three)| {
                    if at % 2 == 0 { [three[0], three[1], three[2]] } else { [three[1], three[0], three[2]] }
                })
                .collect()
        }
        Mode::TriangleFan => {
            corners.get(1..).unwrap_or_default().windows(2).map(|two| [corners[0], two[0], two[1]]).collect()
        }
        _ => corners.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_strips_and_fans_keep_their_winding() {
        let corners = [0, 1, 2, 3, 4];
        assert_eq!(triangles_of(Mode::Triangles, &corners), [[0, 1, 2]]);
        assert_eq!(triangles_of(Mode::TriangleStrip, &corners), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        assert_eq!(triangles_of(Mode::TriangleFan, &corners), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        for mode in [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan] {
            assert!(triangles_of(mode, &[]).is_empty() && triangles_of(mode, &[1, 2]).is_empty());
        }
    }
}
