//! What a step leaves for the sinks, put together when somebody asks: a step that nobody looks at copies nothing.

use std::sync::{Mutex, OnceLock, PoisonError};

use crate::frame::{ContactPoint, Event, Metrics, SleepState};
use crate::math::Vec3;
use crate::scene::{Pose, Velocity};
use crate::world::World;

/// The events of the last step, and the state after it once it has been asked for.
#[derive(Default)]
pub(crate) struct Output {
    pub(crate) events: Vec<Event>,
    published: OnceLock<Published>,
    /// Storage of the one before, for the next.
    spare: Mutex<Published>,
}

/// The state as the sinks see it.
#[derive(Default)]
pub(crate) struct Published {
    pub(crate) poses: Vec<Pose>,
    pub(crate) velocities: Vec<Velocity>,
    pub(crate) sleep: Vec<SleepState>,
    pub(crate) contacts: Vec<ContactPoint>,
    pub(crate) metrics: Metrics,
}

/// What is published follows from the world's state and is made anew.
impl Clone for Output {
    fn clone(&self) -> Self {
        Self { events: self.events.clone(), ..Self::default() }
    }
}

impl Output {
    /// Forgets what the last step has left.
    pub(crate) fn clear(&mut self) {
        self.events.clear();
        if let Some(published) = self.published.take() {
            *self.spare.get_mut().unwrap_or_else(PoisonError::into_inner) = published;
        }
    }

    /// The state of `world`, whose output this is.
    pub(crate) fn of(&self, world: &World) -> &Published {
        self.published.get_or_init(|| {
            let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
            let mut published = std::mem::take(&mut *spare);
            published.fill(world);
            published
        })
    }
}

impl Published {
    fn fill(&mut self, world: &World) {
        self.poses.clear();
        self.velocities.clear();
        self.sleep.clear();
        self.contacts.clear();
        let mut metrics = Metrics::default();
        for body in &world.bodies {
            self.poses.push(body.frame().to_pose());
            self.velocities.push(Velocity { linear: body.velocity.into(), angular: body.spin.into() });
            self.sleep.push(body.sleep);
            metrics.kinetic_j += body.kinetic_j();
            metrics.potential_j -= body.mass * world.gravity.dot(&body.position);
            metrics.awake += u32::from(body.is_awake());
        }
        for pair in &world.pairs {
            let (a, b) = (world.bodies[pair.a as usize].frame(), world.bodies[pair.b as usize].frame());
            for manifold in &pair.manifolds {
                for point in &manifold.points {
                    let separation = manifold.separation(point, &a, &b);
                    if separation > 0.0 && point.step_impulse <= 0.0 {
                        continue;
                    }
                    // A round surface carries its contact point along.
                    let middle = if point.anchor_b.offset == Vec3::zeros() {
                        a.position + point.anchor_a.arm(&a) + manifold.normal * (0.5 * separation)
                    } else {
                        b.position + point.anchor_b.arm(&b) - manifold.normal * (0.5 * separation)
                    };
                    self.contacts.push(ContactPoint {
                        a: pair.a,
                        b: pair.b,
                        position: middle.into(),
                        normal: manifold.normal.into(),
                        depth_m: -separation,
                        normal_impulse_n_s: point.step_impulse,
                        friction_impulse_n_s: (manifold.tangents[0] * point.step_friction.x
                            + manifold.tangents[1] * point.step_friction.y)
                            .into(),
                    });
                    metrics.max_penetration_m = metrics.max_penetration_m.max(-separation);
                }
            }
        }
        metrics.contacts = u32::try_from(self.contacts.len()).unwrap_or(u32::MAX);
        self.metrics = metrics;
    }
}
