//! Filled cells to the faces between them and the empty ones.

use crate::asset::Mesh;
use crate::{ImportError, Options};

/// A box of cells, each filled or not; cell (x, y, z) spans from (x, y, z) to (x + 1, y + 1, z + 1).
pub(super) struct Grid {
    size: [usize; 3],
    bits: Vec<u64>,
}

impl Grid {
    /// # Errors
    /// Too large over [`Options::max_voxels`].
    pub fn new(size: [u64; 3], place: &str, options: &Options) -> Result<Self, ImportError> {
        // One side of nothing would let the others be anything.
        let size = if size.contains(&0) { [0; 3] } else { size };
        let cells = size.iter().try_fold(1_u64, |cells, &side| cells.checked_mul(side));
        match cells {
            Some(cells) if cells <= options.max_voxels => {
                let words = usize::try_from(cells.div_ceil(64)).unwrap_or(0);
                // Under the limit every side is within `usize`.
                let size = size.map(|side| usize::try_from(side).unwrap_or(0));
                Ok(Self { size, bits: vec![0; words] })
            }
            _ => {
                let [x, y, z] = size;
                let reason = format!("{x} by {y} by {z} voxels, the limit is {} in all", options.max_voxels);
                Err(ImportError::too_large(place, reason))
            }
        }
    }

    fn place(&self, [x, y, z]: [usize; 3]) -> Option<usize> {
        let [width, height, depth] = self.size;
        (x < width && y < height && z < depth).then(|| (z * height + y) * width + x)
    }

    /// Cells outside are passed over.
    pub fn fill(&mut self, cell: [usize; 3]) {
        if let Some(at) = self.place(cell) {
            self.bits[at / 64] |= 1 << (at % 64);
        }
    }

    fn is_filled(&self, cell: [usize; 3]) -> bool {
        self.place(cell).is_some_and(|at| self.bits[at / 64] >> (at % 64) & 1 == 1)
    }

    /// The faces of filled cells that no other filled cell touches, two triangles each, corners shared. Closed, since
    /// every edge has an even number of them, as often one way as the other.
    ///
    /// # Errors
    /// Too large over [`Options::max_triangles`].
    pub fn surface(&self, options: &Options) -> Result<Mesh, ImportError> {
        let mut mesh = Mesh::default();
        let mut corner_at = std::collections::HashMap::new();
        let [width, height, _] = self.size;
        for (place, &word) in self.bits.iter().enumerate().filter(|(_, word)| **word != 0) {
            for bit in (0..64).filter(|bit| word >> bit & 1 == 1) {
                let at = 64 * place + bit;
                let cell = [at % width, at / width % height, at / (width * height)];
                for side in (0..6).filter(|&side| !self.covers(cell, side)) {
                    add_face(cell, side, &mut mesh, &mut corner_at);
                }
            }
            let counts = [mesh.positions.len() as u64, mesh.triangles.len() as u64];
            super::reading::check_counts(counts[0], counts[1], "voxels", options)?;
        }
        Ok(mesh)
    }

    /// Whether the neighbour across a side is filled.
    fn covers(&self, cell: [usize; 3], side: usize) -> bool {
        let (axis, up) = (side / 2, side % 2 == 1);
        let mut next = cell;
        let moved = if up { cell[axis].checked_add(1) } else { cell[axis].checked_sub(1) };
        moved.is_some_and(|moved| {
            next[axis] = moved;
            self.is_filled(next)
        })
    }
}

fn add_face(
    cell: [usize; 3],
    side: usize,
    mesh: &mut Mesh,
    corner_at: &mut std::collections::HashMap<[usize; 3], u32>,
) {
    let (axis, up) = (side / 2, side % 2);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut corner = |du: usize, dv: usize| {
        let mut at = cell;
        at[axis] += up;
        at[u] += du;
        at[v] += dv;
        *corner_at.entry(at).or_insert_with(|| {
            // Held within `u32` by `check_counts`, word by word.
            #[allow(clippy::cast_possible_truncation)]
            let next = mesh.positions.len() as u32;
            mesh.positions.push(at.map(|value| value as f64));
            next
        })
    };
    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    mesh.triangles.extend(if up == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{measure, weld};

    fn measured(size: [u64; 3], cells: &[[usize; 3]]) -> crate::Measures {
        let mut grid = Grid::new(size, "", &Options::default()).unwrap();
        cells.iter().for_each(|&cell| grid.fill(cell));
        measure(&weld(&grid.surface(&Options::default()).unwrap()))
    }

    #[test]
    fn the_volume_is_the_number_of_cells() {
        let bar = measured([4, 1, 1], &[[0, 0, 0], [1, 0, 0], [3, 0, 0], [9, 9, 9]]);
        assert!(bar.closed && bar.wound_consistently);
        assert_eq!((bar.bodies, bar.triangles), (2, 32));
        assert!((bar.solid.unwrap().measure - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_grid_without_height_has_no_rows_to_walk_through() {
        let grid = Grid::new([4, 0, u64::from(u32::MAX)], "", &Options::default()).unwrap();
        assert_eq!(grid.size, [0; 3]);
    }

    #[test]
    fn cells_that_touch_at_an_edge_or_enclose_a_hollow_still_add_up() {
        let touching = measured([2, 2, 1], &[[0, 0, 0], [1, 1, 0]]);
        assert!((touching.solid.unwrap().measure - 2.0).abs() < 1e-12);
        let shell: Vec<[usize; 3]> =
            (0..27).map(|at| [at % 3, at / 3 % 3, at / 9]).filter(|cell| *cell != [1, 1, 1]).collect();
        let hollow = measured([3, 3, 3], &shell);
        assert!((hollow.solid.unwrap().measure - 26.0).abs() < 1e-12);
        assert_eq!(hollow.body_volumes[1].role, crate::BodyRole::Cavity);
    }
}
