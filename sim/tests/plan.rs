//! The plan: what it leaves out is not done, and doing it after all changes the result by no more than a bound.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::{Aspect, Entity, Observer, Phase, Plan, Scene, StepReport, Velocity, Work, World};

/// What sweeps cost beside the full model: a ball that begins to roll, and two cubes that stand on each other, m and rad.
const BALL_SWEPT: f64 = 2e-3;
const PAIR_SWEPT: f64 = 1e-3;
/// Of the angle between equal rotations.
const ROUNDING: f64 = 1e-15;

/// Notes which phases were entered and what was done.
#[derive(Default)]
struct Notes {
    entered: Vec<Phase>,
    work: Work,
}

impl Observer for Notes {
    fn enters(&mut self, phase: Phase) {
        if !self.entered.contains(&phase) {
            self.entered.push(phase);
        }
    }

    fn ended(&mut self, report: &StepReport) -> bool {
        self.work.add(&report.work);
        true
    }
}

fn run(scene: &Scene, plan: &Plan, seconds: f64) -> (World, Notes) {
    let mut world = World::with_plan(scene, &awake(), plan).unwrap();
    let mut notes = Notes::default();
    while world.time_s() < seconds - 1e-9 {
        let report = world.step_observed(&mut notes);
        notes.ended(&report);
    }
    (world, notes)
}

/// Largest distance between the bodies of two worlds, m, and largest angle, rad.
fn difference(a: &World, b: &World) -> (f64, f64) {
    let (a, b) = (a.frame().rigid.unwrap().poses, b.frame().rigid.unwrap().poses);
    let mut largest = (0.0_f64, 0.0_f64);
    for (a, b) in a.iter().zip(b) {
        let apart = nalgebra::Vector3::from(a.position) - nalgebra::Vector3::from(b.position);
        let turn = |q: [f64; 4]| nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::from(q));
        // Twice the vector part: an angle of 1e-9 drowns in the rounding of an arc cosine.
        let angle = 2.0 * (turn(a.rotation).inverse() * turn(b.rotation)).imag().norm();
        largest = (largest.0.max(apart.norm()), largest.1.max(angle));
    }
    largest
}

/// Runs `scene` by its plan and with the full model of `aspect`; the two may differ by no more than `bound`, m and rad.
/// Returns what was done in each.
fn both(scene: &Scene, aspect: Aspect, seconds: f64, bound: f64) -> [Notes; 2] {
    let plan = Plan::of(scene);
    let (cheap, notes) = run(scene, &plan, seconds);
    let (full, full_notes) = run(scene, &plan.clone().with_full(aspect), seconds);
    let (way, angle) = difference(&cheap, &full);
    assert!(way <= bound && angle <= bound, "{}: {way:e} m, {angle:e} rad, bound {bound:e}", aspect.name());
    println!("{}: {way:e} m, {angle:e} rad", aspect.name());
    [notes, full_notes]
}

fn thrown(mut entity: Entity, position: [f64; 3]) -> Entity {
    entity.pose.position = position;
    entity.velocity = Velocity { linear: [1.0, 2.0, -0.5], angular: [1.0, 5.0, 0.3] };
    entity
}

#[test]
fn what_can_meet_nothing_is_not_looked_for() {
    let scene = scene(vec![thrown(cuboid([0.0; 3], [0.1, 0.2, 0.3], 500.0, surface(0.5, 0.5)), [0.0; 3])]);
    let [cheap, full] = both(&scene, Aspect::Meetings, 2.0, 0.0);
    assert_eq!((cheap.work.broad_phases, full.work.broad_phases), (0, 120));
    for phase in [Phase::BroadPhase, Phase::NarrowPhase, Phase::Impacts, Phase::Contacts] {
        assert!(!cheap.entered.contains(&phase), "entered {}", phase.name());
    }
    assert!(full.entered.contains(&Phase::BroadPhase));
}

