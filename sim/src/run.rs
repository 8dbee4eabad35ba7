//! A whole simulation: steps until the time is up or everything rests, and what came of it.

use crate::error::SceneError;
use crate::frame::{Event, FrameSink};
use crate::phase::Observer;
use crate::scene::{Pose, Scene};
use crate::settings::Settings;
use crate::step::StepReport;
use crate::work::Work;
use crate::world::World;

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunLimit {
    /// s
    pub max_time_s: f64,
    /// End once every body rests and no action is left.
    pub stop_at_rest: bool,
}

/// What a run showed.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    pub steps: u64,
    pub time_s: f64,
    /// s, when everything had come to rest for good; `None` if something still moved at the end.
    pub settled_at_s: Option<f64>,
    /// J, kinetic and potential, at the start and at the end.
    pub energy_start_j: f64,
    pub energy_end_j: f64,
    /// J, largest rise of the energy above what it had been before, actions apart. Physics gives 0.
    pub max_energy_rise_j: f64,
    /// m, deepest overlap at any step, and at the last.
    pub max_penetration_m: f64,
    pub end_penetration_m: f64,
    pub impacts: u64,
    pub quarantined: u64,
    /// Summed over all steps.
    pub work: Work,
    /// World from body at the end, one an entity.
    pub end_poses: Vec<Pose>,
    pub state_hash: u64,
}

/// Runs `scene` and pushes every frame, the start included, to the sinks.
///
/// # Errors
/// A [`SceneError`] if the scene is refused; nothing has reached the sinks then.
pub fn run(
    scene: &Scene,
    settings: &Settings,
    limit: &RunLimit,
    sinks: &mut [&mut dyn FrameSink],
) -> Result<RunReport, SceneError> {
    run_observed(scene, settings, limit, sinks, &mut ())
}

/// [`run`] with an observer around every step.
///
/// # Errors
/// As [`run`].
pub fn run_observed(
    scene: &Scene,
    settings: &Settings,
    limit: &RunLimit,
    sinks: &mut [&mut dyn FrameSink],
    observer: &mut dyn Observer,
) -> Result<RunReport, SceneError> {
    let mut world = World::new(scene, settings)?;
    for sink in sinks.iter_mut() {
        sink.begin(scene, settings);
    }
    let mut watch = Watch::new(&world);
    push(&world, sinks);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of steps")]
    let steps = (limit.max_time_s / settings.dt_s).round().max(0.0) as u64;
    for _ in 0..steps {
        observer.begins();
        let report = world.step_observed(observer);
        let go_on = observer.ended(&report);
        watch.see(&world, &report);
        push(&world, sinks);
        if !go_on || limit.stop_at_rest && world.rests() {
            break;
        }
    }
    for sink in sinks.iter_mut() {
        sink.end();
    }
    Ok(watch.report(&world))
}

fn push(world: &World, sinks: &mut [&mut dyn FrameSink]) {
    let frame = world.frame();
    for sink in sinks.iter_mut() {
        sink.frame(&frame);
    }
}

/// Extremes over a run.
struct Watch {
    energy_start_j: f64,
    lowest_energy_j: f64,
    max_energy_rise_j: f64,
    max_penetration_m: f64,
    impacts: u64,
    quarantined: u64,
    work: Work,
}

impl Watch {
    fn new(world: &World) -> Self {
        let energy = energy_j(world);
        Self {
            energy_start_j: energy,
            lowest_energy_j: energy,
            max_energy_rise_j: 0.0,
            max_penetration_m: world.frame().metrics.max_penetration_m,
            impacts: 0,
            quarantined: 0,
            work: Work::default(),
        }
    }

    fn see(&mut self, world: &World, report: &StepReport) {
        let frame = world.frame();
        let energy = energy_j(world);
        if frame.events.iter().any(|event| matches!(event, Event::Acted { .. })) {
            self.lowest_energy_j = energy;
        }
        self.max_energy_rise_j = self.max_energy_rise_j.max(energy - self.lowest_energy_j);
        self.lowest_energy_j = self.lowest_energy_j.min(energy);
        self.max_penetration_m = self.max_penetration_m.max(frame.metrics.max_penetration_m);
        self.impacts += u64::from(report.impacts);
        self.quarantined += u64::from(report.quarantined);
        self.work.add(&report.work);
    }

    fn report(self, world: &World) -> RunReport {
        let frame = world.frame();
        RunReport {
            steps: frame.step,
            time_s: frame.time_s,
            settled_at_s: world.settled_at_s(),
            energy_start_j: self.energy_start_j,
            energy_end_j: energy_j(world),
            max_energy_rise_j: self.max_energy_rise_j,
            max_penetration_m: self.max_penetration_m,
            end_penetration_m: frame.metrics.max_penetration_m,
            impacts: self.impacts,
            quarantined: self.quarantined,
            work: self.work,
            end_poses: frame.rigid.map(|rigid| rigid.poses.to_vec()).unwrap_or_default(),
            state_hash: world.state_hash(),
        }
    }
}

fn energy_j(world: &World) -> f64 {
    let metrics = world.frame().metrics;
    metrics.kinetic_j + metrics.potential_j
}
