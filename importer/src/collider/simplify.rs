//! A coarser surface to search cuts on.

use std::collections::HashMap;

use super::piece::Surface;
use super::prepared::Vec3;

/// Corners clustered on a grid until there are at most `most` triangles or the cells reach `widest`; `None`
/// where there are no more to begin with. Every corner stays where a corner of the mesh was.
pub(super) fn to_triangles(surface: &Surface, most: usize, widest: f64) -> Option<Surface> {
    if surface.triangles.len() <= most {
        return None;
    }
    let mut cell: f64 = 0.002;
    loop {
        let coarse = cluster(surface, cell);
        if coarse.triangles.len() <= most || cell * 1.4 > widest.max(0.002) {
            return Some(coarse);
        }
        cell *= 1.4;
    }
}

fn cluster(surface: &Surface, cell: f64) -> Surface {
    // Lookup only; clusters are numbered in order of first use.
    let mut ids: HashMap<[i32; 3], u32> = HashMap::new();
    let mut sums: Vec<(Vec3, f64)> = Vec::new();
    let key = |p: &Vec3| [p.x, p.y, p.z].map(|x| (x / cell).floor() as i32);
    let cluster_of: Vec<u32> = surface
        .positions
        .iter()
        .map(|p| {
            let id = *ids.entry(key(p)).or_insert_with(|| {
                sums.push((Vec3::zeros(), 0.0));
                (sums.len() - 1) as u32
            });
            sums[id as usize].0 += p;
            sums[id as usize].1 += 1.0;
            id
        })
        .collect();
    let mut nearest: Vec<(f64, Vec3)> = vec![(f64::INFINITY, Vec3::zeros()); sums.len()];
    for (p, &id) in surface.positions.iter().zip(&cluster_of) {
        let (sum, count) = sums[id as usize];
        let distance = (sum / count - p).norm_squared();
        if distance < nearest[id as usize].0 {
            nearest[id as usize] = (distance, *p);
        }
    }
    let mut triangles: Vec<[u32; 3]> = surface
        .triangles
        .iter()
        .map(|t| t.map(|i| cluster_of[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .map(|t| {
            let least = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
            [t[least], t[(least + 1) % 3], t[(least + 2) % 3]]
        })
        .collect();
    triangles.sort_unstable();
    triangles.dedup();
    Surface { positions: nearest.into_iter().map(|(_, p)| p).collect(), triangles }
}
