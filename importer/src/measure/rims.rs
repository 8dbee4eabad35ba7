//! The rims of an oriented surface: closed walks around what is missing.

use std::collections::HashMap;

use super::topology::{Sets, Side, edges, sides};

/// At a corner where very many rims meet, no more ways on than this are looked at.
const MOST_WAYS: usize = 32;

/// Which of several ways to go on at a corner where holes meet.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// To another fan of triangles: around the gap between two of them, as holes of a surface run.
    Across,
    /// Back along the same fan: around the triangles, as the outline of a piece cut out runs.
    Along,
}

/// Walks that bound the holes, each in the direction in which its filling must be wound.
///
/// The boundary of any set of triangles is a sum of closed walks, wherever edges have one, three or more triangles, so
/// filling them all closes it. Three edges around a single missing triangle are found first; the rest are walks that
/// come to no corner twice.
pub(super) fn rims(triangles: &[[u32; 3]], turn: Turn) -> Vec<Vec<u32>> {
    let mut open = Open::of(triangles, turn);
    let mut rims = Vec::new();
    for at in 0..open.edges.len() {
        if let Some(rim) = open.triangle(at) {
            rims.push(rim);
        }
    }
    for at in 0..open.edges.len() {
        open.walk(at, &mut rims);
    }
    rims
}

/// Directed edges that a filling has to have, sorted.
struct Open {
    edges: Vec<(u32, u32)>,
    /// Of each edge, the fans of triangles at its start and at its end.
    fans: Vec<[u32; 2]>,
    used: Vec<bool>,
    turn: Turn,
}

/// Corners of triangles that hang together around a vertex by shared sides: corner `3 t + i` of triangle `t`.
fn fans(triangles: &[[u32; 3]], sides: &[Side]) -> Sets {
    let mut fans = Sets::new(3 * triangles.len());
    for edge in edges(sides) {
        let [one, other] = edge else { continue };
        for corner in [one.low, one.high] {
            fans.join(corner_of(triangles, one, corner), corner_of(triangles, other, corner));
        }
    }
    fans
}

fn corner_of(triangles: &[[u32; 3]], side: &Side, corner: u32) -> u32 {
    let place = triangles[side.triangle as usize].iter().position(|&own| own == corner).unwrap_or(0);
    // There are fewer triangles than a third of `u32::MAX`.
    #[allow(clippy::cast_possible_truncation)]
    let place = place as u32;
    3 * side.triangle + place
}

impl Open {
    fn of(triangles: &[[u32; 3]], turn: Turn) -> Self {
        let sides = sides(triangles);
        let mut fans = fans(triangles, &sides);
        let mut open: Vec<((u32, u32), [u32; 2])> = Vec::new();
        for edge in edges(&sides) {
            let forward = edge.iter().filter(|side| side.forward).count();
            let backward = edge.len() - forward;
            // What is run too often one way has to be run the other way by the filling.
            let surplus = forward.max(backward) - forward.min(backward);
            for side in edge.iter().filter(|side| side.forward == (forward > backward)).take(surplus) {
                let (from, to) = if side.forward { (side.high, side.low) } else { (side.low, side.high) };
                let ends = [from, to].map(|end| fans.find(corner_of(triangles, side, end)));
                open.push(((from, to), ends));
            }
        }
        open.sort_unstable();
        let used = vec![false; open.len()];
        let (edges, fans) = open.into_iter().unzip();
        Self { edges, fans, used, turn }
    }

    fn first_from(&self, corner: u32) -> usize {
        self.edges.partition_point(|edge| edge.0 < corner)
    }

    fn unused(&self, from: u32, to: u32) -> Option<usize> {
        let first = self.edges.partition_point(|edge| *edge < (from, to));
        (first..self.edges.len()).take_while(|&at| self.edges[at] == (from, to)).find(|&at| !self.used[at])
    }