#[test]
fn what_flies_takes_no_small_steps() {
    let s = surface(0.5, 0.5);
    let scene = scene(vec![
        floor(s),
        thrown(cuboid([0.0; 3], [0.1, 0.2, 0.3], 500.0, s), [0.0, 30.0, 0.0]),
        thrown(cylinder([0.0; 3], 0.3, 0.1, s), [3.0, 30.0, 0.0]),
    ]);
    let [cheap, full] = both(&scene, Aspect::Flight, 2.0, 1e-7);
    assert_eq!((cheap.work.flights, cheap.work.substepped), (240, 0));
    assert_eq!((full.work.flights, full.work.substepped), (0, 240));
    assert!(!cheap.entered.contains(&Phase::Contacts));
}

#[test]
fn a_body_turns_by_the_cheapest_model_for_its_moments() {
    let s = surface(0.5, 0.5);
    let scene = scene(vec![
        thrown(sphere([0.0; 3], 0.2, 500.0, s), [0.0; 3]),
        thrown(cylinder([0.0; 3], 0.3, 0.1, s), [3.0, 0.0, 0.0]),
        thrown(cuboid([0.0; 3], [0.1, 0.2, 0.3], 500.0, s), [6.0, 0.0, 0.0]),
    ]);
    let [cheap, full] = both(&scene, Aspect::Rotation, 5.0, 1e-5);
    let turns =
        |notes: &Notes| [notes.work.isotropic_turns, notes.work.symmetric_turns, notes.work.asymmetric_turns];
    assert_eq!(turns(&cheap), [300, 300, 300]);
    assert_eq!(turns(&full), [0, 0, 900]);
}

#[test]
fn without_restitution_no_impact_is_looked_for() {
    let s = surface(0.5, 0.0);
    let mut ball = sphere([0.0, 1.0, 0.0], 0.3, 800.0, s);
    ball.velocity.linear = [1.0, 0.0, 0.0];
    let scene = scene(vec![floor(s), ball, cube([4.0, 0.8, 0.0], s)]);
    // A plastic landing at 3.7 m/s within a small step h instead of at its moment: v h at most.
    let bound = (2.0 * G * 0.7_f64).sqrt() / (60.0 * f64::from(awake().substeps));
    let [cheap, full] = both(&scene, Aspect::Impacts, 1.5, bound);
    assert_eq!(cheap.work.impact_searches, 0);
    assert!(!cheap.entered.contains(&Phase::Impacts));
    assert!(full.work.impact_searches > 0 && full.entered.contains(&Phase::Impacts));
}

#[test]
fn straight_impacts_are_not_integrated() {
    let s = surface(0.4, 0.7);
    let mut ball = sphere([0.0, 1.0, 0.0], 0.3, 800.0, s);
    ball.velocity = Velocity { linear: [2.0, -1.0, 0.5], angular: [3.0, 0.0, 8.0] };
    let scene = scene(vec![floor(s), ball]);
    let [cheap, full] = both(&scene, Aspect::MicroCollisions, 1.5, 1e-5);
    assert!(cheap.work.straight_impacts > 1 && cheap.work.turning_impacts == 0, "{:?}", cheap.work);
    assert!(full.work.turning_impacts > 1, "{:?}", full.work);
}

#[test]
fn impacts_without_friction_are_one_division() {
    let s = surface(0.0, 0.7);
    let scene = scene(vec![floor(s), sphere([0.0, 1.0, 0.0], 0.3, 800.0, s)]);
    let [cheap, _] = both(&scene, Aspect::MicroCollisions, 1.5, 0.0);
    let Work { frictionless_impacts, straight_impacts, turning_impacts, .. } = cheap.work;
    assert!(frictionless_impacts > 1 && straight_impacts + turning_impacts == 0, "{:?}", cheap.work);
}

#[test]
fn without_friction_there_are_no_friction_rows() {
    let s = surface(0.0, 0.0);
    let mut slides = cube([0.0, 0.5, 0.0], s);
    slides.velocity.linear = [1.0, 0.0, 0.3];
    let scene = scene(vec![floor(s), slides, sphere([3.0, 0.5, 0.0], 0.5, 700.0, s)]);
    let [cheap, full] = both(&scene, Aspect::Friction, 2.0, 1e-15);
    assert_eq!(cheap.work.friction_points, 0);
    assert!(full.work.friction_points > 0);
}

