//! A symmetric positive definite matrix of 6 × 6 blocks, one row of blocks a body, and its sparse Cholesky factor.

use nalgebra::{Matrix6, Vector6};

type Block = Matrix6<f64>;

const NONE: u32 = u32::MAX;

/// The lower triangle by blocks; the pattern of the factor is found once a step, its numbers whenever they change.
#[derive(Clone, Default)]
pub(crate) struct BlockMatrix {
    size: usize,
    /// Block of row i, column j (i ≥ j in the order of elimination), or `NONE`.
    at: Vec<u32>,
    blocks: Vec<Block>,
    /// Of each diagonal block, the inverse of its factor.
    inverse: Vec<Block>,
    /// Place of a body in the order of elimination.
    place: Vec<u32>,
    /// Rows below the diagonal in each column.
    below: Vec<Vec<u32>>,
    /// Which bodies are joined, as far as the elimination has come.
    joined: Vec<bool>,
}

impl BlockMatrix {
    /// Sets up the pattern of `size` bodies joined by `links`; the body with the fewest neighbours goes first.
    pub(crate) fn plan(&mut self, size: usize, links: impl Iterator<Item = (usize, usize)>) {
        self.size = size;
        let Self { joined, place, below, .. } = self;
        joined.clear();
        joined.resize(size * size, false);
        for (a, b) in links {
            joined[a * size + b] = true;
            joined[b * size + a] = true;
        }
        place.clear();
        place.resize(size, NONE);
        if below.len() < size {
            below.resize(size, Vec::new());
        }
        for (step, near) in (0..size).zip(below.iter_mut()) {
            let degree = |i: usize| (0..size).filter(|&j| joined[i * size + j]).count();
            let left = (0..size).filter(|&i| place[i] == NONE);
            let Some(next) = left.min_by_key(|&i| (degree(i), i)) else { break };
            place[next] = step as u32;
            near.clear();
            near.extend((0..size as u32).filter(|&j| joined[next * size + j as usize]));
            for i in near.iter().map(|i| *i as usize) {
                joined[i * size + next] = false;
                joined[next * size + i] = false;
                for j in near.iter().map(|j| *j as usize) {
                    if i != j {
                        joined[i * size + j] = true;
                    }
                }
            }
        }
        self.at.clear();
        self.at.resize(size * size, NONE);
        let mut count = 0;
        for (column, rows) in self.below.iter_mut().take(size).enumerate() {
            self.at[column * size + column] = count;
            count += 1;
            rows.iter_mut().for_each(|row| *row = self.place[*row as usize]);
            rows.sort_unstable();
            for &row in rows.iter() {
                self.at[row as usize * size + column] = count;
                count += 1;
            }
        }
        self.blocks.clear();
        self.blocks.resize(count as usize, Block::zeros());
        self.inverse.clear();
        self.inverse.resize(size, Block::zeros());
    }

    pub(crate) fn clear(&mut self) {
        self.blocks.fill(Block::zeros());
    }

    /// Adds `block` at body `a`'s row and body `b`'s column, and its transpose opposite.
    pub(crate) fn add(&mut self, a: usize, b: usize, block: &Block) {
        let (row, column) = (self.place[a] as usize, self.place[b] as usize);
        if row >= column {
            self.blocks[self.at[row * self.size + column] as usize] += block;
        } else {
            self.blocks[self.at[column * self.size + row] as usize] += block.transpose();
        }
    }

    fn block(&self, row: u32, column: usize) -> usize {
        self.at[row as usize * self.size + column] as usize
    }

    /// Turns the matrix into its Cholesky factor; `false` if it is not positive definite.
    pub(crate) fn factor(&mut self) -> bool {
        for column in 0..self.size {
            let diagonal = self.block(column as u32, column);
            let Some(cholesky) = self.blocks[diagonal].cholesky() else { return false };
            let lower = cholesky.unpack();
            let Some(inverse) = lower.solve_lower_triangular(&Block::identity()) else { return false };
            self.blocks[diagonal] = lower;
            self.inverse[column] = inverse;
            let below = std::mem::take(&mut self.below[column]);
            for &row in &below {
                let at = self.block(row, column);
                self.blocks[at] *= inverse.transpose();
            }
            for (i, &row) in below.iter().enumerate() {
                let left = self.blocks[self.block(row, column)];
                for &other in &below[..=i] {
                    let right = self.blocks[self.block(other, column)];
                    let target = self.block(row, other as usize);
                    self.blocks[target] -= left * right.transpose();
                }
            }
            self.below[column] = below;
        }
        true
    }

    /// Solves with the factor, in place; `x` is by body.
    pub(crate) fn solve(&self, x: &mut [Vector6<f64>], work: &mut Vec<Vector6<f64>>) {
        work.clear();
        work.resize(self.size, Vector6::zeros());
        for (value, place) in x.iter().zip(&self.place) {
            work[*place as usize] = *value;
        }
        for column in 0..self.size {
            let value = self.inverse[column] * work[column];
            work[column] = value;
            for &row in &self.below[column] {
                work[row as usize] -= self.blocks[self.block(row, column)] * value;
            }
        }
        for column in (0..self.size).rev() {
            let mut value = work[column];
            for &row in &self.below[column] {
                value -= self.blocks[self.block(row, column)].tr_mul(&work[row as usize]);
            }
            work[column] = self.inverse[column].tr_mul(&value);
        }
        for (value, place) in x.iter_mut().zip(&self.place) {
            *value = work[*place as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_solves_a_ring_with_a_chord() {
        let size = 7;
        let links = (0..size).map(|i| (i, (i + 1) % size)).chain([(1, 4)]);
        let number = |n: u32| crate::gallery::build::noise(n, 5) - 0.5;
        let mut matrix = BlockMatrix::default();
        matrix.plan(size, links.clone());
        let mut dense = nalgebra::DMatrix::<f64>::zeros(6 * size, 6 * size);
        let mut put = |matrix: &mut BlockMatrix, a: usize, b: usize, block: Block| {
            matrix.add(a, b, &block);
            let mut view = dense.view_mut((6 * a, 6 * b), (6, 6));
            view += block;
            if a != b {
                let mut view = dense.view_mut((6 * b, 6 * a), (6, 6));
                view += block.transpose();
            }
        };
        for (n, (a, b)) in (0..).zip(links) {
            put(&mut matrix, a, b, Block::from_fn(|i, j| number(n * 36 + (6 * i + j) as u32)));
        }
        for i in 0..size {
            put(&mut matrix, i, i, Block::identity() * 8.0);
        }
        let right: Vec<_> =
            (0..size).map(|i| Vector6::from_fn(|j, _| number(1000 + (6 * i + j) as u32))).collect();
        let mut x = right.clone();
        assert!(matrix.factor());
        matrix.solve(&mut x, &mut Vec::new());
        let flat = |v: &[Vector6<f64>]| {
            nalgebra::DVector::from_iterator(6 * size, v.iter().flat_map(|v| v.iter().copied()))
        };
        assert!((dense * flat(&x) - flat(&right)).norm() < 1e-12);
    }
}
