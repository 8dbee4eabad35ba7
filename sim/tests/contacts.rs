//! What contacts must not do: kick over seams, let the fast through, or break on shapes that are hardly any.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::*;
use sim::gallery::build::{cylinder, fixed, noise};
use sim::{Entity, HeightField, Mass, Pose, Scene, SceneError, Settings, Shape, World};

const SLICK: sim::Surface = sim::Surface::new(0.0, 0.0);

/// A flat ground of `cells` along X from -1 on and `strips` along Z about 0, each `along` by `across` metres.
fn triangles(cells: u32, along: f64, strips: u32, across: f64) -> Shape {
    let (columns, rows) = (cells + 1, strips + 1);
    let positions = (0..rows)
        .flat_map(|row| {
            (0..columns).map(move |column| {
                [f64::from(column) * along - 1.0, 0.0, (f64::from(row) - 0.5 * f64::from(strips)) * across]
            })
        })
        .collect();
    let mut faces = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..cells {
            let at = row * columns + column;
            faces.extend([[at, at + columns, at + 1], [at + 1, at + columns, at + columns + 1]]);
        }
    }
    Shape::TriangleMesh { positions, triangles: faces }
}

/// Grounds that are flat: meshes of squares and of slivers, a height field, tiles that are one body each.
fn grounds(length: f64) -> Vec<(&'static str, Vec<Entity>)> {
    let one = |shape| vec![fixed("ground", Pose::IDENTITY, shape, SLICK)];
    let columns = (length / 0.5) as u32 + 1;
    let field = HeightField { heights: vec![0.0; (5 * columns) as usize], columns, spacing: [0.5, 1.0] };
    let middle = 0.25 * f64::from(columns - 1) - 1.0;
    let field = fixed("ground", Pose::at([middle, 0.0, 0.0]), Shape::HeightField(field), SLICK);
    let tile = |i: u32| {
        let shape = Shape::Box { half_extents: [0.5, 0.25, 2.0] };
        fixed("tile", Pose::at([f64::from(i) - 0.5, -0.25, 0.0]), shape, SLICK)
    };
    vec![
        ("squares", one(triangles((length / 0.7) as u32, 0.7, 4, 0.6))),
        ("slivers", one(triangles((length / 2.0) as u32, 2.0, 120, 0.02))),
        ("height field", vec![field]),
        ("tiles", (0..length as u32).map(tile).collect()),
    ]
}

fn sliders() -> Vec<(&'static str, Entity)> {
    let lying = Pose { position: [0.0, 0.25, 0.0], rotation: [0.5_f64.sqrt(), 0.0, 0.0, 0.5_f64.sqrt()] };
    let mut roller = cylinder([0.0, 0.25, 0.0], 0.4, 0.25, 1000.0, SLICK);
    roller.pose = lying;
    let mass = Mass { mass_kg: 100.0, inertia_kg_m2: [4.0, 4.0, 4.0, 0.0, 0.0, 0.0] };
    let mut pill =
        body("capsule", mass, [0.0, 0.25, 0.0], Shape::Capsule { half_height: 0.3, radius: 0.25 }, SLICK);
    pill.pose = lying;
    vec![
        ("box", cuboid([0.0, 0.25, 0.0], [0.25; 3], 1000.0, SLICK)),
        ("sphere", sphere([0.0, 0.25, 0.0], 0.25, 1000.0, SLICK)),
        ("drum", cylinder([0.0, 0.25, 0.0], 0.25, 0.25, 1000.0, SLICK)),
        ("roller", roller),
        ("capsule", pill),
    ]
}

#[test]
fn seams_of_triangles_and_tiles_give_no_kick() {
    let mut worst = Vec::new();
    for speed in [1.0, 5.0, 20.0] {
        for (ground, ground_bodies) in grounds(2.0 * speed + 4.0) {
            for (name, mut slider) in sliders() {
                // Not along the grid, so that seams are met at every angle and corner.
                slider.velocity.linear = [speed, 0.0, 0.01 * speed];
                let mut entities = ground_bodies.clone();
                entities.push(slider);
                let index = entities.len() - 1;
                let mut world = World::new(&scene(entities), &awake()).unwrap();
                let mut kick = 0.0_f64;
                for step in 0..90 {
                    world.step();
                    if step < 5 {
                        // It finds its rest height.
                        continue;
                    }
                    let frame = world.frame();
                    let [x, y, z] = frame.rigid.unwrap().velocities[index].linear;
                    let off = [x - speed, y, z - 0.01 * speed].iter().map(|v| v * v).sum::<f64>().sqrt();
                    kick = kick.max(off / speed);
                }
                worst.push((kick, format!("{name} on {ground} at {speed} m/s: {kick:.1e}")));
            }
        }
    }
    worst.sort_by(|a, b| b.0.total_cmp(&a.0));
    let bad: Vec<&String> = worst.iter().filter(|(kick, _)| *kick > 1e-3).map(|(_, text)| text).collect();
    println!("worst: {}", worst[0].1);
    assert!(bad.is_empty(), "{bad:#?}");
}

