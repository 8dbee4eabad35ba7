//! The smallest box, in any orientation, that holds the mesh.

use nalgebra::{Matrix3, Rotation3, SymmetricEigen};

use super::hull::Hull;
use super::outline::convex_outline;
use super::prepared::{Vec3, bounds};

/// Faces of the hull, largest first, whose normals are tried as an axis of the box.
const FACES: usize = 48;
/// A tilted box must be smaller than the upright one by this much to be taken.
const WORTH_TILTING: f64 = 0.995;

/// A box: its middle, its axes (columns) and half its extents along them.
#[derive(Clone, Copy, Debug)]
pub(super) struct FittedBox {
    pub centre: Vec3,
    pub axes: Matrix3<f64>,
    pub half_extents: Vec3,
}

/// Tries the file's axes, the principal axes, and for each large hull face the rectangle of least area
/// around the hull's outline seen along the face normal: the minimal box has a face on a hull face, or
/// differs little from one that has.
pub(super) fn fit(points: &[Vec3], coarse_hull: Option<&Hull>) -> FittedBox {
    let upright = enclose(points, Matrix3::identity());
    let mut best = upright;
    let mut least = size(&upright) * WORTH_TILTING;
    let mut consider = |axes: Matrix3<f64>, points: &[Vec3]| {
        let candidate = enclose(points, axes);
        if size(&candidate) < least {
            least = size(&candidate);
            best = candidate;
        }
    };
    match coarse_hull {
        Some(hull) => {
            consider(principal_axes(&hull.vertices), &hull.vertices);
            for axes in face_frames(hull) {
                consider(axes, &hull.vertices);
            }
        }
        None => consider(principal_axes(points), points),
    }
    // The search ran on the hull's corners, which may have been cut down; the box must hold all points.
    let tilted = enclose(points, best.axes);
    if size(&tilted) < size(&upright) * WORTH_TILTING { tilted } else { upright }
}

/// Volume, with a floor so that flat and thin things are compared by what extent they have.
fn size(candidate: &FittedBox) -> f64 {
    candidate.half_extents.iter().map(|half| half + 1e-4).product()
}

fn enclose(points: &[Vec3], axes: Matrix3<f64>) -> FittedBox {
    let turned: Vec<Vec3> = points.iter().map(|p| axes.tr_mul(p)).collect();
    let (low, high) = bounds(&turned);
    FittedBox { centre: axes * ((low + high) / 2.0), axes, half_extents: (high - low) / 2.0 }
}

/// A right-handed frame of the points' principal axes.
pub(super) fn principal_axes(points: &[Vec3]) -> Matrix3<f64> {
    let middle = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
    let spread = points.iter().fold(Matrix3::zeros(), |sum, p| sum + (p - middle) * (p - middle).transpose());
    if !spread.iter().all(|x| x.is_finite()) {
        return Matrix3::identity();
    }
    right_handed(SymmetricEigen::new(spread).eigenvectors)
}

fn face_frames(hull: &Hull) -> Vec<Matrix3<f64>> {
    let mut areas = vec![0.0; hull.planes.len()];
    for [a, b, c] in hull.face_points() {
        let cross = (b - a).cross(&(c - a));
        let area = cross.norm();
        if area > 0.0 {
            let normal = cross / area;
            if let Some(plane) = hull.planes.iter().position(|(n, _)| n.dot(&normal) > 1.0 - 1e-9) {
                areas[plane] += area;
            }
        }
    }
    let mut order: Vec<usize> = (0..areas.len()).collect();
    order.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]).then(a.cmp(&b)));
    order.truncate(FACES);
    order
        .into_iter()
        .map(|plane| {
            let normal = hull.planes[plane].0;
            let (u, v) = super::prepared::tangents(normal);
            let flat: Vec<[f64; 2]> = hull.vertices.iter().map(|p| [p.dot(&u), p.dot(&v)]).collect();
            let [x, y] = least_rectangle(&convex_outline(&flat));
            let first = u * x + v * y;
            right_handed(Matrix3::from_columns(&[first, normal.cross(&first), normal]))
        })
        .collect()
}

/// The unit direction of one side of the smallest rectangle around a convex outline.
fn least_rectangle(outline: &[[f64; 2]]) -> [f64; 2] {
    let mut best = ([1.0, 0.0], f64::INFINITY);
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let length = x.hypot(y);
        if length < 1e-9 {
            continue;
        }
        let (x, y) = (x / length, y / length);
        let extent = |dx: f64, dy: f64| {
            let along = outline.iter().map(|p| p[0] * dx + p[1] * dy);
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(t), h.max(t)));
            high - low
        };
        let area = extent(x, y) * extent(-y, x);
        if area < best.1 * (1.0 - 1e-9) {
            best = ([x, y], area);
        }
    }
    best.0
}

fn right_handed(mut axes: Matrix3<f64>) -> Matrix3<f64> {
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    axes
}

/// The quaternion `x, y, z, w` of a right-handed frame, with `w` not negative.
pub(super) fn quaternion(axes: &Matrix3<f64>) -> [f64; 4] {
    let q = nalgebra::UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*axes));
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    // Adding zero turns -0 into 0, so that files do not differ by a sign of nothing.
    [q.i, q.j, q.k, q.w].map(|x| x * sign + 0.0)
}
