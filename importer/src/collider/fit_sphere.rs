//! The sphere that stands best for the mesh.

use nalgebra::{Matrix4, Vector4};

use super::prepared::{Vec3, bounds};

/// Centre and radius of the candidate with the least largest distance from `points` to its surface.
///
/// Tried are the least-squares sphere (exact for a sphere mesh), the smallest enclosing one and the middle
/// of the bounds, each with the radius half-way between the nearest and the farthest point and with the
/// farthest.
pub(super) fn fit(points: &[Vec3]) -> Option<(Vec3, f64)> {
    let (low, high) = bounds(points);
    let mut centres = vec![(low + high) / 2.0, enclosing_centre(points)];
    centres.extend(least_squares_centre(points));
    let mut best: Option<(f64, Vec3, f64)> = None;
    for centre in centres {
        let (near, far) = points
            .iter()
            .map(|p| (p - centre).norm())
            .fold((f64::INFINITY, 0.0f64), |(n, f), d| (n.min(d), f.max(d)));
        for radius in [far, (near + far) / 2.0] {
            let error = (far - radius).max(radius - near);
            if radius.is_finite() && best.is_none_or(|(least, ..)| error < least - 1e-9) {
                best = Some((error, centre, radius));
            }
        }
    }
    best.map(|(_, centre, radius)| (centre, radius))
}

/// Badoiu and Clarkson: step towards the farthest point, ever less.
pub(super) fn enclosing_centre(points: &[Vec3]) -> Vec3 {
    let (low, high) = bounds(points);
    let mut centre = (low + high) / 2.0;
    for step in 2..120 {
        let mut far = (0.0, centre);
        for p in points {
            let distance = (p - centre).norm_squared();
            if distance > far.0 {
                far = (distance, *p);
            }
        }
        centre += (far.1 - centre) / f64::from(step);
    }
    centre
}

/// Minimises the sum of `(|p|^2 - 2 c·p - k)^2`, linear in `c` and `k`.
fn least_squares_centre(points: &[Vec3]) -> Option<Vec3> {
    let middle = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
    let mut normal = Matrix4::zeros();
    let mut right = Vector4::zeros();
    for p in points {
        let q = p - middle;
        let row = Vector4::new(2.0 * q.x, 2.0 * q.y, 2.0 * q.z, 1.0);
        normal += row * row.transpose();
        right += row * q.norm_squared();
    }
    let solution = normal.cholesky()?.solve(&right);
    let centre = middle + solution.xyz();
    // A nearly flat set puts the centre far away; such a sphere fits nothing else.
    ((centre - middle).norm() < 2.0).then_some(centre)
}
