//! The way from the stepping threads to the worker: bounded by bytes, and the way back of empty blocks.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::block::Block;

/// Bytes that may wait before a push does. A run that outpaces the worker by more than this is held up; no frame
/// is dropped.
const MAX_WAITING_BYTES: usize = 128 << 20;
/// Empty blocks kept for the next push.
const MAX_FREE: usize = 64;

/// Messages `M` with their sizes in bytes.
pub(crate) struct Queue<M> {
    state: Mutex<State<M>>,
    filled: Condvar,
    drained: Condvar,
}

struct State<M> {
    messages: VecDeque<(M, usize)>,
    bytes: usize,
    /// No more is accepted: the run ended or the worker did.
    closed: bool,
    free: Vec<Block>,
}

impl<M> Queue<M> {
    pub(crate) fn new() -> Self {
        let state = State { messages: VecDeque::new(), bytes: 0, closed: false, free: Vec::new() };
        Self { state: Mutex::new(state), filled: Condvar::new(), drained: Condvar::new() }
    }

    /// A panic while the lock is held cannot leave the deque half changed, so poison is ignored.
    fn lock(&self) -> MutexGuard<'_, State<M>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits while too much is waiting; lost where the queue is closed.
    pub(crate) fn push(&self, message: M, bytes: usize) {
        let mut state = self.lock();
        while !state.closed && state.bytes > 0 && state.bytes + bytes > MAX_WAITING_BYTES {
            state = self.drained.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if !state.closed {
            state.bytes += bytes;
            state.messages.push_back((message, bytes));
            drop(state);
            self.filled.notify_one();
        }
    }

    /// The next message; `None` once closed and empty.
    pub(crate) fn pop(&self) -> Option<M> {
        let mut state = self.lock();
        loop {
            if let Some((message, bytes)) = state.messages.pop_front() {
                state.bytes -= bytes;
                drop(state);
                self.drained.notify_all();
                return Some(message);
            }
            if state.closed {
                return None;
            }
            state = self.filled.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// What was pushed is still popped.
    pub(crate) fn close(&self) {
        self.lock().closed = true;
        self.filled.notify_all();
        self.drained.notify_all();
    }

    /// An empty block, used before where there is one.
    pub(crate) fn block(&self) -> Block {
        self.lock().free.pop().unwrap_or_default()
    }

    pub(crate) fn give_back(&self, mut block: Block) {
        block.clear();
        let mut state = self.lock();
        if state.free.len() < MAX_FREE {
            state.free.push(block);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_queue_holds_the_pusher_until_drained_and_loses_nothing() {
        let queue = Queue::new();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                (0..20).for_each(|i| queue.push(i, MAX_WAITING_BYTES / 3));
                queue.close();
            });
            let got: Vec<i32> = std::iter::from_fn(|| queue.pop()).collect();
            assert_eq!(got, (0..20).collect::<Vec<_>>());
        });
        assert_eq!(queue.lock().bytes, 0);
    }

    #[test]
    fn a_closed_queue_never_holds_the_pusher() {
        let queue = Queue::new();
        queue.push(1, MAX_WAITING_BYTES);
        queue.close();
        queue.push(2, MAX_WAITING_BYTES);
        assert_eq!((queue.pop(), queue.pop()), (Some(1), None));
    }

    #[test]
    fn blocks_come_back_empty() {
        let queue = Queue::<()>::new();
        let mut block = queue.block();
        block.sleep.push(sim::SleepState::Asleep);
        queue.give_back(block);
        assert!(queue.block().sleep.is_empty());
    }
}
