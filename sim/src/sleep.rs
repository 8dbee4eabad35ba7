//! Sleeping: an island whose bodies have all been still for a while is left out of the step until it is touched.
//!
//! Still means slow by the paper's measure, kinetic energy over mass, over a window and at the moment; not gaining
//! energy, as what begins to fall does; and not creeping: what has moved away from where it became still, by however
//! little a step, is not.

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::frame::{Event, SleepState};
use crate::island::Sets;
use crate::settings::Settings;

/// m/s below which a body of a metre or more is slow; smaller ones in proportion to the square root of their
/// size, as speeds under gravity are.
const SLOW_M_S: f64 = 0.03;
/// Share of a body's inner radius by which it may creep while it falls asleep.
const CREEP_SHARE: f64 = 0.002;
/// s. Windows over which kinetic energy is averaged: what it is now, and what it has been.
const NOW_S: f64 = 0.1;
const LATELY_S: f64 = 0.4;
/// Energy that grows is the start of a fall, however slow; below this share of a slow body's it is rounding.
const GROWTH: f64 = 1.5;
const ROUNDING_SHARE: f64 = 1e-4;

/// The storage of the phase.
#[derive(Clone, Default)]
pub(crate) struct Sleepers {
    islands: Sets,
    /// By island: shortest time for which any member has been still, s; and whether one is awake.
    still: Vec<f64>,
    awake: Vec<bool>,
}

/// Updates every body's state after a step that ended at `now_s`. Wakes islands that something awake has joined, and
/// puts to sleep those that have been still long enough.
pub(crate) fn update(
    storage: &mut Sleepers,
    bodies: &mut [Body],
    pairs: &[Pair],
    settings: &Settings,
    now_s: f64,
    events: &mut Vec<Event>,
) {
    let Sleepers { islands, still, awake } = storage;
    islands.join_touching(bodies, pairs);
    still.clear();
    still.resize(bodies.len(), f64::INFINITY);
    awake.clear();
    awake.resize(bodies.len(), false);
    for (i, body) in (0..).zip(bodies.iter_mut()).filter(|(_, body)| !body.is_static()) {
        let root = islands.root(i) as usize;
        if body.sleep != SleepState::Asleep {
            watch(body, settings.dt_s, now_s);
            awake[root] = true;
        }
        still[root] = still[root].min(body.still_s);
    }
    for (i, body) in (0..).zip(bodies.iter_mut()).filter(|(_, body)| !body.is_static()) {
        let root = islands.root(i) as usize;
        let was = body.sleep;
        body.sleep = if !settings.sleeping {
            SleepState::Active
        } else if still[root] >= settings.sleep_delay_s || was == SleepState::Asleep && !awake[root] {
            SleepState::Asleep
        } else if body.still_s > 0.0 {
            SleepState::Drowsy
        } else {
            SleepState::Active
        };
        match (was == SleepState::Asleep, body.sleep == SleepState::Asleep) {
            (false, true) => {
                body.velocity.fill(0.0);
                body.spin.fill(0.0);
                events.push(Event::FellAsleep { entity: i });
            }
            (true, false) => {
                body.still_s = 0.0;
                body.sleep = SleepState::Active;
                (body.stir_now, body.stir_lately) = (0.0, 0.0);
                events.push(Event::WokeUp { entity: i });
            }
            _ => {}
        }
    }
}

/// Counts how long an awake body has been still.
fn watch(body: &mut Body, dt: f64, now_s: f64) {
    let slow = SLOW_M_S * body.reach.min(1.0).sqrt();
    let speed_squared = 2.0 * body.kinetic_j() / body.mass;
    let toward = |average: f64, window: f64| average + (speed_squared - average) * (dt / window).min(1.0);
    body.stir_now = toward(body.stir_now, NOW_S);
    body.stir_lately = toward(body.stir_lately, LATELY_S);
    let grows = body.stir_now > GROWTH * body.stir_lately && body.stir_now > ROUNDING_SHARE * slow * slow;
    let moved = (body.position - body.still_from.position).norm()
        + body.rotation.angle_to(&body.still_from.rotation) * body.reach;
    let still = body.stir_now.max(speed_squared) < slow * slow && !grows;
    if still && moved < CREEP_SHARE * body.inner_radius {
        body.still_s += dt;
    } else {
        body.still_s = 0.0;
        body.still_since_s = now_s;
        body.still_from = body.frame();
    }
}
