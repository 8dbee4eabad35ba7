//! The baseline scenes A to J, the figures of the 2013 paper among them. Unit cubes of 1,000 kg unless said.

use super::build::{cube, cuboid, cylinder, fixed, floor, hull, noise, scene, sphere, surface};
use super::criterion::Criterion;
use super::figure::{drift, end_depth, energy_change, energy_rise, sink};
use super::track::Track;
use super::{Exhibit, Group};
use crate::measure;
use crate::scene::{Action, Change, Entity, Pose, Scene, Shape, Surface, Velocity};

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Baseline.exhibit(
        "seed-8e",
        "A: a tower of ten cubes hit by a ball",
        10.0,
        tower_and_ball,
        &[end_depth(1e-3), energy_rise(1e-3)],
    ),
    Group::Baseline.exhibit(
        "seed-8f",
        "B: a wall of 210 cubes hit by a ball",
        10.0,
        wall_and_ball,
        &[end_depth(1e-3), energy_rise(1e-3)],
    ),
    Group::Baseline.exhibit(
        "seed-8g",
        "C: 343 spheres, cubes and cylinders fall into a pit",
        10.0,
        mixed_drop,
        &[end_depth(1e-3), energy_rise(1e-3)],
    ),
    Group::Baseline.exhibit(
        "seed-9",
        "H: ten cubes of restitution 0.8 fall on each other, the paper's blow-up",
        20.0,
        bouncing_stack,
        &[
            Criterion { figure: "energy rise", unit: "", limit: 1e-3, measure: rise_above_rest },
            Criterion { figure: "energy above the start", unit: "", limit: 1e-6, measure: gain_above_rest },
            Criterion { figure: "time to rest", unit: "", limit: 0.05, measure: rest_time_error },
        ],
    ),
    Group::Baseline.exhibit(
        "seed-10",
        "D: a flat pyramid of 1,275 cubes",
        10.0,
        || pyramid(50),
        &[end_depth(1e-3), drift(25e-3), sink(50e-3)],
    ),
    Group::Baseline.exhibit(
        "heap",
        "E: 4,096 convex hulls of 12 vertices fall into a pit",
        3.0,
        heap,
        &[end_depth(20e-3), energy_rise(1e-3)],
    ),
    Group::Baseline.exhibit(
        "stack-20",
        "F: twenty cubes on each other",
        20.0,
        tall_stack,
        &[sink(2e-3), drift(2e-3), end_depth(1e-3)],
    ),
    Group::Baseline.exhibit(
        "mass-ratio-2",
        "G: 1,000 kg on a cube of 1 kg",
        10.0,
        || masses(&[1.0, 1000.0]),
        &[end_depth(2e-3), ANY_DEPTH, sink(10e-3), drift(2e-3)],
    ),
    Group::Baseline.exhibit(
        "mass-ratio-10",
        "G: ten cubes, each twice as heavy as the one below",
        10.0,
        || masses(&[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0]),
        &[end_depth(2e-3), ANY_DEPTH, sink(10e-3), drift(2e-3)],
    ),
    Group::Baseline.exhibit(
        "gas",
        "J: 216 elastic spheres fall and bounce off each other and far walls",
        10.0,
        gas,
        &[energy_change(1e-4), energy_rise(1e-4)],
    ),
];

const ANY_DEPTH: Criterion =
    Criterion { figure: "deepest ever", unit: "m", limit: 10e-3, measure: |track| track.deepest_m(0.0) };

fn tower_and_ball() -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend((0..10).map(|i| cube([0.0, 0.5 + f64::from(i), 0.0], s)));
    let mut ball = sphere([-10.0, 6.0, 0.125], 0.5, 10_000.0, s);
    ball.velocity.linear = [20.0, 0.0, 0.0];
    entities.push(ball);
    scene("seed-8e", entities)
}

