//! The region of two convex shapes of any kind: the least way out, then what faces it on either side, one clipped
//! against the other.

use crate::collide::convex::{Core, Feature};
use crate::collide::gjk::CorePair;
use crate::collide::region::{ClipBuffers, Region, RegionPoint};
use crate::collide::round;
use crate::math::Vec3;

/// Cosine between a face's normal and the contact's from which on the two surfaces lie on each other.
const FLAT: f64 = 1.0 - 1e-5;
/// Sine of the angle between two edges below which they touch along a line.
const PARALLEL: f64 = 1e-3;

/// Buffers of the query.
#[derive(Clone, Debug, Default)]
pub(crate) struct TouchBuffers {
    feature_a: Feature,
    feature_b: Feature,
    pub(crate) clip: ClipBuffers,
}

impl TouchBuffers {
    /// Fills `region` with what is nearer than `reach`, and returns how far apart the shapes are along its normal.
    /// `guess` is the normal to start from, and `gap` a length small against the shapes.
    pub(crate) fn region(
        &mut self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        guess: &Vec3,
        gap: f64,
        reach: f64,
        region: &mut Region,
    ) -> f64 {
        region.points.clear();
        let rounding = radii[0] + radii[1];
        if let Some(distance) = on_sphere(pair, radii, reach, region) {
            return distance;
        }
        if let Some(distance) = self.on_known_face(pair, radii, guess, gap, reach, region) {
            return distance;
        }
        let nearest = pair.touching(guess, gap);
        region.normal = nearest.normal;
        let distance = nearest.distance - rounding;
        if distance >= reach {
            return distance;
        }
        if matches!(pair.a, Core::Point) || matches!(pair.b, Core::Point) {
            let on_a = nearest.on_a + nearest.normal * radii[0];
            region.points.push(RegionPoint { on_a, separation: distance, feature: 0 });
            return distance;
        }
        let Self { feature_a, feature_b, clip } = self;
        let turned = pair.relative.rotation.tr_mul(&-nearest.normal);
        pair.a.feature(&nearest.normal, feature_a);
        pair.b.feature(&turned, feature_b);
        let faces = |feature: &Feature, normal: &Vec3| feature.is_face() && feature.normal.dot(normal) > FLAT;
        let placed = feature_b.corners.iter().map(|&(corner, id)| (pair.relative.point(&corner), id));
        if feature_b.corners.len() > 1 && faces(feature_a, &nearest.normal) {
            let normal = feature_a.normal;
            clip.set_reference(feature_a.corners.iter().map(|corner| corner.0));
            clip.set_incident(placed);
            clip.clip(&normal);
            region.normal = normal;
            let origin = clip.reference[0];
            clip.push_points(region, (&origin, &normal), true, reach + rounding);
        } else if feature_a.corners.len() > 1 && faces(feature_b, &turned) {
            let normal = pair.relative.rotation * feature_b.normal;
            clip.set_reference(placed.map(|corner| corner.0));
            clip.set_incident(feature_a.corners.iter().copied());
            clip.clip(&normal);
            region.normal = -normal;
            let origin = clip.reference[0];
            clip.push_points(region, (&origin, &normal), false, reach + rounding);
        } else if let ([(p, _), (q, _)], [_, _]) = (&feature_a.corners[..], &feature_b.corners[..]) {
            let along = q - p;
            clip.set_incident(placed);
            let across = clip.incident[1].position - clip.incident[0].position;
            if across.cross(&along).norm_squared()
                < PARALLEL * PARALLEL * across.norm_squared() * along.norm_squared()
            {
                clip.clip_between(p, q);
                clip.push_points(region, (p, &nearest.normal), true, reach + rounding);
            }
        }
        if region.points.is_empty() {
            let separation = nearest.distance;
            region.points.push(RegionPoint { on_a: nearest.on_a, separation, feature: u64::MAX });
        }
        for point in &mut region.points {
            point.on_a += region.normal * radii[0];
            point.separation -= rounding;
        }
        distance
    }

