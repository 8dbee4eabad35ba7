//! Rolling and sliding with a closed form, rolling resistance among them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say so")]

mod common;

use common::*;
use sim::{Entity, Mass, Shape, Surface};

/// Lies on its side, so that it rolls along x.
fn lying(mut entity: Entity) -> Entity {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    entity.pose.rotation = [half, 0.0, 0.0, half];
    entity
}

fn drum(surface: Surface) -> Entity {
    lying(cylinder([0.0, 0.5, 0.0], 0.5, 0.5, surface))
}

/// All mass at the rim.
fn hoop(surface: Surface) -> Entity {
    let (m, r, half_height) = (10.0, 0.5, 0.1);
    let across = m * (0.5 * r * r + half_height * half_height / 3.0);
    let mass = Mass { mass_kg: m, inertia_kg_m2: [across, m * r * r, across, 0.0, 0.0, 0.0] };
    let shape = Shape::Cylinder { half_height, radius: r };
    lying(body("hoop", mass, [0.0, 0.5, 0.0], shape, surface))
}

fn ball(surface: Surface) -> Entity {
    sphere([0.0, 0.5, 0.0], 0.5, 1000.0, surface)
}

/// Way along x after `seconds` on a slope, m.
fn way(entity: Entity, ground: Surface, degrees: f64, seconds: f64) -> f64 {
    let mut scene = scene(vec![floor(ground), entity]);
    scene.gravity = slope(degrees);
    let (track, _) = track(&scene, &awake(), 1, seconds);
    track.poses.last().unwrap().position[0]
}

#[test]
fn round_things_roll_down_a_slope() {
    let s = surface(0.5, 0.0);
    let sin = 20f64.to_radians().sin();
    // a / (g sin θ) = 1 / (1 + I / m r²)
    for (name, entity, share) in
        [("sphere", ball(s), 5.0 / 7.0), ("cylinder", drum(s), 2.0 / 3.0), ("hoop", hoop(s), 0.5)]
    {
        let expected = 0.5 * share * G * sin * 4.0;
        let rolled = way(entity, s, 20.0, 2.0);
        assert!((rolled / expected - 1.0).abs() < 1e-3, "{name} rolled {rolled} m of {expected}");
    }
}

#[test]
fn sphere_on_a_steep_slope_slips_as_it_rolls() {
    // Beyond tan θ = 7/2 μ: a = g (sin θ - μ cos θ).
    let s = surface(0.1, 0.0);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let expected = 0.5 * G * (sin - 0.1 * cos) * 4.0;
    let moved = way(ball(s), s, 30.0, 2.0);
    assert!((moved / expected - 1.0).abs() < 1e-3, "moved {moved} m of {expected}");
}

#[test]
fn sliding_ball_begins_to_roll() {
    // v = 5/7 v₀ after t = 2 v₀ / (7 μ g) and d = 12 v₀² / (49 μ g).
    let (mu, v0) = (0.2, 5.0);
    let s = surface(mu, 0.0);
    let mut thrown = ball(s);
    thrown.velocity.linear = [v0, 0.0, 0.0];
    let (track, _) = track(&scene(vec![floor(s), thrown]), &awake(), 1, 2.0);
    let (t, d) = (2.0 * v0 / (7.0 * mu * G), 12.0 * v0 * v0 / (49.0 * mu * G));
    let end = track.poses.last().unwrap().position[0];
    let expected = d + 5.0 / 7.0 * v0 * (2.0 - t);
    assert!((end / expected - 1.0).abs() < 5e-3, "at {end} m, expected {expected}");
    let speed = track.velocities.last().unwrap().linear[0];
    assert!((speed / (5.0 / 7.0 * v0) - 1.0).abs() < 5e-3, "rolls at {speed} m/s");
    // The moment at which it rolls: the contact has stopped slipping.
    let slip = |i: usize| track.velocities[i].linear[0] + 0.5 * track.velocities[i].angular[2];
    let first = (0..track.times.len()).find(|&i| slip(i).abs() < 1e-3 * v0).unwrap();
    assert!((track.times[first] - t).abs() < 0.02, "rolls from {} s on, expected {t}", track.times[first]);
}

#[test]
fn rolling_resistance_slows_by_its_closed_form() {
    // A moment c r N: a = -c g / (1 + I / m r²) on the level, a = (sin θ - c cos θ) g / (1 + I / m r²) on a slope.
    let c = 0.02;
    let rough = Surface { rolling_resistance: c, ..surface(0.5, 0.0) };
    for (name, entity, share) in
        [("sphere", ball(rough), 5.0 / 7.0), ("cylinder", drum(rough), 2.0 / 3.0), ("hoop", hoop(rough), 0.5)]
    {
        let mut thrown = entity.clone();
        let v0 = 1.0;
        thrown.velocity.linear = [v0, 0.0, 0.0];
        thrown.velocity.angular = [0.0, 0.0, -v0 / 0.5];
        let expected = v0 * v0 / (2.0 * share * c * G);
        let rolled = way(thrown, surface(0.5, 0.0), 0.0, v0 / (share * c * G) + 2.0);
        assert!((rolled / expected - 1.0).abs() < 2e-3, "{name} stops after {rolled} m of {expected}");

        let (sin, cos) = 5f64.to_radians().sin_cos();
        let expected = 0.5 * share * G * (sin - c * cos) * 4.0;
        let rolled = way(entity, surface(0.5, 0.0), 5.0, 2.0);
        assert!((rolled / expected - 1.0).abs() < 1e-3, "{name} rolled {rolled} m of {expected}");
    }
}

#[test]
fn rolling_resistance_holds_a_ball_on_a_gentle_slope() {
    // tan 2° = 0.035: held by c = 0.04, let go by 0.03.
    let resting = |c: f64| {
        let s = Surface { rolling_resistance: c, ..surface(0.5, 0.0) };
        way(ball(s), s, 2.0, 5.0)
    };
    let (held, rolled) = (resting(0.04), resting(0.03));
    assert!(held.abs() < 1e-4, "crept {held} m");
    assert!(rolled > 0.1, "rolled {rolled} m");
}
