//! The fall of a row of dominoes, against the engine's own limit of small steps.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::{Pose, Precision, Scene, Settings, World, gallery};

/// m/s at which a row's fall runs from the sixth to the last but four: a domino's turn is when it leans by 5 degrees.
fn wave_speed(scene: &Scene, last: usize, dt_s: f64, precision: Precision) -> f64 {
    let settings = Settings { dt_s, precision, ..awake() };
    let mut world = World::new(scene, &settings).unwrap();
    let lean = |pose: &Pose| 2.0 * pose.rotation[2].hypot(pose.rotation[0]).asin().to_degrees();
    let mut turns = [0.0; 2];
    let mut before = [0.0; 2];
    while world.time_s() < 12.0 && turns[1] == 0.0 {
        world.step();
        let now = world.time_s();
        let frame = world.frame();
        for (k, i) in [6, last - 4].into_iter().enumerate() {
            let angle = lean(&frame.rigid.unwrap().poses[i]);
            if turns[k] == 0.0 && angle > 5.0 {
                turns[k] = now - dt_s * (angle - 5.0) / (angle - before[k]);
            }
            before[k] = angle;
        }
    }
    let x = |i: usize| scene.entities[i].pose.position[0];
    (x(last - 4) - x(6)) / (turns[1] - turns[0])
}

#[test]
fn dominoes_fall_nearly_as_fast_as_in_the_limit_of_small_steps() {
    let row = (gallery::by_name("h7-dominoes").unwrap().scene)();
    // Box2D's double domino, with a depth: 15 of 0.25 x 1 x 0.5 m, 1.01 m apart.
    let s = surface(0.6, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend((0..15).map(|i| cuboid([1.01 * f64::from(i), 0.5, 0.0], [0.125, 0.5, 0.25], 4.0, s)));
    // 0.2 N s at the top edge.
    let mass = 4.0 * 0.25 * 0.5;
    let inertia = mass * (0.25_f64.powi(2) + 1.0) / 12.0;
    entities[1].velocity.linear = [0.2 / mass, 0.0, 0.0];
    entities[1].velocity.angular = [0.0, 0.0, -0.2 * 0.5 / inertia];
    let double = scene(entities);
    // What they are today at the default step; the aim is 3 % for both. A row's contacts are those of the step's beginning,
    // while a domino turns by some degrees in it.
    for (name, scene, last, today) in [("row", row, 20, 0.18), ("double", double, 15, 0.04)] {
        let limit = wave_speed(&scene, last, 1.0 / 1920.0, Precision::Double);
        for (dt_s, most) in [(1.0 / 60.0, today), (1.0 / 960.0, 0.015)] {
            let error = wave_speed(&scene, last, dt_s, Precision::Single) / limit - 1.0;
            println!("{name} at {dt_s:.5} s: {error:+.4} of {limit:.4} m/s");
            assert!(error.abs() < most, "{name} at {dt_s} s: {error:+.4} of {limit} m/s");
        }
    }
}
