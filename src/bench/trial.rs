//! Two kinds of runs: one is judged, the other is timed.

use serde::Serialize;
use sim::gallery::Track;
use sim::measure::length;

use super::engine::{Programs, Setup};
use super::laws::{LawSums, Laws};
use super::subject::Subject;
use crate::simulate::{Milliseconds, summarize};

/// Steps at the start that are not timed: allocations and cold caches.
const WARM_UP: usize = 5;

/// Steps of a run that are timed, at most: a mean is as good over 20 s as over 60.
const MOST_TIMED: usize = 1_200;

/// One figure of a scene and whether it is good enough.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    pub figure: &'static str,
    pub unit: &'static str,
    /// `null` in JSON where it is not finite.
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
    /// Deepest in the last second.
    pub depth_end_m: f64,
    /// Largest change of height and of place across gravity, start to end: of a thing that should stand, its
    /// static sink and its drift.
    pub sink_m: f64,
    pub drift_m: f64,
    /// Largest rise of energy above what it was before, and change over the start, J.
    pub energy_rise_j: f64,
    pub energy_change_j: f64,
    /// Change of the momentum that no force explains, over the largest that there was; where nothing is static.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub momentum_change: Option<f64>,
    /// Farthest that a body is from where the same engine puts it with a sixteenth of the step, m, in the first
    /// [`HORIZON_S`]; for small scenes without a closed form.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub own_limit_m: Option<f64>,
    pub laws: Laws,
}

/// Trajectories are compared with an engine's own limit only before chaos parts them, s.
pub const HORIZON_S: f64 = 1.0;

/// The step is divided by this for the engine's own limit, and scenes of more bodies are left out.
const FINER: f64 = 16.0;
const MOST_BODIES: usize = 40;

/// Runs the subject once and judges it.
///
/// # Errors
/// The engine refuses the scene.
pub fn judge(subject: &Subject, setup: &Setup, programs: &Programs) -> Result<Errors, String> {
    let (track, laws) = record(subject, setup, programs)?;
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
    let own = setup.is_default() && !subject.has_closed_form() && subject.bodies() <= MOST_BODIES;
    Ok(Errors {
        figures,
        depth_max_m: track.deepest_m(0.0),
        depth_end_m: track.end_depth_m(),
        sink_m: track.sink_m(),
        drift_m: track.drift_m(),
        energy_rise_j: track.energy_rise_j,
        energy_change_j: energy[energy.len() - 1] - energy[0],
        momentum_change: momentum_change(&track),
        own_limit_m: if own { Some(off_own_limit(subject, setup, programs, &track)?) } else { None },
        laws,
    })
}

/// Runs the subject once and keeps its poses, and the residuals of its contacts.
///
/// # Errors
/// The engine refuses the scene.
pub fn record(subject: &Subject, setup: &Setup, programs: &Programs) -> Result<(Track, Laws), String> {
    let steps = subject.steps(setup.dt_s);
    run(subject, setup, programs, steps)
}

fn run(subject: &Subject, setup: &Setup, programs: &Programs, steps: usize) -> Result<(Track, Laws), String> {
    let mut running = setup.open(&subject.scene, steps, programs)?;
    let mut track = Track::new(&subject.scene, steps);
    let mut laws = LawSums::default();
    let (poses, velocities) = running.state();
    track.push(0.0, &poses, &velocities, false);
    for step in 1..=steps {
        let acted = running.advance()?;
        let (poses, velocities) = running.state();
        laws.add(&subject.scene, &running.touches(), &poses, &velocities);
        track.push(step as f64 * setup.dt_s, &poses, &velocities, acted);
    }
    track.finish();
    Ok((track, laws.laws()))
}

/// Distance from the same engine's run in finer steps, at the times that both have.
fn off_own_limit(
    subject: &Subject,
    setup: &Setup,
    programs: &Programs,
    track: &Track,
) -> Result<f64, String> {
    let fine = Setup { dt_s: setup.dt_s / FINER, ..*setup };
    let horizon = HORIZON_S.min(subject.duration_s);
    let (limit, _) = run(subject, &fine, programs, (horizon / fine.dt_s).round() as usize)?;
    let mut farthest = 0.0_f64;
    for (coarse, moment) in track.moments.iter().zip(limit.moments.iter().step_by(FINER as usize)) {
        for i in track.dynamic() {
            let (a, b) = (coarse.poses[i].position, moment.poses[i].position);
            farthest = farthest.max(length(std::array::from_fn(|k| a[k] - b[k])));
        }
    }
    Ok(farthest)
}

/// Largest change of P - M g t and of L about the origin (the latter without gravity), over the sum of the bodies'
/// own momenta.
fn momentum_change(track: &Track) -> Option<f64> {
    if track.dynamic().count() < track.scene.entities.len() {
        return None;
    }
    let mass: f64 =
        track.scene.entities.iter().filter_map(|entity| Some(sim::measure::mass_of(entity)?.mass_kg)).sum();
    let start = track.momentum(track.start());
    let gravity = track.scene.gravity;
    let still = length(gravity) == 0.0;
    let mut worst = [0.0_f64; 2];
    let mut largest = [length(start.linear), length(start.angular)];
    for moment in &track.moments {
        let now = track.momentum(moment);
        let off = |k: usize| now.linear[k] - start.linear[k] - mass * gravity[k] * moment.time_s;
        worst[0] = worst[0].max(length(std::array::from_fn(off)));
        worst[1] = worst[1].max(length(std::array::from_fn(|k| now.angular[k] - start.angular[k])));
        largest[0] = largest[0].max(length(now.linear));
        largest[1] = largest[1].max(length(now.angular));
    }
    let share = |k: usize| if largest[k] > 0.0 { worst[k] / largest[k] } else { 0.0 };
    Some(if still { share(0).max(share(1)) } else { share(0) })
}

/// Runs the subject once and clocks every step, the first `MOST_TIMED` at most.
///
/// # Errors
/// The engine refuses the scene.
pub fn time(subject: &Subject, setup: &Setup, programs: &Programs) -> Result<Milliseconds, String> {
    let steps = subject.steps(setup.dt_s).min(MOST_TIMED);
    let mut times = setup.step_times(&subject.scene, steps, programs)?;
    let warm = times.split_off(WARM_UP.min(times.len().saturating_sub(1)));
    Ok(summarize(warm))
}
