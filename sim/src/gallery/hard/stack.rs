//! H1 to H3 and H15: mass ratios, tall stacks, pyramids, tiny and huge things.

use crate::gallery::baseline::pit;
use crate::gallery::build::{cuboid, fixed, floor, noise, scene, surface};
use crate::gallery::criterion::Criterion;
use crate::gallery::figure::{drift, end_depth, sink};
use crate::gallery::{Exhibit, Group};
use crate::scene::{Entity, Pose, Scene, Shape, Surface};

const S: Surface = surface(0.6, 0.0);

/// Depth at the end over the size of the bodies.
const fn end_depth_share(limit: f64, measure: fn(&crate::gallery::Track) -> f64) -> Criterion {
    Criterion { figure: "depth at the end over the size", unit: "", limit, measure }
}

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Hard.exhibit(
        "h1-ratio-10",
        "a cube ten times as heavy on another",
        10.0,
        || pair(10.0),
        &[end_depth(10e-3), drift(1e-3)],
    ),
    Group::Hard.exhibit(
        "h1-ratio-100",
        "a cube 100 times as heavy on another",
        10.0,
        || pair(100.0),
        &[end_depth(10e-3), drift(1e-3)],
    ),
    Group::Hard.exhibit(
        "h1-ratio-300",
        "a cube 300 times as heavy on another",
        10.0,
        || pair(300.0),
        &[end_depth(10e-3), drift(1e-3)],
    ),
    Group::Hard.exhibit(
        "h1-ratio-1000",
        "a cube 1,000 times as heavy on another",
        10.0,
        || pair(1000.0),
        &[end_depth(10e-3), drift(1e-3)],
    ),
    Group::Hard.exhibit(
        "h1-pyramid",
        "a pyramid of base ten under a cube 300 times as heavy",
        10.0,
        loaded_pyramid,
        &[end_depth(10e-3), drift(25e-3)],
    ),
    Group::Hard.exhibit(
        "h2-stack-10",
        "ten cubes on each other for a minute",
        60.0,
        || stack(10, 0.0),
        &[sink(5e-3), drift(5e-3)],
    ),
    Group::Hard.exhibit(
        "h2-stack-40",
        "forty cubes on each other for a minute",
        60.0,
        || stack(40, 0.0),
        &[sink(20e-3), drift(20e-3)],
    ),
    Group::Hard.exhibit(
        "h2-stack-80",
        "eighty cubes on each other for a minute",
        60.0,
        || stack(80, 0.0),
        &[sink(80e-3), drift(40e-3)],
    ),
    Group::Hard.exhibit(
        "h2-drop-10",
        "ten cubes fall on each other from gaps of 0.25 m",
        20.0,
        || stack(10, 0.25),
        &[
            Criterion {
                figure: "height lost at the top",
                unit: "m",
                limit: 5e-3,
                measure: |track| (track.end().poses[track.body(9)].position[1] - 9.5).abs(),
            },
            end_depth(1e-3),
        ],
    ),
    Group::Hard.exhibit(
        "h3-pyramid-30",
        "a flat pyramid of base 30 for 2,000 steps",
        2000.0 / 60.0,
        || pyramid(30),
        &[end_depth(1e-3), drift(25e-3)],
    ),
    Group::Hard.exhibit(
        "h3-pyramid-80",
        "a flat pyramid of base 80",
        10.0,
        || pyramid(80),
        &[end_depth(2e-3), drift(40e-3)],
    ),
    Group::Hard.exhibit(
        "h15-dice",
        "27 dice of 1 mm fall into a pit of 5 mm",
        2.0,
        dice,
        &[end_depth_share(0.01, |track| track.end_depth_m() / 1e-3)],
    ),
    Group::Hard.exhibit(
        "h15-small-pyramid",
        "a pyramid of boxes of 5 cm",
        10.0,
        small_pyramid,
        &[
            end_depth_share(0.01, |track| track.end_depth_m() / 0.05),
            Criterion {
                figure: "drift over the size",
                unit: "",
                limit: 0.025,
                measure: |track| track.drift_m() / 0.05,
            },
        ],
    ),
    Group::Hard.exhibit(
        "h15-huge-ground",
        "a box of 0.2 m on one of 200 m",
        10.0,
        huge_ground,
        &[end_depth_share(0.01, |track| track.end_depth_m() / 0.2), drift(2e-3)],
    ),
];

fn boxed(x: f64, y: f64, side: f64, mass_kg: f64) -> Entity {
    cuboid([x, y, 0.0], [0.5 * side; 3], mass_kg / (side * side * side), S)
}

fn pair(ratio: f64) -> Scene {
    scene("h1", vec![floor(S), boxed(0.0, 0.5, 1.0, 1000.0), boxed(0.0, 1.5, 1.0, 1000.0 * ratio)])
}

/// Rows of cubes, each cube over the gap of two below.
fn rows(base: u32, side: f64) -> Vec<Entity> {
    let mut entities = vec![floor(S)];
    for row in 0..base {
        let wide = base - row;
        entities.extend((0..wide).map(|column| {
            let x = (f64::from(column) - 0.5 * f64::from(wide - 1)) * 1.125 * side;
            boxed(x, (0.5 + f64::from(row)) * side, side, 1000.0 * side * side * side)
        }));
    }
    entities
}

fn pyramid(base: u32) -> Scene {
    scene("h3", rows(base, 1.0))
}

fn loaded_pyramid() -> Scene {
    let mut entities = rows(10, 1.0);
    entities.push(boxed(0.0, 10.5, 1.0, 300_000.0));
    scene("h1-pyramid", entities)
}

fn small_pyramid() -> Scene {
    scene("h15", rows(15, 0.05))
}

fn stack(count: u32, gap: f64) -> Scene {
    let mut entities = vec![floor(S)];
    entities.extend((0..count).map(|i| boxed(0.0, 0.5 + gap + f64::from(i) * (1.0 + gap), 1.0, 1000.0)));
    scene("h2", entities)
}

fn dice() -> Scene {
    let mut entities = pit(0.0025, 0.02, S);
    for n in 0..27_u32 {
        let at = |i: u32, seed| (f64::from(i) - 1.0) * 1.4e-3 + 0.2e-3 * (noise(n, seed) - 0.5);
        entities.push(cuboid(
            [at(n % 3, 1), 1e-3 + 1.4e-3 * f64::from(n / 9), at(n / 3 % 3, 2)],
            [0.5e-3; 3],
            1000.0,
            S,
        ));
    }
    scene("h15-dice", entities)
}

fn huge_ground() -> Scene {
    let ground = Shape::Box { half_extents: [100.0, 0.5, 100.0] };
    let at = Pose::at([0.0, -0.5, 0.0]);
    scene(
        "h15-huge-ground",
        vec![fixed("ground", at, ground, S), cuboid([40.0, 0.1, -30.0], [0.1; 3], 1000.0, S)],
    )
}
