//! A convex piece as the error measure sees it: signed distance, surface points, volume.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::Shape;
use super::bvh::closest_on_triangle;
use super::fit_box::{FittedBox, quaternion};
use super::fit_frustum::Frustum;
use super::fit_round::Round;
use super::hull::Hull;
use super::prepared::{Prepared, Vec3, bounds, tangents};
use super::sampling::on_triangles;
use super::sight::ray_fan;

/// Corners of each rim of a frustum where it stands as a hull.
const RIM: usize = 16;
/// Corners of a ball or a capsule where it is held to have flat faces, and of each rim of a cylinder.
const FACETS: usize = 240;
const FINE_RIM: usize = 48;

#[derive(Clone, Debug)]
pub(super) enum Solid {
    Sphere { centre: Vec3, radius: f64 },
    Box(FittedBox),
    Capsule(Round),
    Cylinder(Round),
    Frustum(Frustum),
    Hull(Hull),
}

impl Solid {
    /// Negative inside. Exact but for a hull, where points outside get the distance to its faces one by one.
    pub fn distance(&self, p: Vec3) -> f64 {
        match self {
            Self::Sphere { centre, radius } => (p - centre).norm() - radius,
            Self::Box(b) => {
                let gap = b.axes.tr_mul(&(p - b.centre)).abs() - b.half_extents;
                gap.max().min(0.0) + gap.map(|x| x.max(0.0)).norm()
            }
            Self::Capsule(round) => round.capsule_distance(p),
            Self::Cylinder(round) => round.cylinder_distance(p),
            Self::Frustum(frustum) => frustum.distance(p),
            Self::Hull(hull) => {
                let deepest = hull.plane_distance(p);
                if deepest <= 0.0 {
                    return deepest;
                }
                let nearest =
                    hull.face_points().map(|face| (closest_on_triangle(p, &face) - p).norm_squared());
                nearest.fold(f64::INFINITY, f64::min).sqrt()
            }
        }
    }

    /// Whether `p` lies inside by more than `margin`.
    pub fn holds(&self, p: Vec3, margin: f64) -> bool {
        match self {
            Self::Hull(hull) => hull.planes.iter().all(|(n, d)| n.dot(&p) - d < -margin),
            _ => self.distance(p) < -margin,
        }
    }

    /// About `count` points spread over the surface.
    pub fn surface_points(&self, count: usize) -> Vec<Vec3> {
        match self {
            Self::Sphere { centre, radius } => {
                ray_fan(count).into_iter().map(|d| centre + d * *radius).collect()
            }
            Self::Box(b) => {
                let hull = Hull::of_box(-b.half_extents, b.half_extents);
                let faces: Vec<[Vec3; 3]> = hull.face_points().collect();
                let on_faces = on_triangles(&faces, count).into_iter().map(|(p, _)| p);
                on_faces.chain(hull.vertices.iter().copied()).map(|p| b.axes * p + b.centre).collect()
            }
            Self::Capsule(round) => {
                let cap = round.radius / (round.radius + round.half_height);
                let on_caps = (count as f64 * cap) as usize;
                let mut points: Vec<Vec3> = ray_fan(on_caps)
                    .into_iter()
                    .map(|d| {
                        let side =
                            if d.dot(&round.axis) < 0.0 { -round.half_height } else { round.half_height };
                        round.centre + d * round.radius + round.axis * side
                    })
                    .collect();
                points.extend(wall(round, count - on_caps));
                points
            }
            Self::Cylinder(round) => {
                let on_wall = 2.0 * round.half_height / (2.0 * round.half_height + round.radius);
                let on_wall = (count as f64 * on_wall) as usize;
                let mut points = wall(round, on_wall);
                let (u, v) = tangents(round.axis);
                for i in 0..count - on_wall {
                    // Sunflower spiral on alternating caps; the last ones lie on the rim.
                    let r = round.radius
                        * ((i / 2 + 1) as f64 / ((count - on_wall) / 2).max(1) as f64).sqrt().min(1.0);
                    let (sin, cos) = (i as f64 * 2.399_963).sin_cos();
                    let side = if i % 2 == 0 { round.half_height } else { -round.half_height };
                    points.push(round.centre + round.axis * side + (u * cos + v * sin) * r);
                }
                points
            }
            Self::Frustum(frustum) => frustum.surface_points(count),
            Self::Hull(hull) => {
                let faces: Vec<[Vec3; 3]> = hull.face_points().collect();
                let points = on_triangles(&faces, count).into_iter().map(|(p, _)| p);
                points.chain(hull.vertices.iter().copied()).collect()
            }
        }
    }

