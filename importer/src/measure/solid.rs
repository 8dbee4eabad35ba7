//! The best estimate of the solid that a surface bounds.

use crate::asset::Mesh;

use super::moments::Volume;
use super::shells::{Shell, shells};
use super::topology::Topology;
use super::{MassProperties, VolumeMethod, bounds, hull, nesting, repair};

/// With more open shells than this, the whole is taken for one.
const MOST_HULLS: usize = 512;

/// A surface whose volume is a smaller share than this of its bounding cube encloses nothing.
const NOTHING: f64 = 1e-12;

/// Always of positive volume, with an inertia tensor that a body could have. `hull` is that of the whole mesh.
pub(super) fn estimate(
    mesh: &Mesh,
    topology: &Topology,
    hull: Option<&Volume>,
) -> Option<(MassProperties, VolumeMethod)> {
    let (min, max) = bounds(&mesh.positions);
    let size: [f64; 3] = std::array::from_fn(|axis| max[axis] - min[axis]);
    let least = NOTHING * size.iter().fold(0.0_f64, |longest, &side| longest.max(side)).powi(3);
    let repaired = if topology.boundary_edges > 0 { repair::close_rims(mesh, size) } else { None };
    let mesh = repaired.as_ref().unwrap_or(mesh);
    let shells = shells(mesh);
    let (total, method) = total(mesh, &shells, repaired.is_some(), hull);
    let exact = total.filter(|total| total.total() > least).and_then(|total| total.properties());
    exact
        .map(|properties| (properties, method))
        .or_else(|| hull.and_then(Volume::properties).map(|properties| (properties, VolumeMethod::Hull)))
}

fn total(
    mesh: &Mesh,
    shells: &[Shell],
    repaired: bool,
    hull: Option<&Volume>,
) -> (Option<Volume>, VolumeMethod) {
    let mut sum = Volume::default();
    let mut method = if repaired { VolumeMethod::Oriented } else { VolumeMethod::Closed };
    let cavities = nesting::cavities(mesh, shells);
    for (shell, &cavity) in shells.iter().zip(&cavities) {
        let Some(volume) = shell.volume else { continue };
        let inside_out = volume.total() < 0.0;
        // A shell that was turned has no winding of its own to say that it is a cavity.
        let subtract = cavity && inside_out && !shell.turned;
        let turn = inside_out && !subtract;
        if turn || shell.turned {
            method = VolumeMethod::Oriented;
        }
        sum = sum.plus(&if turn { volume.negated() } else { volume });
    }
    let open: Vec<&Shell> = shells.iter().filter(|shell| shell.volume.is_none()).collect();
    if open.is_empty() {
        return (Some(sum), method);
    }
    if open.len() > MOST_HULLS {
        return (hull.copied(), VolumeMethod::Hull);
    }
    let mut any = false;
    for shell in open {
        if let Some(volume) = hull_of(mesh, shell) {
            sum = sum.plus(&volume);
            any = true;
        }
    }
    let too_much = hull.is_none_or(|hull| sum.total() > hull.total());
    match (any, too_much) {
        // Flat open sheets enclose nothing; beside something closed they add nothing.
        (false, _) if sum.total() > 0.0 => (Some(sum), VolumeMethod::Oriented),
        (true, false) => (Some(sum), VolumeMethod::Hull),
        _ => (hull.copied(), VolumeMethod::Hull),
    }
}

fn hull_of(mesh: &Mesh, shell: &Shell) -> Option<Volume> {
    let mut corners: Vec<u32> = shell.triangles.as_flattened().to_vec();
    corners.sort_unstable();
    corners.dedup();
    let points: Vec<[f64; 3]> = corners.iter().map(|&corner| mesh.positions[corner as usize]).collect();
    hull::volume(&points)
}
