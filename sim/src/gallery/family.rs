//! Piles of many bodies in the manner of Box3D's benchmarks, by formulas of our own.

use super::baseline::{pebble, pit};
use super::build::{
    body, child, cube, cuboid, fixed, floor, hull, noise, scene, sphere, surface, then, turn,
};
use super::figure::{drift, end_depth, energy_rise, sink};
use super::{Exhibit, Group};
use crate::scene::{Entity, Mass, Pose, Scene, Shape, Surface};

const S: Surface = surface(0.5, 0.0);

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Pile.exhibit(
        "large-pyramid",
        "a flat pyramid of 5,050 cubes",
        3.0,
        || super::baseline::pyramid(100),
        &[end_depth(2e-3), drift(40e-3), sink(100e-3)],
    ),
    Group::Pile.exhibit(
        "pyramids",
        "twenty pyramids of 55 cubes",
        5.0,
        pyramids,
        &[end_depth(1e-3), drift(10e-3), sink(10e-3)],
    ),
    Group::Pile.exhibit(
        "hull-pile",
        "600 hulls of 20 vertices fall into a pit",
        5.0,
        hull_pile,
        &[end_depth(10e-3), energy_rise(1e-3)],
    ),
    Group::Pile.exhibit(
        "junkyard",
        "800 boxes, beams, hulls and brackets fall into a pit",
        5.0,
        junkyard,
        &[end_depth(10e-3), energy_rise(1e-3)],
    ),
    Group::Pile.exhibit(
        "rain",
        "512 jacks of three capsules rain on the floor",
        5.0,
        rain,
        &[end_depth(5e-3), energy_rise(1e-3)],
    ),
    Group::Pile.exhibit(
        "washer",
        "300 cubes tumble in a drum that turns on its axle",
        5.0,
        washer,
        &[end_depth(10e-3), energy_rise(1e-3)],
    ),
];

/// A place on a grid of `wide` by `wide` by any, `step` apart, displaced by noise.
fn strewn(n: u32, wide: u32, step: f64, low: f64) -> [f64; 3] {
    let at = |i: u32, seed| {
        (f64::from(i) - 0.5 * f64::from(wide - 1)) * step + 0.2 * step * (noise(n, seed) - 0.5)
    };
    [at(n % wide, 1), low + step * f64::from(n / (wide * wide)), at(n / wide % wide, 3)]
}

/// Some rotation, the same for the same number.
fn any_turn(n: u32) -> [f64; 4] {
    then(turn([1.0, 0.0, 0.0], 360.0 * noise(n, 11)), turn([0.0, 1.0, 0.0], 360.0 * noise(n, 12)))
}

fn pyramids() -> Scene {
    let mut entities = vec![floor(S)];
    for n in 0..20_u32 {
        let (x, z) = (f64::from(n % 4) * 14.0 - 21.0, f64::from(n / 4) * 3.0 - 6.0);
        for row in 0..10_u32 {
            let wide = 10 - row;
            entities.extend((0..wide).map(|column| {
                let along = (f64::from(column) - 0.5 * f64::from(wide - 1)) * 1.125;
                cube([x + along, 0.5 + f64::from(row), z], S)
            }));
        }
    }
    scene("pyramids", entities)
}

/// Twenty points on three stretched rings and two poles.
fn boulder(kind: u32) -> Vec<[f64; 3]> {
    let mut points = vec![[0.0, 0.5, 0.0], [0.0, -0.5, 0.0]];
    for (ring, (height, radius)) in (0..).zip([(-0.25, 0.43), (0.0, 0.5), (0.25, 0.43)]) {
        for k in 0..6_u32 {
            let degrees = 60.0 * f64::from(k) + 30.0 * f64::from(ring % 2) + 10.0 * noise(kind, ring);
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let r = radius * (0.9 + 0.2 * noise(100 * kind + 10 * ring + k, 5));
            points.push([r * cos, height, r * sin]);
        }
    }
    points
}

fn hull_pile() -> Scene {
    let mut entities = pit(4.5, 30.0, S);
    let shapes: Vec<Entity> = (0..4).map(|kind| hull([0.0; 3], &boulder(kind), 1000.0, S)).collect();
    for n in 0..600_u32 {
        let mut one = shapes[(n % 4) as usize].clone();
        one.pose = Pose { position: strewn(n, 7, 1.15, 1.0), rotation: any_turn(n) };
        entities.push(one);
    }
    scene("hull-pile", entities)
}

/// Two plates at a right angle, of 20 kg.
fn bracket() -> Entity {
    let mass = Mass { mass_kg: 20.0, inertia_kg_m2: [1.0, 1.4, 1.0, 0.0, 0.0, 0.0] };
    let mut bracket = body("bracket", mass, [0.0; 3], Shape::Box { half_extents: [0.4, 0.05, 0.25] }, S);
    bracket.shapes[0].body_from_shape.position = [0.0, -0.15, 0.0];
    let mut upright = child(Shape::Box { half_extents: [0.05, 0.25, 0.25] }, S);
    upright.body_from_shape.position = [-0.35, 0.15, 0.0];
    bracket.shapes.push(upright);
    bracket
}

