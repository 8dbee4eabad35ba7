//! Falling, bouncing, sliding and rolling.

use super::{G, error};
use crate::gallery::build::{cube, cylinder, floor, scene, slope, sphere, surface, turn};
use crate::gallery::figure::energy_rise;
use crate::gallery::{Exhibit, Group, Track};
use crate::scene::{Entity, Motion, Scene};

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Exact.exhibit(
        "free-fall",
        "I: a sphere falls from 100 m",
        2.0,
        || scene("free-fall", vec![sphere([0.0, 100.0, 0.0], 0.5, 1000.0, surface(0.5, 0.0))]),
        &[error("place after 2 s", "m", 1e-5, |t| {
            (t.end().poses[0].position[1] - 100.0 + 0.5 * G * 4.0).abs()
        })],
    ),
    Group::Exact.exhibit(
        "bounce-10",
        "I: a sphere bounces, e = 1",
        10.0,
        || bounce(1.0),
        &[error("five peaks", "", 1e-3, |t| peak_error(t, 1.0, 5)), energy_rise(1e-6)],
    ),
    Group::Exact.exhibit(
        "bounce-09",
        "I: a sphere bounces, e = 0.9",
        10.0,
        || bounce(0.9),
        &[error("five peaks", "", 1e-3, |t| peak_error(t, 0.9, 5)), energy_rise(1e-6)],
    ),
    Group::Exact.exhibit(
        "bounce-05",
        "I: a sphere bounces, e = 0.5",
        10.0,
        || bounce(0.5),
        &[error("five peaks", "", 1e-3, |t| peak_error(t, 0.5, 5)), energy_rise(1e-6)],
    ),
    Group::Exact.exhibit(
        "slope-20",
        "I: a cube of friction 0.5 on a slope of 20 degrees stays",
        2.0,
        || on_slope(20.0, cube([0.0, 0.5, 0.0], surface(0.5, 0.0))),
        &[error("creep from 0.5 s", "m", 1e-5, |t| {
            let (sink, drift) = t.moved_since_m(0.5);
            sink.hypot(drift)
        })],
    ),
    Group::Exact.exhibit(
        "slope-30",
        "I: a cube of friction 0.5 on a slope of 30 degrees slides",
        2.0,
        || on_slope(30.0, cube([0.0, 0.5, 0.0], surface(0.5, 0.0))),
        &[error("distance", "", 1e-3, |t| {
            let (sin, cos) = libm::sincos(30f64.to_radians());
            (t.end().poses[1].position[0] / (0.5 * G * (sin - 0.5 * cos) * 4.0) - 1.0).abs()
        })],
    ),
    Group::Exact.exhibit(
        "roll-sphere",
        "I: a sphere rolls down a slope of 20 degrees",
        2.0,
        || on_slope(20.0, sphere([0.0, 0.5, 0.0], 0.5, 1000.0, surface(0.5, 0.0))),
        &[error("distance", "", 1e-3, |t| roll_error(t, 5.0 / 7.0))],
    ),
    Group::Exact.exhibit(
        "roll-cylinder",
        "a solid cylinder rolls down a slope of 20 degrees",
        2.0,
        || on_slope(20.0, drum(0.5)),
        &[error("distance", "", 1e-3, |t| roll_error(t, 2.0 / 3.0))],
    ),
    Group::Exact.exhibit(
        "roll-hoop",
        "a thin hoop rolls down a slope of 20 degrees",
        2.0,
        || on_slope(20.0, drum(1.0)),
        &[error("distance", "", 1e-3, |t| roll_error(t, 0.5))],
    ),
    Group::Exact.exhibit(
        "slide-to-roll",
        "a sliding sphere comes to roll: 5/7 of its speed after 12 v0² / (49 mu g)",
        2.0,
        || {
            let mut ball = sphere([0.0, 0.5, 0.0], 0.5, 1000.0, surface(0.2, 0.0));
            ball.velocity.linear = [5.0, 0.0, 0.0];
            scene("slide-to-roll", vec![floor(surface(0.2, 0.0)), ball])
        },
        &[
            error("speed", "", 5e-3, |t| (t.end().velocities[1].linear[0] / (5.0 / 7.0 * 5.0) - 1.0).abs()),
            error("place", "", 5e-3, |t| {
                let (v, mu, time) = (5.0, 0.2, t.duration_s());
                let slid_s = 2.0 * v / (7.0 * mu * G);
                let expected = 12.0 * v * v / (49.0 * mu * G) + 5.0 / 7.0 * v * (time - slid_s);
                (t.end().poses[1].position[0] / expected - 1.0).abs()
            }),
        ],
    ),
];

fn bounce(e: f64) -> Scene {
    let s = surface(0.5, e);
    scene("bounce", vec![floor(s), sphere([0.0, 1.5, 0.0], 0.5, 1000.0, s)])
}

/// Largest error of the first `count` peaks over e^(2k), each from the first moment of its flight:
/// y + v² / 2g of the lowest point. Infinite where there are fewer.
fn peak_error(track: &Track, e: f64, count: usize) -> f64 {
    let mut peaks = Vec::new();
    let mut rising = false;
    for moment in &track.moments {
        let v = moment.velocities[1].linear[1];
        if v > 0.0 && !rising {
            peaks.push(moment.poses[1].position[1] - 0.5 + v * v / (2.0 * G));
        }
        rising = v > 0.0;
    }
    if peaks.len() < count {
        return f64::INFINITY;
    }
    let expected = (1..).map(|k| e.powi(2 * k));
    peaks
        .iter()
        .take(count)
        .zip(expected)
        .map(|(peak, expected)| (peak / expected - 1.0).abs())
        .fold(0.0, f64::max)
}

fn on_slope(degrees: f64, entity: Entity) -> Scene {
    let mut scene = scene("slope", vec![floor(surface(0.5, 0.0)), entity]);
    scene.gravity = slope(degrees);
    scene
}

/// A cylinder that lies across the slope, its moment about its axis a share of m r².
fn drum(share: f64) -> Entity {
    let mut drum = cylinder([0.0, 0.5, 0.0], 0.5, 0.5, 1000.0, surface(0.5, 0.0));
    drum.pose.rotation = turn([1.0, 0.0, 0.0], 90.0);
    if let Motion::Dynamic(mass) = &mut drum.motion {
        mass.inertia_kg_m2[1] = share * mass.mass_kg * 0.25;
    }
    drum
}

/// Distance rolled in the run against ½ a t² with a = share · g sin θ, share = 1 / (1 + I / m r²).
fn roll_error(track: &Track, share: f64) -> f64 {
    let time = track.duration_s();
    let expected = 0.5 * share * G * libm::sin(20f64.to_radians()) * time * time;
    (track.end().poses[1].position[0] / expected - 1.0).abs()
}
