//! The trials: a drop, standing, staying, a slope and a stack.

use importer::Failure;
use sim::{Event, Frame, FrameSink, Meeting, Pose, RunLimit, Scene, Settings, measure};

use super::base;
use super::scenes::{self, BODY, Tilt};
use super::{Both, Drop, Proof, Slope, Stand, Trials, extents};
use crate::pipeline;
use crate::settle::{Outcome, Rest, Trace, angle_deg, penetration_limit_m};

/// s that a body has to come to rest, and that a drop is given after its fall, of which a body that rests needs
/// half a second to be seen resting.
const REST_TIME_S: f64 = 8.0;
const PATIENCE_S: f64 = 1.0;

/// s
const STAND_TIME_S: f64 = 3.0;
const STAY_TIME_S: f64 = 2.0;
const HOLD_TIME_S: f64 = 2.0;
const SLIDE_TIME_S: f64 = 1.0;
const STACK_TIME_S: f64 = 4.0;

/// Slopes, as shares of the friction: well under and well over it.
const HOLD_SHARE: f64 = 0.8;
const SLIDE_SHARE: f64 = 1.25;

/// A slope is tried where the body tips this much later, degrees.
const TIP_MARGIN_DEG: f64 = 3.0;

/// How many stand on each other.
const STACKED: usize = 3;

pub(super) fn all(trials: &Trials<'_>, scene: &Scene, stacks: bool) -> Result<Proof, Failure> {
    let (drop, rest) = dropped(trials, scene)?;
    let stand = standing(trials, scene)?;
    let rest = rest.filter(|_| drop.settled && !drop.tunnelled);
    let stay = rest.as_ref().map(|rest| staying(trials, scene, rest)).transpose()?;
    let slope = match &rest {
        Some(rest) => sloped(trials, scene, rest)?,
        None => None,
    };
    let stack = stacks.then(|| stacking(trials, scene)).transpose()?;
    Ok(Proof { drop, stand, stay, slope, stack })
}

fn dropped(trials: &Trials<'_>, scene: &Scene) -> Result<(Drop, Option<Rest>), Failure> {
    let height = scene.entities.get(BODY).map_or(0.0, scenes::height);
    let clearance = 2.0 * height;
    let g = measure::length(scene.gravity);
    let scene = scenes::above(scene, clearance);
    let time_s = (2.0 * clearance / g).sqrt() + REST_TIME_S + PATIENCE_S;
    let run = run(trials, &scene, true, time_s)?;
    let limit = penetration_limit_m(extents(&scene).into_iter().fold(f64::INFINITY, f64::min));
    let rest = run.outcome.bodies.first().cloned();
    let settled_at = rest.as_ref().and_then(|rest| rest.settled_at_s);
    let contact = run.watch.contact_s.unwrap_or(0.0);
    let drop = Drop {
        settled: settled_at.is_some(),
        rest_after_s: (settled_at.unwrap_or(run.outcome.time_s) - contact).max(0.0),
        energy_rise_percent: run.outcome.energy_rise_share.unwrap_or(0.0) * 100.0,
        rest_depth: rest.as_ref().map_or(0.0, |rest| rest.rest_penetration_m) / limit,
        most_depth: rest.as_ref().map_or(0.0, |rest| rest.max_penetration_m) / limit,
        tunnelled: run.watch.tunnelled,
        launch_percent: run.watch.rise_m.max(0.0) * 100.0 / clearance.max(f64::MIN_POSITIVE),
        quarantined: run.watch.quarantined,
        rapier_differs: rapier_drop(trials, &scene, time_s, &run.outcome)?,
    };
    Ok((drop, rest))
}

/// What differs in rapier, and whether it does so only by the way it bounces.
#[cfg(feature = "validate")]
fn rapier_drop(trials: &Trials<'_>, scene: &Scene, time_s: f64, ours: &Outcome) -> Result<String, Failure> {
    use crate::validate::{Comparison, corners_under, judge, without_restitution};
    let Some(rapier) = trials.in_rapier(scene, true, time_s) else { return Ok(String::new()) };
    let Some(verdict) = judge(scene, ours, &rapier).into_iter().next() else { return Ok(String::new()) };
    if verdict.agrees {
        return Ok(String::new());
    }
    let dead = without_restitution(scene);
    let alike = match trials.in_rapier(&dead, true, time_s) {
        Some(rapier) => {
            let ours = run(trials, &dead, true, time_s)?.outcome;
            judge(&dead, &ours, &rapier).first().map(|verdict| verdict.agrees)
        }
        None => None,
    };
    let corners_under = corners_under(scene, &verdict.ours);
    let comparison = Comparison { verdict, rapier, agrees_without_restitution: alike, corners_under };
    Ok(comparison.difference())
}

