//! H21: hulls that trip geometry code.

use crate::gallery::build::{floor, hull, scene, surface, turn};
use crate::gallery::criterion::Criterion;
use crate::gallery::figure::end_depth;
use crate::gallery::{Exhibit, Group, Track};
use crate::measure::length;
use crate::scene::Scene;

const REST: Criterion =
    Criterion { figure: "speed at the end", unit: "m/s", limit: 0.01, measure: end_speed };

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Hard.exhibit(
        "h21-hull-128",
        "a hull of 128 vertices comes to rest",
        10.0,
        || dropped(&ball(128)),
        &[REST, end_depth(1e-3)],
    ),
    Group::Hard.exhibit(
        "h21-coplanar",
        "a cube's hull with 25 points on every face",
        5.0,
        || dropped(&gridded()),
        &[REST, end_depth(1e-3)],
    ),
    Group::Hard.exhibit(
        "h21-tiny-faces",
        "a cube with corners cut by 0.1 mm",
        5.0,
        || dropped(&cut()),
        &[REST, end_depth(1e-3)],
    ),
    Group::Hard.exhibit(
        "h21-needle",
        "a hull of 2 m by 4 mm comes to rest",
        5.0,
        || dropped(&needle()),
        &[REST, end_depth(1e-3)],
    ),
];

fn end_speed(track: &Track) -> f64 {
    let velocity = track.end().velocities[1];
    length(velocity.linear)
}

fn dropped(points: &[[f64; 3]]) -> Scene {
    let s = surface(0.5, 0.1);
    let mut body = hull([0.0, 1.5, 0.0], points, 1000.0, s);
    body.pose.rotation = turn([0.6, 0.0, 0.8], 25.0);
    scene("degenerate", vec![floor(s), body])
}

/// Points spread over a sphere of 0.5 m, flattened so that it does not roll for ever.
fn ball(n: u32) -> Vec<[f64; 3]> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..n)
        .map(|i| {
            let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n);
            let (sin, cos) = libm::sincos(golden * f64::from(i));
            let r = (1.0 - y * y).sqrt();
            [0.5 * r * cos, 0.3 * y, 0.5 * r * sin]
        })
        .collect()
}

fn gridded() -> Vec<[f64; 3]> {
    let at = |i: u32| 0.25 * f64::from(i) - 0.5;
    let all = (0..125_u32).map(|n| [n % 5, n / 5 % 5, n / 25]);
    all.filter(|p| p.iter().any(|&i| i == 0 || i == 4)).map(|p| p.map(at)).collect()
}

fn cut() -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for i in 0..8_u32 {
        let sign = [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 });
        for axis in 0..3 {
            let mut point = sign.map(|s: f64| 0.5 * s);
            point[axis] -= 1e-4 * sign[axis];
            points.push(point);
        }
    }
    points
}

fn needle() -> Vec<[f64; 3]> {
    let around = |k: u32| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / 5.0);
        [0.0, 0.002 * cos, 0.002 * sin]
    };
    let mut points: Vec<[f64; 3]> = (0..5).map(around).collect();
    points.extend([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]);
    points
}
