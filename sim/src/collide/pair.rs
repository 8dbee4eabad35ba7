//! The contact cache: a pair of bodies and its manifolds, kept from step to step.

use crate::collide::manifold::Manifold;

/// Bodies `a < b` that are near each other.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// Sorted by key.
    pub(crate) manifolds: Vec<Manifold>,
    /// Some point of it carried load or overlapped in the last step.
    pub(crate) touching: bool,
    /// Its surfaces do not meet in this substep: the impact phase has seen to it.
    pub(crate) apart: bool,
}

/// The cache of the next step: sorted pairs `near`, and those of `old` between bodies that both sleep or stand
/// still, which nobody looks at but which hold an island together. What is in both keeps its manifolds.
pub(crate) fn carry_over(
    old: Vec<Pair>,
    near: &[(u32, u32)],
    keep_unseen: impl Fn(u32, u32) -> bool,
) -> Vec<Pair> {
    let mut pairs = Vec::with_capacity(near.len());
    let mut near = near.iter().copied().peekable();
    let fresh = |(a, b)| Pair { a, b, manifolds: Vec::new(), touching: false, apart: false };
    for pair in old {
        let key = (pair.a, pair.b);
        while let Some(earlier) = near.next_if(|next| *next < key) {
            pairs.push(fresh(earlier));
        }
        if near.next_if_eq(&key).is_some() || keep_unseen(pair.a, pair.b) {
            pairs.push(pair);
        }
    }
    pairs.extend(near.map(fresh));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carrying_over_merges_in_order() {
        let pair = |a, b| Pair { a, b, manifolds: Vec::new(), touching: true, apart: false };
        let old = vec![pair(0, 1), pair(1, 2), pair(3, 4)];
        let pairs = carry_over(old, &[(0, 2), (1, 2), (5, 6)], |a, _| a == 3);
        let keys: Vec<_> = pairs.iter().map(|p| (p.a, p.b, p.touching)).collect();
        assert_eq!(keys, [(0, 2, false), (1, 2, true), (3, 4, true), (5, 6, false)]);
    }
}
