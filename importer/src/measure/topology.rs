//! Edges, and what hangs together by them.

use crate::asset::Mesh;

/// Which triangles meet at which edges.
#[derive(Debug, Default)]
pub(super) struct Topology {
    pub closed: bool,
    /// Each edge of two triangles is run once in each direction.
    pub wound_consistently: bool,
    pub boundary_edges: u64,
    pub nonmanifold_edges: u64,
    pub body_count: u64,
    /// Every triangle's three edges, sorted, so that those of one edge lie together.
    pub sides: Vec<Side>,
    /// Every vertex's body.
    body_of: Vec<u32>,
}

/// One triangle's side of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    pub low: u32,
    pub high: u32,
    pub triangle: u32,
    /// The triangle runs from `low` to `high`.
    pub forward: bool,
}

/// Triangles connected by shared vertices.
#[derive(Debug, Default)]
pub(super) struct Body {
    pub triangles: Vec<[u32; 3]>,
    pub closed: bool,
}

impl Topology {
    pub fn of(mesh: &Mesh) -> Self {
        let sides = sides(&mesh.triangles);
        let mut topology = Self { wound_consistently: true, ..Self::default() };
        for edge in edges(&sides) {
            match edge {
                [_] => topology.boundary_edges += 1,
                [one, other] => topology.wound_consistently &= one.forward != other.forward,
                _ => topology.nonmanifold_edges += 1,
            }
        }
        topology.closed =
            !mesh.triangles.is_empty() && topology.boundary_edges == 0 && topology.nonmanifold_edges == 0;
        let mut sets = Sets::new(mesh.positions.len());
        for &[a, b, c] in &mesh.triangles {
            sets.join(a, b);
            sets.join(a, c);
        }
        let (body_of, count) = sets.numbered(mesh.triangles.iter().map(|corners| corners[0]));
        topology.body_of = body_of;
        topology.body_count = u64::from(count);
        topology.sides = sides;
        topology
    }

    /// In order of their first triangle.
    pub fn bodies(&self, mesh: &Mesh) -> Vec<Body> {
        let count = usize::try_from(self.body_count).unwrap_or(0);
        let mut bodies: Vec<Body> =
            (0..count).map(|_| Body { triangles: Vec::new(), closed: true }).collect();
        for triangle in &mesh.triangles {
            bodies[self.body_of[triangle[0] as usize] as usize].triangles.push(*triangle);
        }
        for edge in edges(&self.sides) {
            if edge.len() != 2 {
                bodies[self.body_of[edge[0].low as usize] as usize].closed = false;
            }
        }
        bodies
    }
}

pub(super) fn sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (index, &[a, b, c]) in triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // `Options::max_triangles` is far below `u32::MAX`.
            #[allow(clippy::cast_possible_truncation)]
            let triangle = index as u32;
            sides.push(Side { low: from.min(to), high: from.max(to), triangle, forward: from < to });
        }
    }
    sides.sort_unstable();
    sides
}

/// The sides of each edge in turn.
pub(super) fn edges(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|one, other| (one.low, one.high) == (other.low, other.high))
}

/// Disjoint sets of numbers, with path halving; the smallest member stands for its set.
pub(super) struct Sets(Vec<u32>);

impl Sets {
    #[allow(clippy::cast_possible_truncation)]
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    pub fn find(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    pub fn join(&mut self, one: u32, other: u32) {
        let (one, other) = (self.find(one), self.find(other));
        self.0[one.max(other) as usize] = one.min(other);
    }

    /// Every member's set, numbered in the order of `members`; sets that none of them is in get `u32::MAX`.
    pub fn numbered(mut self, members: impl Iterator<Item = u32>) -> (Vec<u32>, u32) {
        let mut number = vec![u32::MAX; self.0.len()];
        let mut count = 0;
        for member in members {
            let set = self.find(member) as usize;
            if number[set] == u32::MAX {
                number[set] = count;
                count += 1;
            }
        }
        #[allow(clippy::cast_possible_truncation)]
        let of = (0..self.0.len() as u32).map(|member| number[self.find(member) as usize]).collect();
        (of, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn topology(triangles: &[[u32; 3]], vertices: usize) -> Topology {
        Topology::of(&Mesh { positions: vec![[0.0; 3]; vertices], triangles: triangles.to_vec() })
    }

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_tetrahedron_is_closed_until_a_face_goes_or_turns() {
        let whole = topology(&TETRAHEDRON, 4);
        assert!(whole.closed && whole.wound_consistently);
        let open = topology(&TETRAHEDRON[1..], 4);
        assert_eq!((open.closed, open.boundary_edges), (false, 3));
        let mut turned = TETRAHEDRON;
        turned[0].swap(0, 1);
        let turned = topology(&turned, 4);
        assert!(turned.closed && !turned.wound_consistently);
    }

    #[test]
    fn bodies_come_in_order_of_their_first_triangle() {
        let far = TETRAHEDRON.map(|corners| corners.map(|corner| corner + 4));
        let mesh = Mesh { positions: vec![[0.0; 3]; 9], triangles: [&far[..], &TETRAHEDRON[..3]].concat() };
        let topology = Topology::of(&mesh);
        let bodies = topology.bodies(&mesh);
        assert_eq!(topology.body_count, 2);
        assert_eq!(bodies[0].triangles, far);
        assert!(bodies[0].closed && !bodies[1].closed);
    }

    #[test]
    fn three_triangles_at_an_edge_are_not_manifold() {
        let fan = topology(&[[0, 1, 2], [0, 1, 3], [0, 1, 4]], 5);
        assert_eq!((fan.nonmanifold_edges, fan.boundary_edges), (1, 6));
    }
}
