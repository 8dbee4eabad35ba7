//! A bounding volume hierarchy: bodies of a world, triangles of a mesh, shapes of a compound.

use crate::math::Vec3;
use crate::shape::Aabb;

/// Items of a leaf, at most.
const LEAF: usize = 2;
/// Levels a query can have open; halving, 2^31 items need 31.
const DEPTH: usize = 64;

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// Of a leaf its first item in `order`; else the second child, the first being the next node.
    link: u32,
    /// Items; 0 for a node with children.
    count: u32,
}

/// Parents before children, the first child right after its parent. Empty without items.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
    /// Ranges of `order` still to be parted, with the node that waits for the range as its second child.
    open: Vec<(u32, u32, u32)>,
}

const NONE: u32 = u32::MAX;

impl Bvh {
    /// Builds it anew over `items`, in the memory that it has: halves at the median of the axis in which centres spread
    /// most.
    pub(crate) fn build(&mut self, items: &[Aabb]) {
        let Self { nodes, order, open } = self;
        nodes.clear();
        order.clear();
        order.extend((0..).take(items.len()));
        open.clear();
        if let Some(count) = u32::try_from(items.len()).ok().filter(|count| *count > 0) {
            open.push((0, count, NONE));
        }
        let center = |i: u32, axis: usize| items[i as usize].min[axis] + items[i as usize].max[axis];
        while let Some((start, end, parent)) = open.pop() {
            let index = u32::try_from(nodes.len()).unwrap_or(NONE);
            if let Some(parent) = nodes.get_mut(parent as usize) {
                parent.link = index;
            }
            let range = &mut order[start as usize..end as usize];
            let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
            let mut bounds = items[range[0] as usize];
            for &i in range.iter() {
                let middle = Vec3::from_fn(|axis, _| center(i, axis));
                (low, high) = (low.inf(&middle), high.sup(&middle));
                bounds = bounds.merged(&items[i as usize]);
            }
            if range.len() <= LEAF {
                nodes.push(Node { bounds, link: start, count: end - start });
                continue;
            }
            let axis = (high - low).imax();
            let half = range.len() / 2;
            range.select_nth_unstable_by(half, |&i, &j| {
                center(i, axis).total_cmp(&center(j, axis)).then(i.cmp(&j))
            });
            nodes.push(Node { bounds, link: NONE, count: 0 });
            let middle = start + u32::try_from(half).unwrap_or(0);
            // Last in, first out: the first half comes next and is the first child.
            open.push((middle, end, index));
            open.push((start, middle, NONE));
        }
    }

    /// Brings the bounds up to those of the items, which have moved.
    pub(crate) fn refit(&mut self, items: &[Aabb]) {
        for index in (0..self.nodes.len()).rev() {
            let Node { link, count, .. } = self.nodes[index];
            let bounds = if count == 0 {
                self.nodes[index + 1].bounds.merged(&self.nodes[link as usize].bounds)
            } else {
                let own = &self.order[link as usize..(link + count) as usize];
                own[1..].iter().fold(items[own[0] as usize], |all, &i| all.merged(&items[i as usize]))
            };
            self.nodes[index].bounds = bounds;
        }
    }

    /// Hands every item to `found` whose leaf overlaps `bounds`, in the order of the tree.
    pub(crate) fn query(&self, bounds: &Aabb, mut found: impl FnMut(u32)) {
        let mut open = [0_u32; DEPTH];
        let mut len = usize::from(!self.nodes.is_empty());
        while len > 0 {
            len -= 1;
            let index = open[len];
            let node = &self.nodes[index as usize];
            if !node.bounds.overlaps(bounds) {
                continue;
            }
            if node.count > 0 {
                self.order[node.link as usize..(node.link + node.count) as usize]
                    .iter()
                    .for_each(|&item| found(item));
            } else if len + 2 <= DEPTH {
                open[len] = node.link;
                open[len + 1] = index + 1;
                len += 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::build::noise;

    fn items(count: u32, seed: u32) -> Vec<Aabb> {
        let at = |i: u32, k: u32| 10.0 * noise(i, 3 * seed + k);
        (0..count)
            .map(|i| {
                let min = Vec3::new(at(i, 1), at(i, 2), at(i, 3));
                Aabb { min, max: min + Vec3::repeat(0.2 + noise(i, seed + 7)) }
            })
            .collect()
    }

    #[test]
    fn a_query_finds_what_trying_all_finds_after_building_and_after_moving() {
        for count in [0, 1, 2, 3, 7, 100, 333] {
            let mut bvh = Bvh::default();
            bvh.build(&items(count, 1));
            let moved = items(count, 20);
            bvh.refit(&moved);
            for bounds in items(20, 40) {
                let mut found = Vec::new();
                bvh.query(&bounds, |i| {
                    if moved[i as usize].overlaps(&bounds) {
                        found.push(i);
                    }
                });
                found.sort_unstable();
                let truth: Vec<u32> = (0..count).filter(|&i| moved[i as usize].overlaps(&bounds)).collect();
                assert_eq!(found, truth);
            }
        }
    }
}