fn junkyard() -> Scene {
    let mut entities = pit(5.0, 30.0, S);
    let debris = hull([0.0; 3], &pebble(3, 0.5), 2000.0, S);
    for n in 0..800_u32 {
        let mut one = match n % 4 {
            0 => cuboid([0.0; 3], [0.35, 0.25, 0.3], 800.0, S),
            1 => cuboid([0.0; 3], [0.1, 0.6, 0.1], 7800.0, S),
            2 => debris.clone(),
            _ => bracket(),
        };
        one.pose = Pose { position: strewn(n, 7, 1.3, 1.0), rotation: any_turn(n) };
        entities.push(one);
    }
    scene("junkyard", entities)
}

fn rain() -> Scene {
    let mut entities = vec![floor(S)];
    let mass = Mass { mass_kg: 3.0, inertia_kg_m2: [0.08, 0.08, 0.08, 0.0, 0.0, 0.0] };
    let arm = Shape::Capsule { half_height: 0.25, radius: 0.08 };
    let mut jack = body("jack", mass, [0.0; 3], arm.clone(), S);
    for axis in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
        let mut arm = child(arm.clone(), S);
        arm.body_from_shape.rotation = turn(axis, 90.0);
        jack.shapes.push(arm);
    }
    for n in 0..512_u32 {
        let mut one = jack.clone();
        let [x, y, z] = strewn(n, 8, 1.1, 1.0);
        one.pose = Pose { position: [x, y + 1.5 * noise(n, 2), z], rotation: any_turn(n) };
        one.velocity.linear = [0.0, -2.0, 0.0];
        entities.push(one);
    }
    scene("rain", entities)
}

/// Half length and radius of the drum, m; how many staves it is made of.
const DRUM: [f64; 2] = [2.0, 3.0];
const STAVES: u32 = 24;

/// A drum of staves, paddles and two lids on an axle that lies without friction in two notches. Nothing drives
/// it: it is heavy, and turns on.
fn drum() -> Entity {
    let [half, radius] = DRUM;
    let grip = surface(0.5, 0.0);
    let slick = surface(0.0, 0.0);
    let mass_kg = 2e6;
    let (along, across) = (mass_kg * radius * radius, mass_kg * (0.5 * radius * radius + half * half / 3.0));
    let mass = Mass { mass_kg, inertia_kg_m2: [across, across, along, 0.0, 0.0, 0.0] };
    let mut drum = body("drum", mass, [0.0, 5.0, 0.0], Shape::Sphere { radius: 0.1 }, grip);
    drum.shapes.clear();
    let half_wide = radius * libm::tan(std::f64::consts::PI / f64::from(STAVES)) + 0.02;
    for k in 0..STAVES {
        let degrees = 360.0 * f64::from(k) / f64::from(STAVES);
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let mut place = |shape: Shape, r: f64| {
            let mut part = child(shape, grip);
            part.body_from_shape =
                Pose { position: [r * cos, r * sin, 0.0], rotation: turn([0.0, 0.0, 1.0], degrees) };
            drum.shapes.push(part);
        };
        place(Shape::Box { half_extents: [0.2, half_wide, half] }, radius + 0.2);
        if k % 6 == 0 {
            place(Shape::Box { half_extents: [0.3, 0.1, half] }, radius - 0.3);
        }
    }
    for end in [-1.0, 1.0] {
        let mut lid = child(Shape::Box { half_extents: [radius + 0.4, radius + 0.4, 0.2] }, grip);
        lid.body_from_shape.position = [0.0, 0.0, end * (half + 0.2)];
        let mut axle = child(Shape::Cylinder { half_height: 0.5, radius: 0.3 }, slick);
        axle.body_from_shape =
            Pose { position: [0.0, 0.0, end * (half + 0.9)], rotation: turn([1.0, 0.0, 0.0], 90.0) };
        drum.shapes.extend([lid, axle]);
    }
    drum.velocity.angular = [0.0, 0.0, 1.2];
    drum
}

fn washer() -> Scene {
    let slick = surface(0.0, 0.0);
    let mut entities = vec![floor(S), drum()];
    for end in [-1.0, 1.0] {
        for side in [-1.0, 1.0] {
            // Blocks at 45 degrees whose faces touch the axle of radius 0.3 m.
            let away = (0.3 + 0.5) * 0.5f64.sqrt();
            let at = [side * away, 5.0 - away, end * (DRUM[0] + 0.9)];
            let notch = Shape::Box { half_extents: [0.8, 0.5, 0.4] };
            let pose = Pose { position: at, rotation: turn([0.0, 0.0, 1.0], side * 45.0) };
            entities.push(fixed("notch", pose, notch, slick));
        }
    }
    for n in 0..300_u32 {
        let at = |i: u32, wide: u32| (f64::from(i) - 0.5 * f64::from(wide - 1)) * 0.5;
        let (i, j, k) = (n % 7, n / 42, n / 7 % 6);
        let position = [at(i, 7), 5.0 + at(j, 8), at(k, 6)];
        entities.push(match n % 5 {
            0 => sphere(position, 0.2, 1000.0, S),
            _ => cuboid(position, [0.18; 3], 1000.0, S),
        });
    }
    scene("washer", entities)
}
