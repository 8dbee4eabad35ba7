//! The border to parry: the one file of this crate that names it. f32 in parry's frame of shape A, f64 outside;
//! relative poses are formed in f64, so that distance from the origin costs nothing.

use std::sync::Arc;

use parry3d::math::{Pose, Rot3, Vector};
use parry3d::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::{
    Ball, Capsule, ConvexPolyhedron, Cuboid, Cylinder, HalfSpace, Shape as ParryShape, TriMesh, TriMeshFlags,
};
use parry3d::transformation::try_convex_hull;

use crate::math::{Frame3, Vec3};
use crate::scene::Shape as SceneShape;

/// A shape as parry knows it.
#[derive(Clone)]
pub(crate) struct Shape {
    shape: Arc<dyn ParryShape>,
    corners: Option<Vec<Vec3>>,
}

/// One point between two surfaces, in the frame of shape A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawPoint {
    pub(crate) on_a: Vec3,
    /// Distance along the manifold's normal, negative where they overlap.
    pub(crate) separation: f64,
    /// Identifies the features that meet, for matching between steps.
    pub(crate) feature: u64,
}

/// Points that share a normal, from A to B, in the frame of shape A.
#[derive(Clone, Debug)]
pub(crate) struct RawManifold {
    pub(crate) normal: Vec3,
    /// Triangle of a mesh, else 0.
    pub(crate) subshape: u32,
    pub(crate) points: Vec<RawPoint>,
}

impl Shape {
    /// # Errors
    /// What is wrong with the shape, in words.
    pub(crate) fn new(shape: &SceneShape) -> Result<Self, String> {
        let mut corners = None;
        let shape: Arc<dyn ParryShape> = match shape {
            SceneShape::Sphere { radius } => Arc::new(Ball::new(single(*radius))),
            SceneShape::Box { half_extents } => Arc::new(Cuboid::new(vector(&Vec3::from(*half_extents)))),
            SceneShape::Capsule { half_height, radius } => {
                Arc::new(Capsule::new_y(single(*half_height), single(*radius)))
            }
            SceneShape::Cylinder { half_height, radius } => {
                Arc::new(Cylinder::new(single(*half_height), single(*radius)))
            }
            SceneShape::Hull { points } => {
                let (hull, kept) = convex(points)?;
                corners = Some(kept);
                Arc::new(hull)
            }
            SceneShape::HalfSpace => Arc::new(HalfSpace::new(Vector::Y)),
            SceneShape::TriangleMesh { positions, triangles } => {
                Arc::new(triangle_mesh(positions, triangles)?)
            }
        };
        Ok(Self { shape, corners })
    }

    /// The corners of a hull, points inside it left out; `None` for other shapes.
    pub(crate) fn hull_corners(&self) -> Option<Vec<Vec3>> {
        self.corners.clone()
    }
}

/// Every manifold between two shapes closer than `reach` metres; `b` is seen from `a`'s frame.
pub(crate) fn manifolds(a: &Shape, b: &Shape, a_from_b: &Frame3, reach: f64) -> Vec<RawManifold> {
    let pose = Pose::from_parts(
        vector(&a_from_b.position),
        Rot3::from_array(a_from_b.rotation.coords.map(single).into()),
    );
    let dispatcher = DefaultQueryDispatcher;
    let mut found: Vec<ContactManifold<(), ()>> = Vec::new();
    // A fresh manifold each time: parry would else keep points of an older pose and only move them.
    // Pairs that it does not support do not occur: construction admits no static against static.
    let supported = dispatcher.contact_manifolds(
        &pose,
        a.shape.as_ref(),
        b.shape.as_ref(),
        single(reach),
        &mut found,
        &mut None,
    );
    if supported.is_err() {
        return Vec::new();
    }
    found
        .iter()
        .filter(|manifold| !manifold.points.is_empty())
        .map(|manifold| {
            let subpose = manifold.subshape_pos1();
            let into_a = |v: Vector, point: bool| match (subpose, point) {
                (Some(pose), true) => pose.transform_point(v),
                (Some(pose), false) => pose.transform_vector(v),
                (None, _) => v,
            };
            RawManifold {
                normal: double(into_a(manifold.local_n1, false)).normalize(),
                subshape: manifold.subshape1.max(manifold.subshape2),
                points: manifold
                    .points
                    .iter()
                    .map(|point| RawPoint {
                        on_a: double(into_a(point.local_p1, true)),
                        separation: f64::from(point.dist),
                        feature: u64::from(point.fid1.0) << 32 | u64::from(point.fid2.0),
                    })
                    .collect(),
            }
        })
        .filter(|manifold| manifold.normal.iter().all(|x| x.is_finite()))
        .collect()
}

/// The hull is found on points scaled to a unit box, where parry's tolerances are meant to be.
fn convex(points: &[[f64; 3]]) -> Result<(ConvexPolyhedron, Vec<Vec3>), String> {
    let flat = || "the points of the hull span no volume; give it a thickness".to_owned();
    let points: Vec<Vec3> = points.iter().map(|point| Vec3::from(*point)).collect();
    let min = points.iter().fold(Vec3::repeat(f64::INFINITY), |min, p| min.inf(p));
    let max = points.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |max, p| max.sup(p));
    let scale = (max - min).max();
    if !(scale > 0.0 && scale.is_finite()) || (max - min).min() < 1e-6 * scale {
        return Err(flat());
    }
    let center = (min + max) * 0.5;
    let unit: Vec<Vector> = points.iter().map(|p| vector(&((p - center) / scale))).collect();
    let (unit_corners, triangles) = try_convex_hull(&unit).map_err(|_| flat())?;
    let corners: Vec<Vec3> = unit_corners.iter().map(|p| double(*p) * scale + center).collect();
    let hull = ConvexPolyhedron::from_convex_mesh(corners.iter().map(vector).collect(), &triangles)
        .ok_or_else(flat)?;
    Ok((hull, corners))
}

fn triangle_mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<TriMesh, String> {
    if let Some(index) = triangles.iter().flatten().find(|index| **index as usize >= positions.len()) {
        return Err(format!("a triangle names vertex {index} of {}", positions.len()));
    }
    let vertices = positions.iter().map(|p| vector(&Vec3::from(*p))).collect();
    TriMesh::with_flags(vertices, triangles.to_vec(), TriMeshFlags::FIX_INTERNAL_EDGES)
        .map_err(|error| format!("the triangle mesh cannot be used: {error}"))
}

#[expect(clippy::cast_possible_truncation, reason = "parry computes in f32; the border rounds to it")]
fn single(x: f64) -> f32 {
    x as f32
}

fn vector(v: &Vec3) -> Vector {
    Vector::new(single(v.x), single(v.y), single(v.z))
}

fn double(v: Vector) -> Vec3 {
    Vec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}
