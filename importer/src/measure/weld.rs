//! Vertices in one place made one.

use std::collections::HashMap;

use crate::asset::Mesh;

/// A mesh whose vertices are all apart and all used, and what was in the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welded {
    /// Without triangles that have two corners in one place.
    pub mesh: Mesh,
    /// As given.
    pub triangles: u64,
    pub vertices: u64,
    /// Triangles without area.
    pub degenerate: u64,
}

/// Merges vertices whose three coordinates are equal (and 0 with -0). The order is that of first use.
#[must_use]
pub fn weld(mesh: &Mesh) -> Welded {
    const UNUSED: u32 = u32::MAX;
    let mut number_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let mut number_of = vec![UNUSED; mesh.positions.len()];
    let mut welded = Welded {
        triangles: mesh.triangles.len() as u64,
        vertices: mesh.positions.len() as u64,
        ..Welded::default()
    };
    let merged = &mut welded.mesh;
    merged.triangles.reserve(mesh.triangles.len());
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| {
            let slot = &mut number_of[corner as usize];
            if *slot == UNUSED {
                // Adding 0 turns -0 into 0.
                let position = mesh.positions[corner as usize].map(|value| value + 0.0);
                // There are no more of them than positions, which `u32` numbers.
                #[allow(clippy::cast_possible_truncation)]
                let next = merged.positions.len() as u32;
                *slot = *number_at.entry(position.map(f64::to_bits)).or_insert(next);
                if *slot == next {
                    merged.positions.push(position);
                }
            }
            *slot
        });
        let [a, b, c] = corners;
        let degenerate = a == b || b == c || c == a;
        if !degenerate {
            merged.triangles.push(corners);
        }
        if degenerate || on_a_line(corners.map(|corner| merged.positions[corner as usize])) {
            welded.degenerate += 1;
        }
    }
    welded
}

fn on_a_line([a, b, c]: [[f64; 3]; 3]) -> bool {
    super::moments::cross(super::moments::minus(b, a), super::moments::minus(c, a)) == [0.0; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_places_merge_and_unused_ones_go() {
        let positions = vec![
            [9.0; 3],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-0.0, 0.0, -0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let triangles = vec![[1, 2, 3], [4, 6, 5], [1, 4, 2]];
        let welded = weld(&Mesh { positions, triangles });
        assert_eq!(welded.mesh.positions.len(), 4);
        assert_eq!(welded.mesh.triangles, [[0, 1, 2], [0, 3, 1]]);
        assert_eq!((welded.triangles, welded.vertices, welded.degenerate), (3, 7, 1));
    }

    #[test]
    fn a_needle_is_degenerate_but_stays() {
        let positions = vec![[0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0]];
        let welded = weld(&Mesh { positions, triangles: vec![[0, 1, 2]] });
        assert_eq!((welded.degenerate, welded.mesh.triangles.len()), (1, 1));
    }
}