#[cfg(not(feature = "validate"))]
#[expect(clippy::unnecessary_wraps, reason = "the signature of the full build")]
fn rapier_drop(_: &Trials<'_>, _: &Scene, _: f64, _: &Outcome) -> Result<String, Failure> {
    Ok(String::new())
}

fn standing(trials: &Trials<'_>, scene: &Scene) -> Result<Stand, Failure> {
    let scene = scenes::above(scene, 0.0);
    let tips_at_deg =
        scene.entities.get(BODY).map_or(0.0, |body| base::tips_at_rad(&body.shapes, &body.pose).to_degrees());
    let tilt = |outcome: &Outcome| outcome.bodies.first().map_or(0.0, |rest| rest.tipped_deg);
    let ours = run(trials, &scene, true, STAND_TIME_S)?;
    let rapier = trials.in_rapier(&scene, true, STAND_TIME_S);
    Ok(Stand { tips_at_deg, tilt_deg: Both { ours: tilt(&ours.outcome), rapier: rapier.as_ref().map(tilt) } })
}

/// Drift of any point of the body, over what a resting body may sink in.
fn staying(trials: &Trials<'_>, scene: &Scene, rest: &Rest) -> Result<Both<f64>, Failure> {
    let pose = Pose { position: rest.position_m, rotation: rest.rotation };
    let scene = scenes::resting(scene, pose);
    let limit = penetration_limit_m(rest.smallest_side_m);
    let reach = scene.entities.get(BODY).map_or(0.0, |body| measure::reach(&body.shapes));
    let drift = |outcome: &Outcome| {
        outcome.bodies.first().map_or(0.0, |end| {
            let way: [f64; 3] = std::array::from_fn(|axis| end.position_m[axis] - pose.position[axis]);
            (measure::length(way) + turned_rad(pose.rotation, end.rotation) * reach) / limit
        })
    };
    let ours = run(trials, &scene, false, STAY_TIME_S)?;
    let rapier = trials.in_rapier(&scene, false, STAY_TIME_S);
    Ok(Both { ours: drift(&ours.outcome), rapier: rapier.as_ref().map(drift) })
}

fn sloped(trials: &Trials<'_>, scene: &Scene, rest: &Rest) -> Result<Option<Slope>, Failure> {
    let pose = Pose { position: rest.position_m, rotation: rest.rotation };
    let scene = scenes::placed(scene, pose, 0.0);
    let [Some(floor), Some(body)] = [scene.entities.first(), scene.entities.get(BODY)] else {
        return Ok(None);
    };
    let [Some(under), Some(over)] = [floor.shapes.first(), body.shapes.first()] else { return Ok(None) };
    let friction = Meeting::of(&scene.pairs, &over.surface, &under.surface).friction;
    let (down, tips_at) = base::steadiest(&body.shapes, &body.pose);
    // Where it tips sideways it does not matter how steep the slope is along it.
    let sideways = base::tips_at_rad(&body.shapes, &body.pose);
    let g = measure::length(scene.gravity);
    let along = |outcome: &Outcome| {
        outcome.bodies.first().map_or(0.0, |end| {
            let way: [f64; 3] = std::array::from_fn(|axis| end.position_m[axis] - body.pose.position[axis]);
            measure::dot(way, down)
        })
    };
    let tried = |share: f64, time_s: f64, whole: f64| -> Result<Option<Both<f64>>, Failure> {
        let angle_rad = (share * friction).atan();
        let steady =
            angle_rad + TIP_MARGIN_DEG.to_radians() < tips_at && sideways.to_degrees() > TIP_MARGIN_DEG;
        if !steady || friction <= 0.0 {
            return Ok(None);
        }
        let slope = scenes::tilted(&scene, Tilt { down, angle_rad });
        let percent = |outcome: &Outcome| along(outcome) * 100.0 / whole;
        let ours = run(trials, &slope, false, time_s)?;
        let rapier = trials.in_rapier(&slope, false, time_s);
        Ok(Some(Both { ours: percent(&ours.outcome), rapier: rapier.as_ref().map(percent) }))
    };
    let hold_percent = tried(HOLD_SHARE, HOLD_TIME_S, rest.size_m)?;
    let (sin, cos) = (SLIDE_SHARE * friction).atan().sin_cos();
    let closed_form = 0.5 * g * (sin - friction * cos) * SLIDE_TIME_S * SLIDE_TIME_S;
    let slide_percent = tried(SLIDE_SHARE, SLIDE_TIME_S, closed_form)?;
    Ok(Some(Slope { friction, hold_percent, slide_percent }))
}

