//! The narrow phase of all pairs: which of them are looked at, and by which worker.

use std::sync::{Mutex, PoisonError};

use crate::body::Body;
use crate::collide::manifold::Manifold;
use crate::collide::narrow::{self, Ahead, NarrowBuffers, Outlook};
use crate::collide::pair::Pair;
use crate::collide::travel::Travels;
use crate::solve::wide::lanes::prefetch;
use crate::solve::wide::team::Team;

/// Pairs that a worker takes at a time: enough to be worth the asking, few enough that all end together.
const CHUNK: usize = 256;
/// Pairs before its turn for which what is known of a pair is called from memory: a heap's contacts do not fit into any
/// cache, and waiting for them was most of its narrow phase.
const CALLED_AHEAD: usize = 6;

/// The narrow phase of a world: what its workers keep from step to step is storage.
#[derive(Clone, Default)]
pub(crate) struct NarrowPhase {
    workers: Vec<Worker>,
    /// Pairs of which a meeting was foreseen in this step, sorted.
    pub(crate) fast: Vec<u32>,
}

/// One worker's storage, and what it has found.
#[derive(Clone, Default)]
struct Worker {
    buffers: NarrowBuffers,
    /// Pairs of a chunk that are looked at.
    open: Vec<u32>,
    manifolds: usize,
    fast: Vec<u32>,
    /// Bodies that have come to overlap so deeply that no motion explains it, and by how much, m.
    deep: Vec<(u32, u32, f64)>,
}

impl NarrowPhase {
    /// Brings the manifolds of all pairs with a body that is awake up to their bodies' poses, and returns how many those
    /// pairs have; `deep` is told of pairs that have come to overlap so deeply that no motion explains it, with the depth
    /// in m, once each. Pairs do not depend on each other, so any number of threads finds the same.
    pub(crate) fn update(
        &mut self,
        pairs: &mut [Pair],
        (bodies, travels): (&[Body], &Travels),
        ahead: Ahead,
        threads: u32,
        mut deep: impl FnMut(u32, u32, f64),
    ) -> usize {
        // A thread costs more than a few pairs do.
        let threads = if pairs.len() <= 2 * CHUNK { 1 } else { threads };
        self.workers.resize_with(self.workers.len().max(threads as usize), Worker::default);
        let free = Mutex::new(std::mem::take(&mut self.workers));
        let chunks = Mutex::new((0..).step_by(CHUNK).zip(pairs.chunks_mut(CHUNK)));
        Team::new(threads).run(|_| {
            let mut worker = lock(&free).pop().unwrap_or_default();
            worker.begin(&ahead);
            loop {
                let next = lock(&chunks).next();
                let Some((first, chunk)) = next else { break };
                worker.update(first, chunk, bodies, travels, ahead);
            }
            lock(&free).push(worker);
        });
        self.workers = free.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.fast.clear();
        self.workers.iter_mut().for_each(|worker| self.fast.append(&mut worker.fast));
        self.fast.sort_unstable();
        let mut all: Vec<_> = self.workers.iter_mut().flat_map(|worker| worker.deep.drain(..)).collect();
        all.sort_unstable_by_key(|(a, b, _)| (*a, *b));
        all.into_iter().for_each(|(a, b, depth)| deep(a, b, depth));
        self.workers.iter_mut().map(|worker| std::mem::take(&mut worker.manifolds)).sum()
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Worker {
    fn begin(&mut self, ahead: &Ahead) {
        self.buffers.sat.axes.simd = ahead.simd;
    }

    /// Looks at a chunk of pairs, `first` being the number of the first.
    fn update(&mut self, first: u32, pairs: &mut [Pair], bodies: &[Body], travels: &Travels, ahead: Ahead) {
        let Self { buffers, open, manifolds, fast, deep } = self;
        open.clear();
        for (i, pair) in (0..).zip(pairs.iter_mut()) {
            let (a, b) = (travels.of(pair.a), travels.of(pair.b));
            if !a.awake && !b.awake {
                continue;
            }
            pair.apart = false;
            let (path, reach) = (a.path + b.path, ahead.reach(a, b));
            if !pair.outlook.holds(path, reach, pair.manifolds.is_empty()) {
                let gap = a.bounds.gap(&b.bounds);
                if gap <= reach {
                    open.push(i);
                    continue;
                }
                pair.manifolds.clear();
                pair.memories.clear();
                pair.outlook = Outlook::apart(path + gap);
            }
            *manifolds += pair.manifolds.len();
            if ahead.piecewise {
                pair.manifolds.iter_mut().for_each(Manifold::begin_step);
            }
        }
        for (turn, &i) in open.iter().enumerate() {
            if let Some(&next) = open.get(turn + CALLED_AHEAD) {
                let next = &pairs[next as usize];
                prefetch(&next.memories);
                prefetch(&next.manifolds);
                prefetch(&bodies[next.b as usize].colliders);
            }
            let pair = &mut pairs[i as usize];
            let two = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
            let travels = (travels.of(pair.a), travels.of(pair.b));
            if let Some(depth) = narrow::update(pair, two, travels, ahead, buffers) {
                deep.push((pair.a, pair.b, depth));
            }
            if pair.fast {
                fast.push(first + i);
            }
            *manifolds += pair.manifolds.len();
            if ahead.piecewise {
                pair.manifolds.iter_mut().for_each(Manifold::begin_step);
            }
        }
    }
}
