//! Things that must stand, rest, sleep or at least not explode.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::{Pose, RunLimit, Shape};

fn tower(count: u32, restitution: f64, gap: f64) -> sim::Scene {
    let mut entities = vec![floor(surface(0.5, restitution))];
    entities.extend(
        (0..count)
            .map(|i| cube([0.0, 0.5 + gap + f64::from(i) * (1.0 + gap), 0.0], surface(0.5, restitution))),
    );
    scene(entities)
}

#[test]
fn tower_of_ten_stands_for_a_minute_awake() {
    let (track, report) = track(&tower(10, 0.0, 0.0), &awake(), 10, 60.0);
    let top = track.poses.last().unwrap().position;
    assert!((top[1] - 9.5).abs() < 0.02, "the top sank to {}", top[1]);
    assert!(top[0].hypot(top[2]) < 0.01, "the top drifted to {top:?}");
    assert!(report.end_penetration_m < 5e-3, "{report:?}");
}

#[test]
fn bouncing_stack_never_gains_energy_and_rests() {
    // The paper's Fig. 9: a stack of boxes with restitution 0.8.
    let (_, report) = track(&tower(10, 0.8, 0.1), &awake(), 10, 20.0);
    let rest: f64 = (0..10).map(|i| 1000.0 * G * (0.5 + f64::from(i))).sum();
    let above = report.energy_start_j - rest;
    assert!(report.max_energy_rise_j < 1e-3 * above, "rises by {} of {above} J", report.max_energy_rise_j);
    assert!((report.energy_end_j - rest).abs() < 0.02 * rest, "ends at {} of {rest} J", report.energy_end_j);
}

#[test]
fn dropped_shapes_come_to_rest_and_sleep() {
    let hull = Shape::Hull {
        points: vec![
            [0.3, 0.0, 0.0],
            [-0.2, 0.0, 0.25],
            [-0.2, 0.0, -0.25],
            [0.0, 0.5, 0.0],
            [0.0, -0.2, 0.0],
        ],
    };
    let mass = sim::Mass { mass_kg: 20.0, inertia_kg_m2: [0.5, 0.4, 0.5, 0.0, 0.0, 0.0] };
    let shapes = [
        ("box", cuboid([0.0, 1.0, 0.0], [0.2, 0.1, 0.3], 500.0, surface(0.5, 0.3))),
        (
            "capsule",
            body(
                "capsule",
                mass,
                [0.0, 1.0, 0.0],
                Shape::Capsule { half_height: 0.3, radius: 0.1 },
                surface(0.5, 0.3),
            ),
        ),
        ("hull", body("hull", mass, [0.0, 1.0, 0.0], hull, surface(0.5, 0.3))),
        ("cylinder", cylinder([0.0, 1.0, 0.0], 0.1, 0.3, surface(0.5, 0.3))),
    ];
    for (name, mut entity) in shapes {
        entity.pose.rotation = nalgebra::UnitQuaternion::from_euler_angles(0.4, 0.2, 0.3).coords.into();
        let scene = scene(vec![floor(surface(0.5, 0.3)), entity]);
        let settings = sim::Settings::default();
        let limit = RunLimit { max_time_s: 30.0, stop_at_rest: true };
        let report = sim::run(&scene, &settings, &limit, &mut []).unwrap();
        assert!(report.settled_at_s.is_some(), "{name} never rests: {report:?}");
        assert!(report.end_penetration_m < 5e-4, "{name}: {report:?}");
        assert!(report.max_energy_rise_j < 1e-3 * report.energy_start_j, "{name}: {report:?}");
    }
}

#[test]
fn compound_rests_on_static_box_and_mesh() {
    let stool = || {
        let mut stool = cuboid([0.0, 0.8, 0.0], [0.3, 0.05, 0.3], 600.0, surface(0.5, 0.1));
        for (x, z) in [(-0.25, -0.25), (-0.25, 0.25), (0.25, -0.25), (0.25, 0.25)] {
            let mut leg = child(Shape::Box { half_extents: [0.03, 0.2, 0.03] }, surface(0.5, 0.1));
            leg.body_from_shape = Pose::at([x, -0.25, z]);
            stool.shapes.push(leg);
        }
        stool
    };
    let grid = |n: u32| {
        let at = |i: u32| f64::from(i) - f64::from(n) * 0.5;
        let positions = (0..=n).flat_map(|i| (0..=n).map(move |j| [at(i), 0.0, at(j)])).collect();
        let index = |i: u32, j: u32| i * (n + 1) + j;
        let triangles = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .flat_map(|(i, j)| {
                [
                    [index(i, j), index(i, j + 1), index(i + 1, j)],
                    [index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)],
                ]
            })
            .collect();
        Shape::TriangleMesh { positions, triangles }
    };
    let slab = Shape::Box { half_extents: [2.0, 0.5, 2.0] };
    for (name, ground) in [
        ("box", fixed("ground", Pose::at([0.0, -0.5, 0.0]), slab, surface(0.5, 0.1))),
        ("mesh", fixed("ground", Pose::IDENTITY, grid(6), surface(0.5, 0.1))),
    ] {
        let scene = scene(vec![ground, stool()]);
        let (track, report) = track(&scene, &sim::Settings::default(), 1, 6.0);
        let height = track.poses.last().unwrap().position[1];
        assert!((height - 0.45).abs() < 1e-3, "on a {name}: stands at {height} m");
        assert!(report.settled_at_s.is_some(), "on a {name}: {report:?}");
    }
}

#[test]
fn overlapping_start_is_pushed_apart_gently() {
    let scene = scene(vec![
        floor(surface(0.5, 0.0)),
        cube([0.0, 0.3, 0.0], surface(0.5, 0.0)),
        cube([0.1, 1.0, 0.0], surface(0.5, 0.0)),
    ]);
    let (track, report) = track(&scene, &awake(), 2, 5.0);
    let fastest = track
        .velocities
        .iter()
        .map(|v| v.linear.iter().map(|x| x * x).sum::<f64>().sqrt())
        .fold(0.0, f64::max);
    assert!(fastest < 3.5, "thrown at {fastest} m/s");
    assert!(report.end_penetration_m < 2e-3, "{report:?}");
}

#[test]
fn same_scene_gives_the_same_bits() {
    let run = || track(&tower(5, 0.3, 0.05), &sim::Settings::default(), 1, 3.0).1.state_hash;
    assert_eq!(run(), run());
}
