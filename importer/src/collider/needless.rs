//! Pieces that others stand for already.

use super::decompose::Context;
use super::hull::Hull;
use super::prepared::{Vec3, bounds};

/// Without those of which the others hold all that is of the mesh, seen surface and solid, to within `margin`;
/// smallest first.
pub(super) fn without_needless(context: &Context, hulls: &[Hull], margin: f64) -> Vec<Hull> {
    let mut order: Vec<usize> = (0..hulls.len()).collect();
    let volumes: Vec<f64> = hulls.iter().map(Hull::volume).collect();
    order.sort_by(|&a, &b| volumes[a].total_cmp(&volumes[b]).then(a.cmp(&b)));
    let mut needed = vec![true; hulls.len()];
    for own in order {
        let others = |p: &Vec3| {
            let mut others = (0..hulls.len()).filter(|&other| other != own && needed[other]);
            others.any(|other| hulls[other].plane_distance(*p) <= margin)
        };
        let hull = &hulls[own];
        let (low, high) = bounds(&hull.vertices);
        let margins = Vec3::repeat(margin);
        let near = context.seen.within(low - margins, high + margins);
        let mut seen = near.filter(|p| hull.plane_distance(**p) <= margin);
        if seen.all(others) && solid_points(context, hull).iter().all(others) {
            needed[own] = false;
        }
    }
    hulls.iter().zip(needed).filter(|(_, needed)| *needed).map(|(hull, _)| hull.clone()).collect()
}

/// Points of the hull that lie in the solid: on rays from its middle to corners and faces.
fn solid_points(context: &Context, hull: &Hull) -> Vec<Vec3> {
    let middle = hull.vertices.iter().sum::<Vec3>() / hull.vertices.len() as f64;
    let faces = hull.face_points().map(|[a, b, c]| (a + b + c) / 3.0);
    let ends = hull.vertices.iter().copied().chain(faces);
    let rays = ends.flat_map(|end| [0.3, 0.6, 0.95].map(|t| middle + (end - middle) * t));
    rays.chain([middle]).filter(|p| context.field.distance(*p) < 0.0).collect()
}
