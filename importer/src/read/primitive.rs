//! One glTF primitive: corners in the order of its mode, made triangles.

use gltf::json::mesh::{Mode, MorphTarget, Primitive, Semantic};
use gltf::json::validation::Checked;

use crate::ImportError;

use super::accessor::Accessors;
use super::attributes::Attributes;
use super::notes::Notes;
use super::reading::{Reading, check_counts};
use super::skin::Bond;

/// Positions in the mesh's own frame.
#[derive(Debug)]
pub(super) struct Piece {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// Displacements of every vertex, by morph target; empty where no use of the mesh weighs any.
    pub targets: Vec<Vec<[f64; 3]>>,
    /// Per vertex, where there are any: the joints it hangs on.
    pub bonds: Result<Vec<Bond>, String>,
}

impl Piece {
    /// As its targets bend it, each as much as it weighs; `None` where that changes nothing.
    pub fn morphed(&self, weights: &[f32]) -> Option<Self> {
        let used = || {
            self.targets.iter().zip(weights).filter(|(target, weight)| **weight != 0.0 && !target.is_empty())
        };
        used().next()?;
        let mut positions = self.positions.clone();
        for (target, &weight) in used() {
            for (position, shift) in positions.iter_mut().zip(target) {
                *position = std::array::from_fn(|axis| position[axis] + f64::from(weight) * shift[axis]);
            }
        }
        Some(Self {
            positions,
            triangles: self.triangles.clone(),
            targets: Vec::new(),
            bonds: self.bonds.clone(),
        })
    }
}

/// `None`, with a note, for what is no surface. `with_targets`: some use of it weighs its morph targets.
pub(super) fn read(
    primitive: &Primitive,
    accessors: &Accessors<'_>,
    place: &str,
    with_targets: bool,
    reading: &mut Reading,
) -> Result<Option<Piece>, ImportError> {
    let notes = &mut reading.notes;
    if primitive.mode == Checked::Valid(Mode::Points) {
        let attributes = Attributes::open(primitive, accessors, place, notes)?;
        let positions = attributes.vectors::<3>(&Semantic::Positions)?.unwrap_or_default();
        let normals = attributes.vectors::<3>(&Semantic::Normals)?.unwrap_or_default();
        let normals = if normals.len() == positions.len() { normals } else { Vec::new() };
        reading.add_cloud(place, positions, normals);
        return Ok(None);
    }
    let Some(mode) = surface_mode(primitive, place, notes) else { return Ok(None) };
    let attributes = Attributes::open(primitive, accessors, place, notes)?;
    let Some(positions) = attributes.vectors::<3>(&Semantic::Positions)? else {
        notes.add("no-position", place, "a primitive without POSITION has no geometry");
        return Ok(None);
    };
    let targets =
        if with_targets { targets(primitive, accessors, positions.len(), place)? } else { Vec::new() };
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
    Ok(Some(Piece { positions, triangles, targets, bonds }))
}

/// All targets together are held under the limit of vertices, as if each were a mesh.
fn targets(
    primitive: &Primitive,
    accessors: &Accessors<'_>,
    vertices: usize,
    place: &str,
) -> Result<Vec<Vec<[f64; 3]>>, ImportError> {
    let targets = primitive.targets.as_deref().unwrap_or_default();
    let all = (vertices as u64).saturating_mul(targets.len() as u64);
    check_counts(all, 0, &format!("{place}.targets"), accessors.options)?;
    let read = |(at, target): (usize, &MorphTarget)| match target.positions {
        Some(index) => accessors.vectors::<3>(index.value(), &format!("{place}.targets[{at}].POSITION")),
        None => Ok(Vec::new()),
    };
    targets.iter().enumerate().map(read).collect()
}

fn surface_mode(primitive: &Primitive, place: &str, notes: &mut Notes) -> Option<Mode> {
    match primitive.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => Some(mode),
        Checked::Valid(Mode::Points) => None,
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