/// A projectile in flight without gravity, before an obstacle about the origin.
fn shot(mut projectile: Entity, velocity: [f64; 3], spin: [f64; 3], obstacle: Entity) -> Scene {
    projectile.velocity.linear = velocity;
    projectile.velocity.angular = spin;
    Scene { gravity: [0.0; 3], ..scene(vec![obstacle, projectile]) }
}

#[test]
fn nothing_passes_a_thin_wall_however_fast() {
    let s = surface(0.3, 0.0);
    let wall = |turn: f64| {
        let pose = Pose { position: [0.0; 3], rotation: [0.0, 0.0, (0.5 * turn).sin(), (0.5 * turn).cos()] };
        fixed("wall", pose, Shape::Box { half_extents: [0.005, 2.0, 2.0] }, s)
    };
    let sheet = {
        let positions = vec![[0.0, -2.0, -2.0], [0.0, 2.0, -2.0], [0.0, 2.0, 2.0], [0.0, -2.0, 2.0]];
        // Faces -x, where the shots come from.
        let triangles = vec![[0, 2, 1], [0, 3, 2]];
        fixed("sheet", Pose::IDENTITY, Shape::TriangleMesh { positions, triangles }, s)
    };
    let rod = || cuboid([0.0; 3], [0.01, 0.5, 0.01], 7800.0, s);
    let coin = || cylinder([0.0; 3], 0.002, 0.02, 7800.0, s);
    let mut passed: Vec<String> = Vec::new();
    let mut shots = 0;
    for speed in [30.0, 70.0, 120.0, 250.0, 500.0] {
        for (name, projectile, spin) in [
            ("bullet", sphere([0.0; 3], 0.005, 7800.0, s), [0.0; 3]),
            ("die", cuboid([0.0; 3], [0.01; 3], 1000.0, s), [10.0, 20.0, 30.0]),
            ("rod", rod(), [0.0, 0.0, 0.0]),
            ("whirling rod", rod(), [0.0, 0.0, 60.0]),
            ("coin", coin(), [20.0, 0.0, 50.0]),
        ] {
            for (obstacle_name, obstacle) in
                [("wall", wall(0.0)), ("leaning wall", wall(0.6)), ("sheet", sheet.clone())]
            {
                for i in 0..20 {
                    shots += 1;
                    let mut projectile = projectile.clone();
                    projectile.pose.position = [
                        -1.5 - 0.37 * f64::from(i % 6),
                        0.8 * (noise(i, 1) - 0.5),
                        0.8 * (noise(i, 2) - 0.5),
                    ];
                    let scene = shot(
                        projectile,
                        [speed, 0.1 * speed * (noise(i, 3) - 0.5), 0.0],
                        spin,
                        obstacle.clone(),
                    );
                    let mut world = World::new(&scene, &awake()).unwrap();
                    let mut farthest = f64::NEG_INFINITY;
                    for _ in 0..30 {
                        world.step();
                        let [x, y, _] = world.frame().rigid.unwrap().poses[1].position;
                        let lean = if obstacle_name == "leaning wall" { 0.6_f64 } else { 0.0 };
                        // Behind the wall, along its normal, and beside its face.
                        let behind = x * lean.cos() + y * lean.sin();
                        let beside = (y * lean.cos() - x * lean.sin()).abs() < 1.9;
                        if beside {
                            farthest = farthest.max(behind);
                        }
                    }
                    if farthest > 0.02 {
                        println!("{name} {i} at {speed} m/s is {farthest} m behind the {obstacle_name}");
                        passed.push(format!("{name} {i} at {speed} through the {obstacle_name}"));
                    }
                }
            }
        }
    }
    assert!(passed.is_empty(), "{} of {shots} shots: {passed:#?}", passed.len());
}

#[test]
fn the_fast_meet_what_moves_too() {
    let s = surface(0.3, 0.0);
    for speed in [50.0, 300.0] {
        // A plate of a centimetre, free to move, hit in its middle: momentum is handed over.
        let plate = cuboid([0.0; 3], [0.005, 0.5, 0.5], 7800.0, s);
        let mut bullet = sphere([-2.3, 0.0, 0.0], 0.02, 7800.0, s);
        bullet.velocity.linear = [speed, 0.0, 0.0];
        let mut other = plate.clone();
        other.velocity.linear = [-speed, 0.0, 0.0];
        other.pose.position = [3.1, 0.0, 0.0];
        let mut world =
            World::new(&Scene { gravity: [0.0; 3], ..scene(vec![plate, bullet, other]) }, &awake()).unwrap();
        for _ in 0..30 {
            world.step();
            let frame = world.frame();
            let x: Vec<f64> = frame.rigid.unwrap().poses.iter().map(|pose| pose.position[0]).collect();
            assert!(x[1] < x[0] && x[0] < x[2] + 0.02, "at {speed} m/s the order is lost: {x:?}");
        }
    }
}

