//! Depth below a static triangle mesh.

use super::distance::{nearest_on_triangle, segment_to_triangle};
use super::posed::Posed;
use crate::math::{Frame3, Vec3};

/// A mesh in the world, its triangles in columns over the xz plane.
pub(super) struct Terrain {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    columns: Vec<Vec<u32>>,
    low: [f64; 2],
    width: [f64; 2],
    count: usize,
}

/// Points on each rim that stand for a cylinder or cone.
const RIM: u32 = 32;

impl Terrain {
    pub(super) fn new(positions: &[[f64; 3]], triangles: &[[u32; 3]], frame: &Frame3) -> Self {
        let points: Vec<Vec3> = positions.iter().map(|point| frame.point(&Vec3::from(*point))).collect();
        let side = |axis: usize| {
            let values = points.iter().map(|point| point[axis]);
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            (low, (high - low).max(1e-9))
        };
        let ((low_x, wide_x), (low_z, wide_z)) = (side(0), side(2));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
        let count = ((triangles.len() as f64).sqrt() as usize).clamp(1, 512);
        let mut terrain = Self {
            points,
            triangles: triangles.to_vec(),
            columns: vec![Vec::new(); count * count],
            low: [low_x, low_z],
            width: [wide_x, wide_z],
            count,
        };
        for (index, triangle) in (0..).zip(triangles) {
            let corners = triangle.map(|i| terrain.points[i as usize]);
            let min = corners.iter().fold(corners[0], |min, corner| min.inf(corner));
            let max = corners.iter().fold(corners[0], |max, corner| max.sup(corner));
            for column in terrain.columns_over(&min, &max) {
                terrain.columns[column].push(index);
            }
        }
        terrain
    }

    fn columns_over(&self, min: &Vec3, max: &Vec3) -> Vec<usize> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
        let cell = |value: f64, k: usize| {
            let share = (value - self.low[k]) / self.width[k] * self.count as f64;
            (share.max(0.0) as usize).min(self.count - 1)
        };
        let (x, z) = (cell(min.x, 0)..=cell(max.x, 0), cell(min.z, 1)..=cell(max.z, 1));
        x.flat_map(|i| z.clone().map(move |k| (i, k))).map(|(i, k)| i * self.count + k).collect()
    }

    fn triangle(&self, index: u32) -> [Vec3; 3] {
        self.triangles[index as usize].map(|i| self.points[i as usize])
    }

    /// How deep a shape reaches below the surface, m, at least 0: its corners (or rounded core) against the nearest
    /// triangle, and the mesh's vertices against its faces. Shapes deeper than their own size are taken to be on
    /// another side of the surface.
    pub(super) fn depth(&self, posed: &Posed<'_>) -> f64 {
        let mut near: Vec<u32> = self
            .columns_over(&posed.min, &posed.max)
            .into_iter()
            .flat_map(|c| self.columns[c].iter().copied())
            .collect();
        near.sort_unstable();
        near.dedup();
        let mut deepest = 0.0_f64;
        for (point, radius) in probes(posed) {
            if let Some(height) = self.height(&near, &point) {
                let depth = radius - height;
                if depth < 2.0 * posed.solid.reach {
                    deepest = deepest.max(depth);
                }
            }
        }
        if let ([from, to], None) = (&posed.vertices[..], posed.rims()) {
            let axis = [from + posed.position, to + posed.position];
            let distance = near
                .iter()
                .map(|&i| segment_to_triangle(&axis, &self.triangle(i)))
                .fold(f64::INFINITY, f64::min);
            deepest = deepest.max(posed.radius() - distance);
        }
        if !posed.normals.is_empty() {
            let corners = near.iter().flat_map(|&i| self.triangle(i));
            deepest = corners.filter_map(|corner| posed.depth_of(&corner)).fold(deepest, f64::max);
        }
        deepest
    }

    /// Signed distance of a point from the surface: negative behind every triangle that is nearest to it.
    fn height(&self, near: &[u32], point: &Vec3) -> Option<f64> {
        let mut least = f64::INFINITY;
        let mut behind = true;
        for &index in near {
            let triangle = self.triangle(index);
            let away = point - nearest_on_triangle(point, &triangle);
            let distance = away.norm();
            let tie = 1e-9 + 1e-9 * least.min(1e9);
            if distance > least + tie {
                continue;
            }
            let normal = (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0]));
            let is_behind = normal.dot(&(point - triangle[0])) < 0.0;
            behind = is_behind && (behind || distance < least - tie);
            least = least.min(distance);
        }
        least.is_finite().then_some(if behind { -least } else { least })
    }
}

/// Points of a shape that may be its lowest, with the radius around each.
fn probes(posed: &Posed<'_>) -> Vec<(Vec3, f64)> {
    let Some(rims) = posed.rims() else {
        return posed.vertices.iter().map(|v| (v + posed.position, posed.radius())).collect();
    };
    let [u, v] = crate::math::tangents(&posed.edges[0]);
    let around = move |k: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(RIM));
        u * cos + v * sin
    };
    let rim = |(end, radius): (&Vec3, f64)| {
        let center = end + posed.position;
        (0..RIM).map(move |k| (center + around(k) * radius, 0.0)).collect::<Vec<_>>()
    };
    posed.vertices.iter().zip(rims).flat_map(rim).collect()
}
