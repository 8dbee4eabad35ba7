//! Openings that matter stay open: what a thing is for still works once its collider stands for it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may stop and say so")]

use std::f64::consts::TAU;

use importer::collider::{Shape as FileShape, cheapest, ladder, surface};
use importer::{Options, measure, weld};
use mapper::scene::{COLLIDER_TOLERANCE, Placement, child, floor_entity};
use physique::demo::Mesh;
use sim::{ChildShape, Entity, Mass, Motion, Pose, Scene, Settings, Shape, Surface, Velocity, World};

const SURFACE: Surface = Surface::new(0.5, 0.0);

/// The collider that the default tolerance chooses for a mesh, in metres, Y up.
fn collider(mesh: &Mesh) -> Vec<FileShape> {
    let mesh = importer::Mesh { positions: mesh.positions.clone(), triangles: mesh.triangles.clone() };
    let welded = weld(&mesh);
    let options = Options { collider_tolerance: COLLIDER_TOLERANCE, ..Options::default() };
    let ladder = ladder(&welded.mesh, &measure(&welded), &options);
    cheapest(&ladder, COLLIDER_TOLERANCE).expect("a collider").shapes.clone()
}

fn fixed(name: &str, shapes: &[FileShape]) -> Entity {
    let placement = Placement { metres_per_unit: 1.0, body_from_file: Pose::IDENTITY };
    Entity {
        name: name.to_owned(),
        motion: Motion::Static,
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes: shapes.iter().map(|shape| child(shape, &placement, SURFACE)).collect(),
    }
}

fn moving(name: &str, shape: Shape, radius: f64, position: [f64; 3], linear: [f64; 3]) -> Entity {
    let moment = 0.4 * 0.1 * radius * radius;
    Entity {
        name: name.to_owned(),
        motion: Motion::Dynamic(Mass {
            mass_kg: 0.1,
            inertia_kg_m2: [moment, moment, moment, 0.0, 0.0, 0.0],
        }),
        pose: Pose::at(position),
        velocity: Velocity { linear, ..Velocity::default() },
        shapes: vec![ChildShape { shape, body_from_shape: Pose::IDENTITY, surface: SURFACE, part: 0 }],
    }
}

/// Where the last entity is after `seconds`.
fn after(seconds: f64, entities: Vec<Entity>) -> [f64; 3] {
    let scene = Scene {
        name: "opening".to_owned(),
        gravity: Scene::GRAVITY,
        entities,
        actions: Vec::new(),
        pairs: Vec::new(),
    };
    let settings = Settings::default();
    let mut world = World::new(&scene, &settings).expect("a scene");
    for _ in 0..(seconds / settings.dt_s).round() as u32 {
        world.step();
    }
    let frame = world.frame();
    frame.rigid.expect("bodies").poses.last().expect("an entity").position
}

#[test]
fn a_mug_holds_a_ball() {
    let wall = [(0.0, 0.0), (0.040, 0.0), (0.042, 0.095), (0.038, 0.095), (0.036, 0.006), (0.0, 0.006)];
    let handle: Vec<[f64; 3]> = (0..=16)
        .map(|step| TAU / 2.0 * f64::from(step) / 16.0)
        .map(|angle| [0.039 + 0.030 * angle.sin(), 0.048 + 0.028 * angle.cos(), 0.0])
        .collect();
    let mug = collider(&Mesh::lathe(&wall, 48).and(&Mesh::tube(&handle, 0.0055, 12)));
    let radius = 0.012;
    let ball = moving("ball", Shape::Sphere { radius }, radius, [0.008, 0.13, 0.004], [0.0; 3]);
    let [x, y, z] = after(2.0, vec![floor_entity(SURFACE), fixed("mug", &mug), ball]);
    assert!(x.hypot(z) < 0.036, "left the mug: {x} {y} {z}");
    assert!((y - (0.006 + radius)).abs() < 0.004, "not on the bottom: {y}");
}

#[test]
fn a_ring_lets_a_rod_pass() {
    let section: Vec<(f64, f64)> = (0..=24)
        .map(|step| TAU * f64::from(step) / 24.0)
        .map(|angle| (0.10 + 0.02 * angle.cos(), 0.2 + 0.02 * angle.sin()))
        .collect();
    let ring = collider(&Mesh::lathe(&section, 48));
    let rod = Shape::Capsule { half_height: 0.08, radius: 0.06 };
    // The hole is 16 cm across, the rod 12 cm: 2 cm all around.
    let [x, y, z] =
        after(0.45, vec![fixed("ring", &ring), moving("rod", rod, 0.06, [0.0, 0.5, 0.0], [0.0; 3])]);
    let fallen = 0.5 - 0.5 * 9.81 * 0.45 * 0.45;
    assert!((y - fallen).abs() < 0.02 && x.hypot(z) < 1e-6, "touched the ring: {x} {y} {z}, free {fallen}");
}

#[test]
fn a_ball_rolls_under_a_table() {
    let mut table = Mesh::cuboid([0.6, 0.02, 0.4], 0.004).at([0.0, 0.72, 0.0]);
    for (x, z) in [(-0.55, -0.35), (-0.55, 0.35), (0.55, -0.35), (0.55, 0.35)] {
        table = table.and(&Mesh::cuboid([0.025, 0.352, 0.025], 0.003).at([x, 0.352, z]));
    }
    let shapes = collider(&table);
    assert_eq!(shapes.len(), 5);
    assert!(shapes.iter().all(|shape| matches!(shape, FileShape::Box { .. })), "{shapes:?}");
    let radius = 0.1;
    let ball = moving("ball", Shape::Sphere { radius }, radius, [-1.2, radius, 0.0], [3.0, 0.0, 0.0]);
    let [x, _, z] = after(2.0, vec![floor_entity(SURFACE), fixed("table", &shapes), ball]);
    assert!(x > 1.0 && z.abs() < 1e-6, "stopped under the table: {x} {z}");
}

#[test]
fn a_door_frame_stays_open() {
    let frame = Mesh::cuboid([0.05, 1.0, 0.06], 0.003)
        .at([-0.5, 1.0, 0.0])
        .and(&Mesh::cuboid([0.05, 1.0, 0.06], 0.003).at([0.5, 1.0, 0.0]))
        .and(&Mesh::cuboid([0.55, 0.05, 0.06], 0.003).at([0.0, 2.05, 0.0]));
    let shapes = collider(&frame);
    for shape in &shapes {
        let (corners, _) = surface(shape);
        // A shape that reaches across the opening has corners on both sides of it below the lintel.
        let low = corners.iter().filter(|p| p[1] < 1.9);
        let (left, right) = low.fold((false, false), |(l, r), p| (l || p[0] < 0.0, r || p[0] > 0.0));
        assert!(!(left && right), "{shape:?} closes the door");
    }
}
