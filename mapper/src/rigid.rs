//! Mass properties of primitives and of bodies made of several.

use sim::{ChildShape, Entity, Mass, Motion, Pose, Shape, Velocity};

use crate::scene::{bounds, rotate, turn_inertia};

/// A shape, its place in the body, and what it is made of.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub child: ChildShape,
    pub density: Option<f64>,
    /// Beats the density.
    pub mass_kg: Option<f64>,
}

/// Volume (m³), centroid and inertia per mass (m²) of a shape about its centroid, in the shape's axes.
///
/// Closed forms; a hull's by tetrahedra from its mean point over its faces, which needs the faces, so that a hull
/// is taken through the tetrahedra of [`hull_moments`]. `None` for what has no volume.
#[must_use]
pub(crate) fn moments(shape: &Shape) -> Option<(f64, [f64; 3], [f64; 6])> {
    use std::f64::consts::PI;
    let diagonal = |x: f64, y: f64, z: f64| [x, y, z, 0.0, 0.0, 0.0];
    let origin = [0.0; 3];
    Some(match shape {
        Shape::Sphere { radius: r } => {
            let about = 0.4 * r * r;
            (4.0 / 3.0 * PI * r.powi(3), origin, diagonal(about, about, about))
        }
        Shape::Box { half_extents: [x, y, z] } => {
            let about = |a: &f64, b: &f64| (a * a + b * b) / 3.0;
            (8.0 * x * y * z, origin, diagonal(about(y, z), about(x, z), about(x, y)))
        }
        Shape::Cylinder { half_height: h, radius: r } => {
            let across = (3.0 * r * r + 4.0 * h * h) / 12.0;
            (2.0 * PI * r * r * h, origin, diagonal(across, 0.5 * r * r, across))
        }
        Shape::Capsule { half_height: h, radius: r } => {
            // Cylinder and two half balls; a half ball's centroid lies 3/8 r from its flat side.
            let tube = 2.0 * PI * r * r * h;
            let ball = 4.0 / 3.0 * PI * r.powi(3);
            let volume = tube + ball;
            let along = (tube * 0.5 + ball * 0.4) * r * r / volume;
            let tube_across = tube * (3.0 * r * r + 4.0 * h * h) / 12.0;
            let ball_across = ball * (0.4 * r * r + h * h + 0.75 * h * r);
            let across = (tube_across + ball_across) / volume;
            (volume, origin, diagonal(across, along, across))
        }
        Shape::Cone { half_height: h, radius: r } => {
            // The centroid lies at a quarter of the height above the base.
            let across = 0.15 * (r * r + h * h);
            (2.0 / 3.0 * PI * r * r * h, [0.0, -0.5 * h, 0.0], diagonal(across, 0.3 * r * r, across))
        }
        Shape::Hull { points } => return hull_moments(points),
        Shape::HalfSpace | Shape::TriangleMesh { .. } | Shape::HeightField(_) => return None,
    })
}

