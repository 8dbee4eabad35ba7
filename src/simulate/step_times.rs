//! How long steps take, measured from outside: the simulation itself knows no clock.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::{Deserialize, Serialize};
use sim::{Observer, Phase, StepReport};

/// Clocks every step, sinks apart, and ends the run early when told to stop.
pub struct StepTimes<'a> {
    stop: &'a AtomicBool,
    begun: Instant,
    milliseconds: Vec<f64>,
    phases: Option<PhaseTimes>,
}

/// Seconds spent in each phase, and the one that runs.
struct PhaseTimes {
    seconds: [f64; Phase::ALL.len()],
    running: Option<(Phase, Instant)>,
}

impl PhaseTimes {
    fn switch(&mut self, next: Option<Phase>) {
        let now = Instant::now();
        if let Some((phase, since)) = self.running {
            self.seconds[phase as usize] += (now - since).as_secs_f64();
        }
        self.running = next.map(|phase| (phase, now));
    }
}

/// Milliseconds a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Milliseconds {
    pub median: f64,
    pub mean: f64,
    pub p99: f64,
    pub max: f64,
    pub min: f64,
}

impl<'a> StepTimes<'a> {
    #[must_use]
    pub fn new(stop: &'a AtomicBool) -> Self {
        Self { stop, begun: Instant::now(), milliseconds: Vec::new(), phases: None }
    }

    /// Clocks the phases of every step as well.
    #[must_use]
    pub fn with_phases(self) -> Self {
        Self { phases: Some(PhaseTimes { seconds: [0.0; Phase::ALL.len()], running: None }), ..self }
    }

    /// Seconds spent in each phase over all steps, in the order of [`Phase::ALL`]; zero where nobody asked.
    #[must_use]
    pub fn phase_seconds(&self) -> [f64; Phase::ALL.len()] {
        self.phases.as_ref().map_or([0.0; Phase::ALL.len()], |phases| phases.seconds)
    }

    #[must_use]
    pub fn summary(&self) -> Milliseconds {
        summarize(self.milliseconds.clone())
    }
}

impl Observer for StepTimes<'_> {
    fn begins(&mut self) {
        self.begun = Instant::now();
    }

    fn enters(&mut self, phase: Phase) {
        if let Some(phases) = &mut self.phases {
            phases.switch(Some(phase));
        }
    }

    fn ended(&mut self, _: &StepReport) -> bool {
        if let Some(phases) = &mut self.phases {
            phases.switch(None);
        }
        self.milliseconds.push(self.begun.elapsed().as_secs_f64() * 1e3);
        !self.stop.load(Ordering::Relaxed)
    }
}

/// Percentiles by the nearest rank.
pub(crate) fn summarize(mut times: Vec<f64>) -> Milliseconds {
    if times.is_empty() {
        return Milliseconds::default();
    }
    times.sort_by(f64::total_cmp);
    let rank = |share: f64| times[((times.len() as f64 * share).ceil() as usize).clamp(1, times.len()) - 1];
    Milliseconds {
        median: rank(0.5),
        mean: times.iter().sum::<f64>() / times.len() as f64,
        p99: rank(0.99),
        max: rank(1.0),
        min: times[0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_the_nearest_rank() {
        let times = summarize((1..=200).rev().map(f64::from).collect());
        assert_eq!(
            [times.median, times.mean, times.p99, times.max, times.min],
            [100.0, 100.5, 198.0, 200.0, 1.0]
        );
        assert_eq!(
            summarize(vec![3.0]),
            Milliseconds { median: 3.0, mean: 3.0, p99: 3.0, max: 3.0, min: 3.0 }
        );
        assert_eq!(summarize(Vec::new()), Milliseconds::default());
    }
}
