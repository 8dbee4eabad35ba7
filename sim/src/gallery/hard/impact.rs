//! H7, H9, H12, H18 and H20: dominoes, restitution, what is too fast or too thin, overlapping starts.

use crate::gallery::build::{
    child, cube, cuboid, cylinder, fixed, floor, scene, sphere, surface, then, turn,
};
use crate::gallery::criterion::Criterion;
use crate::gallery::figure::{end_depth, energy_rise};
use crate::gallery::{Exhibit, Group, Track};
use crate::measure::length;
use crate::scene::{Entity, Mass, Pose, Scene, Shape, Surface};

const S: Surface = surface(0.5, 0.0);
const G: f64 = 9.81;

/// How far the `n`th moving body's centre has come past x = 0, the middle of the wall, m.
fn past_wall(track: &Track, n: usize) -> f64 {
    let i = track.body(n);
    track.moments.iter().map(|moment| moment.poses[i].position[0]).fold(f64::NEG_INFINITY, f64::max)
}

const fn no_passing(measure: fn(&Track) -> f64) -> Criterion {
    Criterion { figure: "past the wall's middle", unit: "m", limit: 0.0, measure }
}

fn fastest(track: &Track) -> f64 {
    let speeds = track.moments.iter().flat_map(|m| m.velocities.iter().map(|v| length(v.linear)));
    speeds.fold(0.0, f64::max)
}

/// Overlaps are pushed apart at 3 m/s at most, by both engines' defaults; falling adds a little.
const GENTLE: Criterion = Criterion { figure: "fastest body", unit: "m/s", limit: 3.5, measure: fastest };

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Hard.exhibit(
        "h7-dominoes",
        "twenty dominoes in a row",
        10.0,
        dominoes,
        &[Criterion {
            figure: "dominoes left standing",
            unit: "",
            limit: 0.0,
            measure: |track| {
                let standing = track.dynamic().filter(|&i| track.end().poses[i].position[1] > 0.45);
                standing.fold(0.0, |count, _| count + 1.0)
            },
        }],
    ),
    Group::Hard.exhibit(
        "h9-rebounds",
        "spheres, boxes and cylinders fall flat, e from 0 to 1",
        1.2,
        rebounds,
        &[
            Criterion { figure: "height of the rebound", unit: "m", limit: 0.01, measure: rebound_error },
            energy_rise(1e-3),
        ],
    ),
    Group::Hard.exhibit(
        "h12-stick",
        "a spinning stick of 4 m at 100 m/s against a wall of 0.25 m",
        1.0,
        spinning_stick,
        &[no_passing(|track| past_wall(track, 0))],
    ),
    Group::Hard.exhibit(
        "h12-bar",
        "a bar of 0.8 m at 180 m/s against a wall of 0.2 m",
        1.0,
        || shot(180.0),
        &[no_passing(|track| past_wall(track, 0))],
    ),
    Group::Hard.exhibit(
        "h12-bullet",
        "a ball of 0.1 m at 600 m/s against a wall of 0.1 m",
        1.0,
        bullet,
        &[no_passing(|track| past_wall(track, 0))],
    ),
    Group::Hard.exhibit(
        "h12-bullet-cube",
        "a ball at 500 m/s against a free cube",
        0.5,
        bullet_and_cube,
        &[Criterion {
            figure: "past the cube's middle",
            unit: "m",
            limit: 0.0,
            measure: |track| {
                let (cube, ball) = (track.body(0), track.body(1));
                let gap = |m: &crate::gallery::Moment| m.poses[ball].position[0] - m.poses[cube].position[0];
                track.moments.iter().map(gap).fold(f64::NEG_INFINITY, f64::max)
            },
        }],
    ),
    Group::Hard.exhibit(
        "h18-slab",
        "a slab of 10 x 0.03 x 10 m lands at 100 m/s",
        2.0,
        || slab([5.0, 0.015, 5.0], 100.0),
        &[
            Criterion {
                figure: "below the ground",
                unit: "m",
                limit: 0.0,
                measure: |track| {
                    let lowest =
                        track.moments.iter().map(|m| m.poses[1].position[1]).fold(f64::INFINITY, f64::min);
                    -lowest
                },
            },
            end_depth(1e-3),
        ],
    ),
    Group::Hard.exhibit(
        "h18-plate",
        "a plate of 2 x 0.06 x 2 m comes to rest",
        6.0,
        || slab([1.0, 0.03, 1.0], 0.0),
        &[
            Criterion {
                figure: "speed at the end",
                unit: "m/s",
                limit: 1e-3,
                measure: |track| {
                    let velocity = track.end().velocities[1];
                    length(velocity.linear) + length(velocity.angular)
                },
            },
            end_depth(1e-3),
        ],
    ),
    Group::Hard.exhibit(
        "h18-coin",
        "a coin is spun on its edge and falls over",
        10.0,
        coin,
        &[energy_rise(1e-3), end_depth(1e-4)],
    ),
    Group::Hard.exhibit(
        "h18-ring",
        "a ring falls around a peg and stays",
        5.0,
        ring,
        &[
            Criterion {
                figure: "from the peg's axis",
                unit: "m",
                limit: 0.101,
                measure: |track| {
                    let place = track.end().poses[track.body(0)].position;
                    place[0].hypot(place[2])
                },
            },
            end_depth(1e-3),
        ],
    ),
    Group::Hard.exhibit(
        "h20-overlap",
        "a pyramid of base four, all overlapping by a quarter",
        5.0,
        overlapping,
        &[GENTLE, end_depth(1e-3)],
    ),
    Group::Hard.exhibit(
        "h20-in-wall",
        "a cube begins half inside a wall and the floor",
        5.0,
        in_wall,
        &[GENTLE, end_depth(1e-3)],
    ),
];

