//! The trials: a drop, standing, staying, a slope and a stack.

use importer::Failure;
use sim::{Meeting, Pose, RunLimit, Scene, Settings, measure, pair_rolling_resistance};

use super::base::Base;
use super::scenes::{self, BODY, Tilt};
use super::watch::Watch;
use super::{Both, Drop, Proof, Slope, Stand, Trials, extents};
use crate::pipeline;
use crate::settle::{Outcome, Rest, Trace, angle_deg, penetration_limit_m};

/// How long a body has to come to rest after it has landed: this many times the fall, and no less than so many
/// seconds. Bouncing and rocking take as long as falling does, in proportion to the root of the size: a ship that falls
/// for five seconds cannot be judged by the clock of a mug. What is slender or round rocks from edge to edge and keeps nearly
/// all of its energy at each (Housner 1963).
const REST_FALLS: f64 = 60.0;
const REST_TIME_S: f64 = 30.0;

/// s on top, of which a body that rests needs half a second to be seen resting.
const PATIENCE_S: f64 = 1.0;

/// s beyond which nothing is waited for, however slowly it rolls.
const ROLLS_OUT_S: f64 = 120.0;

/// s
const STAND_TIME_S: f64 = 3.0;
const STAY_TIME_S: f64 = 2.0;
const HOLD_TIME_S: f64 = 2.0;
const SLIDE_TIME_S: f64 = 1.0;
const STACK_TIME_S: f64 = 4.0;

/// Slopes, as shares of the friction: well under and well over it.
pub(super) const HOLD_SHARE: f64 = 0.8;
pub(super) const SLIDE_SHARE: f64 = 1.25;

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
    let fall_s = (2.0 * clearance / g).sqrt();
    let mut rests_within_s = (REST_FALLS * fall_s).max(REST_TIME_S);
    let time_s = |rests_within_s: f64| fall_s + rests_within_s + PATIENCE_S;
    let mut run = run(trials, &scene, true, time_s(rests_within_s))?;
    if let Some(rolls_s) = rolls_out_s(&scene, &run).filter(|_| !run.outcome.settled()) {
        rests_within_s += rolls_s;
        run = self::run(trials, &scene, true, time_s(rests_within_s))?;
    }
    let time_s = time_s(rests_within_s);
    let limit = penetration_limit_m(extents(&scene).into_iter().fold(f64::INFINITY, f64::min));
    let rest = run.outcome.bodies.first().cloned();
    let settled_at = rest.as_ref().and_then(|rest| rest.settled_at_s);
    let contact = run.watch.contact_s.unwrap_or(0.0);
    let drop = Drop {
        settled: settled_at.is_some(),
        rest_after_s: (settled_at.unwrap_or(run.outcome.time_s) - contact).max(0.0),
        rests_within_s,
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

/// How much longer a body that rolls may take by the law of its rolling resistance: from a speed v, `v (1 + k) / (c g)`,
/// with `k = I / (m r^2)` at most that of a hoop, 1. `None` where it does not roll or nothing resists it.
fn rolls_out_s(scene: &Scene, run: &Ran) -> Option<f64> {
    let [floor, body] = [scene.entities.first()?, scene.entities.get(BODY)?];
    let resistance = pair_rolling_resistance(&body.shapes.first()?.surface, &floor.shapes.first()?.surface);
    let speed = run.watch.rolls_m_s?;
    (resistance > 0.0).then(|| (2.0 * speed / (resistance * measure::length(scene.gravity))).min(ROLLS_OUT_S))
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
    let tips_at_deg = scene
        .entities
        .get(BODY)
        .map_or(0.0, |body| Base::of(&body.shapes, &body.pose).tips_at_rad().to_degrees());
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
    let (down, tips_at) = Base::of(&body.shapes, &body.pose).steadiest();
    let g = measure::length(scene.gravity);
    let along = |outcome: &Outcome| {
        outcome.bodies.first().map_or(0.0, |end| {
            let way: [f64; 3] = std::array::from_fn(|axis| end.position_m[axis] - body.pose.position[axis]);
            measure::dot(way, down)
        })
    };
    let tried = |share: f64, time_s: f64, whole: f64| -> Result<Option<Both<f64>>, Failure> {
        let angle_rad = (share * friction).atan();
        if angle_rad + TIP_MARGIN_DEG.to_radians() >= tips_at || friction <= 0.0 {
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
