//! Distance to the solid on a grid: what a point of a hull has grown beyond the mesh.

use super::bvh::closest_on_triangle;
use super::prepared::{Prepared, Vec3, bounds};
use super::sets::Sets;
use super::winding::{self, encloses};

/// Cells around the mesh's bounds.
const MARGIN: usize = 2;

/// Distance to the solid's surface at the nodes of a regular grid, negative inside.
///
/// Inside is what a flood from outside does not reach. Where every edge is run as often one way as the other the
/// surface encloses a solid, winding numbers say where, and the flood stops at nothing else, so that a hollow
/// with any way in is outside; one that it does not reach counts as filled, unless the surface is a single body,
/// whose hollows are all open somewhere, if only by a spout narrower than a cell. Else the flood stops near the surface: an open mesh with slits narrower than
/// about a cell has an inside, an open bowl has none.
pub(super) struct Field {
    low: Vec3,
    cells_per_length: f64,
    dims: [usize; 3],
    /// A hair before the last node along each axis.
    last: [f64; 3],
    values: Vec<f32>,
}

impl Field {
    /// `resolution` cells along the longest side.
    pub fn new(mesh: &Prepared, resolution: u32) -> Self {
        let cell = mesh.size.max() / f64::from(resolution.clamp(8, 256));
        let dims: [usize; 3] =
            std::array::from_fn(|k| (mesh.size[k] / cell).ceil() as usize + 1 + 2 * MARGIN);
        let low = Vec3::repeat(-(MARGIN as f64) * cell);
        let grid = Grid { low, cell, dims };
        let mut feet = grid.near_feet(mesh);
        grid.sweep(&mut feet);
        let mut values: Vec<f32> = feet.iter().map(|foot| foot.squared.sqrt()).collect();
        // A neighbour on the other side of the surface is within half a cell of it, or this one is.
        let near = (cell / 2.0) as f32;
        let wound = encloses(mesh).then(|| winding::inside(mesh, low, cell, dims));
        let blocked: Vec<bool> = match &wound {
            Some(inside) => inside.clone(),
            None => values.iter().map(|value| *value <= near).collect(),
        };
        let reached = grid.flood(&blocked);
        let one_body = wound.is_some() && is_one_body(mesh);
        for (i, value) in values.iter_mut().enumerate() {
            let inside = match &wound {
                Some(wound) => wound[i] || !(reached[i] || one_body),
                None => !reached[i] && *value > near,
            };
            if inside {
                *value = -*value;
            }
        }
        let last = dims.map(|n| (n - 1) as f64 - 1e-9);
        Self { low, cells_per_length: 1.0 / cell, dims, last, values }
    }

