//! The cone frustum that stands best for the mesh: cups, buckets, lampshades, tree trunks.

use super::fit_round::{Round, circle_centres};
use super::prepared::{Vec3, tangents};

/// A cone frustum: `round.radius` at the lower end of the axis, `top` at the upper one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frustum {
    pub round: Round,
    pub top: f64,
}

impl Frustum {
    /// Signed distance to the surface.
    ///
    /// In the half-plane of height and radius the frustum is a trapezoid: the nearest point lies on an end or on
    /// the slant side.
    pub fn distance(&self, p: Vec3) -> f64 {
        let Round { half_height, radius, .. } = self.round;
        let (along, across) = self.round.split(p);
        let of_end = if along < 0.0 { radius } else { self.top };
        let end = [across - across.min(of_end), along.abs() - half_height];
        let side = [self.top - radius, 2.0 * half_height];
        let from_top = [self.top - across, half_height - along];
        let t = ((from_top[0] * side[0] + from_top[1] * side[1]) / (side[0] * side[0] + side[1] * side[1]))
            .clamp(0.0, 1.0);
        let slant = [side[0] * t - from_top[0], side[1] * t - from_top[1]];
        let square = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
        let distance = square(end).min(square(slant)).sqrt();
        if slant[0] < 0.0 && end[1] < 0.0 { -distance } else { distance }
    }

    pub fn volume(&self) -> f64 {
        let (a, b) = (self.round.radius, self.top);
        std::f64::consts::PI * 2.0 * self.round.half_height / 3.0 * (a * a + a * b + b * b)
    }

    /// Points on the slant side and on both ends, rims included.
    pub fn surface_points(&self, count: usize) -> Vec<Vec3> {
        let Round { centre, axis, half_height, radius } = self.round;
        let (u, v) = tangents(axis);
        let on_side = (count as f64 * half_height / (half_height + radius.max(self.top))) as usize;
        let place = |i: usize, along: f64, r: f64| {
            let (sin, cos) = (i as f64 * 2.399_963).sin_cos();
            centre + axis * (along * half_height) + (u * cos + v * sin) * r
        };
        let side = (0..on_side).map(|i| {
            let along = 2.0 * (i as f64 + 0.5) / on_side as f64 - 1.0;
            place(i, along, radius + (self.top - radius) * (along + 1.0) / 2.0)
        });
        let ends = (0..count - on_side).map(|i| {
            let r = ((i / 2 + 1) as f64 / ((count - on_side) / 2).max(1) as f64).sqrt().min(1.0);
            if i % 2 == 0 { place(i, 1.0, self.top * r) } else { place(i, -1.0, radius * r) }
        });
        side.chain(ends).collect()
    }
}

/// The frustum around `points`, along one of `axes`, whose surface stays nearest to all `checks`.
pub(super) fn fit(points: &[Vec3], checks: &[Vec3], axes: &[Vec3], thinnest: f64) -> Option<Frustum> {
    let mut best: Option<(f64, Frustum)> = None;
    for &axis in axes {
        let (u, v) = tangents(axis);
        let flat: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.dot(&u), p.dot(&v), 0.0)).collect();
        for middle in circle_centres(&flat) {
            let polar: Vec<[f64; 2]> =
                points.iter().zip(&flat).map(|(p, q)| [p.dot(&axis), (q - middle).norm()]).collect();
            let Some(frustum) = around(&polar, axis, u * middle.x + v * middle.y, thinnest) else { continue };
            let worst = checks.iter().map(|p| frustum.distance(*p).abs()).fold(0.0, f64::max);
            if worst.is_finite() && best.as_ref().is_none_or(|(least, _)| worst < least - 1e-9) {
                best = Some((worst, frustum));
            }
        }
    }
    best.map(|(_, frustum)| frustum)
}

/// The side line above all points of height and radius that is lowest at half height: the edge of their upper
/// outline there.
fn around(polar: &[[f64; 2]], axis: Vec3, foot: Vec3, thinnest: f64) -> Option<Frustum> {
    let low = polar.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
    let high = polar.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
    let middle = (low + high) / 2.0;
    let mut sorted = polar.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut upper: Vec<[f64; 2]> = Vec::new();
    for p in sorted {
        while let [.., a, b] = upper.as_slice()
            && (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0
        {
            upper.pop();
        }
        upper.push(p);
    }
    let edge = upper
        .windows(2)
        .find(|edge| edge[0][0] <= middle && middle <= edge[1][0] && edge[0][0] < edge[1][0])?;
    let slope = (edge[1][1] - edge[0][1]) / (edge[1][0] - edge[0][0]);
    let at = |height: f64| (edge[0][1] + slope * (height - edge[0][0])).max(thinnest);
    let round = Round {
        centre: foot + axis * middle,
        axis,
        half_height: ((high - low) / 2.0).max(thinnest),
        radius: at(low),
    };
    Some(Frustum { round, top: at(high) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frustum_is_found_again() {
        let truth = Frustum {
            round: Round { centre: Vec3::new(0.3, 0.4, 0.5), axis: Vec3::y(), half_height: 0.2, radius: 0.1 },
            top: 0.16,
        };
        let points = truth.surface_points(600);
        for p in &points {
            assert!(truth.distance(*p).abs() < 1e-9, "{p}");
        }
        let found = fit(&points, &points, &[Vec3::x(), Vec3::y(), Vec3::z()], 1e-3).expect("found");
        let worst = points.iter().map(|p| found.distance(*p).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-3, "{worst} {found:?}");
        assert!((found.volume() / truth.volume() - 1.0).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn distance_of_a_cylinder_is_the_cylinders() {
        let round = Round { centre: Vec3::zeros(), axis: Vec3::z(), half_height: 0.3, radius: 0.2 };
        let frustum = Frustum { round, top: 0.2 };
        for p in [[0.0, 0.0, 0.0], [0.25, 0.0, 0.1], [0.0, 0.1, 0.5], [0.3, 0.3, -0.4], [0.15, 0.0, 0.28]] {
            let p = Vec3::from(p);
            assert!((frustum.distance(p) - round.cylinder_distance(p)).abs() < 1e-12, "{p}");
        }
    }
}
