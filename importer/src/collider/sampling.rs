//! Points on the mesh at which errors are measured.

use super::bvh::Bvh;
use super::prepared::{Prepared, Vec3};
use super::sight::Sight;

/// Points on the surface, with whether each can be seen from outside.
pub(super) struct Samples {
    pub points: Vec<Vec3>,
    pub seen: Vec<bool>,
}

impl Samples {
    /// `count` points spread by area, and as many of the corners.
    ///
    /// The same mesh gives the same points: systematic sampling along the triangles' summed area, and the
    /// R2 low-discrepancy sequence inside each.
    pub fn of_mesh(mesh: &Prepared, tree: &Bvh, count: usize) -> Self {
        let triangles: Vec<[Vec3; 3]> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
        let mut points = on_triangles(&triangles, count).into_iter().map(|(p, _)| p).collect::<Vec<_>>();
        let stride = mesh.positions.len().div_ceil(count.max(1)).max(1);
        points.extend(mesh.positions.iter().step_by(stride));
        let mut sight = Sight::new(tree);
        let mut seen: Vec<bool> = points.iter().map(|&p| sight.sees_out(p)).collect();
        // Inside a shell without any opening for a ray, everything counts.
        if !seen.contains(&true) {
            seen.fill(true);
        }
        Self { points, seen }
    }

    pub fn seen_points(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.points.iter().zip(&self.seen).filter(|(_, seen)| **seen).map(|(p, _)| *p)
    }
}

/// `count` points by area with the triangle each lies on; none where there is no area.
pub(super) fn on_triangles(triangles: &[[Vec3; 3]], count: usize) -> Vec<(Vec3, usize)> {
    let areas: Vec<f64> = triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a)).norm()).collect();
    let total: f64 = areas.iter().sum();
    let mut points = Vec::with_capacity(count);
    if total <= 0.0 || count == 0 {
        return points;
    }
    let step = total / count as f64;
    let mut done = 0.0;
    for (t, area) in areas.iter().enumerate() {
        done += area;
        while points.len() < count && (points.len() as f64 + 0.5) * step < done {
            let (mut u, mut v) = r2(points.len());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = &triangles[t];
            points.push((a + (b - a) * u + (c - a) * v, t));
        }
    }
    points
}

/// Roberts' R2 sequence on the unit square.
fn r2(index: usize) -> (f64, f64) {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let i = index as f64 + 0.5;
    ((i / PLASTIC).fract(), (i / (PLASTIC * PLASTIC)).fract())
}

/// Roberts' R3 sequence in the unit cube.
pub(super) fn r3(index: usize) -> Vec3 {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let i = index as f64 + 0.5;
    Vec3::new((i / ROOT).fract(), (i / (ROOT * ROOT)).fract(), (i / (ROOT * ROOT * ROOT)).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_is_shared_fairly() {
        let triangle = |x: f64, size: f64| {
            [Vec3::new(x, 0.0, 0.0), Vec3::new(x + size, 0.0, 0.0), Vec3::new(x, size, 0.0)]
        };
        let points = on_triangles(&[triangle(0.0, 1.0), triangle(5.0, 2.0)], 1000);
        assert_eq!(points.len(), 1000);
        assert_eq!(points.iter().filter(|(_, t)| *t == 0).count(), 200);
        let mean = points.iter().filter(|(_, t)| *t == 1).map(|(p, _)| p.x - 5.0).sum::<f64>() / 800.0;
        assert!((mean - 2.0 / 3.0).abs() < 0.01, "{mean}");
    }
}
