//! Sliding over the seams of what stands: the gap between two tiles is no wall.
//!
//! The least way out of a hair's overlap may be sideways, against the side of the next tile, although the shape moves
//! along the tiles' tops. Then the top that it moves along takes the place of the axis that would stop it.

use crate::collide::convex::Core;
use crate::collide::gjk::CorePair;
use crate::collide::polytope::Polytope;
use crate::collide::region::Region;
use crate::collide::relative::Relative;
use crate::collide::sat::{Axis, SatBuffers};
use crate::collide::touch::TouchBuffers;
use crate::math::{Mat3, Vec3};

/// Sine of the angle between a motion and a side along which it goes, at most.
const ALONG: f64 = 0.1;
/// Cosine between a motion and the axis of an edge or a side that would stop it, at least.
const HEAD_ON: f64 = 0.5;
/// Share of the speed below which a round shape does not run into what it touches.
const STEADY: f64 = 1e-6;

/// A motion over something that stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slide {
    /// m/s, of B against A, in the frame of A.
    pub(crate) velocity: Vec3,
    /// m: how high a step in the ground may be and still be none.
    pub(crate) lip: f64,
    /// Whether A and B never move.
    pub(crate) stands: [bool; 2],
}

impl Slide {
    /// For two polytopes, after a query of `sat` that found the normal `chosen`: the axis of the side along which the
    /// motion goes.
    pub(crate) fn axis(
        &self,
        (a, b): (&Polytope, &Polytope),
        relative: &Relative,
        chosen: &Vec3,
        sat: &SatBuffers,
    ) -> Option<Axis> {
        let speed = self.velocity.norm();
        if self.velocity.dot(chosen) > -HEAD_ON * speed {
            return None;
        }
        let (on_a, on_b) = sat.face_distances(a.faces.len());
        let faces_a = (0..).zip(&a.faces).map(|(i, face)| (Axis::FaceOfA(i), face.normal));
        let faces_b =
            (0..).zip(&b.faces).map(|(i, face)| (Axis::FaceOfB(i), relative.rotation * face.normal));
        let of_a = faces_a.zip(on_a).filter(|_| self.stands[0]);
        let of_b = faces_b.zip(on_b).filter(|_| self.stands[1]);
        of_a.chain(of_b)
            .filter(|((_, normal), distance)| {
                f64::from(**distance).abs() < self.lip && self.velocity.dot(normal).abs() < ALONG * speed
            })
            .max_by(|(_, p), (_, q)| p.total_cmp(q))
            .map(|((axis, _), _)| axis)
    }

    /// For a round shape that touches an edge of a polytope that stands: puts what lies over the side along which the
    /// motion goes in the place of `region`.
    pub(crate) fn over_side(
        &self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        reach: f64,
        touch: &mut TouchBuffers,
        region: &mut Region,
    ) {
        let speed = self.velocity.norm();
        if region.points.is_empty() || self.velocity.dot(&region.normal) >= -STEADY * speed {
            return;
        }
        let flipped = !matches!((pair.a, self.stands[0]), (Core::Polytope(_), true));
        let (seen, turn) = if flipped {
            let seen = CorePair { a: pair.b, b: pair.a, relative: pair.relative.inverse() };
            (seen, -pair.relative.rotation.transpose())
        } else {
            (*pair, Mat3::identity())
        };
        let (Core::Polytope(ground), true) = (seen.a, self.stands[usize::from(flipped)]) else { return };
        let normal = turn * region.normal;
        // The other's velocity against the ground: that of B turned round is that of A against it.
        let velocity = turn * self.velocity;
        let overlap = |side: &Vec3| seen.separation_along(side).distance - radii[0] - radii[1];
        let side = ground
            .faces
            .iter()
            .map(|face| face.normal)
            .filter(|side| velocity.dot(side).abs() < ALONG * speed && normal.dot(side) < 1.0 - 1e-9)
            .map(|side| (overlap(&side), side))
            .filter(|(overlap, _)| overlap.abs() < self.lip)
            .max_by(|(p, _), (q, _)| p.total_cmp(q));
        if let Some((_, side)) = side {
            let radii = if flipped { [radii[1], radii[0]] } else { radii };
            touch.region_along(&seen, radii, &side, reach, region);
            if flipped {
                region.flip(&pair.relative);
            }
        }
    }
}
