//! What must hold whatever the scene: the same bits again, the same motion elsewhere, no bad body among good ones.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::{Action, Change, Event, Pose, Precision, SceneError, Settings, Velocity, World, gallery};

fn hash_after(name: &str, seconds: f64) -> u64 {
    let scene = (gallery::by_name(name).unwrap().scene)();
    let settings = Settings::default();
    let mut world = World::new(&scene, &settings).unwrap();
    while world.time_s() < seconds - 1e-9 {
        world.step();
    }
    world.state_hash()
}

/// The same bits in debug and release. A change of the solver changes them: put in what is
/// printed, after looking at what changed.
#[test]
fn gallery_ends_in_the_known_state() {
    let golden = [
        ("seed-8e", 2.0, 1_269_278_816_548_506_154),
        ("seed-9", 2.0, 16_463_592_333_284_564_417),
        ("mass-ratio-10", 1.0, 2_629_740_294_257_880_933),
        ("stack-20", 0.5, 17_345_688_375_602_632_691),
    ];
    let found: Vec<_> = golden.iter().map(|(name, t, _)| (*name, *t, hash_after(name, *t))).collect();
    assert_eq!(found, golden, "the state hashes of today");
}

#[test]
fn bits_are_the_same_for_any_kernel_and_number_of_threads() {
    let state = |simd, threads| {
        let settings = Settings { simd, threads, ..Settings::default() };
        let mut world = World::new(&(gallery::by_name("seed-8g").unwrap().scene)(), &settings).unwrap();
        for _ in 0..30 {
            world.step();
        }
        world.state_hash()
    };
    let reference = state(true, 1);
    assert_eq!(state(false, 1), reference, "the portable twin");
    assert_eq!(state(true, 2), reference, "two threads");
    assert_eq!(state(false, 3), reference, "three threads, portable");
}

#[test]
fn saved_state_continues_with_the_same_bits() {
    // A wall while it stands, one that is being hit, and one that bounces: cache, actions and impacts under way.
    for (name, until) in [("seed-8f", 100), ("seed-8f", 135), ("seed-9", 80)] {
        let scene = (gallery::by_name(name).unwrap().scene)();
        let mut world = World::new(&scene, &Settings::default()).unwrap();
        let go = |world: &mut World, steps: u32| (0..steps).for_each(|_| _ = world.step());
        go(&mut world, until);
        let saved = world.save();
        go(&mut world, 40);
        let expected = world.state_hash();
        world.restore(&saved);
        go(&mut world, 40);
        assert_eq!(world.state_hash(), expected, "{name} from step {until} in the same world");
        let mut other = World::new(&scene, &Settings::default()).unwrap();
        other.restore(&saved);
        go(&mut other, 40);
        assert_eq!(other.state_hash(), expected, "{name} from step {until} in another world");
    }
}

#[test]
fn single_precision_agrees_with_the_reference() {
    let height = |precision| {
        let settings = Settings { precision, sleeping: false, ..Settings::default() };
        let mut world = World::new(&(gallery::by_name("seed-8f").unwrap().scene)(), &settings).unwrap();
        for _ in 0..60 {
            world.step();
        }
        let poses = world.frame().rigid.unwrap().poses.to_vec();
        poses.iter().map(|pose| pose.position[1]).collect::<Vec<_>>()
    };
    let (single, double) = (height(Precision::Single), height(Precision::Double));
    let apart = single.iter().zip(&double).map(|(s, d)| (s - d).abs()).fold(0.0, f64::max);
    assert!(apart < 5e-4, "a standing wall differs by {apart} m");
}

#[test]
fn motion_is_the_same_a_hundred_kilometres_away() {
    let drop = |offset: f64| {
        let mut entities = vec![
            floor(surface(0.5, 0.4)),
            cuboid([0.0, 1.0, 0.0], [0.3, 0.2, 0.4], 700.0, surface(0.5, 0.4)),
            sphere([0.1, 2.0, 0.0], 0.25, 2000.0, surface(0.5, 0.4)),
        ];
        for entity in &mut entities {
            entity.pose.position[0] += offset;
            entity.pose.position[2] -= offset;
        }
        let (track, _) = track(&scene(entities), &awake(), 1, 1.0);
        let end = track.poses.last().unwrap().position;
        [end[0] - offset, end[1], end[2] + offset]
    };
    let (here, there) = (drop(0.0), drop(131_072.0));
    for axis in 0..3 {
        assert!((here[axis] - there[axis]).abs() < 1e-6, "{here:?} against {there:?}");
    }
}

