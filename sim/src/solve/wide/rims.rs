//! Rims that roll: the lowest point of a leaning cylinder or cone wanders round its rim while that turns.
//!
//! An anchor on the rim turns with the body and lifts off by `r (1 - cos)`, so what rolls on its rim would sink in
//! over a step and be pushed out by the next, and the push is energy. Here the point of the rim that is lowest now takes
//! the anchor's place after each motion: another point of the body, with its own gap when the step began.

use crate::body::Body;
use crate::collide::manifold::Manifold;
use crate::math::{Quat, Vec3, rotated};

use super::block::PointRow;
use super::lanes::{Eight, Scalar};

/// Sine between the axis and the normal below which the whole rim is as low as its lowest point.
const LEANS: f64 = 1e-3;
/// rad² of rotation within the step below which an anchor has not lifted off.
const STILL: f64 = 1e-8;

/// A contact point on a rim.
#[derive(Clone, Debug)]
pub(crate) struct Rim {
    /// Row among the points, and lane.
    pub(crate) point: usize,
    lane: usize,
    /// 0 where it is A's, 1 where it is B's.
    side: usize,
    /// Row of its body.
    pub(crate) row: u32,
    /// World.
    normal: Vec3,
    tangents: [Vec3; 2],
    /// In the body's frame.
    center: Vec3,
    axis: Vec3,
    radius: f64,
    /// World, from the centre of mass when the step began: of the point of the body that touches now.
    arm: Vec3,
}

impl Rim {
    /// Of the point of `manifold` numbered `index` on the body of `side`, if it lies on a rim.
    pub(crate) fn of(
        manifold: &Manifold,
        index: usize,
        (side, row, body): (usize, u32, &Body),
        (point, lane): (usize, usize),
    ) -> Option<Self> {
        let anchors = &manifold.points.get(index)?;
        let anchor = [&anchors.anchor_a, &anchors.anchor_b][side];
        let child = [manifold.key.0, manifold.key.1][side];
        let shape = body.colliders.get(child as usize).filter(|_| anchor.rim > 0.0)?;
        let origin = shape.in_body(&Vec3::zeros());
        let axis = shape.in_body(&Vec3::y()) - origin;
        Some(Self {
            point,
            lane,
            side,
            row,
            normal: manifold.normal,
            tangents: manifold.tangents,
            center: origin + axis * (anchor.core - origin).dot(&axis),
            axis,
            radius: anchor.rim,
            arm: anchor.arm(&body.frame()),
        })
    }

    /// Puts the point of the rim that is lowest in the place of the anchor. `start` is the body's rotation when the step
    /// began, `moved` how it has moved since.
    pub(crate) fn follow<S: Scalar>(&mut self, start: &Quat, moved: &Eight<S>, row: &mut PointRow<S>) {
        let turn = Vec3::new(moved.0[3].wide(), moved.0[4].wide(), moved.0[5].wide());
        if turn.norm_squared() < STILL {
            return;
        }
        let rotation = rotated(start, &turn);
        let axis = rotation * self.axis;
        let sign = if self.side == 0 { 1.0 } else { -1.0 };
        let outward = self.normal * sign;
        let across = outward - axis * axis.dot(&outward);
        let lean = across.norm();
        if lean < LEANS {
            return;
        }
        let lowest = rotation * self.center + across * (self.radius / lean);
        let arm = start * (rotation.inverse() * lowest);
        let change = arm - self.arm;
        self.arm = arm;
        let add = |to: &mut Eight<S>, x: f64| to.0[self.lane] = S::of(to.0[self.lane].wide() + x);
        add(&mut row.separation, -sign * change.dot(&self.normal));
        for (axis, tangent) in self.tangents.iter().enumerate() {
            // What has slipped stays, though another point has come another way.
            add(&mut row.slip[axis], sign * tangent.dot(&turn.cross(&change)));
        }
        for (to, x) in row.arm[self.side].iter_mut().zip(arm.iter()) {
            to.0[self.lane] = S::of(*x);
        }
    }
}
