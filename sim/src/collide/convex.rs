//! Convex shapes by their support functions: a core and a radius round it.
//!
//! A sphere is a point with a radius and a capsule a segment with one; cylinder and cone are true ones, with rims
//! that are circles. What has no radius is its own core.

use crate::collide::polytope::Polytope;
use crate::math::Vec3;

/// The core of a convex shape, in its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Core<'a> {
    Point,
    /// Along Y, both ways.
    Segment {
        half_height: f64,
    },
    /// Along Y.
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    /// Along Y: the base at `-half_height`, the tip at `+half_height`.
    Cone {
        half_height: f64,
        radius: f64,
    },
    Polytope(&'a Polytope),
}

/// Cosine between a direction and the axis from which on the cap and no longer the mantle faces that way.
const FACES_CAP: f64 = 0.5;
/// Sine of the lean from which on the lowest point of a rim is one of its corners.
const LEANS: f64 = 1e-3;

/// What of a shape faces a direction: a polygon, a segment or a point, and the normal of the polygon.
#[derive(Clone, Debug, Default)]
pub(crate) struct Feature {
    /// Counter-clockwise from outside, each with a number that stays with it from step to step.
    pub(crate) corners: Vec<(Vec3, u32)>,
    /// Outward; only where there are three corners or more.
    pub(crate) normal: Vec3,
}

impl Feature {
    /// Whether it is a flat side, and not an edge or a point.
    pub(crate) fn is_face(&self) -> bool {
        self.corners.len() > 2
    }
}

impl Core<'_> {
    /// The point farthest along `direction`, of any length but zero.
    pub(crate) fn support(&self, direction: &Vec3) -> Vec3 {
        let up = |half_height: f64| if direction.y < 0.0 { -half_height } else { half_height };
        match *self {
            Self::Point => Vec3::zeros(),
            Self::Segment { half_height } => Vec3::new(0.0, up(half_height), 0.0),
            Self::Cylinder { half_height, radius } => rim(direction, radius, up(half_height)),
            Self::Cone { half_height, radius } => {
                let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
                if direction.y * half_height > radius * across - direction.y * half_height {
                    Vec3::new(0.0, half_height, 0.0)
                } else {
                    rim(direction, radius, -half_height)
                }
            }
            Self::Polytope(polytope) => polytope.vertices[polytope.support(direction)],
        }
    }

    /// A ball inside of the core: its centre and radius, m.
    pub(crate) fn ball_inside(&self) -> (Vec3, f64) {
        match *self {
            Self::Point | Self::Segment { .. } => (Vec3::zeros(), 0.0),
            Self::Cylinder { half_height, radius } => (Vec3::zeros(), radius.min(half_height)),
            Self::Cone { half_height, radius } => {
                let height = 2.0 * half_height;
                let ball = radius * height / (radius + (radius * radius + height * height).sqrt());
                (Vec3::new(0.0, ball - half_height, 0.0), ball)
            }
            Self::Polytope(polytope) => polytope.ball_inside(),
        }
    }

    /// What faces the unit `direction`. A cap's corners stay with the body, and the lowest point of its rim joins them
    /// where it leans: a rim of corners that follow the lowest point would put its load where nothing was before.
    pub(crate) fn feature(&self, direction: &Vec3, out: &mut Feature) {
        out.corners.clear();
        match *self {
            Self::Point => out.corners.push((Vec3::zeros(), 0)),
            Self::Segment { half_height } => {
                out.corners
                    .extend([(Vec3::new(0.0, -half_height, 0.0), 0), (Vec3::new(0.0, half_height, 0.0), 1)]);
            }
            Self::Cylinder { half_height, radius } => {
                if direction.y.abs() >= FACES_CAP {
                    cap(direction, radius, half_height, direction.y.signum(), out);
                } else {
                    let foot = rim(direction, radius, 0.0);
                    let half = Vec3::new(0.0, half_height, 0.0);
                    out.corners.extend([(foot - half, 0), (foot + half, 1)]);
                }
            }
            Self::Cone { half_height, radius } => {
                // From half way between the base's normal and the mantle's on.
                let slant = (4.0 * half_height * half_height + radius * radius).sqrt();
                let mantle_y = radius / slant;
                if direction.y < -((1.0 - mantle_y) * 0.5).sqrt() {
                    cap(direction, radius, half_height, -1.0, out);
                } else {
                    let tip = Vec3::new(0.0, half_height, 0.0);
                    out.corners.extend([(rim(direction, radius, -half_height), 0), (tip, 1)]);
                }
            }
            Self::Polytope(polytope) => {
                let face = polytope.face_along(direction);
                out.normal = polytope.faces[face].normal;
                let corners = polytope.face_loop(face).iter();
                out.corners.extend(corners.map(|&v| (polytope.vertices[v as usize], v)));
            }
        }
    }

    /// Every point that can be the lowest along `-direction` or come near it within a step.
    pub(crate) fn extremes(&self, direction: &Vec3, out: &mut Feature) {
        match *self {
            Self::Polytope(polytope) => {
                out.corners.clear();
                out.corners.extend(polytope.vertices.iter().copied().zip(0..));
            }
            Self::Cylinder { half_height, radius } => {
                self.feature(direction, out);
                if out.is_face() {
                    let other = -half_height * direction.y.signum();
                    out.corners.push((rim(direction, radius, other), FAR_RIM));
                }
            }
            Self::Cone { half_height, .. } => {
                self.feature(direction, out);
                if out.is_face() {
                    out.corners.push((Vec3::new(0.0, half_height, 0.0), FAR_RIM));
                }
            }
            Self::Point | Self::Segment { .. } => self.feature(direction, out),
        }
    }
}