#[test]
fn a_slab_falls_onto_a_mesh_and_stays_above_it() {
    let s = surface(0.5, 0.0);
    for speed in [10.0, 100.0] {
        for half in [[5.0, 0.015, 5.0], [1.0, 0.03, 1.0]] {
            let mut slab = cuboid([7.0, 2.0, 0.1], half, 1000.0, s);
            slab.velocity.linear = [0.0, -speed, 0.0];
            let ground = fixed("ground", Pose::IDENTITY, triangles(24, 0.7, 4, 3.6), s);
            let mut world = World::new(&scene(vec![ground, slab]), &awake()).unwrap();
            for _ in 0..120 {
                world.step();
            }
            let pose = world.frame().rigid.unwrap().poses[1];
            assert!(
                (pose.position[1] - half[1]).abs() < 5e-3,
                "slab {half:?} at {speed} m/s ends at {pose:?}"
            );
        }
    }
}

#[test]
fn shapes_that_are_hardly_any_are_refused_and_poor_ones_work() {
    let s = surface(0.5, 0.0);
    let with = |shape: Shape| {
        let mut entity = cuboid([0.0, 0.6, 0.0], [0.5; 3], 1000.0, s);
        entity.shapes[0].shape = shape;
        World::new(&scene(vec![floor(s), entity]), &Settings::default())
    };
    let hull = |points: Vec<[f64; 3]>| Shape::Hull { points };
    let square = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    for refused in [
        hull(square.clone()),
        hull(vec![[0.3; 3]; 20]),
        hull((0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect()),
        hull(vec![[f64::NAN; 3]; 4]),
        Shape::Cone { half_height: 0.0, radius: 1.0 },
        Shape::Box { half_extents: [1.0, f64::INFINITY, 1.0] },
    ] {
        let error = with(refused.clone()).err().unwrap_or_else(|| panic!("{refused:?} was taken"));
        assert!(matches!(error, SceneError::Shape { .. }), "{error}");
    }
    // Twelve corners on every face of a cube, a ball of 128 corners, a sliver: poor, but shapes.
    let crowded = (0..72).map(|i| {
        let (face, u, v) = (i % 6, noise(i, 1) - 0.5, noise(i, 2) - 0.5);
        let mut point = [u, v, if face < 3 { 0.5 } else { -0.5 }];
        point.rotate_right((face % 3) as usize);
        point
    });
    let ball = (0..128).map(|i| {
        let v = [1, 2, 3].map(|k| noise(i, k) - 0.5);
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| 0.5 * x / length)
    });
    let sliver = square.iter().flat_map(|p| [*p, [p[0], 1e-3, p[2]]]);
    for points in [crowded.collect::<Vec<_>>(), ball.collect(), sliver.collect()] {
        let mut world = with(hull(points.clone())).unwrap();
        for _ in 0..120 {
            assert_eq!(world.step().quarantined, 0);
        }
        let pose = world.frame().rigid.unwrap().poses[1];
        assert!(pose.position.iter().all(|x| x.abs() < 3.0), "{} points end at {pose:?}", points.len());
    }
}

#[test]
fn overlapping_starts_part_without_a_burst() {
    let s = surface(0.5, 0.0);
    for overlap in [0.25, 0.9, 1.0] {
        for (name, a, b) in [
            ("cubes", cube([0.0, 0.5, 0.0], s), cube([0.0, 1.5 - overlap, 0.0], s)),
            (
                "spheres",
                sphere([0.0, 0.5, 0.0], 0.5, 1000.0, s),
                sphere([0.0, 1.5 - overlap, 0.0], 0.5, 1000.0, s),
            ),
            (
                "cylinders",
                cylinder([0.0, 0.5, 0.0], 0.5, 0.5, 1000.0, s),
                cylinder([0.0, 1.5 - overlap, 0.0], 0.5, 0.5, 1000.0, s),
            ),
        ] {
            let mut world = World::new(&scene(vec![floor(s), a, b]), &awake()).unwrap();
            let limit = Settings::default().max_push_speed_m_s;
            let mut fastest = 0.0_f64;
            for _ in 0..120 {
                world.step();
                for velocity in world.frame().rigid.unwrap().velocities {
                    fastest = fastest.max(velocity.linear.iter().map(|v| v * v).sum::<f64>().sqrt());
                }
            }
            // It may fall from where it was pushed to.
            let fall = (2.0 * G * (1.0 + overlap)).sqrt();
            assert!(fastest < limit + fall, "{name} sunk by {overlap}: {fastest} m/s");
        }
    }
}
