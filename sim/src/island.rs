//! Bodies that touch, directly or through others, move and sleep together.

use crate::body::Body;
use crate::collide::pair::Pair;

/// Disjoint sets of bodies by union-find; the root is the lowest index, so names do not depend on order.
#[derive(Clone, Default)]
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Every body on its own.
    pub(crate) fn reset(&mut self, bodies: usize) {
        self.parent.clear();
        self.parent.extend((0..).take(bodies));
    }

    /// Links every touching pair of bodies that move.
    pub(crate) fn join_touching(&mut self, bodies: &[Body], pairs: &[Pair]) {
        self.reset(bodies.len());
        for pair in pairs.iter().filter(|pair| pair.touching) {
            if !bodies[pair.a as usize].is_static() && !bodies[pair.b as usize].is_static() {
                self.join(pair.a, pair.b);
            }
        }
    }

    /// The set of `body`: the lowest index in it.
    pub(crate) fn root(&mut self, body: u32) -> u32 {
        let mut at = body;
        while self.parent[at as usize] != at {
            self.parent[at as usize] = self.parent[self.parent[at as usize] as usize];
            at = self.parent[at as usize];
        }
        at
    }

    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