    /// Where the guess is the normal of a flat side and what lies over that side is the nearest of all, no search can find
    /// a shorter way out nearby: moved out along the normal, the shapes part exactly there.
    fn on_known_face(
        &mut self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        guess: &Vec3,
        gap: f64,
        reach: f64,
        region: &mut Region,
    ) -> Option<f64> {
        const NEAR: f64 = 0.999;
        let rounding = radii[0] + radii[1];
        for of_a in [true, false] {
            let Self { feature_a, feature_b, clip } = self;
            let (pair_a, pair_b) = (&pair.a, &pair.b);
            let normal = if of_a {
                pair_a.feature(guess, feature_a);
                feature_a.normal
            } else {
                pair_b.feature(&pair.relative.rotation.tr_mul(&-guess), feature_b);
                -(pair.relative.rotation * feature_b.normal)
            };
            let side: &Feature = if of_a { feature_a } else { feature_b };
            if !side.is_face() || normal.dot(guess) < NEAR {
                continue;
            }
            let along = pair.separation_along(&normal).distance;
            if along - rounding >= reach {
                region.normal = normal;
                return Some(along - rounding);
            }
            if of_a {
                pair_b.feature(&pair.relative.rotation.tr_mul(&-normal), feature_b);
            } else {
                pair_a.feature(&normal, feature_a);
            }
            let placed = feature_b.corners.iter().map(|&(corner, id)| (pair.relative.point(&corner), id));
            let out = if of_a {
                clip.set_reference(feature_a.corners.iter().map(|corner| corner.0));
                clip.set_incident(placed);
                normal
            } else {
                clip.set_reference(placed.map(|corner| corner.0));
                clip.set_incident(feature_a.corners.iter().copied());
                -normal
            };
            clip.clip(&out);
            let origin = clip.reference[0];
            let lowest = clip.incident.iter().map(|corner| (corner.position - origin).dot(&out));
            if lowest.fold(f64::INFINITY, f64::min) > along + 1e-6 * gap {
                continue;
            }
            region.normal = normal;
            clip.push_points(region, (&origin, &out), of_a, reach + rounding);
            for point in &mut region.points {
                point.on_a += normal * radii[0];
                point.separation -= rounding;
            }
            return Some(along - rounding);
        }
        None
    }

    /// The region along the `normal` of A's flat side, whatever the least way out: what of B lies over that side.
    pub(crate) fn region_along(
        &mut self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        normal: &Vec3,
        reach: f64,
        region: &mut Region,
    ) {
        region.points.clear();
        region.normal = *normal;
        let Self { feature_a, feature_b, clip } = self;
        let rounding = radii[0] + radii[1];
        pair.a.feature(normal, feature_a);
        pair.b.feature(&pair.relative.rotation.tr_mul(&-normal), feature_b);
        clip.set_reference(feature_a.corners.iter().map(|corner| corner.0));
        clip.set_incident(feature_b.corners.iter().map(|&(corner, id)| (pair.relative.point(&corner), id)));
        clip.clip(normal);
        let origin = clip.reference.first().copied().unwrap_or_default();
        clip.push_points(region, (&origin, normal), true, reach + rounding);
        for point in &mut region.points {
            point.on_a += normal * radii[0];
            point.separation -= rounding;
        }
    }
}

/// The region of a sphere and a core that has a closed form, and how far they are apart.
fn on_sphere(pair: &CorePair<'_>, radii: [f64; 2], reach: f64, region: &mut Region) -> Option<f64> {
    let (normal, distance) = match (&pair.a, &pair.b) {
        (core, Core::Point) => round::from_point(core, &pair.relative.translation)?,
        (Core::Point, core) => {
            let center = -pair.relative.rotation.tr_mul(&pair.relative.translation);
            let (normal, distance) = round::from_point(core, &center)?;
            (-(pair.relative.rotation * normal), distance)
        }
        _ => return None,
    };
    region.normal = normal;
    let separation = distance - radii[0] - radii[1];
    if separation < reach {
        let on_core = if matches!(pair.b, Core::Point) {
            pair.relative.translation - normal * distance
        } else {
            Vec3::zeros()
        };
        region.points.push(RegionPoint { on_a: on_core + normal * radii[0], separation, feature: 0 });
    }
    Some(separation)
}
