//! parry's V-HACD, as the baseline that reports compare with.

use parry3d::math::Vector;
use parry3d::transformation::vhacd::{VHACD, VHACDParameters};

use super::error::Reference;
use super::hull::Hull;
use super::ladder::{THIN, candidate};
use super::prepared::{Prepared, Vec3};
use super::solid::Solid;
use super::{Candidate, Rung};
use crate::asset::Mesh;
use crate::measure::Measures;
use crate::{Options, guard};

/// What parry 0.31 makes of `mesh` with `resolution` voxels a side and `concavity` (its defaults are 64 and
/// 0.01), measured as the ladder's candidates are. Hulls are exact ones of the mesh inside each part, with all
/// their corners.
///
/// The call is guarded: welded and scaled to the unit cube first, as parry works in single precision; a panic
/// inside it gives `None`; a part whose hull parry fails to make, which it would drop without a word, is
/// replaced by our own hull of the part's voxels, thickened where it is flat, and counted in `fallback`.
/// `None` too where there is nothing to decompose or more than `options.max_decomposition_triangles`.
#[must_use]
pub fn parry_decomposition(
    mesh: &Mesh,
    measures: &Measures,
    options: &Options,
    resolution: u32,
    concavity: f64,
) -> Option<Candidate> {
    let prepared = Prepared::from_mesh(mesh)?;
    if prepared.triangles.len() as u64 > options.max_decomposition_triangles {
        return None;
    }
    #[allow(clippy::cast_possible_truncation)]
    let points: Vec<Vector> =
        prepared.positions.iter().map(|p| Vector::new(p.x as f32, p.y as f32, p.z as f32)).collect();
    #[allow(clippy::cast_possible_truncation)]
    let parameters =
        VHACDParameters { resolution, concavity: concavity as f32, ..VHACDParameters::default() };
    let (hulls, replaced) =
        guard::catch("parry's convex decomposition", || Ok(parts(&parameters, &points, &prepared.triangles)))
            .ok()?;
    if hulls.is_empty() {
        return None;
    }
    let reference = Reference::new(&prepared, options.error_samples, measures);
    let note =
        (replaced > 0).then(|| format!("{replaced} parts without a hull replaced by hulls of their voxels"));
    let pieces: Vec<Solid> = hulls.into_iter().map(Solid::Hull).collect();
    Some(candidate(&prepared, Rung::Decomposition, &pieces, reference.measure(&pieces), note))
}

fn parts(parameters: &VHACDParameters, points: &[Vector], triangles: &[[u32; 3]]) -> (Vec<Hull>, usize) {
    let made = VHACD::decompose(parameters, points, triangles, true);
    let mut replaced = 0;
    let mut hulls = Vec::new();
    for part in made.voxel_parts() {
        let (corners, _) = part.compute_exact_convex_hull(points, triangles);
        let corners: Vec<Vec3> = corners.into_iter().map(wide).collect();
        if let Ok(hull) = Hull::of(&corners, usize::MAX, 0.0) {
            hulls.push(hull);
            continue;
        }
        replaced += 1;
        let half = f64::from(part.scale) / 2.0;
        let voxels: Vec<Vec3> = part.voxels().iter().map(|voxel| wide(part.get_voxel_point(voxel))).collect();
        if let Some((hull, _)) = Hull::of_any(&voxels, usize::MAX, 0.0, THIN.max(half)) {
            hulls.push(hull);
        }
    }
    (hulls, replaced)
}

fn wide(p: Vector) -> Vec3 {
    Vec3::new(f64::from(p.x), f64::from(p.y), f64::from(p.z))
}
