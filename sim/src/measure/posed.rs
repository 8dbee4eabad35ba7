//! A convex shape where it is, and how deep two of them overlap.

use super::distance::{segment_to_triangle, segments};
use super::polyhedron::Polyhedron;
use super::round;
use crate::math::{Frame3, Vec3};
use crate::scene::Shape;

/// A convex shape about its own origin: a polyhedron, segment or point with a radius around it, or a cylinder or cone.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    core: Polyhedron,
    radius: f64,
    /// Of a cylinder or cone along Y, whose core is its axis: radii of the lower and the upper end, m.
    rims: Option<[f64; 2]>,
    /// Largest distance from the origin, m.
    pub(super) reach: f64,
}

/// A solid turned into the world's axes, its points counted from `position`.
#[derive(Clone, Debug)]
pub(super) struct Posed<'a> {
    pub(super) solid: &'a Solid,
    pub(super) position: Vec3,
    pub(super) vertices: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) edges: Vec<Vec3>,
    pub(super) min: Vec3,
    pub(super) max: Vec3,
}

impl Solid {
    /// `None` for shapes without an inside of their own: half-spaces and meshes.
    pub(super) fn new(shape: &Shape) -> Option<Self> {
        let segment = |half: f64| Polyhedron {
            vertices: vec![Vec3::y() * -half, Vec3::y() * half],
            edges: vec![Vec3::y()],
            ..Polyhedron::default()
        };
        let (core, radius, rims) = match shape {
            Shape::Sphere { radius } => {
                (Polyhedron { vertices: vec![Vec3::zeros()], ..Polyhedron::default() }, *radius, None)
            }
            Shape::Capsule { half_height, radius } => (segment(*half_height), *radius, None),
            Shape::Cylinder { half_height, radius } => (segment(*half_height), *radius, Some([*radius; 2])),
            Shape::Cone { half_height, radius } => (segment(*half_height), *radius, Some([*radius, 0.0])),
            Shape::Box { half_extents } => (Polyhedron::cuboid(&(*half_extents).into()), 0.0, None),
            Shape::Hull { points } if !points.is_empty() => {
                let points: Vec<Vec3> = points.iter().map(|point| Vec3::from(*point)).collect();
                (Polyhedron::hull(&points), 0.0, None)
            }
            Shape::Hull { .. } | Shape::HalfSpace | Shape::TriangleMesh { .. } | Shape::HeightField(_) => {
                return None;
            }
        };
        let reach = core.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max) + radius;
        Some(Self { core, radius, rims, reach })
    }

    pub(super) fn at(&self, frame: &Frame3) -> Posed<'_> {
        let turned = |all: &[Vec3]| -> Vec<Vec3> { all.iter().map(|v| frame.rotation * v).collect() };
        let mut posed = Posed {
            solid: self,
            position: frame.position,
            vertices: turned(&self.core.vertices),
            normals: turned(&self.core.normals),
            edges: turned(&self.core.edges),
            min: frame.position,
            max: frame.position,
        };
        for axis in 0..3 {
            let mut direction = Vec3::zeros();
            direction[axis] = 1.0;
            posed.max[axis] += posed.support(&direction);
            posed.min[axis] -= posed.support(&-direction);
        }
        posed
    }
}

impl Posed<'_> {
    pub(super) const fn radius(&self) -> f64 {
        self.solid.radius
    }

    /// Radii of the lower and the upper end, for a cylinder or cone.
    pub(super) const fn rims(&self) -> Option<[f64; 2]> {
        self.solid.rims
    }

    /// Extent of the core along `direction`, from `position`.
    fn core_support(&self, direction: &Vec3) -> f64 {
        self.vertices.iter().map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The support function from `position`: the largest `direction · point`, for a unit direction.
    pub(super) fn support(&self, direction: &Vec3) -> f64 {
        let Some(rims) = self.rims() else { return self.core_support(direction) + self.solid.radius };
        let along = direction.dot(&self.edges[0]);
        let across = (1.0 - along * along).max(0.0).sqrt();
        let ends = self.vertices.iter().zip(rims).map(|(end, radius)| end.dot(direction) + radius * across);
        ends.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The core's triangles, from `position`.
    fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.solid.core.triangles.iter().map(|triangle| triangle.map(|i| self.vertices[i as usize]))
    }

    fn segment(&self) -> Option<[Vec3; 2]> {
        match self.vertices[..] {
            [point] => Some([point, point]),
            [from, to] => Some([from, to]),
            _ => None,
        }
    }

    /// How deep a point lies below this polyhedron's surface, m; `None` where it is outside or there is no
    /// surface.
    pub(super) fn depth_of(&self, point: &Vec3) -> Option<f64> {
        let from_here = point - self.position;
        let height = |normal: &Vec3| self.core_support(normal) - normal.dot(&from_here);
        let depth = self.normals.iter().map(height).fold(f64::INFINITY, f64::min);
        (depth > 0.0 && depth.is_finite()).then_some(depth)
    }

    pub(super) fn near(&self, other: &Posed<'_>) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

/// How deep `a` and `b` overlap, m: the shortest way to part them. `None` unless that is above `floor`, which
/// saves the search where only the deepest is asked for.
pub(super) fn overlap(a: &Posed<'_>, b: &Posed<'_>, floor: f64) -> Option<f64> {
    if a.rims().is_some() || b.rims().is_some() {
        return round::overlap(a, b, floor);
    }
    let radii = a.radius() + b.radius();
    let bare = a.segment().is_some() && b.segment().is_some();
    let core = if bare { 0.0 } else { separating_axis(a, b, floor - radii) };
    if core > 0.0 || radii == 0.0 {
        return (core + radii > floor).then_some(core + radii);
    }
    // Apart by their cores: what is left of the radii after their distance.
    let depth = radii - core_distance(a, b);
    (depth > floor).then_some(depth)
}

/// Overlap of the cores, at least one of which has faces, along their best axis, all 15 for two boxes; any value
/// up to `floor` as soon as one axis says so.
fn separating_axis(a: &Posed<'_>, b: &Posed<'_>, floor: f64) -> f64 {
    let apart = b.position - a.position;
    let mut least = f64::INFINITY;
    let mut try_axis = |axis: &Vec3| {
        let forward = a.core_support(axis) + b.core_support(&-axis) - axis.dot(&apart);
        let backward = b.core_support(axis) + a.core_support(&-axis) + axis.dot(&apart);
        least = least.min(forward).min(backward);
        least <= floor.max(0.0)
    };
    for axis in a.normals.iter().chain(&b.normals) {
        if try_axis(axis) {
            return least;
        }
    }
    for u in &a.edges {
        for v in &b.edges {
            let across = u.cross(v);
            let sine = across.norm();
            // Parallel edges have no axis of their own: a face's normal is as good.
            if sine > 1e-9 && try_axis(&(across / sine)) {
                return least;
            }
        }
    }
    least
}

/// Distance of two cores that are apart, one of them at least a point or a segment.
fn core_distance(a: &Posed<'_>, b: &Posed<'_>) -> f64 {
    let apart = b.position - a.position;
    match (a.segment(), b.segment()) {
        (Some(one), Some(other)) => segments(&one, &other.map(|end| end + apart)),
        (Some(segment), None) => to_surface(&segment.map(|end| end - apart), b),
        (None, Some(segment)) => to_surface(&segment.map(|end| end + apart), a),
        (None, None) => f64::INFINITY,
    }
}

fn to_surface(segment: &[Vec3; 2], solid: &Posed<'_>) -> f64 {
    solid.triangles().map(|triangle| segment_to_triangle(segment, &triangle)).fold(f64::INFINITY, f64::min)
}
