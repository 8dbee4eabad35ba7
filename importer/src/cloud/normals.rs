//! Normals of a cloud, outwards.
//!
//! H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, Surface Reconstruction from Unorganized Points, 1992: the
//! plane through the neighbours, and its side carried from point to point where the planes agree best. Where outside
//! can be reached from one side of a point alone, that decides first: a tree of agreement alone is wrong for good after
//! one sharp edge.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::neighbours::Near;
use super::{Point, extent};

/// Cells of the outside along the longest side, at most.
const MOST_CELLS: f64 = 96.0;

/// `None` where the points lie on a line.
pub(super) fn outward(positions: &[Point], near: &[Near], spacing: f64) -> Option<Vec<Point>> {
    let mut normals: Vec<Point> = (0..positions.len()).map(|at| plane(positions, &near[at], at)).collect();
    if normals.iter().flatten().any(|value| !value.is_finite()) {
        return None;
    }
    let outside = Outside::of(positions, spacing);
    let mut decided: Vec<bool> = (0..positions.len())
        .map(|at| {
            let side = outside.side(positions[at], normals[at]);
            if side < 0 {
                normals[at] = normals[at].map(|value| -value);
            }
            side != 0
        })
        .collect();
    if !decided.contains(&true) {
        // What is highest looks up.
        let top = (0..positions.len()).max_by(|&a, &b| positions[a][1].total_cmp(&positions[b][1]))?;
        if normals[top][1] < 0.0 {
            normals[top] = normals[top].map(|value| -value);
        }
        decided[top] = true;
    }
    carry(&mut normals, &mut decided, near);
    Some(normals)
}

fn plane(positions: &[Point], near: &Near, at: usize) -> Point {
    let points =
        || near.points.iter().map(|&other| other as usize).chain([at]).map(|at| Vector3::from(positions[at]));
    let middle = points().sum::<Vector3<f64>>() / (near.points.len() + 1) as f64;
    let spread: Matrix3<f64> = points().map(|point| (point - middle) * (point - middle).transpose()).sum();
    let spread = spread / spread.amax().max(f64::MIN_POSITIVE);
    let eigen = SymmetricEigen::new(spread);
    eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned().into()
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// From those decided to their neighbours, where the planes agree best first.
fn carry(normals: &mut [Point], decided: &mut [bool], near: &[Near]) {
    let mut heap: BinaryHeap<(u64, Reverse<(u32, u32)>)> = BinaryHeap::new();
    let push = |heap: &mut BinaryHeap<_>, from: usize, normals: &[Point], decided: &[bool]| {
        for &to in near[from].points.iter().filter(|&&to| !decided[to as usize]) {
            let agreement = dot(normals[from], normals[to as usize]).abs();
            // Not negative, and so ordered as its bits are.
            #[allow(clippy::cast_possible_truncation)]
            heap.push((agreement.to_bits(), Reverse((from as u32, to))));
        }
    };
    (0..normals.len()).filter(|&at| decided[at]).for_each(|at| push(&mut heap, at, normals, decided));
    while let Some((_, Reverse((from, to)))) = heap.pop() {
        let (from, to) = (from as usize, to as usize);
        if std::mem::replace(&mut decided[to], true) {
            continue;
        }
        if dot(normals[from], normals[to]) < 0.0 {
            normals[to] = normals[to].map(|value| -value);
        }
        push(&mut heap, to, normals, decided);
    }
}

/// The cells that can be reached from outside without coming near a point.
struct Outside {
    low: Point,
    cell: f64,
    size: [usize; 3],
    state: Vec<State>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Free,
    Near,
    Outside,
}

impl Outside {
    fn of(positions: &[Point], spacing: f64) -> Self {
        let (low, longest) = extent(positions);
        // Three spacings wide, a cell without a point is a hole and no chance.
        let cell = (3.0 * spacing).max(longest / MOST_CELLS);
        let low = low.map(|value| value - 2.0 * cell);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let size = [((longest / cell) as usize) + 5; 3];
        let mut outside = Self { low, cell, size, state: vec![State::Free; size.iter().product()] };
        for point in positions {
            if let Some(at) = outside.cell_at(*point) {
                outside.state[at] = State::Near;
            }
        }
        outside.flood();
        outside
    }

    fn cell_at(&self, point: Point) -> Option<usize> {
        let place: [f64; 3] =
            std::array::from_fn(|axis| ((point[axis] - self.low[axis]) / self.cell).floor());
        let [x, y, z] = place;
        let inside = place.iter().zip(self.size).all(|(&value, size)| value >= 0.0 && value < size as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        inside.then(|| (z as usize * self.size[1] + y as usize) * self.size[0] + x as usize)
    }

    fn flood(&mut self) {
        let [width, height, depth] = self.size;
        let mut open = vec![0_usize];
        self.state[0] = State::Outside;
        while let Some(at) = open.pop() {
            let [x, y, z] = [at % width, at / width % height, at / (width * height)];
            let steps = [
                (x > 0).then(|| at - 1),
                (x + 1 < width).then(|| at + 1),
                (y > 0).then(|| at - width),
                (y + 1 < height).then(|| at + width),
                (z > 0).then(|| at - width * height),
                (z + 1 < depth).then(|| at + width * height),
            ];
            for next in steps.into_iter().flatten() {
                if self.state[next] == State::Free {
                    self.state[next] = State::Outside;
                    open.push(next);
                }
            }
        }
    }

    /// 1 where outside lies along the normal alone, -1 where against it alone, else 0.
    fn side(&self, point: Point, normal: Point) -> i32 {
        let sees = |sign: f64| {
            for step in 1..=4 {
                let along = sign * self.cell * f64::from(step);
                let at: Point = std::array::from_fn(|axis| point[axis] + along * normal[axis]);
                match self.cell_at(at).map(|at| self.state[at]) {
                    Some(State::Near) => {}
                    Some(State::Free) => return Some(false),
                    Some(State::Outside) | None => return Some(true),
                }
            }
            None
        };
        match (sees(1.0), sees(-1.0)) {
            (Some(true), Some(false) | None) => 1,
            (Some(false) | None, Some(true)) => -1,
            _ => 0,
        }
    }
}
