//! H13: what slides over the seams of coplanar triangles and tiles must not feel them.

use crate::gallery::build::{body, cuboid, cylinder, fixed, scene, sphere, surface, turn};
use crate::gallery::criterion::Criterion;
use crate::gallery::{Exhibit, Group, Track};
use crate::scene::{Entity, Mass, Pose, Scene, Shape, Surface};

const S: Surface = surface(0.0, 0.0);

/// m/s
const SPEEDS: [f64; 3] = [1.0, 5.0, 20.0];
/// m, between lanes, and along them.
const LANE: f64 = 2.0;
const LONG: u32 = 44;

const KICK: Criterion =
    Criterion { figure: "velocity kick over the speed", unit: "", limit: 1e-3, measure: largest_kick };

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Hard.exhibit(
        "h13-mesh",
        "four shapes slide over coplanar triangles at 1 to 20 m/s",
        2.0,
        || over(mesh(&even())),
        &[KICK],
    ),
    Group::Hard.exhibit(
        "h13-slivers",
        "the same over slivers of 1:1,000",
        2.0,
        || over(mesh(&slivers())),
        &[KICK],
    ),
    Group::Hard.exhibit("h13-tiles", "the same over tiles", 2.0, || over(tiles()), &[KICK]),
];

fn lanes() -> f64 {
    LANE * 12.0
}

/// Twelve lanes along x: each of four shapes at each of three speeds.
fn over(ground: Vec<Entity>) -> Scene {
    let mut entities = ground;
    for (speed, i) in SPEEDS.into_iter().zip(0..) {
        let z = |k: u32| LANE * (f64::from(4 * i + k) + 0.5);
        let mass = Mass { mass_kg: 100.0, inertia_kg_m2: [8.0, 4.0, 8.0, 0.0, 0.0, 0.0] };
        let mut capsule =
            body("capsule", mass, [0.6, 0.3, z(2)], Shape::Capsule { half_height: 0.3, radius: 0.3 }, S);
        capsule.pose.rotation = turn([0.0, 0.0, 1.0], 90.0);
        let sliders = [
            sphere([0.6, 0.4, z(0)], 0.4, 1000.0, S),
            cuboid([0.6, 0.3, z(1)], [0.4, 0.3, 0.35], 1000.0, S),
            capsule,
            cylinder([0.6, 0.3, z(3)], 0.3, 0.4, 1000.0, S),
        ];
        entities.extend(sliders.into_iter().map(|mut slider| {
            slider.velocity.linear = [speed, 0.0, 0.0];
            slider
        }));
    }
    scene("seams", entities)
}

fn even() -> Vec<f64> {
    (0..=LONG).map(f64::from).collect()
}

/// Pairs of lines a millimetre apart.
fn slivers() -> Vec<f64> {
    (0..LONG).flat_map(|i| [f64::from(i), f64::from(i) + 1e-3]).collect()
}

/// A flat mesh with lines across the lanes at `xs` and along them every metre.
fn mesh(xs: &[f64]) -> Vec<Entity> {
    let wide = 24_u32;
    let step = lanes() / f64::from(wide);
    let positions = xs.iter().flat_map(|x| (0..=wide).map(move |k| [*x, 0.0, step * f64::from(k)])).collect();
    let rows = u32::try_from(xs.len()).unwrap_or(0);
    let triangles = (0..rows - 1)
        .flat_map(|i| (0..wide).map(move |k| i * (wide + 1) + k))
        .flat_map(|n| [[n, n + 1, n + wide + 1], [n + wide + 1, n + 1, n + wide + 2]])
        .collect();
    vec![fixed("mesh", Pose::IDENTITY, Shape::TriangleMesh { positions, triangles }, S)]
}

fn tiles() -> Vec<Entity> {
    let half = [0.5, 0.5, 0.5 * lanes()];
    (0..LONG)
        .map(|i| {
            fixed("tile", Pose::at([f64::from(i) + 0.5, -0.5, half[2]]), Shape::Box { half_extents: half }, S)
        })
        .collect()
}

/// Largest speed up or aside, over the speed along, of any slider.
fn largest_kick(track: &Track) -> f64 {
    let kick = |(n, i): (usize, usize)| {
        let speed = SPEEDS[n / 4];
        let aside = |m: &crate::gallery::Moment| {
            let [x, y, z] = m.velocities[i].linear;
            y.abs().max(z.abs()).max((x - speed).abs()) / speed
        };
        track.moments.iter().map(aside).fold(0.0, f64::max)
    };
    track.dynamic().enumerate().map(kick).fold(0.0, f64::max)
}
