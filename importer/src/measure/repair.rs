//! Rims that nearly meet, made to meet.

use std::collections::HashMap;

use crate::asset::Mesh;

use super::norm_of;
use super::topology::{edges, sides};
use super::weld::weld;

/// Share of the diagonal within which rim vertices are taken for one.
const TOLERANCE: f64 = 1e-6;

/// The mesh with vertices on open edges merged where they are within a millionth of the diagonal; `None` where that
/// changes nothing.
pub(super) fn close_rims(mesh: &Mesh, size: [f64; 3]) -> Option<Mesh> {
    let tolerance = TOLERANCE * norm_of(size);
    let rim = rim_vertices(mesh);
    if rim.is_empty() || tolerance <= 0.0 {
        return None;
    }
    let cell_of = |position: [f64; 3]| {
        #[allow(clippy::cast_possible_truncation)]
        position.map(|value| (value / tolerance).floor() as i64)
    };
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut moved = mesh.clone();
    let mut merged = false;
    for vertex in rim {
        let position = mesh.positions[vertex as usize];
        let cell = cell_of(position);
        let near = neighbours(cell).find_map(|neighbour| {
            let close = |other: &&u32| {
                let other = mesh.positions[**other as usize];
                let gap = std::array::from_fn(|axis| position[axis] - other[axis]);
                norm_of(gap) <= tolerance
            };
            cells.get(&neighbour)?.iter().find(close).copied()
        });
        if let Some(near) = near {
            moved.positions[vertex as usize] = mesh.positions[near as usize];
            merged = true;
        } else {
            cells.entry(cell).or_default().push(vertex);
        }
    }
    merged.then(|| weld(&moved).mesh)
}

fn rim_vertices(mesh: &Mesh) -> Vec<u32> {
    let sides = sides(&mesh.triangles);
    let mut rim: Vec<u32> =
        edges(&sides).filter(|edge| edge.len() == 1).flat_map(|edge| [edge[0].low, edge[0].high]).collect();
    rim.sort_unstable();
    rim.dedup();
    rim
}

/// The cell and the 26 around it.
fn neighbours(cell: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(move |at| {
        let step = [at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1];
        std::array::from_fn(|axis| cell[axis].saturating_add(step[axis]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_a_hair_apart_close() {
        let hair = 1e-7;
        let positions = vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0 + hair, 0.0, 0.0],
            [0.0, 1.0, hair],
            [1.0, 1.0, 0.0],
        ];
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [4, 3, 5]] };
        let closed = close_rims(&mesh, [1.0, 1.0, 0.0]).unwrap();
        assert_eq!(closed.positions.len(), 4);
        assert!(close_rims(&closed, [1.0, 1.0, 0.0]).is_none());
    }
}
