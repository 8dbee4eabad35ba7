//! Walls that span a hollow, moved half-way in: an error to either side is half of one to one side.

use nalgebra::Matrix3;

use super::decompose::Context;
use super::hull::Hull;
use super::piece::Plane;
use super::prepared::Vec3;

/// A wall nearer to the mesh than this share of the tolerance stays where it is.
const NEAR: f64 = 0.2;
/// How firmly such a wall holds its corners, against one for a wall that moves.
const FIRM: f64 = 4.0;
/// The same for a wall between pieces, in which a crack would open.
const CUT: f64 = 100.0;
/// By how much pieces reach into one another at walls between them, so that no crack opens there.
const OVERLAP: f64 = 1e-3;
/// Points looked at along a side of a face.
const MOST_STEPS: usize = 8;

/// `hulls[own]` with every wall that reaches beyond the mesh moved inwards by half of that, at most by `most`;
/// `cuts` are its walls towards other pieces, which are moved a little outwards. Walls on the mesh keep their
/// corners in their planes, so that what a thing stands on stays exact.
pub(super) fn balanced(context: &Context, hulls: &[Hull], own: usize, cuts: &[Plane], most: f64) -> Hull {
    let hull = &hulls[own];
    let plane_of: Vec<usize> = hull
        .face_points()
        .map(|[a, b, c]| {
            let normal = (b - a).cross(&(c - a)).normalize();
            let along = |plane: &(Vec3, f64)| plane.0.dot(&normal) - (plane.0.dot(&a) - plane.1).abs();
            let planes = hull.planes.iter().enumerate();
            planes.max_by(|x, y| along(x.1).total_cmp(&along(y.1))).map_or(0, |(k, _)| k)
        })
        .collect();
    let mut gaps = vec![0.0f64; hull.planes.len()];
    for (face, &plane) in hull.face_points().zip(&plane_of) {
        gaps[plane] = gaps[plane].max(gap(context, hulls, own, &face));
    }
    let inner: Vec<bool> = hull.planes.iter().map(|plane| cuts.iter().any(|cut| cut.holds(plane))).collect();
    let shift = |(gap, inner): (&f64, &bool)| match inner {
        true => -OVERLAP,
        false if *gap < NEAR * context.tolerance => 0.0,
        false => (gap / 2.0).min(most),
    };
    let shifts: Vec<f64> = gaps.iter().zip(&inner).map(shift).collect();
    if shifts.iter().all(|shift| *shift == 0.0) {
        return hull.clone();
    }
    let mut moved = hull.vertices.clone();
    for (v, vertex) in moved.iter_mut().enumerate() {
        let mut around: Vec<usize> = hull
            .faces
            .iter()
            .zip(&plane_of)
            .filter(|(f, _)| f.contains(&(v as u32)))
            .map(|(_, k)| *k)
            .collect();
        around.sort_unstable();
        around.dedup();
        // Least squares: each wall asks its corner to move by its shift along its normal.
        let mut left = Matrix3::identity() * 0.05;
        let mut right = Vec3::zeros();
        for k in around {
            let normal = hull.planes[k].0;
            let weight = match shifts[k] > 0.0 {
                true => 1.0,
                false if inner[k] => CUT,
                false => FIRM,
            };
            left += normal * normal.transpose() * weight;
            right -= normal * (weight * shifts[k]);
        }
        if let Some(solved) = left.cholesky() {
            let step = solved.solve(&right);
            let longest = most.max(2.0 * OVERLAP);
            *vertex += step * (longest / step.norm().max(longest));
        }
    }
    Hull::of(&moved, usize::MAX, 0.0).unwrap_or_else(|_| hull.clone())
}

/// How far the face reaches beyond the mesh where no other hull covers it.
fn gap(context: &Context, hulls: &[Hull], own: usize, [a, b, c]: &[Vec3; 3]) -> f64 {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let steps = ((longest / context.tolerance).ceil() as usize).clamp(2, MOST_STEPS);
    let mut gap = 0.0f64;
    for i in 0..=steps {
        for j in 0..=steps - i {
            let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
            let p = a + (b - a) * u + (c - a) * v;
            let beyond = context.field.distance(p);
            let covered =
                || hulls.iter().enumerate().any(|(h, hull)| h != own && hull.plane_distance(p) < -1e-4);
            if beyond > gap && !covered() {
                gap = beyond;
            }
        }
    }
    gap
}