/// A hull's faces are every plane through three points with all others on one side: cubic in the number of
/// points, which are few in a scene written by hand. Integrals by tetrahedra from the mean point.
fn hull_moments(points: &[[f64; 3]]) -> Option<(f64, [f64; 3], [f64; 6])> {
    if points.len() < 4 || points.len() > 256 {
        return None;
    }
    let count = points.len() as f64;
    let mean: [f64; 3] =
        std::array::from_fn(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let local: Vec<[f64; 3]> = points.iter().map(|point| sub(*point, mean)).collect();
    let reach = local.iter().map(|point| dot(*point, *point)).fold(0.0, f64::max).sqrt();
    let mut volume = 0.0;
    let mut first = [0.0; 3];
    let mut second = [[0.0; 3]; 3];
    for [a, b, c] in faces(&local, reach * 1e-9) {
        let tetra = dot(a, cross(b, c)) / 6.0;
        volume += tetra;
        let sum: [f64; 3] = std::array::from_fn(|axis| a[axis] + b[axis] + c[axis]);
        for axis in 0..3 {
            first[axis] += tetra * sum[axis] / 4.0;
            for other in 0..3 {
                let own = a[axis] * a[other] + b[axis] * b[other] + c[axis] * c[other];
                second[axis][other] += tetra * (own + sum[axis] * sum[other]) / 20.0;
            }
        }
    }
    if volume <= reach.powi(3) * 1e-9 {
        return None;
    }
    let centroid = first.map(|entry| entry / volume);
    let s = |axis: usize, other: usize| second[axis][other] / volume - centroid[axis] * centroid[other];
    let inertia = [s(1, 1) + s(2, 2), s(0, 0) + s(2, 2), s(0, 0) + s(1, 1), -s(0, 1), -s(0, 2), -s(1, 2)];
    Some((volume, std::array::from_fn(|axis| centroid[axis] + mean[axis]), inertia))
}

/// Triangles of the hull of points around the origin, wound outwards; a face of many corners is fanned.
fn faces(points: &[[f64; 3]], slack: f64) -> Vec<[[f64; 3]; 3]> {
    let mut planes: Vec<([f64; 3], f64)> = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            for k in j + 1..points.len() {
                let raw = cross(sub(points[j], points[i]), sub(points[k], points[i]));
                let length = dot(raw, raw).sqrt();
                if length <= slack * slack {
                    continue;
                }
                let mut normal = raw.map(|entry| entry / length);
                let mut offset = dot(normal, points[i]);
                if offset < 0.0 {
                    normal = normal.map(|entry| -entry);
                    offset = -offset;
                }
                let near = slack.max(1e-12) * 10.0;
                if points.iter().any(|point| dot(normal, *point) > offset + near)
                    || planes
                        .iter()
                        .any(|(known, at)| dot(*known, normal) > 1.0 - 1e-9 && (at - offset).abs() <= near)
                {
                    continue;
                }
                planes.push((normal, offset));
                fan(points, normal, offset, near, &mut triangles);
            }
        }
    }
    triangles
}

fn fan(points: &[[f64; 3]], normal: [f64; 3], offset: f64, near: f64, triangles: &mut Vec<[[f64; 3]; 3]>) {
    let mut corners: Vec<[f64; 3]> =
        points.iter().filter(|point| (dot(normal, **point) - offset).abs() <= near).copied().collect();
    let count = corners.len() as f64;
    let middle: [f64; 3] =
        std::array::from_fn(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / count);
    let Some(first) = corners.first() else { return };
    let along = sub(*first, middle);
    let across = cross(normal, along);
    let angle = |corner: &[f64; 3]| dot(sub(*corner, middle), across).atan2(dot(sub(*corner, middle), along));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    for next in 1..corners.len().saturating_sub(1) {
        triangles.push([corners[0], corners[next], corners[next + 1]]);
    }
}