    /// Signed distance from `p` to the solid; trilinear between nodes.
    #[inline]
    pub fn distance(&self, p: Vec3) -> f64 {
        let [nx, ny, _] = self.dims;
        let mut base = [0usize; 3];
        let mut t = [0.0f32; 3];
        for k in 0..3 {
            let x = ((p[k] - self.low[k]) * self.cells_per_length).clamp(0.0, self.last[k]);
            // Through i32, which is one instruction.
            let whole = x as i32;
            base[k] = whole as usize;
            t[k] = (x - f64::from(whole)) as f32;
        }
        let start = (base[2] * ny + base[1]) * nx + base[0];
        let row = |offset: usize| {
            let pair = &self.values[start + offset..][..2];
            pair[0] + (pair[1] - pair[0]) * t[0]
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        f64::from(mix(mix(row(0), row(nx), t[1]), mix(row(nx * ny), row(nx * ny + nx), t[1]), t[2]))
    }
}

fn is_one_body(mesh: &Prepared) -> bool {
    let mut sets = Sets::new(mesh.positions.len());
    for [a, b, c] in &mesh.triangles {
        sets.join(*a, *b);
        sets.join(*a, *c);
    }
    let mut roots = mesh.triangles.iter().map(|[a, ..]| sets.root(*a));
    roots.next().is_none_or(|first| roots.all(|root| root == first))
}

#[derive(Clone, Copy)]
struct Foot {
    point: [f32; 3],
    squared: f32,
}

struct Grid {
    low: Vec3,
    cell: f64,
    dims: [usize; 3],
}

impl Grid {
    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.dims[1] + y) * self.dims[0] + x
    }

    fn node(&self, at: [usize; 3]) -> Vec3 {
        self.low + Vec3::new(at[0] as f64, at[1] as f64, at[2] as f64) * self.cell
    }

    /// The exact nearest surface point of every node within about a cell of the surface.
    fn near_feet(&self, mesh: &Prepared) -> Vec<Foot> {
        let mut feet = vec![Foot { point: [0.0; 3], squared: f32::INFINITY }; self.dims.iter().product()];
        for t in 0..mesh.triangles.len() {
            let corners = mesh.corners(t);
            let (low, high) = bounds(&corners);
            let first: [usize; 3] = std::array::from_fn(|k| {
                (((low[k] - self.low[k]) / self.cell).floor() as usize).saturating_sub(1)
            });
            let last: [usize; 3] = std::array::from_fn(|k| {
                (((high[k] - self.low[k]) / self.cell).ceil() as usize + 1).min(self.dims[k] - 1)
            });
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(1e-30);
            for z in first[2]..=last[2] {
                for y in first[1]..=last[1] {
                    for x in first[0]..=last[0] {
                        let p = self.node([x, y, z]);
                        if normal.is_some_and(|n| n.dot(&(p - corners[0])).abs() > 1.8 * self.cell) {
                            continue;
                        }
                        let foot = closest_on_triangle(p, &corners);
                        let squared = (foot - p).norm_squared() as f32;
                        let known = &mut feet[self.index([x, y, z])];
                        if squared < known.squared {
                            *known = Foot { point: [foot.x as f32, foot.y as f32, foot.z as f32], squared };
                        }
                    }
                }
            }
        }
        feet
    }

    /// Hands nearest points on from node to node, once in each of the eight diagonal directions.
    fn sweep(&self, feet: &mut [Foot]) {
        let [nx, ny, nz] = self.dims;
        let strides = [1, nx, nx * ny];
        for direction in 0..8 {
            let forward = [direction & 1 == 0, direction & 2 == 0, direction & 4 == 0];
            let order = |i: usize, n: usize, forward: bool| if forward { i } else { n - 1 - i };
            for zi in 0..nz {
                let z = order(zi, nz, forward[2]);
                for yi in 0..ny {
                    let y = order(yi, ny, forward[1]);
                    for xi in 0..nx {
                        let x = order(xi, nx, forward[0]);
                        let here = self.index([x, y, z]);
                        let p = self.node([x, y, z]);
                        let p = [p.x as f32, p.y as f32, p.z as f32];
                        let mut best = feet[here];
                        for (k, &i) in [xi, yi, zi].iter().enumerate() {
                            if i == 0 {
                                continue;
                            }
                            let from = if forward[k] { here - strides[k] } else { here + strides[k] };
                            let Foot { point, squared } = feet[from];
                            if squared.is_infinite() {
                                continue;
                            }
                            let d = [point[0] - p[0], point[1] - p[1], point[2] - p[2]];
                            let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                            if squared < best.squared {
                                best = Foot { point, squared };
                            }
                        }
                        feet[here] = best;
                    }
                }
            }
        }
    }

    /// Nodes that can be reached from the corner through nodes that are not blocked.
    fn flood(&self, blocked: &[bool]) -> Vec<bool> {
        let [nx, ny, nz] = self.dims;
        let mut reached = vec![false; blocked.len()];
        let mut open = vec![0usize];
        reached[0] = true;
        while let Some(here) = open.pop() {
            let at = [here % nx, here / nx % ny, here / (nx * ny)];
            for (k, (stride, n)) in [(1, nx), (nx, ny), (nx * ny, nz)].into_iter().enumerate() {
                let below = (at[k] > 0).then(|| here - stride);
                let above = (at[k] + 1 < n).then(|| here + stride);
                for next in below.into_iter().chain(above) {
                    if !reached[next] && !blocked[next] {
                        reached[next] = true;
                        open.push(next);
                    }
                }
            }
        }
        reached
    }
}
