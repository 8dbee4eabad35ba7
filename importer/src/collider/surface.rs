//! The surface of a shape as triangles, for pictures and exports.

use super::hull::Hull;
use super::prepared::{Vec3, bounds};
use super::solid::frustum_corners;
use super::{Shape, sight::ray_fan};

/// Directions in which a round shape is cut into facets.
const FACETS: usize = 240;
/// Corners of a cylinder's rim.
const RIM: usize = 32;

/// Corners and counter-clockwise triangles of the shape's surface, in file units; round shapes in facets. Empty
/// for a hull of points in a plane.
#[must_use]
pub fn surface(shape: &Shape) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let fan = |radius: f64, y: f64| {
        ray_fan(FACETS).into_iter().map(move |d| [d.x * radius, d.y * radius + y, d.z * radius])
    };
    match shape {
        Shape::TriangleMesh { positions, triangles } => (positions.clone(), triangles.clone()),
        Shape::Hull { points } => hull_of(points),
        Shape::Sphere { center, radius } => {
            hull_of(&placed(fan(*radius, 0.0), *center, [0.0, 0.0, 0.0, 1.0]))
        }
        Shape::Box { center, rotation, half_extents: [x, y, z] } => {
            let corners = (0..8).map(|corner| {
                let side = |bit: u32, half: f64| if corner >> bit & 1 == 0 { -half } else { half };
                [side(0, *x), side(1, *y), side(2, *z)]
            });
            hull_of(&placed(corners, *center, *rotation))
        }
        Shape::Capsule { center, rotation, half_height, radius } => {
            hull_of(&placed(fan(*radius, -half_height).chain(fan(*radius, *half_height)), *center, *rotation))
        }
        Shape::Cylinder { center, rotation, half_height, radius } => {
            let rim = (0..2 * RIM).map(|i| {
                let (sin, cos) = (std::f64::consts::PI * (i / 2) as f64 * 2.0 / RIM as f64).sin_cos();
                [cos * radius, if i % 2 == 0 { *half_height } else { -half_height }, sin * radius]
            });
            hull_of(&placed(rim, *center, *rotation))
        }
        Shape::Frustum { center, rotation, half_height, radius_bottom, radius_top } => {
            let corners = frustum_corners(*half_height, *radius_bottom, *radius_top);
            hull_of(&placed(corners.into_iter(), *center, *rotation))
        }
    }
}

fn placed(points: impl Iterator<Item = [f64; 3]>, center: [f64; 3], [x, y, z, w]: [f64; 4]) -> Vec<[f64; 3]> {
    let turn = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
    points.map(|p| (turn * Vec3::from(p) + Vec3::from(center)).into()).collect()
}

fn hull_of(points: &[[f64; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let points: Vec<Vec3> = points.iter().map(|p| Vec3::from(*p)).collect();
    let (low, high) = bounds(&points);
    let diagonal = (high - low).norm();
    let scaled: Vec<Vec3> = points.iter().map(|p| (p - low) / diagonal).collect();
    match Hull::of(&scaled, usize::MAX, 0.0) {
        Ok(hull) => (hull.vertices.iter().map(|v| (v * diagonal + low).into()).collect(), hull.faces),
        Err(_) => (Vec::new(), Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the divergence theorem, so that a face turned inwards shows.
    fn volume(shape: &Shape) -> f64 {
        let (positions, triangles) = surface(shape);
        let corner = |i: u32| Vec3::from(positions[i as usize]);
        triangles.iter().map(|t| corner(t[0]).dot(&corner(t[1]).cross(&corner(t[2]))) / 6.0).sum()
    }

    #[test]
    fn volumes_are_those_of_the_shapes() {
        let (center, rotation) = ([1.0, 2.0, 3.0], [0.5, 0.5, 0.5, 0.5]);
        let pi = std::f64::consts::PI;
        let cases = [
            (Shape::Sphere { center, radius: 2.0 }, 4.0 / 3.0 * pi * 8.0),
            (Shape::Box { center, rotation, half_extents: [1.0, 2.0, 3.0] }, 48.0),
            (Shape::Capsule { center, rotation, half_height: 1.0, radius: 0.5 }, pi * (0.5 + 1.0 / 6.0)),
            (Shape::Cylinder { center, rotation, half_height: 1.0, radius: 0.5 }, pi * 0.5),
            (
                Shape::Frustum { center, rotation, half_height: 1.0, radius_bottom: 1.0, radius_top: 0.5 },
                pi * 2.0 / 3.0 * 1.75,
            ),
        ];
        for (shape, expected) in cases {
            let found = volume(&shape);
            assert!((found / expected - 1.0).abs() < 0.04, "{shape:?}: {found} {expected}");
        }
    }
}
