//! The convex hull's moments, through parry, which reckons in single precision.

use std::panic::{AssertUnwindSafe, catch_unwind};

use parry3d::math::Vector;
use parry3d::transformation::try_convex_hull;

use super::moments::Volume;
use super::{bounds, center};

/// Thinner than this share of its longest side, a hull is flat: single precision says nothing of it.
const FLAT: f64 = 1e-6;

/// `None` for points in a plane, on a line or in one place, and where parry finds no hull.
pub(super) fn volume(positions: &[[f64; 3]]) -> Option<Volume> {
    let (min, max) = bounds(positions);
    let size: [f64; 3] = std::array::from_fn(|axis| max[axis] - min[axis]);
    let longest = size.iter().fold(0.0_f64, |longest, &side| longest.max(side));
    if positions.len() < 4 || longest <= 0.0 {
        return None;
    }
    // Around the origin and of unit size, single precision is the same 1e-7 for a screw and for a mountain.
    let middle = center(min, max);
    #[allow(clippy::cast_possible_truncation)]
    let points: Vec<Vector> = positions
        .iter()
        .map(|position| {
            let [x, y, z] = std::array::from_fn(|axis| ((position[axis] - middle[axis]) / longest) as f32);
            Vector::new(x, y, z)
        })
        .collect();
    // parry asserts on some nearly flat input; such a shape has no hull here, and the rest of the measures stand.
    let (corners, faces) = catch_unwind(AssertUnwindSafe(|| try_convex_hull(&points))).ok()?.ok()?;
    let corners: Vec<[f64; 3]> = corners
        .iter()
        .map(|corner| {
            let unit = [corner.x, corner.y, corner.z].map(f64::from);
            std::array::from_fn(|axis| unit[axis] * longest + middle[axis])
        })
        .collect();
    if faces.iter().flatten().any(|&corner| corner as usize >= corners.len()) {
        return None;
    }
    let volume = Volume::of(&corners, &faces);
    (volume.total() > FLAT * longest.powi(3) * 1e-3 && volume.properties().is_some()).then_some(volume)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_box_far_from_the_origin() {
        let corners: Vec<[f64; 3]> = (0..8)
            .map(|bits| {
                [1e6 + f64::from(bits & 1), 2.0 * f64::from(bits >> 1 & 1), 3.0 * f64::from(bits >> 2)]
            })
            .collect();
        let volume = volume(&corners).unwrap().total();
        assert!((volume / 6.0 - 1.0).abs() < 1e-6, "{volume}");
    }

    #[test]
    fn flat_points_have_none() {
        assert_eq!(
            volume(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.3, 0.4, 0.0]]),
            None
        );
        assert_eq!(volume(&[[5.0; 3]; 6]), None);
        assert_eq!(volume(&[]), None);
    }
}