/// The point of the circle of `radius` at `height` that lies farthest along `direction`.
fn rim(direction: &Vec3, radius: f64, height: f64) -> Vec3 {
    let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
    if across <= f64::MIN_POSITIVE {
        return Vec3::new(radius, height, 0.0);
    }
    Vec3::new(direction.x / across * radius, height, direction.z / across * radius)
}

/// Corners of a rim by the body's own axes, as cosine and sine of eighths of a turn.
const RIM: [[f64; 2]; 8] = {
    const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [D, D], [0.0, 1.0], [-D, D], [-1.0, 0.0], [-D, -D], [0.0, -1.0], [D, -D]]
};
/// Numbers of the lowest point of a cap's rim and of the one opposite; upper caps count from `UPPER`.
const LOWEST: u32 = 8;
const FAR_RIM: u32 = 9;
const UPPER: u32 = 16;

/// The cap at `side` (1 above, -1 below) as a polygon, counter-clockwise seen from outside.
fn cap(direction: &Vec3, radius: f64, half_height: f64, side: f64, out: &mut Feature) {
    out.normal = Vec3::new(0.0, side, 0.0);
    let first = if side > 0.0 { UPPER } else { 0 };
    // A turn round +Y takes z to x, so the cap above runs with it and the one below against it.
    let at = |[cos, sin]: [f64; 2]| Vec3::new(radius * cos, half_height * side, -radius * sin * side);
    out.corners.extend(RIM.iter().map(|turn| at(*turn)).zip(first..));
    let across = (direction.x * direction.x + direction.z * direction.z).sqrt();
    if across > LEANS {
        let lowest = rim(direction, radius, half_height * side);
        let along = |i: usize| out.corners[i % 8].0.dot(&lowest);
        let nearest = (0..8).fold(0, |best, i| if along(i) > along(best) { i } else { best });
        let after = if along(nearest + 1) > along(nearest + 7) { nearest + 1 } else { nearest };
        out.corners.insert(after, (lowest, first + LOWEST));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// No point of a finely sampled surface lies farther along the direction than the support point.
        #[test]
        fn supports_are_the_farthest_points(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            let direction = Vec3::new(x, y, z);
            prop_assume!(direction.norm() > 1e-3);
            let (half_height, radius) = (0.7, 0.4);
            for core in [Core::Cylinder { half_height, radius }, Core::Cone { half_height, radius }] {
                let far = core.support(&direction).dot(&direction);
                for i in 0..360 {
                    let (sin, cos) = libm::sincos(f64::from(i).to_radians());
                    let mut surface = vec![Vec3::new(radius * cos, -half_height, radius * sin)];
                    surface.push(match core {
                        Core::Cylinder { .. } => Vec3::new(radius * cos, half_height, radius * sin),
                        _ => Vec3::new(0.0, half_height, 0.0),
                    });
                    for point in surface {
                        prop_assert!(point.dot(&direction) <= far + 1e-12);
                    }
                }
                let mut feature = Feature::default();
                let unit = direction.normalize();
                core.feature(&unit, &mut feature);
                let nearest = feature.corners.iter().map(|c| c.0.dot(&unit)).fold(f64::MIN, f64::max);
                prop_assert!((nearest - core.support(&unit).dot(&unit)).abs() < 1e-12, "{feature:?}");
            }
        }
    }

    #[test]
    fn caps_run_counter_clockwise_seen_from_outside() {
        let core = Core::Cylinder { half_height: 0.5, radius: 0.3 };
        for side in [-1.0, 1.0] {
            let mut feature = Feature::default();
            core.feature(&Vec3::new(0.1, side, 0.2).normalize(), &mut feature);
            let [a, b, c] = [0, 1, 2].map(|i| feature.corners[i].0);
            assert!((b - a).cross(&(c - b)).y * side > 0.0);
        }
    }
}
