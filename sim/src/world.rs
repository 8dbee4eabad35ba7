//! The state of a simulation, and how a scene becomes one.

use crate::body::Body;
use crate::collide::broad::BroadPhase;
use crate::collide::pair::{Pair, PairCache};
use crate::collide::update::NarrowPhase;
use crate::error::SceneError;
use crate::frame::{ContactBlock, FRAME_VERSION, Frame, RigidBlock};
use crate::material::MaterialPair;
use crate::math::{Frame3, Vec3};
use crate::output::{Output, Published};
use crate::plan::Plan;
use crate::scene::{Action, Change, Scene};
use crate::settings::Settings;
use crate::shape;
use crate::sleep::Sleepers;
use crate::solve::rolling::RollingConstraint;
use crate::solve::substeps::Solver;

/// A scene under way.
#[derive(Clone)]
pub struct World {
    pub(crate) settings: Settings,
    pub(crate) plan: Plan,
    pub(crate) gravity: Vec3,
    pub(crate) bodies: Vec<Body>,
    /// The contact cache, sorted.
    pub(crate) pairs: Vec<Pair>,
    /// Of the last step, sorted.
    pub(crate) rolling: Vec<RollingConstraint>,
    pub(crate) pair_cache: PairCache,
    pub(crate) broad: BroadPhase,
    pub(crate) narrow: NarrowPhase,
    /// Sorted by time, with their place in the scene.
    pub(crate) actions: Vec<(u32, Action)>,
    pub(crate) next_action: usize,
    pub(crate) step: u64,
    pub(crate) solver: Solver,
    pub(crate) sleepers: Sleepers,
    /// Where the bodies were when the step began.
    pub(crate) start: Vec<Frame3>,
    pub(crate) output: Output,
}

impl World {
    /// Builds the world of a scene.
    ///
    /// # Errors
    /// A [`SceneError`] that names the entity, the shape and the way out. Nothing is refused later: a step
    /// reports instead.
    pub fn new(scene: &Scene, settings: &Settings) -> Result<Self, SceneError> {
        Self::with_plan(scene, settings, &Plan::of(scene))
    }

    /// [`World::new`] with models chosen by hand.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn with_plan(scene: &Scene, settings: &Settings, plan: &Plan) -> Result<Self, SceneError> {
        settings.check()?;
        if !scene.gravity.iter().all(|x| x.is_finite()) {
            return Err(SceneError::Gravity);
        }
        check_pairs(&scene.pairs)?;
        let mut bodies =
            scene.entities.iter().map(|entity| Body::new(entity, plan)).collect::<Result<Vec<_>, _>>()?;
        bodies
            .iter_mut()
            .flat_map(|body| &mut body.colliders)
            .for_each(|collider| collider.learn(&scene.pairs));
        shape::share(bodies.iter_mut().flat_map(|body| &mut body.colliders));
        let mut actions: Vec<(u32, Action)> = (0..).zip(scene.actions.iter().copied()).collect();
        for (index, action) in scene.actions.iter().enumerate() {
            let fault = |fault: String| SceneError::Action { action: index, fault };
            if action.entity >= bodies.len() {
                return Err(fault(format!("entity {} of {} is not there", action.entity, bodies.len())));
            }
            let values: Vec<f64> = match action.change {
                Change::SetPose(pose) => [&pose.position[..], &pose.rotation[..]].concat(),
                Change::SetVelocity(velocity) => [velocity.linear, velocity.angular].concat(),
            };
            if !values.iter().all(|x| x.is_finite()) {
                return Err(fault("a number of its pose or velocity is not finite".to_owned()));
            }
            if !(action.time_s >= 0.0 && action.time_s.is_finite()) {
                return Err(fault(format!("time is {} s; expected 0 or more", action.time_s)));
            }
        }
        actions.sort_by(|(i, a), (j, b)| a.time_s.total_cmp(&b.time_s).then(i.cmp(j)));
        let world = Self {
            settings: *settings,
            plan: plan.clone(),
            gravity: scene.gravity.into(),
            bodies,
            pairs: Vec::new(),
            rolling: Vec::new(),
            pair_cache: PairCache::default(),
            broad: BroadPhase::default(),
            narrow: NarrowPhase::default(),
            actions,
            next_action: 0,
            step: 0,
            solver: Solver::new(settings),
            sleepers: Sleepers::default(),
            start: Vec::new(),
            output: Output::default(),
        };
        Ok(world)
    }

    /// Its models, with the reasons.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// s since the start.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "2^53 steps are three million years")]
        let steps = self.step as f64;
        steps * self.settings.dt_s
    }

    /// Whether every body that moves has been still for [`Settings::sleep_delay_s`], and no action is left.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.next_action == self.actions.len() && self.settled_at_s().is_some()
    }

    /// s, since when nothing has moved, if that is long enough ago to be called rest.
    #[must_use]
    pub fn settled_at_s(&self) -> Option<f64> {
        let moving = self.bodies.iter().filter(|body| !body.is_static());
        let still_s = moving.map(|body| body.still_s).fold(f64::INFINITY, f64::min);
        let last = self.bodies.iter().map(|body| body.still_since_s).fold(0.0, f64::max);
        (still_s >= self.settings.sleep_delay_s).then_some(last)
    }

    /// The state as it is, for a sink.
    #[must_use]
    pub fn frame(&self) -> Frame<'_> {
        let Published { poses, velocities, sleep, contacts, metrics } = self.output.of(self);
        Frame {
            version: FRAME_VERSION,
            step: self.step,
            time_s: self.time_s(),
            rigid: Some(RigidBlock { poses, velocities, sleep }),
            soft: None,
            fluid: None,
            contacts: Some(ContactBlock { points: contacts }),
            events: &self.output.events,
            metrics: *metrics,
        }
    }

    /// A number that differs when any bit of any pose or velocity does: FNV-1a over them in order.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        let words = self.bodies.iter().flat_map(|body| {
            let rotation = body.rotation.coords;
            [body.position, body.velocity, body.spin]
                .into_iter()
                .flat_map(|v| [v.x, v.y, v.z])
                .chain([rotation.x, rotation.y, rotation.z, rotation.w])
        });
        words
            .flat_map(|x| x.to_bits().to_le_bytes())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }
}

fn check_pairs(pairs: &[MaterialPair]) -> Result<(), SceneError> {
    for pair in pairs {
        let wrong = |what, value, range| SceneError::Pair { between: pair.between, what, value, range };
        if let Some(friction) = pair.friction.filter(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(wrong("friction", friction, "0 or more"));
        }
        if let Some(restitution) = pair.restitution.filter(|value| !(0.0..=1.0).contains(value)) {
            return Err(wrong("restitution", restitution, "0 to 1"));
        }
    }
    Ok(())
}
