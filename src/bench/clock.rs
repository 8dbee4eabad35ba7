//! The CPU time of this process: all its threads, and nothing of what else the machine does.

use std::time::Duration;

/// CPU time since the process began.
#[cfg(unix)]
#[must_use]
pub fn cpu_time() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

/// Where there is no such clock: wall time since the first call.
#[cfg(not(unix))]
#[must_use]
pub fn cpu_time() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// What [`cpu_time`] measures here.
pub const CLOCK: &str = if cfg!(unix) { "process CPU time" } else { "wall time" };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_runs_while_work_is_done() {
        let begin = cpu_time();
        let mut x = 1_u64;
        while cpu_time() - begin < Duration::from_millis(2) {
            x = std::hint::black_box(x.wrapping_mul(3));
        }
        assert!(cpu_time() > begin);
    }
}
