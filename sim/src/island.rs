//! Bodies that touch, directly or through others, move and sleep together.

use crate::body::Body;
use crate::collide::pair::Pair;

/// Disjoint sets of bodies by union-find; the root is the lowest index, so names do not depend on order.
pub(crate) struct Islands {
    parent: Vec<u32>,
}

impl Islands {
    /// Links every touching pair of bodies that move.
    pub(crate) fn of(bodies: &[Body], pairs: &[Pair]) -> Self {
        let mut islands = Self { parent: (0..).take(bodies.len()).collect() };
        for pair in pairs.iter().filter(|pair| pair.touching) {
            if !bodies[pair.a as usize].is_static() && !bodies[pair.b as usize].is_static() {
                islands.join(pair.a, pair.b);
            }
        }
        islands
    }

    /// The island of `body`: the lowest index in it.
    pub(crate) fn root(&mut self, body: u32) -> u32 {
        let mut at = body;
        while self.parent[at as usize] != at {
            self.parent[at as usize] = self.parent[self.parent[at as usize] as usize];
            at = self.parent[at as usize];
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
