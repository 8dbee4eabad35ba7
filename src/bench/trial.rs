//! Two kinds of runs: one is judged, the other is timed.

use serde::Serialize;
use sim::gallery::Track;

use super::clock::cpu_time;
use super::engine::Setup;
use super::subject::Subject;
use crate::simulate::{Milliseconds, summarize};

/// Steps at the start that are not timed: allocations and cold caches.
const WARM_UP: usize = 5;

/// One figure of a scene and whether it is good enough.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    pub figure: &'static str,
    pub unit: &'static str,
    /// `null` where it is not finite.
    pub value: f64,
    pub limit: f64,
    pub passes: bool,
}

/// What went wrong in a run, by one ruler for all engines. Lengths in m.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The scene's own figures, its error first.
    pub figures: Vec<Figure>,
    pub depth_max_m: f64,
    pub depth_end_m: f64,
    /// Largest change of height and of place across gravity, start to end.
    pub sink_m: f64,
    pub drift_m: f64,
    /// Largest rise of energy above what it was before, and change over the start, J.
    pub energy_rise_j: f64,
    pub energy_change_j: f64,
}

/// Runs the subject once and judges it.
///
/// # Errors
/// The engine refuses the scene.
pub fn judge(subject: &Subject, setup: &Setup) -> Result<Errors, String> {
    let track = record(subject, setup)?;
    let figures = subject
        .judge(&track)
        .into_iter()
        .map(|judgement| Figure {
            figure: judgement.figure,
            unit: judgement.unit,
            value: judgement.value,
            limit: judgement.limit,
            passes: judgement.passes(),
        })
        .collect();
    let energy = &track.energy_j;
    Ok(Errors {
        figures,
        depth_max_m: track.deepest_m(0.0),
        depth_end_m: track.end_depth_m(),
        sink_m: track.sink_m(),
        drift_m: track.drift_m(),
        energy_rise_j: track.energy_rise_j,
        energy_change_j: energy[energy.len() - 1] - energy[0],
    })
}

/// Runs the subject once and keeps its poses.
///
/// # Errors
/// The engine refuses the scene.
pub fn record(subject: &Subject, setup: &Setup) -> Result<Track, String> {
    let mut running = setup.open(&subject.scene)?;
    let steps = subject.steps(setup.dt_s);
    let mut track = Track::new(&subject.scene, steps);
    let (poses, velocities) = running.state();
    track.push(0.0, &poses, &velocities, false);
    for step in 1..=steps {
        let acted = running.advance();
        let (poses, velocities) = running.state();
        track.push(step as f64 * setup.dt_s, &poses, &velocities, acted);
    }
    track.finish();
    Ok(track)
}

/// Runs the subject once and clocks every step; nothing else is done between steps.
///
/// # Errors
/// The engine refuses the scene.
pub fn time(subject: &Subject, setup: &Setup) -> Result<Milliseconds, String> {
    let mut running = setup.open(&subject.scene)?;
    let steps = subject.steps(setup.dt_s);
    let mut times = Vec::with_capacity(steps);
    for _ in 0..steps {
        let begin = cpu_time();
        running.advance();
        times.push((cpu_time() - begin).as_secs_f64() * 1e3);
    }
    let warm = times.split_off(WARM_UP.min(times.len().saturating_sub(1)));
    Ok(summarize(warm))
}
