//! Which manifolds may be solved at once: a greedy colouring in the order of the pairs.
//!
//! Within a colour no two manifolds share a body that moves, so eight of them fit side by side and two workers never
//! meet. The order of the pairs is that of the entities, so the colours stay from step to step while the contacts
//! do, and depend neither on the past nor on the number of threads. What touches the ground comes last: there the
//! answer should be right.

/// A manifold that takes part: where it is, the rows of its bodies, how many points it has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) pair: u32,
    pub(crate) manifold: u32,
    pub(crate) rows: [u32; 2],
    pub(crate) points: u32,
}

/// Edges by colour and, within a colour, by number of points.
#[derive(Clone, Default)]
pub(crate) struct Graph {
    /// Bit set of the colours at each row: of edges between bodies, and of edges to the ground.
    taken: [Vec<u64>; 2],
    class: Vec<u32>,
    /// Edges in the order of the solve.
    pub(crate) order: Vec<u32>,
    /// Ends of the runs of equal colour and number of points, with the colour.
    pub(crate) runs: Vec<(u32, u32)>,
    counts: Vec<u32>,
}

const BITS: u32 = 64;
/// Points are at most this many; runs of a colour go from many points to few.
const MAX_POINTS: u32 = crate::collide::manifold::MAX_POINTS as u32;

impl Graph {
    /// Colours `edges` among `rows` bodies, row 0 being the ground.
    pub(crate) fn color(&mut self, edges: &[Edge], rows: usize) {
        for taken in &mut self.taken {
            taken.clear();
            taken.resize(rows, 0);
        }
        self.class.clear();
        // Colours of bodies, then of the ground; what finds no free colour is solved alone, after the others.
        let mut alone = [2 * BITS, 0];
        for edge in edges {
            let to_ground = edge.rows.contains(&super::block::GROUND);
            let taken = &mut self.taken[usize::from(to_ground)];
            let [a, b] = edge.rows.map(|row| row as usize);
            let used = if to_ground { taken[a.max(b)] } else { taken[a] | taken[b] };
            let free = (!used).trailing_zeros();
            let color = if free < BITS {
                for row in [a, b].into_iter().filter(|row| *row != super::block::GROUND as usize) {
                    taken[row] |= 1 << free;
                }
                free + if to_ground { BITS } else { 0 }
            } else {
                alone[0] += 1;
                alone[0] - 1
            };
            self.class.push(color * MAX_POINTS + (MAX_POINTS - edge.points));
        }
        let classes = (alone[0] * MAX_POINTS) as usize;
        self.counts.clear();
        self.counts.resize(classes + 1, 0);
        for class in &self.class {
            self.counts[*class as usize + 1] += 1;
        }
        self.runs.clear();
        for class in 0..classes {
            let size = self.counts[class + 1];
            self.counts[class + 1] += self.counts[class];
            if size > 0 {
                self.runs.push((self.counts[class + 1], class as u32 / MAX_POINTS));
            }
        }
        self.order.clear();
        self.order.resize(edges.len(), 0);
        for (edge, class) in (0..).zip(&self.class) {
            let slot = &mut self.counts[*class as usize];
            self.order[*slot as usize] = edge;
            *slot += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_color_has_a_body_twice_and_ground_comes_last() {
        let edge = |a: u32, b: u32, points| Edge { pair: 0, manifold: 0, rows: [a, b], points };
        let mut edges: Vec<Edge> = (1..9).flat_map(|i| [edge(i, i + 1, 4), edge(0, i, 1 + i % 4)]).collect();
        // A star of more edges than there are colours.
        edges.extend((10..90).map(|i| edge(9, i, 2)));
        let mut graph = Graph::default();
        graph.color(&edges, 90);
        let mut seen = vec![false; edges.len()];
        let mut start = 0;
        let mut by_color: Vec<(u32, Vec<Edge>)> = Vec::new();
        for &(end, color) in &graph.runs {
            let run: Vec<Edge> = graph.order[start as usize..end as usize]
                .iter()
                .map(|i| {
                    assert!(!std::mem::replace(&mut seen[*i as usize], true));
                    edges[*i as usize]
                })
                .collect();
            assert!(run.windows(2).all(|pair| pair[0].points == pair[1].points));
            match by_color.last_mut() {
                Some((last, all)) if *last == color => all.extend(run),
                _ => by_color.push((color, run)),
            }
            start = end;
        }
        assert!(seen.iter().all(|seen| *seen));
        for (color, edges) in by_color {
            let mut rows: Vec<u32> = edges.iter().flat_map(|e| e.rows).filter(|row| *row != 0).collect();
            let count = rows.len();
            rows.sort_unstable();
            rows.dedup();
            assert_eq!(rows.len(), count, "colour {color}");
            assert!(edges.iter().all(|e| (e.rows[0] == 0) == (BITS..2 * BITS).contains(&color)));
        }
    }
}