fn wall_and_ball() -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = vec![floor(s)];
    for row in 0..10 {
        let shift = 0.25 * f64::from(row % 2);
        entities.extend(
            (0..21).map(|column| cube([f64::from(column) - 10.0 + shift, 0.5 + f64::from(row), 0.0], s)),
        );
    }
    entities.push(sphere([0.0, 0.5, 40.0], 0.5, 10_000.0, s));
    let ball = entities.len() - 1;
    let mut scene = scene("seed-8f", entities);
    let velocity = Velocity { linear: [0.0, 0.0, -25.0], angular: [0.0; 3] };
    scene.actions = vec![
        Action { time_s: 2.0, entity: ball, change: Change::SetPose(Pose::at([0.0, 5.25, 6.0])) },
        Action { time_s: 2.0, entity: ball, change: Change::SetVelocity(velocity) },
    ];
    scene
}

fn mixed_drop() -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = pit(6.0, 20.0, s);
    let mut n = 0;
    for j in 0..7_u32 {
        for i in 0..7_u32 {
            for k in 0..7_u32 {
                let at = |i: u32, seed| (f64::from(i) - 3.0) * 1.375 + 0.25 * (noise(n, seed) - 0.5);
                let y = 3.0 + 1.375 * f64::from(j) + 0.125 * noise(n, 2);
                let position = [at(i, 1), y, at(k, 3)];
                entities.push(match (i + j + k) % 3 {
                    0 => sphere(position, 0.5, 1000.0, s),
                    1 => cube(position, s),
                    _ => cylinder(position, 0.5, 0.5, 1000.0, s),
                });
                n += 1;
            }
        }
    }
    scene("seed-8g", entities)
}

/// A flat pyramid, each cube over the gap between two.
pub(super) fn pyramid(base: u32) -> Scene {
    let s = surface(0.6, 0.0);
    let mut entities = vec![floor(s)];
    for row in 0..base {
        let wide = base - row;
        entities.extend((0..wide).map(|column| {
            let x = (f64::from(column) - 0.5 * f64::from(wide - 1)) * 1.125;
            cube([x, 0.5 + f64::from(row), 0.0], s)
        }));
    }
    scene("pyramid", entities)
}

fn tall_stack() -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend((0..20).map(|i| cube([0.0, 0.5 + f64::from(i), 0.0], s)));
    scene("stack-20", entities)
}

/// Cubes of the given masses, bottom first.
fn masses(masses_kg: &[f64]) -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend(
        masses_kg
            .iter()
            .zip(0..)
            .map(|(mass_kg, i)| cuboid([0.0, 0.5 + f64::from(i), 0.0], [0.5; 3], *mass_kg, s)),
    );
    scene("mass-ratio", entities)
}

fn bouncing_stack() -> Scene {
    let s = surface(0.5, 0.8);
    let mut entities = vec![floor(s)];
    entities.extend((0..10).map(|i| cube([0.0, 0.6 + 1.1 * f64::from(i), 0.0], s)));
    scene("seed-9", entities)
}

/// Energy of the bouncing stack above that of the same cubes resting on each other, at the start, J.
fn above_rest_j(track: &Track) -> f64 {
    let rest: f64 = track
        .dynamic()
        .zip(0..)
        .filter_map(|(i, place)| {
            Some(measure::mass_of(&track.scene.entities[i])?.mass_kg * (0.5 + f64::from(place)))
        })
        .sum();
    track.energy_j[0] - 9.81 * rest
}

fn rise_above_rest(track: &Track) -> f64 {
    track.energy_rise_j / above_rest_j(track)
}

fn gain_above_rest(track: &Track) -> f64 {
    let highest = track.energy_j.iter().copied().fold(0.0, f64::max);
    (highest - track.energy_j[0]) / above_rest_j(track)
}

/// When the kinetic energy of such a stack falls below 1e-4 of the energy above rest, s: of ten points on a line that
/// fall freely and meet at their exact times with restitution 0.8, from impact to impact in double precision. They
/// collapse in a finite time; below 1 cm/s, 3 mm/s or 3 cm/s their meetings are elastic, and the time is the same.
const COLLAPSE_S: f64 = 0.5222;