fn dominoes() -> Scene {
    let mut entities = vec![floor(S)];
    entities.extend((0..20).map(|i| cuboid([0.5 * f64::from(i), 0.5, 0.0], [0.05, 0.5, 0.25], 600.0, S)));
    entities[1].velocity.angular = [0.0, 0.0, -1.5];
    entities[1].velocity.linear = [0.75, 0.0, 0.0];
    scene("dominoes", entities)
}

const REBOUNDS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Lowest points 0.5 m above the floor, whose restitution is 0: a pair takes the larger.
fn rebounds() -> Scene {
    let mut entities = vec![floor(S)];
    for (e, k) in REBOUNDS.into_iter().zip(0..) {
        let s = surface(0.5, e);
        let x = 3.0 * f64::from(k);
        entities.push(sphere([x, 1.0, 0.0], 0.5, 1000.0, s));
        entities.push(cube([x, 1.0, 3.0], s));
        entities.push(cylinder([x, 1.0, 6.0], 0.5, 0.5, 1000.0, s));
    }
    scene("rebounds", entities)
}

/// Largest error of the first rebound, e² times 0.5 m, by the energy of the flight at its first moment.
fn rebound_error(track: &Track) -> f64 {
    let rebound = |i: usize| {
        let rising = track.moments.iter().find(|moment| moment.velocities[i].linear[1] > 1e-6);
        rising.map_or(0.0, |moment| {
            let v = moment.velocities[i].linear[1];
            moment.poses[i].position[1] - 0.5 + v * v / (2.0 * G)
        })
    };
    let error = |(n, i): (usize, usize)| {
        let e = REBOUNDS[n / 3];
        (rebound(i) - 0.5 * e * e).abs()
    };
    track.dynamic().enumerate().map(error).fold(0.0, f64::max)
}

fn wall(half_thick: f64) -> Entity {
    fixed("wall", Pose::IDENTITY, Shape::Box { half_extents: [half_thick, 5.0, 5.0] }, S)
}

fn weightless(name: &str, entities: Vec<Entity>) -> Scene {
    let mut scene = scene(name, entities);
    scene.gravity = [0.0; 3];
    scene
}

fn spinning_stick() -> Scene {
    let mut stick = cuboid([-20.0, 0.0, 0.0], [0.1, 2.0, 0.1], 1000.0, S);
    stick.velocity.linear = [100.0, 0.0, 0.0];
    stick.velocity.angular = [0.0, 0.0, 30.0];
    weightless("stick", vec![wall(0.125), stick])
}

