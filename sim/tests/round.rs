//! Things that stand on something round or many-cornered.

mod common;

use common::*;
use sim::{Mass, RunLimit, Settings, Shape};

fn prism(corners: u32, radius: f64, half_height: f64) -> Shape {
    let ring = |y: f64| {
        (0..corners).map(move |i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / f64::from(corners)).sin_cos();
            [radius * cos, y, radius * sin]
        })
    };
    Shape::Hull { points: ring(-half_height).chain(ring(half_height)).collect() }
}

#[test]
fn slender_prisms_of_many_corners_come_to_rest() {
    for corners in [6, 8, 12, 24] {
        let (radius, half) = (0.04, 0.135);
        let mass_kg = 2500.0 * std::f64::consts::PI * radius * radius * 2.0 * half;
        let across = mass_kg * (3.0 * radius * radius + 4.0 * half * half) / 12.0;
        let mass =
            Mass { mass_kg, inertia_kg_m2: [across, 0.5 * mass_kg * radius * radius, across, 0.0, 0.0, 0.0] };
        let body =
            body("prism", mass, [0.0, half + 0.03, 0.0], prism(corners, radius, half), surface(0.5, 0.0));
        let scene = scene(vec![floor(surface(0.5, 0.0)), body]);
        let limit = RunLimit { max_time_s: 8.0, stop_at_rest: false };
        let report = sim::run(&scene, &Settings::default(), &limit, &mut []).unwrap();
        let fall = mass_kg * G * 0.03;
        assert!(report.settled_at_s.is_some(), "{corners} corners: {report:?}");
        assert!(report.max_energy_rise_j < 1e-3 * fall, "{corners} corners: {report:?}");
    }
}

#[test]
fn tall_cylinder_rocks_to_rest_and_gains_nothing() {
    let mut tall = cylinder([0.0, 1.1, 0.0], 0.9, 0.2, surface(0.5, 0.3));
    tall.pose.rotation = [0.01, 0.0, 0.01, 0.9999];
    let scene = scene(vec![floor(surface(0.5, 0.3)), tall]);
    let (track, report) = track(&scene, &Settings::default(), 1, 15.0);
    let end = track.poses.last().unwrap().position[1];
    assert!(report.settled_at_s.is_some(), "{report:?}");
    assert!((end - 0.9).abs() < 1e-4, "its centre ends at {end} m");
    assert!(report.max_energy_rise_j < 1e-3 * report.energy_start_j * 0.2 / 1.1, "{report:?}");
}
