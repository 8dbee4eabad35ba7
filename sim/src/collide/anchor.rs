//! Where a body touches, split into what turns with it and what does not.

use crate::collide::relative::Relative;
use crate::math::{Frame3, Vec3};
use crate::shape::{Collider, Geometry};

/// Cosine between the normal and a mantle's below which a shape does not lie on it.
const ON_MANTLE: f64 = 0.02;
/// Share of its size by which a point may lie off a rim, or off its lowest point.
const ON_RIM: f64 = 1e-6;

/// A corner turns with its body. The lowest point of a sphere does not: its centre turns (that is, stays) and the
/// radius hangs from it. Taking it for a corner would let a ball that rolls by an angle sink by r (1 - cos).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Anchor {
    /// In the body frame.
    pub(crate) core: Vec3,
    /// World vector from the core to the surface.
    pub(crate) offset: Vec3,
    /// m: radius of the rim whose lowest point this is, else 0. It turns with its body like a corner; what rolls on it is
    /// for the solver to follow.
    pub(crate) rim: f64,
}

impl Anchor {
    /// The anchor of a surface point of `shape` where the outward normal is `outward`, both in the frame of the shape,
    /// which lies at `world`. What rolls there hangs on the shape's axis.
    pub(crate) fn new(shape: &Collider, world: &Relative, point: &Vec3, outward: &Vec3) -> Self {
        let arm = match &shape.geometry {
            Geometry::Sphere { radius } | Geometry::Capsule { radius, .. } => *radius,
            Geometry::Cylinder { radius, .. } if outward.y.abs() < ON_MANTLE => *radius,
            Geometry::Cone { half_height, radius } => {
                let slant = (4.0 * half_height * half_height + radius * radius).sqrt();
                let across = (1.0 - outward.y * outward.y).max(0.0).sqrt();
                if (outward.y - radius / slant).abs() < ON_MANTLE && across > ON_MANTLE {
                    (point.x * point.x + point.z * point.z).sqrt() / across
                } else {
                    0.0
                }
            }
            _ => 0.0,
        };
        if arm == 0.0 {
            let rim = lowest_of_rim(&shape.geometry, point, outward);
            return Self { core: shape.in_body(point), offset: Vec3::zeros(), rim };
        }
        let offset = outward * arm;
        Self { core: shape.in_body(&(point - offset)), offset: world.rotation * offset, rim: 0.0 }
    }

    /// Whether the point of contact moves over the body while that turns.
    pub(crate) fn rolls(&self) -> bool {
        self.offset != Vec3::zeros()
    }

    /// From the centre of mass to the surface point, world.
    pub(crate) fn arm(&self, frame: &Frame3) -> Vec3 {
        frame.rotation * self.core + self.offset
    }
}

/// m: radius of the rim of which `point` is the farthest along `outward`, 0 where it is none.
fn lowest_of_rim(geometry: &Geometry, point: &Vec3, outward: &Vec3) -> f64 {
    let (half_height, radius) = match *geometry {
        Geometry::Cylinder { half_height, radius } => (half_height, radius),
        Geometry::Cone { half_height, radius } if point.y < 0.0 => (half_height, radius),
        _ => return 0.0,
    };
    let across = (outward.x * outward.x + outward.z * outward.z).sqrt();
    let along = (point.x * outward.x + point.z * outward.z) / across;
    let on_rim = (point.y.abs() - half_height).abs() < ON_RIM * half_height;
    if on_rim && along > (1.0 - ON_RIM) * radius { radius } else { 0.0 }
}
