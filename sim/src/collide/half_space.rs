//! Contacts with a half-space, in closed form: every point of the other shape that can be its lowest.

use crate::collide::convex::{Core, Feature};
use crate::collide::region::{Region, RegionPoint};
use crate::collide::relative::Relative;
use crate::math::Vec3;

/// The region of the half-space below the plane y = 0 of its own frame, and the shape of core `core` and `radius` that
/// lies at `other`, seen from there; points higher than `reach` are left out. In the plane's frame, from the plane on. Returns the least height, m.
pub(crate) fn region(
    core: &Core<'_>,
    radius: f64,
    other: &Relative,
    reach: f64,
    feature: &mut Feature,
    region: &mut Region,
) -> f64 {
    region.points.clear();
    region.normal = Vec3::y();
    let down = -other.rotation.row(1).transpose();
    core.extremes(&down, feature);
    let mut lowest = f64::INFINITY;
    for (corner, id) in &feature.corners {
        let point = other.point(corner);
        let separation = point.y - radius;
        lowest = lowest.min(separation);
        if separation < reach {
            let on_a = Vec3::new(point.x, 0.0, point.z);
            region.points.push(RegionPoint { on_a, separation, feature: u64::from(*id) });
        }
    }
    lowest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Mat3;

    /// Lowest height of the region of a cylinder whose axis leans by `lean` rad.
    fn lowest(half_height: f64, radius: f64, lean: f64) -> (f64, usize) {
        let (sin, cos) = libm::sincos(lean);
        let rotation = Mat3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        let other = Relative { rotation, translation: Vec3::new(0.3, 1.0, -0.2) };
        let mut found = Region::default();
        let core = Core::Cylinder { half_height, radius };
        region(&core, 0.0, &other, 10.0, &mut Feature::default(), &mut found);
        let heights = found.points.iter().map(|point| point.separation);
        (heights.fold(f64::MAX, f64::min), found.points.len())
    }

    #[test]
    fn the_lowest_point_of_a_leaning_cylinder_is_that_of_its_true_rim() {
        let (half_height, radius) = (0.4, 0.25);
        for lean in [0.0, 1e-6, 0.01, 0.3, 1.0, 1.2, 1.5, std::f64::consts::FRAC_PI_2, 2.0, 3.0] {
            let (sin, cos) = libm::sincos(lean);
            let truth = 1.0 - half_height * cos.abs() - radius * sin.abs();
            let (height, points) = lowest(half_height, radius, lean);
            assert!((height - truth).abs() < 1e-3 * radius * 1e-3, "lean {lean}: {height}, truth {truth}");
            assert!(points >= 2, "lean {lean}: {points} points");
        }
    }
}