/// The body of several pieces, its frame moved to the centre of mass, and where the old origin lies in it.
/// `None` where nothing has a mass.
#[must_use]
pub(crate) fn about_center(
    name: &str,
    pieces: Vec<Piece>,
    mass_kg: Option<f64>,
) -> Option<(Entity, [f64; 3])> {
    let mut weighed = Vec::with_capacity(pieces.len());
    for piece in &pieces {
        let (volume, centroid, inertia) = moments(&piece.child.shape)?;
        let mass =
            piece.mass_kg.or_else(|| Some(piece.density? * volume)).or_else(|| Some(mass_kg? * volume))?;
        let pose = piece.child.body_from_shape;
        let turned = rotate(pose.rotation, centroid);
        let center: [f64; 3] = std::array::from_fn(|axis| pose.position[axis] + turned[axis]);
        weighed.push((mass, center, turn_inertia(pose.rotation, inertia.map(|entry| entry * mass))));
    }
    let total: f64 = weighed.iter().map(|(mass, ..)| mass).sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let center: [f64; 3] =
        std::array::from_fn(|axis| weighed.iter().map(|(mass, at, _)| mass * at[axis]).sum::<f64>() / total);
    let mut inertia = [0.0; 6];
    for (mass, at, own) in &weighed {
        let [x, y, z] = sub(*at, center);
        let steiner = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
        for entry in 0..6 {
            inertia[entry] += own[entry] + mass * steiner[entry];
        }
    }
    let factor = mass_kg.map_or(1.0, |wanted| wanted / total);
    let shapes: Vec<ChildShape> = pieces
        .into_iter()
        .map(|Piece { mut child, .. }| {
            child.body_from_shape.position = sub(child.body_from_shape.position, center);
            child
        })
        .collect();
    bounds(&shapes)?;
    let mass = Mass { mass_kg: total * factor, inertia_kg_m2: inertia.map(|entry| entry * factor) };
    let entity = Entity {
        name: name.to_owned(),
        motion: Motion::Dynamic(mass),
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes,
    };
    Some((entity, center.map(|coordinate| -coordinate)))
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use sim::Surface;

    use super::*;

    fn corners(x: f64, y: f64, z: f64) -> Vec<[f64; 3]> {
        (0..8)
            .map(|bits| {
                [
                    if bits & 1 == 0 { -x } else { x },
                    if bits & 2 == 0 { -y } else { y },
                    if bits & 4 == 0 { -z } else { z },
                ]
            })
            .collect()
    }

    #[test]
    fn a_hull_of_a_box_weighs_as_the_box() {
        let shifted = corners(0.5, 1.0, 1.5).into_iter().map(|[x, y, z]| [x + 3.0, y - 1.0, z]).collect();
        let (volume, centroid, inertia) = moments(&Shape::Hull { points: shifted }).unwrap();
        let (box_volume, _, box_inertia) = moments(&Shape::Box { half_extents: [0.5, 1.0, 1.5] }).unwrap();
        assert!((volume - box_volume).abs() < 1e-9, "{volume}");
        assert!((centroid[0] - 3.0).abs() < 1e-9 && (centroid[1] + 1.0).abs() < 1e-9, "{centroid:?}");
        assert!(
            inertia.iter().zip(box_inertia).all(|(a, b)| (a - b).abs() < 1e-9),
            "{inertia:?} {box_inertia:?}"
        );
    }

    #[test]
    fn a_capsule_without_a_tube_is_a_ball() {
        let capsule = moments(&Shape::Capsule { half_height: 0.0, radius: 0.3 }).unwrap();
        let ball = moments(&Shape::Sphere { radius: 0.3 }).unwrap();
        assert!((capsule.0 - ball.0).abs() < 1e-12);
        assert!(capsule.2.iter().zip(ball.2).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn two_halves_of_a_box_make_the_box() {
        let surface = Surface::new(0.5, 0.1);
        let half = |x: f64| Piece {
            child: ChildShape {
                shape: Shape::Box { half_extents: [0.5, 0.5, 0.5] },
                body_from_shape: Pose::at([x, 2.0, 0.0]),
                surface,
                part: 0,
            },
            density: Some(100.0),
            mass_kg: None,
        };
        let (entity, origin) = about_center("pair", vec![half(-0.5), half(0.5)], None).unwrap();
        let Motion::Dynamic(mass) = entity.motion else { panic!("static") };
        let (volume, _, inertia) = moments(&Shape::Box { half_extents: [1.0, 0.5, 0.5] }).unwrap();
        assert!((mass.mass_kg - 100.0 * volume).abs() < 1e-9);
        assert!(mass.inertia_kg_m2.iter().zip(inertia).all(|(a, b)| (a - b * 200.0).abs() < 1e-9));
        assert_eq!(origin, [0.0, -2.0, 0.0]);
    }
}
