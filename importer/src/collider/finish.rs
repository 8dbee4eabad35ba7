//! From groups of atoms to the hulls that stand for them.

use super::atoms::Piece;
use super::balance::balanced;
use super::decompose::Context;
use super::group::{self, Group};
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::Plane;
use super::prepared::Vec3;

/// Most that the mesh is left outside of a piece, in tolerances.
pub(super) const SHARE: f64 = 0.42;

/// Hulls of the full mesh's points within the budget of corners, one a group.
pub(super) fn finish(
    context: &Context,
    atoms: &[Piece],
    groups: &[Group],
    notes: &mut Vec<String>,
) -> Vec<Hull> {
    let mut hulls: Vec<Hull> = Vec::with_capacity(groups.len());
    let mut residuals: Vec<f64> = Vec::with_capacity(groups.len());
    let mut thickened = 0;
    for group in groups {
        let mut points: Vec<Vec3> = Vec::new();
        for atom in group.atoms.iter().map(|&i| &atoms[i]) {
            let full = atom.full.as_ref().filter(|full| !full.positions.is_empty());
            points.extend(full.map_or(&atom.surface.positions, |full| &full.positions));
            points.extend(&atom.inner);
        }
        let made = Hull::of_any(&points, context.corners, 0.05 * context.tolerance, THIN);
        let (hull, thick) = made.unwrap_or_else(|| (group.hull.clone(), false));
        thickened += usize::from(thick);
        residuals.push(hull.residual);
        hulls.push(hull.balanced());
    }
    if thickened > 0 {
        notes.push(format!("{thickened} flat pieces thickened to {} % of the diagonal", THIN * 100.0));
    }
    (0..hulls.len())
        .map(|i| {
            let cuts = inner_walls(atoms, &groups[i], &hulls[i]);
            let share = if groups[i].exact { 0.0 } else { SHARE };
            balanced(context, &hulls, i, &cuts, (share * context.tolerance - residuals[i]).max(0.0))
        })
        .collect()
}

/// The cuts on which the group has next to no surface of the mesh: walls between pieces, not of the thing.
fn inner_walls(atoms: &[Piece], group: &Group, hull: &Hull) -> Vec<Plane> {
    let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).norm();
    let on_cut = |cut: &Plane, face: &[Vec3; 3]| face.iter().all(|p| cut.above(p).abs() < 1e-4);
    let mut cuts = group::cuts_of(atoms, group.atoms.iter());
    cuts.retain(|cut| {
        let wall: f64 = hull.face_points().filter(|face| on_cut(cut, face)).map(area).sum();
        let surfaces = group.atoms.iter().map(|&i| &atoms[i].surface);
        let faces = surfaces
            .flat_map(|surface| surface.triangles.iter().map(|t| t.map(|i| surface.positions[i as usize])));
        let mesh: f64 = faces.filter(|face| on_cut(cut, face)).map(area).sum();
        mesh < 0.3 * wall
    });
    cuts
}

/// Without those that lie inside another.
pub(super) fn without_covered(mut hulls: Vec<Hull>) -> Vec<Hull> {
    let mut kept: Vec<Hull> = Vec::new();
    hulls.sort_by(|a, b| b.volume().total_cmp(&a.volume()));
    for hull in hulls {
        let inside = |other: &Hull| hull.vertices.iter().all(|v| other.plane_distance(*v) < 1e-4);
        if !kept.iter().any(inside) {
            kept.push(hull);
        }
    }
    kept
}
