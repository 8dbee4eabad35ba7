//! The nearest neighbours of every point, by a tree.

use super::Point;

/// Of one point.
pub(super) struct Near {
    /// Nearest first, without itself.
    pub points: Vec<u32>,
    /// Distance to the farthest of them.
    pub reach: f64,
    /// Distance to the nearest.
    pub spacing: f64,
}

/// Points in a leaf.
const LEAF: usize = 8;

struct Tree<'a> {
    positions: &'a [Point],
    order: Vec<u32>,
}

/// `count` neighbours of every point; fewer where there are fewer points.
pub(super) fn nearest(positions: &[Point], count: usize) -> Vec<Near> {
    // A cloud has fewer points than `u32::MAX`: `check_counts` sees to it.
    #[allow(clippy::cast_possible_truncation)]
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    arrange(positions, &mut order, 0);
    let tree = Tree { positions, order };
    (0..positions.len()).map(|at| tree.around(at, count)).collect()
}

/// A balanced tree in place: the middle parts the two halves along the axes in turn.
fn arrange(positions: &[Point], order: &mut [u32], axis: usize) {
    if order.len() <= LEAF {
        return;
    }
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    let (low, high) = order.split_at_mut(middle);
    arrange(positions, low, (axis + 1) % 3);
    arrange(positions, &mut high[1..], (axis + 1) % 3);
}

fn squared(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum()
}

impl Tree<'_> {
    fn around(&self, at: usize, count: usize) -> Near {
        let mut best: Vec<(f64, u32)> = Vec::with_capacity(count + 1);
        self.search(&self.order, 0, self.positions[at], at, count, &mut best);
        let distance = |entry: Option<&(f64, u32)>| entry.map_or(0.0, |entry| entry.0.sqrt());
        Near {
            reach: distance(best.last()),
            spacing: distance(best.first()),
            points: best.iter().map(|entry| entry.1).collect(),
        }
    }

    fn search(
        &self,
        order: &[u32],
        axis: usize,
        point: Point,
        own: usize,
        count: usize,
        best: &mut Vec<(f64, u32)>,
    ) {
        let mut offer = |other: u32| {
            if other as usize == own {
                return;
            }
            let entry = (squared(point, self.positions[other as usize]), other);
            if best.len() < count || best.last().is_some_and(|last| entry < *last) {
                let place = best.partition_point(|kept| *kept < entry);
                best.insert(place, entry);
                best.truncate(count);
            }
        };
        if order.len() <= LEAF {
            order.iter().for_each(|&other| offer(other));
            return;
        }
        let middle = order.len() / 2;
        offer(order[middle]);
        let gap = point[axis] - self.positions[order[middle] as usize][axis];
        let (low, high) = (&order[..middle], &order[middle + 1..]);
        let (first, second) = if gap < 0.0 { (low, high) } else { (high, low) };
        self.search(first, (axis + 1) % 3, point, own, count, best);
        if best.len() < count || best.last().is_some_and(|last| gap * gap <= last.0) {
            self.search(second, (axis + 1) % 3, point, own, count, best);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_finds_what_a_search_of_all_finds() {
        let positions: Vec<Point> = (0..300_u32)
            .map(|at| [7, 11, 13].map(|factor| f64::from(at.wrapping_mul(factor * 2_654_435_761) >> 16)))
            .collect();
        for (at, near) in nearest(&positions, 5).iter().enumerate() {
            let mut all: Vec<f64> = (0..300)
                .filter(|&other| other != at)
                .map(|other| squared(positions[at], positions[other]))
                .collect();
            all.sort_by(f64::total_cmp);
            assert_eq!(near.points.len(), 5);
            assert_eq!((near.spacing, near.reach), (all[0].sqrt(), all[4].sqrt()));
        }
    }
}
