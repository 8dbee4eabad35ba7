//! Bounds the memory of a batch by the bytes of the files in work.

use std::sync::{Condvar, Mutex, PoisonError};

/// Lets files in while their sizes come to no more than a limit; one above it goes alone.
pub(super) struct Gate {
    limit: u64,
    taken: Mutex<u64>,
    freed: Condvar,
}

/// Room taken, given back when dropped.
pub(super) struct Pass<'a> {
    gate: &'a Gate,
    bytes: u64,
}

impl Gate {
    pub fn new(limit: u64) -> Self {
        Self { limit, taken: Mutex::new(0), freed: Condvar::new() }
    }

    /// Waits for room.
    pub fn enter(&self, bytes: u64) -> Pass<'_> {
        let bytes = bytes.min(self.limit);
        let taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let mut taken = self
            .freed
            .wait_while(taken, |taken| *taken + bytes > self.limit)
            .unwrap_or_else(PoisonError::into_inner);
        *taken += bytes;
        Pass { gate: self, bytes }
    }
}

impl Drop for Pass<'_> {
    fn drop(&mut self) {
        *self.gate.taken.lock().unwrap_or_else(PoisonError::into_inner) -= self.bytes;
        self.gate.freed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::thread;

    use super::*;

    #[test]
    fn the_limit_holds_and_everyone_gets_through() {
        let gate = Gate::new(10);
        let (inside, served) = (AtomicU64::new(0), AtomicU64::new(0));
        thread::scope(|scope| {
            for size in [1, 4, 6, 10, 25, 3, 7, 2] {
                let (gate, inside, served) = (&gate, &inside, &served);
                scope.spawn(move || {
                    for _ in 0..200 {
                        let pass = gate.enter(size);
                        let now = inside.fetch_add(size.min(10), Ordering::SeqCst) + size.min(10);
                        assert!(now <= 10, "{now}");
                        thread::yield_now();
                        inside.fetch_sub(size.min(10), Ordering::SeqCst);
                        drop(pass);
                        served.fetch_add(1, Ordering::SeqCst);
                    }
                });
            }
        });
        assert_eq!(served.into_inner(), 1_600);
    }
}