    /// The shape in flat faces: exact for a box and a hull, round ones with corners on their surface.
    pub fn facets(&self) -> Cow<'_, Hull> {
        let points: Vec<Vec3> = match self {
            Self::Hull(hull) => return Cow::Borrowed(hull),
            Self::Box(b) => {
                let corners = Hull::of_box(-b.half_extents, b.half_extents).vertices;
                corners.into_iter().map(|p| b.axes * p + b.centre).collect()
            }
            Self::Cylinder(round) => rims(round, round.radius),
            Self::Frustum(frustum) => rims(&frustum.round, frustum.top),
            Self::Sphere { .. } | Self::Capsule(_) => self.surface_points(FACETS),
        };
        let (low, high) = bounds(&points);
        Cow::Owned(Hull::of(&points, usize::MAX, 0.0).unwrap_or_else(|_| Hull::of_box(low, high)))
    }

    pub fn volume(&self) -> f64 {
        match self {
            Self::Sphere { radius, .. } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Box(b) => 8.0 * b.half_extents.product(),
            Self::Capsule(round) => {
                PI * round.radius.powi(2) * (2.0 * round.half_height + 4.0 / 3.0 * round.radius)
            }
            Self::Cylinder(round) => 2.0 * PI * round.radius.powi(2) * round.half_height,
            Self::Frustum(frustum) => frustum.volume(),
            Self::Hull(hull) => hull.volume(),
        }
    }

    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Self::Sphere { centre, radius } => {
                (centre - Vec3::repeat(*radius), centre + Vec3::repeat(*radius))
            }
            Self::Box(b) => {
                let reach = b.axes.abs() * b.half_extents;
                (b.centre - reach, b.centre + reach)
            }
            Self::Capsule(round) | Self::Cylinder(round) => {
                let reach = round.axis.abs() * round.half_height + Vec3::repeat(round.radius);
                (round.centre - reach, round.centre + reach)
            }
            Self::Frustum(Frustum { round, top }) => {
                let reach = round.axis.abs() * round.half_height + Vec3::repeat(round.radius.max(*top));
                (round.centre - reach, round.centre + reach)
            }
            Self::Hull(hull) => bounds(&hull.vertices),
        }
    }

    pub fn corners(&self) -> usize {
        match self {
            Self::Hull(hull) => hull.vertices.len(),
            Self::Box(_) => 8,
            Self::Frustum(_) => 2 * RIM,
            _ => 0,
        }
    }

    /// Relative cost of a contact with this shape: a ball is one; a hull's grows with the corners that a
    /// support query visits.
    pub fn cost(&self) -> f64 {
        match self {
            Self::Sphere { .. } => 1.0,
            Self::Box(_) | Self::Capsule(_) => 2.0,
            Self::Cylinder(_) => 4.0,
            Self::Frustum(_) | Self::Hull(_) => 4.0 + 0.1 * self.corners() as f64,
        }
    }

    /// In file units and axes.
    pub fn shape(&self, mesh: &Prepared) -> Shape {
        let scale = mesh.diagonal;
        match self {
            Self::Sphere { centre, radius } => {
                Shape::Sphere { center: mesh.to_file(*centre), radius: radius * scale }
            }
            Self::Box(b) => Shape::Box {
                center: mesh.to_file(b.centre),
                rotation: quaternion(&b.axes),
                half_extents: (b.half_extents * scale).into(),
            },
            Self::Capsule(round) => Shape::Capsule {
                center: mesh.to_file(round.centre),
                rotation: quaternion(&round.frame()),
                half_height: round.half_height * scale,
                radius: round.radius * scale,
            },
            Self::Cylinder(round) => Shape::Cylinder {
                center: mesh.to_file(round.centre),
                rotation: quaternion(&round.frame()),
                half_height: round.half_height * scale,
                radius: round.radius * scale,
            },
            Self::Frustum(Frustum { round, top }) => Shape::Frustum {
                center: mesh.to_file(round.centre),
                rotation: quaternion(&round.frame()),
                half_height: round.half_height * scale,
                radius_bottom: round.radius * scale,
                radius_top: top * scale,
            },
            Self::Hull(hull) => {
                Shape::Hull { points: hull.vertices.iter().map(|p| mesh.to_file(*p)).collect() }
            }
        }
    }
}

/// Corners of a frustum's hull in its local frame, along Y: rings of `RIM` corners that err by as much to the
/// inside as to the outside of the round. For engines that know no frustum.
#[must_use]
pub fn frustum_corners(half_height: f64, radius_bottom: f64, radius_top: f64) -> Vec<[f64; 3]> {
    let step = 2.0 * PI / RIM as f64;
    let wider = 2.0 / (1.0 + (step / 2.0).cos());
    [(-half_height, radius_bottom), (half_height, radius_top)]
        .into_iter()
        .flat_map(|(y, radius)| {
            (0..RIM).map(move |i| {
                let (sin, cos) = (i as f64 * step).sin_cos();
                [cos * radius * wider, y, sin * radius * wider]
            })
        })
        .collect()
}

/// Corners of both rims, the lower one's radius that of `round`.
fn rims(round: &Round, top: f64) -> Vec<Vec3> {
    let (u, v) = tangents(round.axis);
    let rim = |side: f64, radius: f64| {
        (0..FINE_RIM).map(move |i| {
            let (sin, cos) = (2.0 * PI * i as f64 / FINE_RIM as f64).sin_cos();
            round.centre + round.axis * side + (u * cos + v * sin) * radius
        })
    };
    rim(-round.half_height, round.radius).chain(rim(round.half_height, top)).collect()
}

/// Points spread over the straight part of a capsule or cylinder.
fn wall(round: &Round, count: usize) -> Vec<Vec3> {
    let (u, v) = tangents(round.axis);
    (0..count)
        .map(|i| {
            let along = round.half_height * (2.0 * (i as f64 + 0.5) / count as f64 - 1.0);
            let (sin, cos) = (i as f64 * 2.399_963).sin_cos();
            round.centre + round.axis * along + (u * cos + v * sin) * round.radius
        })
        .collect()
}
