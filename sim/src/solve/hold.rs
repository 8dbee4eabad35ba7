//! What is fast and would have gone through: held in front of the plane that was foreseen.
//!
//! A corner that meets first can make a die turn by radians a substep, more than sweeps over its contact can follow.
//! Whatever they leave, the ball inside of a fast shape does not end behind the plane: it is put back, and its approach
//! ends as in an impact without rebound. That is a shock, and takes energy only.

use crate::body::Body;
use crate::collide::foresee::BALL;
use crate::collide::pair::Pair;
use crate::math::Vec3;

/// Share of the ball's radius by which it may be behind the plane: so deep contacts come by themselves.
const DEEP_SHARE: f64 = 0.1;

/// Holds the bodies of those `pairs` that `fast` names.
pub(crate) fn hold(bodies: &mut [Body], pairs: &mut [Pair], fast: &[u32]) {
    for &pair in fast {
        let Pair { a, b, manifolds, .. } = &mut pairs[pair as usize];
        for manifold in manifolds {
            let normal = manifold.normal;
            let [frame_a, frame_b] = [*a, *b].map(|body| bodies[body as usize].frame());
            let Some(ball) = manifold.points.iter().position(|point| point.feature == BALL) else { continue };
            let point = &manifold.points[ball];
            let radius = point.anchor_a.offset.norm().max(point.anchor_b.offset.norm());
            let separation = manifold.separation(point, &frame_a, &frame_b);
            let [inv_a, inv_b] = [*a, *b].map(|body| inv_mass(&bodies[body as usize]));
            let inv_mass = inv_a + inv_b;
            if separation >= -DEEP_SHARE * radius || inv_mass == 0.0 {
                continue;
            }
            let velocity = bodies[*b as usize].velocity - bodies[*a as usize].velocity;
            let impulse = (-velocity.dot(&normal)).max(0.0) / inv_mass;
            let way = -separation / inv_mass;
            let mut push = |body: u32, by: Vec3| {
                let body = &mut bodies[body as usize];
                body.position += by * way;
                body.velocity += by * impulse;
            };
            push(*a, -normal * inv_a);
            push(*b, normal * inv_b);
            manifold.points[ball].step_impulse += impulse;
        }
    }
}

fn inv_mass(body: &Body) -> f64 {
    if body.is_awake() { body.inv_mass } else { 0.0 }
}