fn shot(speed: f64) -> Scene {
    let mut bar = cuboid([-20.0, 0.0, 0.0], [0.4, 0.1, 0.1], 1000.0, S);
    bar.velocity.linear = [speed, 0.0, 0.0];
    weightless("bar", vec![wall(0.1), bar])
}

fn bullet() -> Scene {
    let mut ball = sphere([-20.0, 0.0, 0.0], 0.05, 8000.0, S);
    ball.velocity.linear = [600.0, 0.0, 0.0];
    weightless("bullet", vec![wall(0.05), ball])
}

fn bullet_and_cube() -> Scene {
    let mut ball = sphere([-20.0, 0.0, 0.0], 0.1, 8000.0, S);
    ball.velocity.linear = [500.0, 0.0, 0.0];
    weightless("bullet-cube", vec![cuboid([0.0; 3], [0.25; 3], 1000.0, S), ball])
}

fn slab(half: [f64; 3], speed: f64) -> Scene {
    let ground = Shape::Box { half_extents: [20.0, 0.5, 20.0] };
    let mut slab = cuboid([0.0, 2.0, 0.0], half, 1000.0, S);
    slab.pose.rotation = turn([0.6, 0.0, 0.8], 3.0);
    slab.velocity.linear = [0.0, -speed, 0.0];
    scene("slab", vec![fixed("ground", Pose::at([0.0, -0.5, 0.0]), ground, S), slab])
}

fn coin() -> Scene {
    let (radius, half) = (0.0375, 0.0064);
    let lean = 20f64.to_radians();
    let up = radius * libm::cos(lean) + half * libm::sin(lean);
    let mut coin = cylinder([0.0, up, 0.0], half, radius, 7800.0, S);
    coin.pose.rotation = then(turn([1.0, 0.0, 0.0], 90.0), turn([1.0, 0.0, 0.0], -20.0));
    coin.velocity.angular = [0.0, 25.0, 0.0];
    scene("coin", vec![floor(S), coin])
}

/// Sixteen blocks in a circle of mean radius 0.3 m around a peg of radius 0.15 m.
fn ring() -> Scene {
    let peg = Shape::Cylinder { half_height: 0.6, radius: 0.15 };
    let (mass_kg, r) = (10.0, 0.3);
    let i = mass_kg * r * r;
    let mass = Mass { mass_kg, inertia_kg_m2: [0.5 * i, i, 0.5 * i, 0.0, 0.0, 0.0] };
    let block = |k: u32| {
        let degrees = 22.5 * f64::from(k);
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let mut block = child(Shape::Box { half_extents: [0.05, 0.05, 0.065] }, S);
        block.body_from_shape =
            Pose { position: [r * cos, 0.0, -r * sin], rotation: turn([0.0, 1.0, 0.0], degrees) };
        block
    };
    let mut ring =
        crate::gallery::build::body("ring", mass, [0.02, 1.6, 0.01], Shape::Sphere { radius: 0.1 }, S);
    ring.shapes = (0..16).map(block).collect();
    ring.pose.rotation = turn([0.0, 0.0, 1.0], 8.0);
    scene("ring", vec![floor(S), fixed("peg", Pose::at([0.0, 0.6, 0.0]), peg, S), ring])
}

fn overlapping() -> Scene {
    let mut entities = vec![floor(S)];
    for row in 0..4_u32 {
        let wide = 4 - row;
        entities.extend((0..wide).map(|column| {
            let x = (f64::from(column) - 0.5 * f64::from(wide - 1)) * 0.75;
            cube([x, 0.25 + 0.75 * f64::from(row), 0.0], S)
        }));
    }
    scene("overlapping", entities)
}

fn in_wall() -> Scene {
    let wall = fixed("wall", Pose::at([-1.0, 2.0, 0.0]), Shape::Box { half_extents: [1.0, 2.0, 4.0] }, S);
    scene("in-wall", vec![floor(S), wall, cube([0.1, 0.2, 0.0], S)])
}
