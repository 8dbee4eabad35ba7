//! The level of a half of a field, as a closed mesh: every cell of a grid cut into six tetrahedra.
//!
//! A. Doi, A. Koide, An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells, 1991. No
//! tables, no ambiguous cases, and always closed.

use std::collections::HashMap;

use crate::asset::Mesh;

use super::{Point, extent};

/// The corners of a cube, one bit an axis, and the six tetrahedra about the diagonal from 0 to 7.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// `field` is over a half inside. Cells are no finer than the points are apart.
pub(super) fn surface(positions: &[Point], spacing: f64, most: usize, field: impl Fn(Point) -> f64) -> Mesh {
    let (low, longest) = extent(positions);
    let cell = (0.75 * spacing).max(longest / most as f64);
    let mut high = low;
    for point in positions {
        high = std::array::from_fn(|axis| high[axis].max(point[axis]));
    }
    // Two cells around are outside, so that the surface is closed.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let size: [usize; 3] = std::array::from_fn(|axis| ((high[axis] - low[axis]) / cell).ceil() as usize + 5);
    let place =
        |at: [usize; 3]| -> Point { std::array::from_fn(|axis| low[axis] + cell * (at[axis] as f64 - 2.0)) };
    let number = |[x, y, z]: [usize; 3]| (z * size[1] + y) * size[0] + x;
    let mut values = vec![0.0; size.iter().product()];
    for z in 1..size[2] - 1 {
        for y in 1..size[1] - 1 {
            for x in 1..size[0] - 1 {
                values[number([x, y, z])] = field(place([x, y, z])).abs();
            }
        }
    }
    let mut cut = Cut { mesh: Mesh::default(), on_edge: HashMap::new() };
    for z in 0..size[2] - 1 {
        for y in 0..size[1] - 1 {
            for x in 0..size[0] - 1 {
                let corner = |bits: usize| [x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2)];
                let inside = (0..8).filter(|&bits| values[number(corner(bits))] > 0.5).count();
                if inside == 0 || inside == 8 {
                    continue;
                }
                for tetrahedron in TETRAHEDRA {
                    cut.tetrahedron(tetrahedron.map(|bits| {
                        let at = corner(bits);
                        (number(at), place(at), values[number(at)])
                    }));
                }
            }
        }
    }
    cut.mesh
}

type Corner = (usize, Point, f64);

struct Cut {
    mesh: Mesh,
    on_edge: HashMap<(usize, usize), u32>,
}

impl Cut {
    fn tetrahedron(&mut self, corners: [Corner; 4]) {
        let (inside, outside): (Vec<&Corner>, Vec<&Corner>) =
            corners.iter().partition(|corner| corner.2 > 0.5);
        let corner = |list: &[&Corner], at: usize| *list[at];
        match (inside.len(), outside.len()) {
            (1, 3) | (3, 1) => {
                let (one, three) = if inside.len() == 1 { (&inside, &outside) } else { (&outside, &inside) };
                let at = |k: usize| (corner(one, 0), corner(three, k));
                self.triangle([at(0), at(1), at(2)], inside[0].1);
            }
            (2, 2) => {
                let at = |i: usize, o: usize| (corner(&inside, i), corner(&outside, o));
                self.triangle([at(0, 0), at(0, 1), at(1, 0)], inside[0].1);
                self.triangle([at(1, 0), at(0, 1), at(1, 1)], inside[1].1);
            }
            _ => {}
        }
    }

    /// On three edges that are crossed, turned away from a corner inside.
    fn triangle(&mut self, crossed: [(Corner, Corner); 3], inside: Point) {
        let corners = crossed.map(|(one, other)| self.crossing(one, other));
        let [a, b, c] = corners.map(|corner| self.mesh.positions[corner as usize]);
        let minus = |a: Point, b: Point| -> Point { std::array::from_fn(|axis| a[axis] - b[axis]) };
        let (u, v, w) = (minus(b, a), minus(c, a), minus(inside, a));
        let volume = w[0] * (u[1] * v[2] - u[2] * v[1])
            + w[1] * (u[2] * v[0] - u[0] * v[2])
            + w[2] * (u[0] * v[1] - u[1] * v[0]);
        let [a, b, c] = corners;
        self.mesh.triangles.push(if volume > 0.0 { [a, c, b] } else { [a, b, c] });
    }

    fn crossing(&mut self, one: Corner, other: Corner) -> u32 {
        let (one, other) = if one.0 < other.0 { (one, other) } else { (other, one) };
        *self.on_edge.entry((one.0, other.0)).or_insert_with(|| {
            // Kept off the ends: a corner on the level would make triangles without area.
            let share = ((0.5 - one.2) / (other.2 - one.2)).clamp(0.02, 0.98);
            // Crossed edges are fewer than the cells of the grid.
            #[allow(clippy::cast_possible_truncation)]
            let next = self.mesh.positions.len() as u32;
            self.mesh
                .positions
                .push(std::array::from_fn(|axis| one.1[axis] + share * (other.1[axis] - one.1[axis])));
            next
        })
    }
}