/// The last time at which the kinetic energy is above 1e-4 of the energy above rest, against [`COLLAPSE_S`].
fn rest_time_error(track: &Track) -> f64 {
    let limit = 1e-4 * above_rest_j(track);
    let kinetic = |moment: &super::Moment| -> f64 {
        track
            .dynamic()
            .filter_map(|i| {
                let mass = measure::mass_of(&track.scene.entities[i])?;
                Some(measure::energy(&mass, &moment.poses[i], &moment.velocities[i], [0.0; 3]))
            })
            .sum()
    };
    let last = track.moments.iter().rev().find(|moment| kinetic(moment) > limit);
    (last.map_or(0.0, |moment| moment.time_s) / COLLAPSE_S - 1.0).abs()
}

/// Four walls around a pit of inner half width `half` and height `height`, and the floor.
pub(super) fn pit(half: f64, height: f64, s: Surface) -> Vec<Entity> {
    let wall = |position, half_extents| fixed("wall", Pose::at(position), Shape::Box { half_extents }, s);
    let mut entities = vec![floor(s)];
    let (at, mid) = (half + 0.5, 0.5 * height);
    for side in [-at, at] {
        entities.push(wall([side, mid, 0.0], [0.5, mid, half + 1.0]));
        entities.push(wall([0.0, mid, side], [half + 1.0, mid, 0.5]));
    }
    entities
}

/// A hull of twelve vertices about the origin, one of eight: an icosahedron's, stretched and dented by noise.
pub(super) fn pebble(kind: u32, size: f64) -> Vec<[f64; 3]> {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let scale = size / (1.0 + golden * golden).sqrt();
    let mut points = Vec::new();
    for (i, [a, b]) in [[1.0, golden], [1.0, -golden], [-1.0, golden], [-1.0, -golden]].iter().enumerate() {
        for (axis, mut point) in [[0.0, *a, *b], [*a, *b, 0.0], [*b, 0.0, *a]].into_iter().enumerate() {
            let n = 100 * kind + u32::try_from(3 * i + axis).unwrap_or(0);
            for (k, x) in (0..).zip(&mut point) {
                *x *= scale * (1.0 + 0.2 * (noise(n, k) - 0.5)) * (1.0 + 0.4 * (noise(kind, 7 + k) - 0.5));
            }
            points.push(point);
        }
    }
    points
}

fn heap() -> Scene {
    let s = surface(0.5, 0.0);
    let mut entities = pit(11.0, 40.0, s);
    let shapes: Vec<Vec<[f64; 3]>> = (0..8).map(|kind| pebble(kind, 0.6)).collect();
    let bodies: Vec<Entity> = shapes.iter().map(|points| hull([0.0; 3], points, 1000.0, s)).collect();
    for n in 0..4096_u32 {
        let (i, j, k) = (n % 16, n / 256, n / 16 % 16);
        let at = |i: u32, seed| (f64::from(i) - 7.5) * 1.3 + 0.2 * (noise(n, seed) - 0.5);
        let mut body = bodies[(n % 8) as usize].clone();
        body.pose = Pose::at([at(i, 1), 1.0 + 1.3 * f64::from(j), at(k, 3)]);
        entities.push(body);
    }
    scene("heap", entities)
}

fn gas() -> Scene {
    let s = surface(0.0, 1.0);
    let mut entities = pit(10.0, 40.0, s);
    for n in 0..216_u32 {
        let at = |i: u32, seed| (f64::from(i) - 2.5) * 1.5 + 0.2 * (noise(n, seed) - 0.5);
        let y = 2.0 + 1.5 * f64::from(n / 36) + 0.2 * noise(n, 2);
        entities.push(sphere([at(n % 6, 1), y, at(n / 6 % 6, 3)], 0.5, 1000.0, s));
    }
    scene("gas", entities)
}
