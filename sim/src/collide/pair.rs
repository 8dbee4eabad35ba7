//! The contact cache: a pair of bodies, its manifolds and what the narrow phase found out about it, kept from step to
//! step.

use crate::collide::manifold::Manifold;
use crate::collide::narrow::Outlook;
use crate::collide::relative::Relative;
use crate::collide::sat::Axis;
use crate::math::Vec3;

/// What the narrow phase remembers of two child shapes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// Child shapes of A and of B.
    pub(crate) key: (u32, u32),
    /// Relative pose at the last full query; `None` before the first.
    pub(crate) queried_at: Option<Relative>,
    /// Along the axis found by that query, m.
    pub(crate) distance: f64,
    /// m that the shapes may move before another axis can be the best.
    pub(crate) lead: f64,
    pub(crate) axis: Option<Axis>,
    /// From A to B, in the frame of A.
    pub(crate) normal: Vec3,
    /// A point of A and one of B where they touched last, each in the frame of its shape: they bear witness to how far
    /// apart the shapes can be at most.
    pub(crate) witness: Option<[Vec3; 2]>,
    /// Relative pose for which the manifold was made, and the reach of its points in m; `None` if there is none that
    /// may be kept.
    pub(crate) region_at: Option<(Relative, f64)>,
}

/// Bodies `a < b` that are near each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pair {
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// Sorted by key.
    pub(crate) manifolds: Vec<Manifold>,
    /// Sorted by key.
    pub(crate) memories: Vec<Memory>,
    pub(crate) outlook: Outlook,
    /// Some point of it carried load or overlapped in the last step.
    pub(crate) touching: bool,
    /// Its surfaces do not meet in this substep: the impact phase has seen to it.
    pub(crate) apart: bool,
    /// Their meeting was foreseen in this step.
    pub(crate) fast: bool,
    /// Overlaps by more than motion explains, and has been reported.
    pub(crate) deep: bool,
}

/// The pairs of a world, sorted, and the memory that pairs have left behind.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairCache {
    spare: Vec<Pair>,
    left: Vec<Pair>,
}

impl PairCache {
    /// Makes `pairs` those of the sorted `near`; what is in both keeps its manifolds.
    pub(crate) fn carry_over(&mut self, pairs: &mut Vec<Pair>, near: &[(u32, u32)]) {
        let Self { spare, left } = self;
        let mut fresh = |(a, b)| {
            let Pair { mut manifolds, mut memories, .. } = left.pop().unwrap_or_default();
            manifolds.clear();
            memories.clear();
            Pair { a, b, manifolds, memories, ..Pair::default() }
        };
        let mut near = near.iter().copied().peekable();
        let mut gone = 0;
        // Those that stay move to `spare`; those that go are gathered at the front of `pairs`.
        for at in 0..pairs.len() {
            let key = (pairs[at].a, pairs[at].b);
            while let Some(earlier) = near.next_if(|next| *next < key) {
                spare.push(fresh(earlier));
            }
            if near.next_if_eq(&key).is_some() {
                spare.push(std::mem::take(&mut pairs[at]));
            } else {
                pairs.swap(at, gone);
                gone += 1;
            }
        }
        spare.extend(near.map(fresh));
        pairs.truncate(gone);
        left.append(pairs);
        std::mem::swap(pairs, spare);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carrying_over_merges_in_order() {
        let pair = |a, b| Pair { a, b, touching: true, ..Pair::default() };
        let mut pairs = vec![pair(0, 1), pair(1, 2), pair(3, 4)];
        let mut cache = PairCache::default();
        cache.carry_over(&mut pairs, &[(0, 2), (1, 2), (5, 6)]);
        let keys: Vec<_> = pairs.iter().map(|p| (p.a, p.b, p.touching)).collect();
        assert_eq!(keys, [(0, 2, false), (1, 2, true), (5, 6, false)]);
        cache.carry_over(&mut pairs, &[]);
        assert!(pairs.is_empty());
    }
}
