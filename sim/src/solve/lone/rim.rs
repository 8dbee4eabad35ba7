//! The edge of a cylinder's end, which touches where it is lowest: at another point of the body at every moment.

use crate::math::{Mat3, Vec3};
use crate::shape::{Collider, Geometry};

/// A circle in the body's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    center: Vec3,
    /// Unit vector.
    axis: Vec3,
    /// m
    radius: f64,
}

/// How far from the circle a contact point may lie, as a share of its radius.
const ON_RIM: f64 = 0.01;
/// rad, lean of the axis from the normal below which an end lies flat: it has no lowest point.
const FLAT_RAD: f64 = 1e-3;

impl Rim {
    /// The rim of `shape` on which `point` of the body lies.
    pub(super) fn of(shape: &Collider, point: &Vec3) -> Option<Self> {
        let (half, radius, ends): (f64, f64, &[f64]) = match shape.geometry {
            Geometry::Cylinder { half_height, radius } => (half_height, radius, &[-1.0, 1.0]),
            Geometry::Cone { half_height, radius } => (half_height, radius, &[-1.0]),
            _ => return None,
        };
        let axis = shape.in_body(&Vec3::y()) - shape.in_body(&Vec3::zeros());
        ends.iter().find_map(|end| {
            let center = shape.in_body(&(Vec3::y() * (half * end)));
            let out = point - center;
            let near = out.dot(&axis).abs().max((out.norm() - radius).abs()) < ON_RIM * radius;
            near.then_some(Self { center, axis, radius })
        })
    }

    /// Its lowest point where the normal points up and the body's axes are `axes`, body frame; `None` where it lies flat.
    pub(super) fn lowest(&self, axes: &Mat3, normal: &Vec3) -> Option<Vec3> {
        let up = axes.tr_mul(normal);
        let across = up - self.axis * up.dot(&self.axis);
        let size = across.norm();
        (size > FLAT_RAD * up.norm()).then(|| self.center - across * (self.radius / size))
    }
}
