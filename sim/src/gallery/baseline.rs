//! The baseline scenes A to J, the figures of the 2013 paper among them. Unit cubes of 1,000 kg unless said.

use super::Exhibit;
use super::build::{cube, cuboid, cylinder, fixed, floor, noise, scene, sphere};
use crate::scene::{Action, Change, Pose, Scene, Shape, Surface, Velocity};

pub(super) const EXHIBITS: &[Exhibit] = &[
    Exhibit {
        name: "seed-8e",
        about: "a tower of ten cubes hit by a ball",
        duration_s: 10.0,
        scene: tower_and_ball,
    },
    Exhibit {
        name: "seed-8f",
        about: "a wall of 210 cubes hit by a ball",
        duration_s: 10.0,
        scene: wall_and_ball,
    },
    Exhibit {
        name: "seed-8g",
        about: "343 spheres, cubes and cylinders fall into a pit",
        duration_s: 10.0,
        scene: mixed_drop,
    },
    Exhibit {
        name: "pyramid",
        about: "a flat pyramid of 1,275 cubes",
        duration_s: 10.0,
        scene: || pyramid(50),
    },
    Exhibit { name: "stack-20", about: "twenty cubes on each other", duration_s: 20.0, scene: tall_stack },
    Exhibit {
        name: "mass-ratio-2",
        about: "1,000 kg on a cube of 1 kg",
        duration_s: 10.0,
        scene: || masses(&[1.0, 1000.0]),
    },
    Exhibit {
        name: "mass-ratio-10",
        about: "ten cubes, each twice as heavy as the one below",
        duration_s: 10.0,
        scene: || masses(&[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0]),
    },
    Exhibit {
        name: "seed-9",
        about: "ten cubes of restitution 0.8 fall on each other: the paper's blow-up",
        duration_s: 20.0,
        scene: bouncing_stack,
    },
];

const fn surface(friction: f64, restitution: f64) -> Surface {
    Surface::new(friction, restitution)
}

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
    let mut entities = vec![floor(s)];
    let wall = |position, half_extents| fixed("wall", Pose::at(position), Shape::Box { half_extents }, s);
    for side in [-6.5, 6.5] {
        entities.push(wall([side, 10.0, 0.0], [0.5, 10.0, 7.0]));
        entities.push(wall([0.0, 10.0, side], [7.0, 10.0, 0.5]));
    }
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

fn pyramid(base: u32) -> Scene {
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
