//! Triangles over a rim.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::moments::{Point, cross, minus, norm};

/// Rims of up to so many corners get the filling of least area, by dynamic programming; its cost is cubic.
const SMALL: usize = 32;

/// A filling of a rim, wound along it. Corners in one line or in one place cost nothing.
///
/// P. Liepa, Filling Holes in Meshes, 2003, section 3, by area alone: where the rim is of a smooth surface, what the
/// missing piece bulged by is told from the surface around, see `resample`.
pub(super) fn cap(positions: &[Point], rim: &[u32]) -> Vec<[u32; 3]> {
    match rim.len() {
        0..=2 => Vec::new(),
        3 => vec![[rim[0], rim[1], rim[2]]],
        count if count <= SMALL => least_area(positions, rim),
        _ => by_ears(positions, rim),
    }
}

pub(super) fn area(positions: &[Point], triangles: &[[u32; 3]]) -> f64 {
    triangles.iter().map(|&corners| area_of(positions, corners)).sum()
}

fn area_of(positions: &[Point], [a, b, c]: [u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|corner| positions[corner as usize]);
    0.5 * norm(cross(minus(b, a), minus(c, a)))
}

fn least_area(positions: &[Point], rim: &[u32]) -> Vec<[u32; 3]> {
    let count = rim.len();
    let mut least = vec![0.0; count * count];
    let mut split = vec![0_usize; count * count];
    for span in 2..count {
        for from in 0..count - span {
            let to = from + span;
            let mut best = (f64::INFINITY, from + 1);
            for middle in from + 1..to {
                let whole = least[from * count + middle]
                    + least[middle * count + to]
                    + area_of(positions, [rim[from], rim[middle], rim[to]]);
                if whole < best.0 {
                    best = (whole, middle);
                }
            }
            (least[from * count + to], split[from * count + to]) = best;
        }
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut open = vec![(0, count - 1)];
    while let Some((from, to)) = open.pop() {
        if to - from < 2 {
            continue;
        }
        let middle = split[from * count + to];
        triangles.push([rim[from], rim[middle], rim[to]]);
        open.extend([(from, middle), (middle, to)]);
    }
    triangles
}

/// Cuts the smallest corner off again and again.
fn by_ears(positions: &[Point], rim: &[u32]) -> Vec<[u32; 3]> {
    let count = rim.len();
    let mut before: Vec<usize> = (0..count).map(|at| (at + count - 1) % count).collect();
    let mut after: Vec<usize> = (0..count).map(|at| (at + 1) % count).collect();
    let mut turn = vec![0_u32; count];
    // Areas are not negative, and so ordered as their bits are.
    let ear = |before: usize, at: usize, after: usize| {
        area_of(positions, [rim[before], rim[at], rim[after]]).to_bits()
    };
    let mut heap: BinaryHeap<Reverse<(u64, usize, u32)>> =
        (0..count).map(|at| Reverse((ear(before[at], at, after[at]), at, 0))).collect();
    let mut triangles = Vec::with_capacity(count - 2);
    while let Some(Reverse((_, at, when))) = heap.pop() {
        if turn[at] != when {
            continue;
        }
        let (left, right) = (before[at], after[at]);
        triangles.push([rim[left], rim[at], rim[right]]);
        if triangles.len() == count - 2 {
            break;
        }
        turn[at] = u32::MAX;
        after[left] = right;
        before[right] = left;
        for end in [left, right] {
            turn[end] += 1;
            heap.push(Reverse((ear(before[end], end, after[end]), end, turn[end])));
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn ring(count: u32) -> (Vec<Point>, Vec<u32>) {
        let at = |step: u32| {
            let angle = TAU * f64::from(step) / f64::from(count);
            [angle.cos(), angle.sin(), 0.0]
        };
        ((0..count).map(at).collect(), (0..count).collect())
    }

    #[test]
    fn a_flat_ring_is_covered_once() {
        for count in [4, 5, 12, 32, 33, 200, 3_000] {
            let (positions, rim) = ring(count);
            let cap = cap(&positions, &rim);
            let exact = 0.5 * f64::from(count) * (TAU / f64::from(count)).sin();
            assert_eq!(cap.len(), count as usize - 2);
            assert!((area(&positions, &cap) / exact - 1.0).abs() < 1e-9, "{count}");
        }
    }

    #[test]
    fn the_shorter_fold_is_taken() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.4], [1.0, 1.0, 0.0], [0.0, 1.0, 0.4]];
        let cap = cap(&positions, &[0, 1, 2, 3]);
        let other = area(&positions, &[[0, 1, 3], [1, 2, 3]]);
        assert!(area(&positions, &cap) <= other);
    }
}
