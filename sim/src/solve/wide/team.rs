//! Workers of one step and the barrier at which they meet.
//!
//! A spin barrier: a step has a hundred meetings a millisecond, and a sleeping one costs more than the work between
//! two of them. After a while it yields, so that a busy machine still gets on.

use std::sync::atomic::{AtomicU32, Ordering};

const SPINS_BEFORE_YIELD: u32 = 2000;

/// A number of workers that meet.
pub(crate) struct Team {
    size: u32,
    arrived: AtomicU32,
    round: AtomicU32,
}

impl Team {
    pub(crate) fn new(size: u32) -> Self {
        Self { size, arrived: AtomicU32::new(0), round: AtomicU32::new(0) }
    }

    /// Runs `work` once for every worker, this thread being the first.
    pub(crate) fn run(&self, work: impl Fn(Worker<'_>) + Sync) {
        if self.size == 1 {
            return work(Worker { team: self, index: 0 });
        }
        std::thread::scope(|scope| {
            for index in 1..self.size {
                let work = &work;
                scope.spawn(move || work(Worker { team: self, index }));
            }
            work(Worker { team: self, index: 0 });
        });
    }
}

/// One of a team.
#[derive(Clone, Copy)]
pub(crate) struct Worker<'a> {
    team: &'a Team,
    index: u32,
}

impl Worker<'_> {
    /// This worker's part of `count` things.
    pub(crate) fn share(&self, count: usize) -> std::ops::Range<usize> {
        let (size, index) = (self.team.size as usize, self.index as usize);
        count * index / size..count * (index + 1) / size
    }

    /// Whether it is the thread that has called the team.
    pub(crate) fn is_first(&self) -> bool {
        self.index == 0
    }

    /// Waits for the others.
    pub(crate) fn meet(&self) {
        let team = self.team;
        if team.size == 1 {
            return;
        }
        let round = team.round.load(Ordering::Acquire);
        if team.arrived.fetch_add(1, Ordering::AcqRel) + 1 == team.size {
            team.arrived.store(0, Ordering::Release);
            team.round.store(round.wrapping_add(1), Ordering::Release);
            return;
        }
        let mut spins = 0;
        while team.round.load(Ordering::Acquire) == round {
            spins += 1;
            if spins < SPINS_BEFORE_YIELD {
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
    }
}
