//! What is fast: the manifold of a meeting to come, and what of a shape may follow the point that meets first.

use crate::body::Body;
use crate::collide::anchor::Anchor;
use crate::collide::cache::Cache;
use crate::collide::manifold::MAX_POINTS;
use crate::collide::narrow::NarrowBuffers;
use crate::collide::near::{Found, Holds, Near};
use crate::collide::region::RegionPoint;
use crate::collide::relative::Relative;
use crate::collide::sweep::{Mover, Sweep};
use crate::math::Vec3;
use crate::shape::Geometry;

/// Share of the smaller shape's inner radius: how near surfaces then count as touching.
const TOUCH_SHARE: f64 = 1e-2;

/// Marks the features of corners that were added, and the ball that was.
const CORNER: u64 = 1 << 62;
pub(crate) const BALL: u64 = 1 << 61;

impl Near<'_> {
    /// For what is fast: finds when the shapes will meet, and makes the manifold that they will have then, whose anchors
    /// and normal hold them there. A normal of now may be that of another side, and let a bullet through. Where they miss
    /// each other, what is nearer than `stray` metres is still looked at: that far they may leave their straight way, or
    /// have it left. `false` where one side is a half-space, whose normal is the same everywhere.
    pub(crate) fn foresee(
        &self,
        (a, b): (&Body, &Body),
        (margin, stray): (f64, f64),
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> bool {
        if [self.a, self.b].iter().any(|shape| matches!(shape.geometry, Geometry::HalfSpace)) {
            return false;
        }
        let sweep = Sweep {
            a: Mover::new(self.a, a),
            b: Mover::new(self.b, b),
            span: self.dt,
            touching: TOUCH_SHARE * self.size(),
        };
        match sweep.meeting(&mut buffers.triangles, &mut buffers.sheet) {
            Some(0.0) => {
                Near { foreseen: Some(2.0 * self.reach), ..*self }.update(cache, buffers);
            }
            Some(time) => {
                cache.forget(self.key);
                let (world_a, world_b) = (sweep.a.at(time), sweep.b.at(time));
                // A free end may whip round at twice the speed.
                let way = 2.0 * (1.0 - time / self.dt) * self.reach;
                let then = Near { world_a, world_b, reach: margin, foreseen: Some(way), ..*self };
                if let Holds::Apart(_) = then.update(cache, buffers) {
                    // The search ended on its way: an end that hardly moves goes before one that whips.
                    cache.forget(self.key);
                    Near { reach: self.reach, ..then }.update(cache, buffers);
                }
                cache.forget(self.key);
            }
            None => {
                Near { reach: stray, ..*self }.update(cache, buffers);
            }
        }
        true
    }

    /// Adds what of the smaller shape may come down on the plane of the region in the rest of the step: its corners, since
    /// what hits with one end whips round it and would be through with the other before the next step; and a ball
    /// inside of it, the anchor of one of them on the mover with what hangs from it: however fast it whips, its middle
    /// stays in front.
    pub(crate) fn add_rest(&self, relative: &Relative, way: f64, out: &mut Found) {
        let Found { region, feature, ball, .. } = out;
        let normal = region.normal;
        let b_moves = self.b_moves();
        let (mover, other) = if b_moves { (self.b, self.a) } else { (self.a, self.b) };
        if matches!(mover.geometry, Geometry::Sphere { .. }) {
            // The point that meets first is all that a sphere has.
            return;
        }
        let Some((core, radius)) = mover.geometry.core() else { return };
        let Some(first) = region.points.first().copied() else { return };
        let direction = if b_moves { relative.rotation.tr_mul(&-normal) } else { normal };
        core.extremes(&direction, feature);
        // On the surface of the other.
        let foot = if b_moves { first.on_a } else { first.on_a + normal * first.separation };
        let over = |point: &Vec3, radius: f64, feature: u64| {
            let point = if b_moves { relative.point(point) } else { *point };
            let height = (point - foot).dot(&normal) * if b_moves { 1.0 } else { -1.0 };
            let aside = (point - foot).norm_squared() - height * height;
            let separation = height - radius;
            let on_a = if b_moves { point - normal * height } else { point + normal * radius };
            let comes_down = separation < way && aside < other.shape_reach * other.shape_reach;
            comes_down.then_some(RegionPoint { on_a, separation, feature })
        };
        let corners = feature.corners.iter();
        region.points.extend(corners.filter_map(|(p, id)| over(p, radius, CORNER | u64::from(*id))));
        region.reduce::<{ MAX_POINTS - 1 }>(0.0, |point| point.separation);
        let (center, inside) = core.ball_inside();
        region.points.extend(over(&center, inside + radius, BALL));
        let outward = if b_moves { -normal } else { normal };
        let offset = self.world_a.rotation * outward * (inside + radius);
        *ball = Anchor { core: mover.in_body(&center), offset, rim: 0.0 };
    }

    /// Whether B is the smaller shape.
    pub(crate) fn b_moves(&self) -> bool {
        self.b.shape_reach <= self.a.shape_reach
    }
}