    /// Three edges that come back, beginning with this one.
    fn triangle(&mut self, at: usize) -> Option<Vec<u32>> {
        if self.used[at] {
            return None;
        }
        let (a, b) = self.edges[at];
        let first = self.first_from(b);
        for next in (first..self.edges.len()).take(MOST_WAYS) {
            let (from, c) = self.edges[next];
            if from != b {
                break;
            }
            if self.used[next] || c == a {
                continue;
            }
            if let Some(last) = self.unused(c, a) {
                for edge in [at, next, last] {
                    self.used[edge] = true;
                }
                return Some(vec![a, b, c]);
            }
        }
        None
    }

    /// An edge that goes on from the end of another.
    fn after(&mut self, edge: usize) -> Option<usize> {
        let (_, corner) = self.edges[edge];
        let first = self.first_from(corner);
        let ways = (first..self.edges.len()).take_while(|&at| self.edges[at].0 == corner);
        let mut any = None;
        for at in ways.filter(|&at| !self.used[at]).take(MOST_WAYS) {
            let same = self.fans[at][0] == self.fans[edge][1];
            if same == (self.turn == Turn::Along) {
                return Some(at);
            }
            any = any.or(Some(at));
        }
        any
    }

    /// Follows edges from this one until none goes on; every time the walk comes back to a corner, a rim is done.
    fn walk(&mut self, at: usize, rims: &mut Vec<Vec<u32>>) {
        if self.used[at] {
            return;
        }
        // Corners, each with the edge that goes on from it.
        let mut path: Vec<(u32, usize)> = vec![(self.edges[at].0, at)];
        let mut place = HashMap::from([(self.edges[at].0, 0_usize)]);
        self.used[at] = true;
        while let Some(&(_, edge)) = path.last() {
            let (_, corner) = self.edges[edge];
            if let Some(&start) = place.get(&corner) {
                let rim = path.split_off(start);
                for (corner, _) in &rim {
                    place.remove(corner);
                }
                rims.push(rim.into_iter().map(|(corner, _)| corner).collect());
            } else if let Some(next) = self.after(edge) {
                self.used[next] = true;
                place.insert(corner, path.len());
                path.push((corner, next));
            } else {
                // Cannot be: a boundary has no end.
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OCTAHEDRON: [[u32; 3]; 8] =
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

    fn closes(triangles: &[[u32; 3]], rims: &[Vec<u32>]) -> bool {
        let mut all = triangles.to_vec();
        for rim in rims {
            all.extend((2..rim.len()).map(|at| [rim[0], rim[at - 1], rim[at]]));
        }
        self::rims(&all, Turn::Across).is_empty()
    }

    #[test]
    fn holes_that_touch_at_a_corner_come_apart() {
        let open: Vec<[u32; 3]> = [1, 2, 4, 5, 6, 7].iter().map(|&at| OCTAHEDRON[at]).collect();
        let rims = rims(&open, Turn::Across);
        assert_eq!(rims.iter().map(Vec::len).collect::<Vec<_>>(), [4]);
        let open: Vec<[u32; 3]> = [1, 3, 4, 5, 6, 7].iter().map(|&at| OCTAHEDRON[at]).collect();
        let found = self::rims(&open, Turn::Across);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
        assert!(closes(&open, &found));
    }

    #[test]
    fn any_subset_is_closed_by_filling_its_rims() {
        for mask in 0..256_u32 {
            let kept: Vec<[u32; 3]> =
                (0..8).filter(|at| mask >> at & 1 == 1).map(|at| OCTAHEDRON[at]).collect();
            assert!(
                closes(&kept, &rims(&kept, Turn::Along)) && closes(&kept, &rims(&kept, Turn::Across)),
                "{mask:08b}"
            );
        }
        // Three triangles at an edge, all wound alike.
        let fan = [[0, 1, 2], [0, 1, 3], [0, 1, 4]];
        assert!(closes(&fan, &rims(&fan, Turn::Across)));
    }
}