#[test]
fn without_rolling_resistance_nothing_resists_rolling() {
    let s = surface(0.5, 0.0);
    let mut rolls = sphere([0.0, 0.5, 0.0], 0.5, 700.0, s);
    rolls.velocity.linear = [1.0, 0.0, 0.3];
    let scene = scene(vec![floor(s), rolls]);
    let [cheap, full] = both(&scene, Aspect::Rolling, 2.0, 0.0);
    assert_eq!(cheap.work.rolling_points, 0);
    assert!(!cheap.entered.contains(&Phase::Rolling));
    assert!(full.work.rolling_points > 0 && full.entered.contains(&Phase::Rolling));
}

fn swept(notes: &Notes) -> u64 {
    notes.work.substepped - notes.work.lone_bodies - notes.work.direct_bodies
}

#[test]
fn a_lone_body_is_not_swept() {
    let s = surface(0.5, 0.0);
    let mut tilted = cube([0.0, 1.0, 0.0], s);
    tilted.velocity = Velocity { linear: [1.0, 0.0, 0.5], angular: [1.0, 0.3, 2.0] };
    // Alone it has the full model already.
    let [cheap, full] = both(&scene(vec![floor(s), tilted]), Aspect::Islands, 2.0, ROUNDING);
    assert!(cheap.work.lone_bodies > 60 && cheap.work.direct_bodies == 0, "{:?}", cheap.work);
    assert_eq!((swept(&cheap), swept(&full)), (0, 0));
}

#[test]
fn a_ball_is_swept() {
    let s = surface(0.5, 0.0);
    let mut rolls = sphere([0.0, 0.5, 0.0], 0.5, 700.0, s);
    rolls.velocity.linear = [1.0, 0.0, 0.3];
    let [cheap, full] = both(&scene(vec![floor(s), rolls]), Aspect::Islands, 2.0, BALL_SWEPT);
    assert!(cheap.work.lone_bodies + cheap.work.direct_bodies == 0 && swept(&cheap) == 120);
    assert_eq!((full.work.lone_bodies, swept(&full)), (120, 0));
}

#[test]
fn two_light_cubes_are_swept_and_a_heavy_one_on_a_light_one_is_solved_directly() {
    let s = surface(0.5, 0.0);
    let pile = |heavy: f64| {
        let upper = cuboid([0.1, 1.5, 0.0], [0.5; 3], 1000.0 * heavy, s);
        scene(vec![floor(s), cube([0.0, 0.5, 0.0], s), upper])
    };
    let [cheap, full] = both(&pile(1.0), Aspect::Islands, 2.0, PAIR_SWEPT);
    assert_eq!((cheap.work.direct_bodies, swept(&cheap)), (0, 240));
    assert_eq!((full.work.direct_bodies, swept(&full)), (240, 0));
    let [chosen, full] = both(&pile(10.0), Aspect::Islands, 2.0, ROUNDING);
    assert_eq!((chosen.work.direct_bodies, full.work.direct_bodies), (240, 240));
}

#[test]
fn every_aspect_is_explained() {
    for exhibit in sim::gallery::all() {
        let plan = Plan::of(&(exhibit.scene)());
        for aspect in Aspect::ALL {
            let choices: Vec<_> =
                plan.choices().into_iter().filter(|choice| choice.aspect == aspect).collect();
            assert!(!choices.is_empty(), "{}: nothing on {}", exhibit.name, aspect.name());
            assert!(choices.iter().all(|choice| !choice.reason.is_empty() && !choice.model.is_empty()));
            assert!(plan.to_string().contains(aspect.name()));
        }
    }
    // Degenerate input is planned, and refused by the world.
    let mut bad = scene(vec![cube([0.0; 3], surface(f64::NAN, f64::NAN))]);
    if let sim::Motion::Dynamic(mass) = &mut bad.entities[0].motion {
        mass.inertia_kg_m2 = [f64::NAN; 6];
    }
    assert!(!Plan::of(&bad).to_string().is_empty());
    assert!(World::new(&bad, &awake()).is_err());
}
