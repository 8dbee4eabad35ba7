//! What is left of Lagrange's equations (see `sim::mechanics`) along recorded trajectories.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use nalgebra::Vector3;
use sim::mechanics::{RESIDUAL_POSES, Residual};
use sim::{Frame, FrameSink, Mass, Motion, Pose, RunLimit, Scene, Settings, Shape};

/// Poses of one entity, and force and moment of its contacts as their multipliers give them, a row a step.
struct Record {
    entity: usize,
    dt: f64,
    poses: Vec<Pose>,
    contacts: Vec<[Vector3<f64>; 2]>,
}

impl FrameSink for Record {
    fn begin(&mut self, _: &Scene, _: &Settings) {}

    fn frame(&mut self, frame: &Frame<'_>) {
        let pose = frame.rigid.unwrap().poses[self.entity];
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for point in frame.contacts.unwrap().points {
            let sign = match self.entity {
                e if e == point.a as usize => -1.0,
                e if e == point.b as usize => 1.0,
                _ => continue,
            };
            let impulse = Vector3::from(point.normal) * point.normal_impulse_n_s
                + Vector3::from(point.friction_impulse_n_s);
            let on_body = impulse * (sign / self.dt);
            force += on_body;
            moment += (Vector3::from(point.position) - Vector3::from(pose.position)).cross(&on_body);
        }
        self.poses.push(pose);
        self.contacts.push([force, moment]);
    }

    fn end(&mut self) {}
}

/// Largest force (N) and moment (N m) that the trajectory of an entity implies and its contacts do not give, from
/// `from_s` on.
fn unexplained(scene: &Scene, dt: f64, entity: usize, from_s: f64, seconds: f64) -> (f64, f64) {
    let settings = Settings { dt_s: dt, ..awake() };
    let mut record = Record { entity, dt, poses: Vec::new(), contacts: Vec::new() };
    let limit = RunLimit { max_time_s: seconds, stop_at_rest: false };
    sim::run(scene, &settings, &limit, &mut [&mut record]).unwrap();
    let Motion::Dynamic(mass) = scene.entities[entity].motion else { panic!("it moves") };
    let first = (from_s / dt) as usize;
    let mut largest = (0.0_f64, 0.0_f64);
    for i in first..record.poses.len() - RESIDUAL_POSES {
        let poses: &[Pose; RESIDUAL_POSES] = record.poses[i..i + RESIDUAL_POSES].try_into().unwrap();
        let residual = Residual::at(poses, &mass, scene.gravity, dt);
        let [force, moment] = record.contacts[i + RESIDUAL_POSES / 2];
        largest.0 = largest.0.max((Vector3::from(residual.force_n) - force).norm());
        largest.1 = largest.1.max((Vector3::from(residual.moment_n_m) - moment).norm());
    }
    println!("force {:e} N, moment {:e} N m", largest.0, largest.1);
    largest
}

#[test]
fn free_asymmetric_rotation() {
    let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] };
    let mut top = body("top", mass, [0.0; 3], Shape::Sphere { radius: 0.5 }, surface(0.5, 0.0));
    top.velocity.angular = [0.01, 5.0, 0.01];
    let mut scene = scene(vec![top]);
    scene.gravity = [0.0; 3];
    // Ω × I Ω is of the order of 25 N m.
    let (force, moment) = unexplained(&scene, 1.0 / 960.0, 0, 0.0, 6.0);
    assert!(force < 1e-12 && moment < 1e-6 * 25.0, "{force} N, {moment} N m");
}

#[test]
fn projectile_with_a_regular_precession() {
    let mut thrown = cylinder([0.0, 1000.0, 0.0], 0.3, 0.1, surface(0.5, 0.0));
    thrown.velocity.linear = [30.0, 20.0, -5.0];
    thrown.velocity.angular = [2.0, 6.0, 1.0];
    let Motion::Dynamic(mass) = thrown.motion else { panic!("it moves") };
    let (force, moment) = unexplained(&scene(vec![thrown]), 1.0 / 240.0, 0, 0.0, 4.0);
    let weight = mass.mass_kg * G;
    assert!(force < 1e-7 * weight, "{force} N of {weight} N");
    let scale = mass.inertia_kg_m2[0] * 41.0;
    assert!(moment < 1e-5 * scale, "{moment} N m of {scale} N m");
}

#[test]
fn contacts_give_the_forces_that_the_motion_needs() {
    let s = surface(0.5, 0.0);
    let on_slope = |entity, degrees| {
        let mut scene = scene(vec![floor(s), entity]);
        scene.gravity = slope(degrees);
        scene
    };
    let weight = 1000.0 * G;
    let bound = 1e-3;
    for (name, scene, speed) in [
        ("resting cube", on_slope(cube([0.0, 0.5, 0.0], s), 20.0), 0.0),
        ("sliding cube", on_slope(cube([0.0, 0.5, 0.0], s), 30.0), 1.0),
        ("rolling ball", on_slope(sphere([0.0, 0.5, 0.0], 0.5, 1000.0, s), 20.0), 3.6),
    ] {
        let dt = 1.0 / 480.0;
        let (force, moment) = unexplained(&scene, dt, 1, 0.5, 1.5);
        assert!(force < bound * weight, "{name}: {force} N of {weight} N");
        // A point lies where it was at some moment of the step: its arm is known to v dt.
        let known = bound * 0.5 + speed * dt;
        assert!(moment < known * weight, "{name}: {moment} N m of {} N m", weight * 0.5);
    }
}
