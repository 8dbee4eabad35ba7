//! Whether a point can be seen from outside.

use super::bvh::Bvh;
use super::prepared::Vec3;

/// Rays that are tried before a point counts as hidden.
const RAYS: usize = 48;
/// Start of a ray, so that it is not stopped by what its point lies on.
const START: f64 = 1e-5;

/// Looks out from points along a fixed fan of rays. Neighbours look out the same way and are hidden by the same
/// triangles, so what let or stopped the last ray is tried first: that costs or saves time, never an answer.
pub(super) struct Sight<'a> {
    tree: &'a Bvh,
    rays: Vec<Ray>,
    way_out: usize,
}

struct Ray {
    direction: Vec3,
    stopped_by: Option<usize>,
}

impl<'a> Sight<'a> {
    pub fn new(tree: &'a Bvh) -> Self {
        let rays = ray_fan(RAYS).into_iter().map(|direction| Ray { direction, stopped_by: None }).collect();
        Self { tree, rays, way_out: 0 }
    }

    /// Whether any ray from `p` gets away from the triangles.
    pub fn sees_out(&mut self, p: Vec3) -> bool {
        if self.gets_away(self.way_out, p) {
            return true;
        }
        let way_out = (0..self.rays.len()).find(|&ray| ray != self.way_out && self.gets_away(ray, p));
        self.way_out = way_out.unwrap_or(self.way_out);
        way_out.is_some()
    }

    fn gets_away(&mut self, ray: usize, p: Vec3) -> bool {
        let Ray { direction, stopped_by } = &mut self.rays[ray];
        let origin = p + *direction * START;
        if stopped_by.is_some_and(|triangle| self.tree.stops(triangle, origin, *direction)) {
            return false;
        }
        let found = self.tree.first_stop(origin, *direction);
        *stopped_by = found.or(*stopped_by);
        found.is_none()
    }
}

/// Evenly spread unit directions (a Fibonacci spiral, turned so that no entry is zero).
pub(super) fn ray_fan(count: usize) -> Vec<Vec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count)
        .map(|i| {
            // A stride through the spiral: the first few rays already point all ways.
            let k = (i * 13) % count;
            let y = 1.0 - 2.0 * (k as f64 + 0.5) / count as f64;
            let (sin, cos) = (golden * k as f64 + 0.37).sin_cos();
            let r = (1.0 - y * y).sqrt();
            let d = Vec3::new(r * cos, y, r * sin) + Vec3::new(1.3e-4, 2.1e-4, 1.7e-4);
            d.normalize()
        })
        .collect()
}
