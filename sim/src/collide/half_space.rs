//! Contacts with a half-space, in closed form: the support points of the other shape.

use crate::math::{Frame3, Vec3};
use crate::shape::Geometry;

/// Cosine of the lean up to which a cylinder stands on its cap, and the corners that its rim has then.
const STANDING: f64 = 0.98;
const RIM_CORNERS: u32 = 16;

/// A point of the shape near the plane: what turns with the body, and the radius that hangs from it.
pub(crate) struct Support {
    pub(crate) core: Vec3,
    pub(crate) radius: f64,
    pub(crate) feature: u64,
}

/// Points of `geometry` at `frame` that can touch a plane of normal `up`, world. More than four may come back.
pub(crate) fn supports(geometry: &Geometry, frame: &Frame3, up: &Vec3) -> Vec<Support> {
    match geometry {
        Geometry::Sphere { radius } => vec![Support { core: frame.position, radius: *radius, feature: 0 }],
        Geometry::Capsule { half_height, radius } => {
            let end = frame.rotation * Vec3::new(0.0, *half_height, 0.0);
            [end, -end]
                .iter()
                .zip(0..)
                .map(|(end, feature)| Support { core: frame.position + end, radius: *radius, feature })
                .collect()
        }
        Geometry::Cylinder { half_height, radius } => cylinder(*half_height, *radius, frame, up),
        Geometry::Polyhedron { corners } => corners
            .iter()
            .zip(0..)
            .map(|(corner, feature)| Support { core: frame.point(corner), radius: 0.0, feature })
            .collect(),
        Geometry::HalfSpace | Geometry::TriangleMesh => Vec::new(),
    }
}

/// A true cylinder: where it lies on its side the two ends of the line, which do not turn with it as it rolls;
/// where it stands, corners of the rim that turn with it (the lowest point would wander round the rim as it rocks, and
/// every step push up a place that nothing had held before); where it leans the lowest point of each rim and three
/// more round the lower one.
fn cylinder(half_height: f64, radius: f64, frame: &Frame3, up: &Vec3) -> Vec<Support> {
    let axis = frame.rotation * Vec3::y();
    let lean = axis.dot(up);
    let radial = up - axis * lean;
    if lean.abs() < 0.02 {
        // On its side: rolling, so the radius hangs from the axis.
        return [axis * half_height, -axis * half_height]
            .iter()
            .zip(100..)
            .map(|(end, feature)| Support { core: frame.position + end, radius, feature })
            .collect();
    }
    let lower = if lean > 0.0 { -axis } else { axis } * half_height;
    if lean.abs() > STANDING {
        let rim = (0..RIM_CORNERS).map(|i| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / f64::from(RIM_CORNERS));
            frame.rotation * Vec3::new(radius * cos, 0.0, radius * sin)
        });
        return rim
            .zip(200..)
            .map(|(arm, feature)| Support { core: frame.position + lower + arm, radius: 0.0, feature })
            .collect();
    }
    // Directions round the rim, the first straight down it; a standing cylinder has none, so take the body's
    // own axis, which is the same from step to step.
    let down = if radial.norm() > 1e-3 { -radial.normalize() } else { frame.rotation * Vec3::x() };
    let across = axis.cross(&down);
    let rim = [down, across, -down, -across].map(|direction| direction * radius);
    let mut supports: Vec<Support> = rim
        .iter()
        .zip(0..)
        .map(|(arm, feature)| Support { core: frame.position + lower + arm, radius: 0.0, feature })
        .collect();
    supports.push(Support { core: frame.position - lower + rim[0], radius: 0.0, feature: 4 });
    supports
}
