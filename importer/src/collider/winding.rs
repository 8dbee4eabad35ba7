//! Winding numbers on a grid: where a closed surface has its solid, overlaps and hollows included.

use std::collections::HashMap;

use super::prepared::{Prepared, Vec3};

/// Whether every edge is run as often one way as the other: then every point has a whole winding number.
pub(super) fn encloses(mesh: &Prepared) -> bool {
    // Summed per edge; the map's order does not show.
    let mut balance: HashMap<(u32, u32), i32> = HashMap::with_capacity(mesh.triangles.len() * 2);
    for triangle in &mesh.triangles {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            if a != b {
                *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    balance.values().all(|sum| *sum == 0)
}

/// For every node `low + cell * [x, y, z]` whether the surface winds around it.
///
/// One ray along x serves a row of nodes. Rows are moved by a sliver of a cell that is no simple fraction, so
/// that none runs through an edge of a mesh made on a grid.
pub(super) fn inside(mesh: &Prepared, low: Vec3, cell: f64, [nx, ny, nz]: [usize; 3]) -> Vec<bool> {
    let row_at = |iy: usize, iz: usize| {
        [low.y + (iy as f64 + 1.234_567e-4) * cell, low.z + (iz as f64 + 2.718_281e-4) * cell]
    };
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); ny * nz];
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        let flat = [[a.y, a.z], [b.y, b.z], [c.y, c.z]];
        let area = turn(flat[0], flat[1], flat[2]);
        if area == 0.0 {
            continue;
        }
        let range = |k: usize, low: f64, n: usize| {
            let values = flat.map(|p| (p[k] - low) / cell);
            let first = values[0].min(values[1]).min(values[2]).floor().max(1.0) as usize - 1;
            let last = values[0].max(values[1]).max(values[2]).ceil().max(0.0) as usize;
            first..(last + 1).min(n)
        };
        for iz in range(1, low.z, nz) {
            for iy in range(0, low.y, ny) {
                let p = row_at(iy, iz);
                let weights =
                    [turn(flat[1], flat[2], p), turn(flat[2], flat[0], p), turn(flat[0], flat[1], p)];
                if weights.iter().all(|w| *w * area > 0.0) {
                    let x = (a.x * weights[0] + b.x * weights[1] + c.x * weights[2]) / area;
                    crossings[iz * ny + iy].push((x, if area > 0.0 { 1 } else { -1 }));
                }
            }
        }
    }
    let mut inside = vec![false; nx * ny * nz];
    for (row, mut crossed) in crossings.into_iter().enumerate() {
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        let mut next = 0;
        for ix in 0..nx {
            let x = low.x + ix as f64 * cell;
            while next < crossed.len() && crossed[next].0 < x {
                winding += crossed[next].1;
                next += 1;
            }
            inside[row * nx + ix] = winding != 0;
        }
    }
    inside
}

/// Twice the signed area of a triangle in the plane.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
