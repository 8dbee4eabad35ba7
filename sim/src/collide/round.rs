//! The distance of a point from a convex core in closed form: what a sphere needs.

use crate::collide::convex::Core;
use crate::collide::polytope::Polytope;
use crate::math::Vec3;

/// Outward unit normal of the core's surface towards the point, and the signed distance, m; negative inside, where the
/// normal is the shortest way out. `None` where there is no closed form, or no direction.
pub(crate) fn from_point(core: &Core<'_>, point: &Vec3) -> Option<(Vec3, f64)> {
    match *core {
        Core::Point => outward(*point),
        Core::Segment { half_height } => {
            outward(point - Vec3::new(0.0, point.y.clamp(-half_height, half_height), 0.0))
        }
        Core::Cylinder { half_height, radius } => {
            let across = (point.x * point.x + point.z * point.z).sqrt();
            let radial =
                if across > 0.0 { Vec3::new(point.x / across, 0.0, point.z / across) } else { Vec3::x() };
            let up = Vec3::new(0.0, if point.y < 0.0 { -1.0 } else { 1.0 }, 0.0);
            let (over, out) = (point.y.abs() - half_height, across - radius);
            if over <= 0.0 || out <= 0.0 {
                return Some(if over > out { (up, over) } else { (radial, out) });
            }
            outward(up * over + radial * out)
        }
        Core::Polytope(polytope) => from_polytope(polytope, point),
        Core::Cone { .. } => None,
    }
}

fn outward(way: Vec3) -> Option<(Vec3, f64)> {
    let distance = way.norm();
    (distance > 1e-12).then(|| (way / distance, distance))
}

fn from_polytope(polytope: &Polytope, point: &Vec3) -> Option<(Vec3, f64)> {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, face) in polytope.faces.iter().enumerate() {
        let height = face.normal.dot(point) - face.offset;
        if height > best.1 {
            best = (i, height);
        }
    }
    let (index, height) = best;
    let normal = polytope.faces.get(index)?.normal;
    if height <= 0.0 {
        return Some((normal, height));
    }
    if let Some(half) = &polytope.half_extents {
        return outward(point - point.sup(&-half).inf(half));
    }
    let corners = polytope.face_loop(index);
    let over_face = corners.iter().zip(corners.iter().cycle().skip(1)).all(|(&from, &to)| {
        let (from, to) = (polytope.vertices[from as usize], polytope.vertices[to as usize]);
        (point - from).dot(&(to - from).cross(&normal)) <= 0.0
    });
    over_face.then_some((normal, height))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::collide::gjk::CorePair;
    use crate::collide::relative::Relative;
    use crate::math::Mat3;

    proptest! {
        #[test]
        fn closed_forms_agree_with_the_search(at in [-1.5..1.5_f64, -1.5..1.5_f64, -1.5..1.5_f64]) {
            let point = Vec3::from(at);
            let cuboid = Polytope::cuboid(&Vec3::new(0.5, 0.3, 0.8));
            for core in [
                Core::Segment { half_height: 0.4 },
                Core::Cylinder { half_height: 0.3, radius: 0.5 },
                Core::Polytope(&cuboid),
            ] {
                let relative = Relative { rotation: Mat3::identity(), translation: point };
                let pair = CorePair { a: core, b: Core::Point, relative };
                let Some((normal, distance)) = from_point(&core, &point) else { continue };
                let along = pair.separation_along(&normal).distance;
                prop_assert!((along - distance).abs() < 1e-12, "{core:?}: {along}, {distance}");
                if let Some(nearest) = pair.nearest(&Vec3::y(), 1e-6) {
                    prop_assert!((nearest.distance - distance).abs() < 1e-6, "{core:?}: {nearest:?}, {distance}");
                } else {
                    prop_assert!(distance < 1e-5, "{core:?}: {distance}");
                }
            }
        }
    }
}