#[test]
fn momentum_is_kept_between_free_bodies() {
    let mut a = cuboid([-1.0, 0.05, 0.1], [0.3, 0.2, 0.4], 700.0, surface(0.4, 0.5));
    a.velocity = Velocity { linear: [3.0, 0.2, -0.1], angular: [1.0, -2.0, 0.5] };
    let mut b = cuboid([0.6, 0.0, 0.0], [0.2, 0.5, 0.2], 1200.0, surface(0.4, 0.5));
    b.velocity.angular = [0.0, 0.0, 4.0];
    let mut scene = scene(vec![a, b]);
    scene.gravity = [0.0; 3];
    let mut world = World::new(&scene, &awake()).unwrap();
    let mass = [700.0 * 0.192, 1200.0 * 0.16];
    let momentum = |world: &World| {
        let velocities = world.frame().rigid.unwrap().velocities.to_vec();
        [0, 1, 2].map(|k| mass[0] * velocities[0].linear[k] + mass[1] * velocities[1].linear[k])
    };
    let before = momentum(&world);
    let mut met = false;
    for _ in 0..60 {
        met |= world.step().impacts > 0;
    }
    let after = momentum(&world);
    assert!(met, "they pass without a touch");
    for k in 0..3 {
        assert!((before[k] - after[k]).abs() < 1e-9 * mass[0], "{before:?} became {after:?}");
    }
}

#[test]
fn body_without_a_finite_state_is_taken_out_and_the_rest_goes_on() {
    let mut wild = sphere([5.0, 1.0, 0.0], 0.5, 1000.0, surface(0.5, 0.0));
    wild.velocity.linear = [1.7e308, 0.0, 0.0];
    let scene = scene(vec![floor(surface(0.5, 0.0)), wild, cube([0.0, 0.5, 0.0], surface(0.5, 0.0))]);
    let mut world = World::new(&scene, &awake()).unwrap();
    let mut quarantined = false;
    for _ in 0..120 {
        world.step();
        quarantined |= world.frame().events.contains(&Event::Quarantined { entity: 1 });
    }
    let poses = world.frame().rigid.unwrap().poses.to_vec();
    assert!(quarantined, "the wild body goes unnoticed");
    assert!(poses.iter().flat_map(|pose| pose.position).all(f64::is_finite));
    assert!((poses[2].position[1] - 0.5).abs() < 1e-3, "the cube ends at {:?}", poses[2].position);
}

#[test]
fn bad_scenes_are_refused_with_the_way_out() {
    let good = || vec![floor(surface(0.5, 0.0)), cube([0.0, 0.5, 0.0], surface(0.5, 0.0))];
    let refuse = |change: &dyn Fn(&mut sim::Scene)| {
        let mut scene = scene(good());
        change(&mut scene);
        World::new(&scene, &Settings::default()).err()
    };
    assert!(matches!(
        refuse(&|s| s.entities[1].pose.position[0] = f64::NAN),
        Some(SceneError::NotFinite { what: "position", .. })
    ));
    assert!(matches!(
        refuse(&|s| s.entities[1].shapes[0].shape = sim::Shape::HalfSpace),
        Some(SceneError::StaticOnly { .. })
    ));
    assert!(matches!(
        refuse(&|s| s.entities[1].shapes[0].shape = sim::Shape::Hull { points: vec![[0.0; 3]; 5] }),
        Some(SceneError::Shape { .. })
    ));
    assert!(matches!(
        refuse(&|s| s.entities[1].shapes[0].surface.restitution = 1.2),
        Some(SceneError::Surface { .. })
    ));
    assert!(matches!(
        refuse(&|s| {
            let change = Change::SetPose(Pose::at([f64::INFINITY, 0.0, 0.0]));
            s.actions.push(Action { time_s: 0.0, entity: 1, change });
        }),
        Some(SceneError::Action { .. })
    ));
    assert!(refuse(&|_| {}).is_none());
}
