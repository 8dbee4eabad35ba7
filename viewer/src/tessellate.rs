//! Triangles of the solver's shapes, in the shape's own frame, outward and counter-clockwise.

use std::f64::consts::{FRAC_PI_2, TAU};

use sim::{Entity, Shape};

use crate::hull;
use crate::place::Drawn;
use crate::visual::VisualMesh;

/// Pieces of a full turn, and of a quarter from pole to equator.
const AROUND: u32 = 32;
const TO_POLE: u32 = 8;

/// Triangles of a shape in white; `None` for a half space, which has no extent of its own.
pub(crate) fn shape(shape: &Shape) -> Option<VisualMesh> {
    Some(match shape {
        Shape::Sphere { radius } => sphere(*radius),
        Shape::Box { half_extents } => cuboid(*half_extents),
        Shape::Capsule { half_height, radius } => capsule(*half_height, *radius),
        Shape::Cylinder { half_height, radius } => cylinder(*half_height, *radius),
        Shape::Cone { half_height, radius } => cone(*half_height, *radius),
        Shape::HeightField(field) => {
            let (positions, triangles) = field.mesh();
            mesh(&positions, &triangles)
        }
        Shape::Hull { points } => mesh(points, &hull::triangulate(points)?),
        Shape::TriangleMesh { positions, triangles } => mesh(positions, triangles),
        Shape::HalfSpace => return None,
    })
}

/// All shapes of an entity in the body's frame.
pub(crate) fn entity(entity: &Entity) -> Vec<VisualMesh> {
    let place = |child: &sim::ChildShape| {
        let mut mesh = shape(&child.shape)?;
        let pose = Drawn::of(&child.body_from_shape);
        mesh.positions.iter_mut().for_each(|point| *point = pose.apply(*point));
        Some(mesh)
    };
    entity.shapes.iter().filter_map(place).collect()
}

#[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
fn single(point: [f64; 3]) -> [f32; 3] {
    point.map(|x| x as f32)
}

fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> VisualMesh {
    VisualMesh {
        positions: positions.iter().map(|point| single(*point)).collect(),
        triangles: triangles.to_vec(),
        color: [255; 4],
    }
}

pub(crate) fn cuboid([x, y, z]: [f64; 3]) -> VisualMesh {
    let corner = |i: u8| {
        let side = |bit: u8, half: f64| if i & bit == 0 { -half } else { half };
        [side(1, x), side(2, y), side(4, z)]
    };
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles: Vec<[u32; 3]> =
        quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    mesh(&(0..8).map(corner).collect::<Vec<_>>(), &triangles)
}

pub(crate) fn sphere(radius: f64) -> VisualMesh {
    capsule(0.0, radius)
}

/// A surface of revolution about Y through rings `(height, radius)` from the bottom up, closed by a point at each end.
fn revolve(bottom: f64, rings: &[(f64, f64)], top: f64) -> VisualMesh {
    let mut points = vec![[0.0, bottom, 0.0]];
    for (height, radius) in rings {
        points.extend((0..AROUND).map(|i| {
            let turn = TAU * f64::from(i) / f64::from(AROUND);
            [radius * turn.cos(), *height, radius * turn.sin()]
        }));
    }
    points.push([0.0, top, 0.0]);
    let ring = |k: u32, i: u32| 1 + k * AROUND + i % AROUND;
    let count = u32::try_from(rings.len()).unwrap_or(0);
    let tip = 1 + count * AROUND;
    let mut triangles = Vec::new();
    for i in 0..AROUND {
        triangles.push([0, ring(0, i), ring(0, i + 1)]);
        for k in 1..count {
            let [a, b, c, d] = [ring(k - 1, i), ring(k - 1, i + 1), ring(k, i), ring(k, i + 1)];
            triangles.extend([[a, c, b], [b, c, d]]);
        }
        triangles.push([tip, ring(count - 1, i + 1), ring(count - 1, i)]);
    }
    mesh(&points, &triangles)
}

pub(crate) fn cylinder(half_height: f64, radius: f64) -> VisualMesh {
    revolve(-half_height, &[(-half_height, radius), (half_height, radius)], half_height)
}

fn cone(half_height: f64, radius: f64) -> VisualMesh {
    revolve(-half_height, &[(-half_height, radius)], half_height)
}

fn capsule(half_height: f64, radius: f64) -> VisualMesh {
    let ring = |angle: f64, shift: f64| (shift + radius * angle.sin(), radius * angle.cos());
    let step = FRAC_PI_2 / f64::from(TO_POLE);
    let mut rings: Vec<(f64, f64)> =
        (1..=TO_POLE).map(|k| ring(f64::from(k) * step - FRAC_PI_2, -half_height)).collect();
    let upper = (0..TO_POLE).map(|k| ring(f64::from(k) * step, half_height));
    rings.extend(upper.skip(usize::from(half_height == 0.0)));
    revolve(-half_height - radius, &rings, half_height + radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Area of the regular polygon that stands for a circle, as a share of the circle.
    fn polygon_share() -> f64 {
        let n = f64::from(AROUND);
        n / TAU * (TAU / n).sin()
    }

    fn volume(mesh: &VisualMesh) -> f64 {
        let corner = |i: u32| mesh.positions[i as usize].map(f64::from);
        let term = |t: &[u32; 3]| {
            let [a, b, c] = t.map(corner);
            let n = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
            (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6.0
        };
        mesh.triangles.iter().map(term).sum()
    }

    #[test]
    fn volumes_are_those_of_the_closed_forms() {
        assert!((volume(&cuboid([1.0, 2.0, 0.5])) - 8.0).abs() < 1e-6);
        let can = volume(&cylinder(1.5, 2.0));
        assert!((can - PI * 4.0 * 3.0 * polygon_share()).abs() < 1e-4, "{can}");
        let hat = volume(&cone(1.5, 2.0));
        assert!((hat - PI * 4.0 * polygon_share()).abs() < 1e-4, "{hat}");
        let ball = volume(&sphere(1.0));
        assert!(ball > 0.0 && (ball / (4.0 / 3.0 * PI) - 1.0).abs() < 0.02, "{ball}");
        let pill = volume(&capsule(1.0, 1.0));
        assert!((pill / (4.0 / 3.0 * PI + TAU) - 1.0).abs() < 0.02, "{pill}");
    }
}
