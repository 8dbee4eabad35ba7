//! The border to parry: the one file of this crate that names it. It finds convex hulls when a world is built; contacts
//! are our own.

use std::collections::BTreeMap;

use parry3d::math::Vector;
use parry3d::transformation::try_convex_hull;

use crate::math::Vec3;

/// Corners and triangles of the convex hull of `points`, found on points scaled to a unit box, where parry's
/// tolerances are meant to be; the corners are points that were given.
///
/// # Errors
/// What is wrong with the points, in words.
pub(crate) fn convex_hull(points: &[Vec3]) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), String> {
    let flat = || "the points of the hull span no volume; give it a thickness".to_owned();
    let min = points.iter().fold(Vec3::repeat(f64::INFINITY), |min, p| min.inf(p));
    let max = points.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |max, p| max.sup(p));
    let scale = (max - min).max();
    if !(scale > 0.0 && scale.is_finite()) || (max - min).min() < 1e-6 * scale {
        return Err(flat());
    }
    let center = (min + max) * 0.5;
    let unit: Vec<Vector> = points.iter().map(|p| vector(&((p - center) / scale))).collect();
    let (corners, triangles) = try_convex_hull(&unit).map_err(|_| flat())?;
    let bits = |v: &Vector| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits()];
    let given: BTreeMap<[u32; 3], Vec3> = unit.iter().map(bits).zip(points.iter().copied()).collect();
    let exact = |corner: &Vector| {
        given.get(&bits(corner)).copied().unwrap_or_else(|| double(*corner) * scale + center)
    };
    Ok((corners.iter().map(exact).collect(), triangles))
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
