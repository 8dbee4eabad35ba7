//! Motions with a closed form. Each tolerance is the project's promise, not today's figure.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::{Mass, Shape};

#[test]
fn free_fall_is_a_parabola() {
    let scene = scene(vec![sphere([0.0, 100.0, 0.0], 0.5, 1000.0, surface(0.5, 0.0))]);
    let (track, _) = track(&scene, &awake(), 0, 2.0);
    let fallen = 100.0 - track.poses.last().unwrap().position[1];
    assert!((fallen - 0.5 * G * 4.0).abs() < 1e-5, "fell {fallen} m");
}

/// Peaks of the flight, from any moment of it: y + v² / 2g of the lowest point.
fn peaks(track: &Track, radius: f64) -> Vec<f64> {
    let mut peaks = Vec::new();
    let mut rising = false;
    for (pose, velocity) in track.poses.iter().zip(&track.velocities) {
        let v = velocity.linear[1];
        if v > 0.0 && !rising {
            peaks.push(pose.position[1] - radius + v * v / (2.0 * G));
        }
        rising = v > 0.0;
    }
    peaks
}

#[test]
fn bounces_keep_their_restitution() {
    for (e, count) in [(1.0, 5), (0.9, 5), (0.5, 5)] {
        let scene =
            scene(vec![floor(surface(0.5, e)), sphere([0.0, 1.5, 0.0], 0.5, 1000.0, surface(0.5, e))]);
        let (track, report) = track(&scene, &awake(), 1, 10.0);
        let peaks = peaks(&track, 0.5);
        for (k, peak) in (1..).zip(peaks.iter().take(count)) {
            let expected = e.powi(2 * k);
            assert!((peak / expected - 1.0).abs() < 1e-3, "e {e}, bounce {k}: {peak} m of {expected}");
        }
        assert!(peaks.len() >= count, "e {e}: {} bounces", peaks.len());
        assert!(report.max_energy_rise_j < 1e-5 * report.energy_start_j, "e {e}: {report:?}");
    }
}

#[test]
fn cube_on_a_gentle_slope_stays() {
    let mut scene = scene(vec![floor(surface(0.5, 0.0)), cube([0.0, 0.5, 0.0], surface(0.5, 0.0))]);
    scene.gravity = slope(20.0);
    let (track, _) = track(&scene, &awake(), 1, 10.0);
    let at = |time: f64| {
        let i = track.times.iter().position(|t| *t >= time - 1e-9).unwrap();
        track.poses[i].position
    };
    let moved = (at(10.0)[0] - at(0.5)[0]).abs();
    assert!(moved < 1e-5, "crept {moved} m");
}

#[test]
fn cube_on_a_steep_slope_slides_by_coulomb() {
    let mut scene = scene(vec![floor(surface(0.5, 0.0)), cube([0.0, 0.5, 0.0], surface(0.5, 0.0))]);
    scene.gravity = slope(30.0);
    let (track, _) = track(&scene, &awake(), 1, 2.0);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let expected = 0.5 * G * (sin - 0.5 * cos) * 4.0;
    let slid = track.poses.last().unwrap().position[0];
    assert!((slid / expected - 1.0).abs() < 2e-3, "slid {slid} m of {expected}");
}

#[test]
fn free_top_keeps_momentum_and_energy() {
    let mut top = body(
        "top",
        Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] },
        [0.0; 3],
        Shape::Sphere { radius: 0.5 },
        surface(0.5, 0.0),
    );
    top.velocity.angular = [0.01, 5.0, 0.01];
    let mut scene = scene(vec![top]);
    scene.gravity = [0.0; 3];
    let (track, report) = track(&scene, &awake(), 0, 20.0);
    let drift = (report.energy_end_j / report.energy_start_j - 1.0).abs();
    assert!(drift < 1e-6, "energy drifts by {drift}");
    // The intermediate axis flips: ω₂ changes sign four times in 20 s (Jacobi elliptic functions).
    let spin: Vec<f64> = (track.poses.iter().zip(&track.velocities))
        .map(|(pose, velocity)| {
            let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::from(pose.rotation));
            (q.inverse() * nalgebra::Vector3::from(velocity.angular)).y
        })
        .collect();
    let crossings: Vec<f64> = (1..spin.len())
        .filter(|&i| spin[i - 1] * spin[i] < 0.0)
        .map(|i| {
            track.times[i - 1] + (track.times[i] - track.times[i - 1]) * spin[i - 1] / (spin[i - 1] - spin[i])
        })
        .collect();
    let expected = [2.7411, 7.7670, 12.7929, 17.8189];
    assert_eq!(crossings.len(), expected.len(), "{crossings:?}");
    for (found, expected) in crossings.iter().zip(expected) {
        assert!((found - expected).abs() < 0.01, "crosses at {found} s, expected {expected}");
    }
}

#[test]
fn newtons_cradle_passes_the_blow_on() {
    for e in [1.0, 0.95, 0.9] {
        let ball = |i: u32| {
            let mut ball = sphere([f64::from(i) * 1.0, 0.0, 0.0], 0.5, 1000.0, surface(0.0, e));
            if i == 0 {
                ball.pose.position[0] = -1.0;
                ball.velocity.linear = [1.0, 0.0, 0.0];
            }
            ball
        };
        let mut scene = scene((0..5).map(ball).collect());
        scene.gravity = [0.0; 3];
        let (track, _) = track(&scene, &awake(), 4, 2.0);
        let out = track.velocities.last().unwrap().linear[0];
        let expected = (0.5 * (1.0 + e)).powi(4);
        assert!((out / expected - 1.0).abs() < 1e-3, "e {e}: last ball at {out} m/s of {expected}");
    }
}

#[test]
fn oblique_impact_sticks_or_slips() {
    // u_t' = 5/7 u_t where μ (1 + e) |u_n| ≥ 2/7 |u_t|, else u_t - μ (1 + e) |u_n|.
    for (friction, tangential) in [(0.8, 1.0), (0.05, 1.0)] {
        let e = 0.6;
        let mut ball = sphere([0.0, 0.6, 0.0], 0.5, 1000.0, surface(friction, e));
        ball.velocity.linear = [tangential, -2.0, 0.0];
        let scene = scene(vec![floor(surface(friction, e)), ball]);
        let (track, _) = track(&scene, &awake(), 1, 0.2);
        let normal = (4.0 + 2.0 * G * 0.1f64).sqrt();
        let limit = friction * (1.0 + e) * normal;
        let expected =
            if limit >= 2.0 / 7.0 * tangential { 5.0 / 7.0 * tangential } else { tangential - limit };
        let after = track.velocities.last().unwrap().linear[0];
        assert!((after - expected).abs() < 1e-4, "μ {friction}: {after} m/s, expected {expected}");
    }
}
