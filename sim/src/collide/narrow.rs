//! Manifolds between two bodies, one call a pair of child shapes.

use crate::body::Body;
use crate::collide::half_space::supports;
use crate::collide::manifold::{Anchor, Candidate, Manifold, Point, reduce};
use crate::collide::parry;
use crate::material::Meeting;
use crate::math::{Frame3, Vec3, tangents};
use crate::shape::{Collider, Geometry};

/// Manifolds between `a` and `b`, sorted by key; points farther apart than `reach` metres are left out.
pub(crate) fn manifolds(a: &Body, b: &Body, reach: f64) -> Vec<Manifold> {
    let mut found = Vec::new();
    let (frame_a, frame_b) = (a.frame(), b.frame());
    for (i, child_a) in (0..).zip(&a.colliders) {
        let world_a = frame_a.compose(&child_a.body_from_shape);
        let bounds_a = child_a.aabb(&world_a).grown(reach);
        if !bounds_a.overlaps(&b.aabb) {
            continue;
        }
        for (j, child_b) in (0..).zip(&b.colliders) {
            let world_b = frame_b.compose(&child_b.body_from_shape);
            if bounds_a.overlaps(&child_b.aabb(&world_b)) {
                let near = Near { a: (child_a, &world_a, &frame_a), b: (child_b, &world_b, &frame_b), reach };
                near.manifolds((i, j), &mut found);
            }
        }
    }
    found
}

/// A child shape, its frame and its body's frame in the world.
type Side<'a> = (&'a Collider, &'a Frame3, &'a Frame3);

struct Near<'a> {
    a: Side<'a>,
    b: Side<'a>,
    reach: f64,
}

/// A contact point before reduction, world.
struct Found {
    anchor_a: Anchor,
    anchor_b: Anchor,
    middle: Vec3,
    separation: f64,
    feature: u64,
}

impl Near<'_> {
    fn manifolds(&self, (i, j): (u32, u32), out: &mut Vec<Manifold>) {
        match (&self.a.0.geometry, &self.b.0.geometry) {
            (Geometry::HalfSpace, _) => {
                let up = self.a.1.rotation * Vec3::y();
                let points = self.against_plane(&self.a, &self.b, &up, false);
                self.push((i, j, 0), up, points, out);
            }
            (_, Geometry::HalfSpace) => {
                let up = self.b.1.rotation * Vec3::y();
                let points = self.against_plane(&self.b, &self.a, &up, true);
                self.push((i, j, 0), -up, points, out);
            }
            (Geometry::Sphere { radius: ra }, Geometry::Sphere { radius: rb }) => {
                let between = self.b.1.position - self.a.1.position;
                let distance = between.norm();
                let normal = if distance > 1e-12 { between / distance } else { Vec3::y() };
                let point = Found {
                    anchor_a: Anchor::round(self.a.2, &self.a.1.position, normal * *ra),
                    anchor_b: Anchor::round(self.b.2, &self.b.1.position, normal * -*rb),
                    middle: self.a.1.position + normal * *ra,
                    separation: distance - ra - rb,
                    feature: 0,
                };
                self.push((i, j, 0), normal, vec![point], out);
            }
            _ => {
                let a_from_b = self.a.1.inverse_compose(self.b.1);
                for raw in parry::manifolds(&self.a.0.parry, &self.b.0.parry, &a_from_b, self.reach) {
                    let normal = self.a.1.rotation * raw.normal;
                    let points = raw.points.iter().map(|point| {
                        let on_a = self.a.1.point(&point.on_a);
                        let on_b = on_a + normal * point.separation;
                        Found {
                            anchor_a: anchor(&self.a, &on_a, &normal),
                            anchor_b: anchor(&self.b, &on_b, &-normal),
                            middle: (on_a + on_b) * 0.5,
                            separation: point.separation,
                            feature: point.feature,
                        }
                    });
                    self.push((i, j, raw.subshape), normal, points.collect(), out);
                }
            }
        }
    }

    /// Points of `other` near the surface of the half-space `plane`, whose normal is `up`.
    fn against_plane(&self, plane: &Side<'_>, other: &Side<'_>, up: &Vec3, plane_is_b: bool) -> Vec<Found> {
        let found = supports(&other.0.geometry, other.1, up).into_iter().map(|support| {
            let height = (support.core - plane.1.position).dot(up);
            let surface = support.core - up * support.radius;
            let foot = support.core - up * height;
            let on_other = Anchor::round(other.2, &support.core, -up * support.radius);
            let on_plane = Anchor::corner(plane.2, &foot);
            let (anchor_a, anchor_b) = if plane_is_b { (on_other, on_plane) } else { (on_plane, on_other) };
            Found {
                anchor_a,
                anchor_b,
                middle: (surface + foot) * 0.5,
                separation: height - support.radius,
                feature: support.feature,
            }
        });
        found.collect()
    }

    fn push(&self, key: (u32, u32, u32), normal: Vec3, mut found: Vec<Found>, out: &mut Vec<Manifold>) {
        found.retain(|point| point.separation < self.reach);
        if found.is_empty() {
            return;
        }
        let points = reduced(found, &normal).into_iter().map(|found| {
            let Found { anchor_a, anchor_b, feature, .. } = found;
            Point { anchor_a, anchor_b, feature, ..Point::default() }
        });
        let Meeting { friction, restitution } =
            Meeting::of(&self.a.0.pairs, &self.a.0.surface, &self.b.0.surface);
        out.push(Manifold {
            key,
            normal,
            tangents: tangents(&normal),
            friction,
            restitution,
            points: points.collect(),
        });
    }
}

/// The points that span the region.
fn reduced(found: Vec<Found>, normal: &Vec3) -> Vec<Found> {
    let candidates: Vec<Candidate> = found
        .iter()
        .map(|point| Candidate { position: point.middle, separation: point.separation })
        .collect();
    let kept = reduce(&candidates, normal);
    found.into_iter().zip(0..).filter(|(_, i)| kept.contains(i)).map(|(point, _)| point).collect()
}

/// The anchor of the world surface point `point` on a shape whose outward normal there is `outward`.
fn anchor((shape, world, body): &Side<'_>, point: &Vec3, outward: &Vec3) -> Anchor {
    let axis = world.rotation * Vec3::y();
    match &shape.geometry {
        Geometry::Sphere { radius } => Anchor::round(body, &(point - outward * *radius), outward * *radius),
        Geometry::Capsule { half_height, radius } => {
            let along = (point - world.position).dot(&axis).clamp(-*half_height, *half_height);
            Anchor::round(body, &(world.position + axis * along), outward * *radius)
        }
        // On its mantle a cylinder rolls, on its caps it does not.
        Geometry::Cylinder { radius, .. } if outward.dot(&axis).abs() < 0.02 => {
            Anchor::round(body, &(point - outward * *radius), outward * *radius)
        }
        _ => Anchor::corner(body, point),
    }
}
