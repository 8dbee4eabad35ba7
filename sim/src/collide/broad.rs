//! Pairs of bodies that may meet within the step.
//!
//! Every body has fat bounds that it leaves only now and then; only what has left them is looked up again. So a heap at
//! rest costs one comparison a body.

use crate::body::Body;
use crate::collide::bvh::Bvh;
use crate::collide::travel::Travels;
use crate::shape::Aabb;

/// Share of a body's inner radius by which its fat bounds are larger than its bounds.
const FAT_SHARE: f64 = 0.1;
/// Steps of its present motion for which fat bounds are made.
const STEPS_AHEAD: f64 = 2.0;

/// The broad phase of a world. Its buffers are kept, so that a step allocates nothing once they are large enough.
#[derive(Clone, Debug, Default)]
pub(crate) struct BroadPhase {
    bvh: Bvh,
    travels: Travels,
    /// Of every body.
    fat: Vec<Aabb>,
    moved: Vec<u32>,
    is_moved: Vec<bool>,
    /// Bodies moved since the tree was built.
    since_built: usize,
    pairs: Vec<(u32, u32)>,
    fresh: Vec<(u32, u32)>,
    merged: Vec<(u32, u32)>,
}

impl BroadPhase {
    /// Pairs `(a, b)` with `a < b`, sorted: all whose bounds overlap and some that are near, no two that never move.
    /// `dt` in s. The flag tells whether they differ from those of the step before.
    pub(crate) fn update(&mut self, bodies: &[Body], dt: f64) -> (&[(u32, u32)], bool) {
        self.travels.update(bodies);
        let first = self.fat.len() != bodies.len();
        if first {
            self.fat.clear();
            self.fat.extend(bodies.iter().map(|body| body.aabb));
            self.is_moved.clear();
            self.is_moved.resize(bodies.len(), false);
            self.pairs.clear();
        }
        self.moved.clear();
        for ((i, body), fat) in (0..).zip(bodies).zip(&mut self.fat) {
            if first || !fat.contains(&body.aabb) {
                *fat = body.aabb;
                if !body.is_static() {
                    let ahead = body.aabb.shifted(&(body.velocity * (STEPS_AHEAD * dt)));
                    *fat = body.aabb.merged(&ahead).grown(FAT_SHARE * body.inner_radius);
                }
                self.moved.push(i);
            }
        }
        if self.moved.is_empty() {
            return (&self.pairs, first);
        }
        self.since_built += self.moved.len();
        if first || self.since_built > bodies.len() {
            self.bvh.build(&self.fat);
            self.since_built = 0;
        } else {
            self.bvh.refit(&self.fat);
        }
        self.find(bodies);
        self.merge();
        (&self.pairs, true)
    }

    /// Of the bodies, as of the last update.
    pub(crate) fn travels(&self) -> &Travels {
        &self.travels
    }

    /// Looks up what has moved.
    fn find(&mut self, bodies: &[Body]) {
        let Self { bvh, fat, moved, is_moved, fresh, .. } = self;
        moved.iter().for_each(|&i| is_moved[i as usize] = true);
        fresh.clear();
        for &i in moved.iter() {
            let (bounds, still) = (&fat[i as usize], bodies[i as usize].is_static());
            bvh.query(bounds, |j| {
                // Of two that have moved, the one with the lower index finds the other.
                let theirs = j < i && is_moved[j as usize] || i == j;
                let never_meet = theirs || still && bodies[j as usize].is_static();
                if !never_meet && bounds.overlaps(&fat[j as usize]) {
                    fresh.push((i.min(j), i.max(j)));
                }
            });
        }
        fresh.sort_unstable();
    }

    /// The pairs of what has not moved, and the new ones.
    fn merge(&mut self) {
        let Self { moved, is_moved, pairs, fresh, merged, .. } = self;
        merged.clear();
        let mut fresh = fresh.iter().copied().peekable();
        for &pair in pairs.iter().filter(|(a, b)| !is_moved[*a as usize] && !is_moved[*b as usize]) {
            while let Some(earlier) = fresh.next_if(|next| *next < pair) {
                merged.push(earlier);
            }
            merged.push(pair);
        }
        merged.extend(fresh);
        std::mem::swap(pairs, merged);
        moved.iter().for_each(|&i| is_moved[i as usize] = false);
    }
}
