//! The capsule and the cylinder that stand best for the mesh.

use nalgebra::{Matrix3, Vector3};

use super::fit_box::FittedBox;
use super::prepared::{Vec3, tangents};

/// A capsule or a cylinder: middle, unit axis, half the straight length, radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub centre: Vec3,
    pub axis: Vec3,
    pub half_height: f64,
    pub radius: f64,
}

impl Round {
    /// Signed distance to the capsule's surface.
    pub fn capsule_distance(&self, p: Vec3) -> f64 {
        let (along, across) = self.split(p);
        (across.hypot((along.abs() - self.half_height).max(0.0))) - self.radius
    }

    /// Signed distance to the cylinder's surface.
    pub fn cylinder_distance(&self, p: Vec3) -> f64 {
        let (along, across) = self.split(p);
        let (dx, dy) = (across - self.radius, along.abs() - self.half_height);
        dx.max(dy).min(0.0) + dx.max(0.0).hypot(dy.max(0.0))
    }

    /// Height along the axis from the middle, and distance from the axis.
    pub fn split(&self, p: Vec3) -> (f64, f64) {
        let q = p - self.centre;
        let along = q.dot(&self.axis);
        (along, (q - self.axis * along).norm())
    }

    /// A frame whose Y is the axis, for the shape's rotation: none where the axis is Y already.
    pub fn frame(&self) -> Matrix3<f64> {
        if self.axis.y > 1.0 - 1e-12 {
            return Matrix3::identity();
        }
        let (u, v) = tangents(self.axis);
        Matrix3::from_columns(&[u, self.axis, -v])
    }
}

/// Axes worth trying: the file's and those of the smallest box.
pub(super) fn axes(fitted: &FittedBox) -> Vec<Vec3> {
    let mut axes = vec![Vec3::y(), Vec3::z(), Vec3::x()];
    for column in fitted.axes.column_iter() {
        let axis: Vec3 = column.into_owned();
        if axes.iter().all(|known| known.dot(&axis).abs() < 1.0 - 1e-9) {
            axes.push(axis);
        }
    }
    axes
}

/// The capsule around `points` whose surface stays nearest to all `checks`.
pub(super) fn fit_capsule(points: &[Vec3], checks: &[Vec3], axes: &[Vec3], thinnest: f64) -> Option<Round> {
    best(points, checks, axes, Round::capsule_distance, |line, polar| {
        let radius = line.radius.max(thinnest);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &(along, across) in polar {
            let cap = (radius * radius - across * across).max(0.0).sqrt();
            low = low.min(along + cap);
            high = high.max(along - cap);
        }
        // Where the caps alone cover it, low lies above high and the capsule is a ball between them.
        Round {
            half_height: ((high - low) / 2.0).max(0.0),
            radius,
            centre: line.centre + line.axis * ((low + high) / 2.0),
            ..line
        }
    })
}

/// The cylinder around `points` whose surface stays nearest to all `checks`.
pub(super) fn fit_cylinder(points: &[Vec3], checks: &[Vec3], axes: &[Vec3], thinnest: f64) -> Option<Round> {
    best(points, checks, axes, Round::cylinder_distance, |line, polar| {
        let along = polar.iter().map(|(along, _)| *along);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(t), h.max(t)));
        Round {
            half_height: ((high - low) / 2.0).max(thinnest),
            radius: line.radius.max(thinnest),
            centre: line.centre + line.axis * ((low + high) / 2.0),
            ..line
        }
    })
}

fn best(
    points: &[Vec3],
    checks: &[Vec3],
    axes: &[Vec3],
    distance: impl Fn(&Round, Vec3) -> f64,
    build: impl Fn(Round, &[(f64, f64)]) -> Round,
) -> Option<Round> {
    let mut best: Option<(f64, Round)> = None;
    for &axis in axes {
        let (u, v) = tangents(axis);
        let flat: Vec<Vec3> = points.iter().map(|p| Vector3::new(p.dot(&u), p.dot(&v), 0.0)).collect();
        for middle in circle_centres(&flat) {
            let centre = u * middle.x + v * middle.y;
            let polar: Vec<(f64, f64)> =
                points.iter().zip(&flat).map(|(p, q)| (p.dot(&axis), (q - middle).norm())).collect();
            let radius = polar.iter().map(|(_, across)| *across).fold(0.0, f64::max);
            let round = build(Round { centre, axis, half_height: 0.0, radius }, &polar);
            // The volume settles ties between shapes that are all wrong.
            let worst = checks.iter().map(|p| distance(&round, *p).abs()).fold(0.0, f64::max);
            let score = worst + 1e-3 * round.radius;
            if score.is_finite() && best.as_ref().is_none_or(|(least, _)| score < least - 1e-9) {
                best = Some((score, round));
            }
        }
    }
    best.map(|(_, round)| round)
}

/// Middle of the bounds, of the smallest enclosing circle and of the least-squares circle.
pub(super) fn circle_centres(flat: &[Vec3]) -> Vec<Vec3> {
    let (low, high) = super::prepared::bounds(flat);
    let mut centres = vec![(low + high) / 2.0, super::fit_sphere::enclosing_centre(flat)];
    let middle = flat.iter().sum::<Vec3>() / flat.len().max(1) as f64;
    let mut normal = Matrix3::zeros();
    let mut right = Vec3::zeros();
    for p in flat {
        let q = p - middle;
        let row = Vec3::new(2.0 * q.x, 2.0 * q.y, 1.0);
        normal += row * row.transpose();
        right += row * q.norm_squared();
    }
    if let Some(solved) = normal.cholesky() {
        let offset = solved.solve(&right);
        if offset.xy().norm() < 1.0 {
            centres.push(middle + Vec3::new(offset.x, offset.y, 0.0));
        }
    }
    centres
}
