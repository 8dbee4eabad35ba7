//! What every body has covered and may yet cover within the step: small enough to be asked of every pair.

use crate::body::Body;
use crate::math::Frame3;
use crate::math::Vec3;
use crate::shape::Aabb;

/// A body, as the question sees it whether it can touch another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Travel {
    /// Of all its shapes where they are.
    pub(crate) bounds: Aabb,
    /// m/s
    pub(crate) velocity: Vec3,
    /// m/s that any point of it moves beyond its centre of mass, at most.
    pub(crate) rim_speed: f64,
    /// m that any point of it has moved since the first step, at most: what a pair has moved against each other since
    /// some step is no more than what both paths have grown by.
    pub(crate) path: f64,
    /// [`Body::inner_radius`]
    pub(crate) inner_radius: f64,
    pub(crate) awake: bool,
}

/// Of every body of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Travels {
    travels: Vec<Travel>,
    /// Where the bodies were at the last update.
    placed: Vec<Frame3>,
}

impl Travels {
    /// Follows the bodies, whose shapes are in place.
    pub(crate) fn update(&mut self, bodies: &[Body]) {
        let first = self.placed.len() != bodies.len();
        if first {
            self.placed.clear();
            self.placed.extend(bodies.iter().map(Body::frame));
            self.travels.clear();
            self.travels.extend(bodies.iter().map(|body| Travel {
                bounds: body.aabb,
                velocity: Vec3::zeros(),
                rim_speed: 0.0,
                path: 0.0,
                inner_radius: body.inner_radius,
                awake: false,
            }));
        }
        for ((body, travel), placed) in bodies.iter().zip(&mut self.travels).zip(&mut self.placed) {
            travel.awake = body.is_awake();
            let frame = body.frame();
            if !first && frame == *placed && !travel.awake {
                continue;
            }
            travel.path += way(placed, &frame, body.reach);
            *placed = frame;
            let bounds = body.colliders.iter().map(|child| child.bounds);
            travel.bounds = bounds.reduce(|all, one| all.merged(&one)).unwrap_or(body.aabb);
            travel.velocity = body.velocity;
            travel.rim_speed = if body.is_static() { 0.0 } else { body.spin.norm() * body.reach };
        }
    }

    pub(crate) fn of(&self, body: u32) -> &Travel {
        &self.travels[body as usize]
    }
}

/// m that a point within `reach` of the origin moves from one pose to another, at most.
fn way(from: &Frame3, to: &Frame3, reach: f64) -> f64 {
    let (p, q) = (from.rotation.coords, to.rotation.coords);
    // A turn by θ moves it by 2 sin(θ/2) of its distance or less, and the quaternions lie 2 sin(θ/4) apart.
    let turn = 2.0 * (p - q).norm_squared().min((p + q).norm_squared()).sqrt();
    let turned = if turn > 0.0 { turn * reach } else { 0.0 };
    (to.position - from.position).norm() + turned
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::math::{Quat, rotated};

    proptest! {
        #[test]
        fn no_point_within_reach_moves_farther(
            at in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64], turn in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64],
            point in [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64], share in 0.0..1.0_f64
        ) {
            let point = Vec3::from(point);
            let from = Frame3 { position: Vec3::zeros(), rotation: Quat::from_scaled_axis(Vec3::from(at)) };
            let to = Frame3 {
                position: Vec3::from(at) * share,
                rotation: rotated(&from.rotation, &(Vec3::from(turn) * share)),
            };
            let moved = (to.point(&point) - from.point(&point)).norm();
            prop_assert!(moved <= way(&from, &to, point.norm()) + 1e-12);
        }
    }
}
