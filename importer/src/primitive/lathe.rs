//! Triangles of analytical shapes.

use std::f64::consts::{PI, TAU};

use crate::asset::Mesh;

use super::PrimitiveForm;
use super::profile::{Curve, Stretch, profile};

/// Sides of a round shape: its triangles are within 0.1 % of its radius.
const SIDES: u32 = 64;

/// Closed, counter-clockwise from outside.
pub(super) fn mesh(form: &PrimitiveForm) -> Mesh {
    match *form {
        PrimitiveForm::Box { size } => box_mesh(size),
        PrimitiveForm::Cylinder { height, bottom, top } => {
            lathe(&[[0.0, -0.5 * height], [bottom, -0.5 * height], [top, 0.5 * height], [0.0, 0.5 * height]])
        }
        _ => lathe(&profile(form).iter().flat_map(outline_of).collect::<Vec<_>>()),
    }
}

/// Points `[radius, y]` along a stretch, arcs in equal angles.
fn outline_of(stretch: &Stretch) -> Vec<[f64; 2]> {
    // A line lies between two arcs, which bring its ends.
    let Curve::Arc { centre, radius } = stretch.curve else { return Vec::new() };
    if radius <= 0.0 {
        return vec![[0.0, centre]];
    }
    let angle = |y: f64| ((y - centre) / radius).clamp(-1.0, 1.0).asin();
    let (start, end) = (angle(stretch.from), angle(stretch.to));
    let steps = ((end - start) / PI * f64::from(SIDES / 2)).ceil().max(1.0);
    let mut points = Vec::new();
    let mut step = 0.0;
    while step <= steps {
        let angle = start + (end - start) * step / steps;
        let across = if (angle.abs() - PI / 2.0).abs() < 1e-6 { 0.0 } else { radius * angle.cos() };
        points.push([across, centre + radius * angle.sin()]);
        step += 1.0;
    }
    points
}

/// Turns an outline from bottom to top about Y.
fn lathe(outline: &[[f64; 2]]) -> Mesh {
    let mut mesh = Mesh::default();
    let mut rings: Vec<(u32, bool)> = Vec::new();
    for &[radius, y] in outline {
        #[allow(clippy::cast_possible_truncation)]
        let first = mesh.positions.len() as u32;
        let point = radius <= 0.0;
        rings.push((first, point));
        for side in 0..if point { 1 } else { SIDES } {
            let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            mesh.positions.push([radius * cosine, y, radius * sine]);
        }
    }
    for two in rings.windows(2) {
        let [(low, low_point), (high, high_point)] = [two[0], two[1]];
        for side in 0..SIDES {
            let next = (side + 1) % SIDES;
            let at = |first: u32, point: bool, side: u32| if point { first } else { first + side };
            let (a, b) = (at(low, low_point, side), at(low, low_point, next));
            let (c, d) = (at(high, high_point, side), at(high, high_point, next));
            if a != b {
                mesh.triangles.push([a, c, b]);
            }
            if c != d {
                mesh.triangles.push([b, c, d]);
            }
        }
    }
    mesh
}

fn box_mesh(size: [f64; 3]) -> Mesh {
    let corner = |bits: u32| {
        std::array::from_fn(|axis| if bits >> axis & 1 == 0 { -0.5 * size[axis] } else { 0.5 * size[axis] })
    };
    let quads: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    }
}
