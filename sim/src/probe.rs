//! Contacts of two bodies outside of a simulation: for tools that ask whether two things touch, and for benchmarks.

use crate::body::Body;
use crate::collide::narrow::{Ahead, Outlook};
use crate::collide::pair::Pair;
use crate::collide::travel::Travels;
use crate::collide::update::NarrowPhase;
use crate::error::SceneError;
use crate::frame::ContactPoint;
use crate::gallery::build;
use crate::math::quaternion;
use crate::plan::Plan;
use crate::scene::{Entity, Pose};
use crate::settings::Settings;
use crate::solve::wide::simd_available;

/// Two bodies and what is known of their contacts from the query before.
#[derive(Clone)]
pub struct Probe {
    bodies: [Body; 2],
    pair: Pair,
    travels: Travels,
    narrow: NarrowPhase,
    contacts: Vec<ContactPoint>,
}

impl Probe {
    /// # Errors
    /// A [`SceneError`] that names the entity.
    pub fn new(a: &Entity, b: &Entity) -> Result<Self, SceneError> {
        let scene = build::scene("probe", vec![a.clone(), b.clone()]);
        let plan = Plan::of(&scene);
        Ok(Self {
            bodies: [Body::new(a, &plan)?, Body::new(b, &plan)?],
            pair: Pair { a: 0, b: 1, ..Pair::default() },
            travels: Travels::default(),
            narrow: NarrowPhase::default(),
            contacts: Vec::new(),
        })
    }

    /// Moves the bodies, and looks at them with a `margin_m` of their motion for which points are kept that do not
    /// touch. Returns how many regions they have in common.
    pub fn query(&mut self, poses: [Pose; 2], margin_m: f64) -> usize {
        for (body, pose) in self.bodies.iter_mut().zip(poses) {
            body.position = pose.position.into();
            body.rotation = quaternion(pose.rotation);
            let frame = (&body.frame()).into();
            let bounds = body.colliders.iter_mut().map(|child| child.place(&frame));
            if let Some(bounds) = bounds.reduce(|all, one| all.merged(&one)) {
                body.aabb = bounds.grown(margin_m);
            }
        }
        // A fall of the margin within a second.
        let keep_share = Settings::default().contact_keep_share;
        let ahead =
            Ahead { dt: 1.0, gravity: margin_m, keep_share, simd: simd_available(), piecewise: false };
        self.travels.update(&self.bodies);
        let pair = std::slice::from_mut(&mut self.pair);
        self.narrow.update(pair, (&self.bodies, &self.travels), ahead, 1, |_, _, _| ())
    }

    /// Forgets the query before, as if the bodies had only now met.
    pub fn forget(&mut self) {
        self.pair.manifolds.clear();
        self.pair.memories.clear();
        self.pair.outlook = Outlook::default();
    }

    /// Points of the last query, world; deeper is larger.
    pub fn contacts(&mut self) -> &[ContactPoint] {
        let (a, b) = (self.bodies[0].frame(), self.bodies[1].frame());
        self.contacts.clear();
        for manifold in &self.pair.manifolds {
            for point in &manifold.points {
                let separation = manifold.separation(point, &a, &b);
                let on_a = a.position + point.anchor_a.arm(&a);
                self.contacts.push(ContactPoint {
                    a: 0,
                    b: 1,
                    position: (on_a + manifold.normal * (0.5 * separation)).into(),
                    normal: manifold.normal.into(),
                    depth_m: -separation,
                    normal_impulse_n_s: 0.0,
                    friction_impulse_n_s: [0.0; 3],
                });
            }
        }
        &self.contacts
    }
}
