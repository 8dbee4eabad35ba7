//! One scene through the solver, with everything that watches it.

mod explain;
mod poses;
mod step_times;

use std::sync::atomic::AtomicBool;

use serde::Serialize;
use sim::{FrameSink, RunLimit, Scene, SceneError, Settings, Work};

use crate::settle::{Outcome, Trace};

pub use explain::{Counted, Explained, Planned, Timed, planned};
pub use poses::{HEADER, PosesSink, quoted};
pub(crate) use step_times::summarize;
pub use step_times::{Milliseconds, StepTimes};

/// What a simulation of a scene showed.
#[derive(Clone, Debug, Serialize)]
pub struct Simulated {
    pub scene: String,
    pub entities: usize,
    pub steps: u64,
    pub time_s: f64,
    pub dt_s: f64,
    pub substeps: u32,
    /// Of a step of the solver alone, sinks apart.
    pub ms_per_step: Milliseconds,
    /// Deepest overlap of any contact, m.
    pub max_penetration_m: f64,
    pub settled_at_s: Option<f64>,
    pub max_energy_rise_j: f64,
    /// Differs when any bit of the final state does.
    pub state_hash: String,
    pub bodies: Outcome,
}

/// Runs `scene`, frames going to `sinks` as they come. Ends early once `stop` is set.
///
/// # Errors
/// The scene is refused.
pub fn simulate(
    scene: &Scene,
    settings: &Settings,
    limit: &RunLimit,
    sinks: &mut [&mut dyn FrameSink],
    stop: &AtomicBool,
) -> Result<Simulated, SceneError> {
    let mut times = StepTimes::new(stop);
    observed(scene, settings, limit, sinks, &mut times).map(|(simulated, _)| simulated)
}

/// [`simulate`] with the plan, the work done and the time of each phase; the clocks make the steps a little longer.
///
/// # Errors
/// The scene is refused.
pub fn simulate_explained(
    scene: &Scene,
    settings: &Settings,
    limit: &RunLimit,
    sinks: &mut [&mut dyn FrameSink],
    stop: &AtomicBool,
) -> Result<(Simulated, Explained), SceneError> {
    let mut times = StepTimes::new(stop).with_phases();
    let (simulated, work) = observed(scene, settings, limit, sinks, &mut times)?;
    let explained = Explained::new(scene, &work, &times.phase_seconds(), simulated.steps);
    Ok((simulated, explained))
}

fn observed(
    scene: &Scene,
    settings: &Settings,
    limit: &RunLimit,
    sinks: &mut [&mut dyn FrameSink],
    times: &mut StepTimes<'_>,
) -> Result<(Simulated, Work), SceneError> {
    let mut trace = Trace::new(scene);
    let mut all: Vec<&mut dyn FrameSink> = vec![&mut trace];
    for sink in sinks.iter_mut() {
        all.push(*sink);
    }
    let report = sim::run_observed(scene, settings, limit, &mut all, times)?;
    let simulated = Simulated {
        scene: scene.name.clone(),
        entities: scene.entities.len(),
        steps: report.steps,
        time_s: report.time_s,
        dt_s: settings.dt_s,
        substeps: settings.substeps,
        ms_per_step: times.summary(),
        max_penetration_m: report.max_penetration_m,
        settled_at_s: report.settled_at_s,
        max_energy_rise_j: report.max_energy_rise_j,
        state_hash: format!("{:016x}", report.state_hash),
        bodies: trace.outcome(),
    };
    Ok((simulated, report.work))
}