fn stacking(trials: &Trials<'_>, scene: &Scene) -> Result<Both<f64>, Failure> {
    let height = scene.entities.get(BODY).map_or(0.0, scenes::height);
    let scene = scenes::stacked(scene, STACKED);
    let top = scene.entities.len() - 1;
    let start = scene.entities.get(top).map_or(0.0, |body| body.pose.position[1]);
    let lost = |outcome: &Outcome| {
        let end = outcome.bodies.iter().find(|rest| rest.entity == top);
        end.map_or(0.0, |end| (start - end.position_m[1]).max(0.0) * 100.0 / height.max(f64::MIN_POSITIVE))
    };
    let ours = run(trials, &scene, true, STACK_TIME_S)?;
    let rapier = trials.in_rapier(&scene, true, STACK_TIME_S);
    Ok(Both { ours: lost(&ours.outcome), rapier: rapier.as_ref().map(lost) })
}

/// Angle between two orientations, radians.
fn turned_rad(a: [f64; 4], b: [f64; 4]) -> f64 {
    // Of two axes, so that a turn about either of them alone is seen by the other.
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let angles = axes.map(|axis| angle_deg(measure::rotate(a, axis), measure::rotate(b, axis)));
    angles.into_iter().fold(0.0, f64::max).to_radians()
}

/// A run in our engine.
struct Ran {
    outcome: Outcome,
    watch: Watch,
}

/// `sleeping`: also end once everything sleeps.
fn run(trials: &Trials<'_>, scene: &Scene, sleeping: bool, time_s: f64) -> Result<Ran, Failure> {
    let settings = Settings { sleeping, ..trials.solver };
    let limit = RunLimit { max_time_s: time_s, stop_at_rest: sleeping };
    let mut trace = Trace::new(scene);
    let mut watch = Watch::new(scene);
    sim::run(scene, &settings, &limit, &mut [&mut trace, &mut watch])
        .map_err(|error| pipeline::of_scene(&error))?;
    Ok(Ran { outcome: trace.outcome(), watch })
}

/// What the trace of a settling body does not tell.
struct Watch {
    body: Option<sim::Entity>,
    start_m: f64,
    contact_s: Option<f64>,
    rise_m: f64,
    tunnelled: bool,
    quarantined: bool,
}

impl Watch {
    fn new(scene: &Scene) -> Self {
        let body = scene.entities.get(BODY).cloned();
        let start_m = body.as_ref().map_or(0.0, |body| body.pose.position[1]);
        Self {
            body,
            start_m,
            contact_s: None,
            rise_m: f64::NEG_INFINITY,
            tunnelled: false,
            quarantined: false,
        }
    }
}

impl FrameSink for Watch {
    fn begin(&mut self, _: &Scene, _: &Settings) {}

    fn frame(&mut self, frame: &Frame<'_>) {
        let (Some(rigid), Some(body)) = (frame.rigid, &self.body) else { return };
        let Some(pose) = rigid.poses.get(BODY) else { return };
        let touches = frame.contacts.is_some_and(|contacts| !contacts.points.is_empty())
            || frame.events.iter().any(|event| matches!(event, Event::Impact { .. }));
        if touches && self.contact_s.is_none() {
            self.contact_s = Some(frame.time_s);
        }
        if self.contact_s.is_some() {
            self.rise_m = self.rise_m.max(pose.position[1] - self.start_m);
        }
        let top = measure::body_support(&body.shapes, pose, [0.0, 1.0, 0.0]);
        self.tunnelled |= top.is_some_and(|top| top < 0.0);
        self.quarantined |= frame.events.iter().any(|event| matches!(event, Event::Quarantined { .. }));
    }

    fn end(&mut self) {}
}
