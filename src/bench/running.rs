//! A scene under way in an engine.

use sim::{Event, Pose, Velocity, World};

/// One contact region as an engine reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Entities; `normal` points from `a` to `b`.
    pub a: usize,
    pub b: usize,
    /// m, world
    pub position: [f64; 3],
    pub normal: [f64; 3],
    /// N s
    pub normal_impulse: f64,
    /// N s, on `b`, where the engine tells it.
    pub friction_impulse: Option<[f64; 3]>,
}

/// A scene under way.
pub trait Running {
    /// One step; true where an action of the scene took effect in it.
    ///
    /// # Errors
    /// The engine's program has ended.
    fn advance(&mut self) -> Result<bool, String>;
    /// World from body and velocity of every entity of the scene.
    fn state(&self) -> (Vec<Pose>, Vec<Velocity>);
    /// Contacts that carried something in the last step. Empty where the engine does not tell.
    fn touches(&self) -> Vec<Touch>;
}

impl Running for World {
    fn advance(&mut self) -> Result<bool, String> {
        self.step();
        Ok(self.frame().events.iter().any(|event| matches!(event, Event::Acted { .. })))
    }

    fn state(&self) -> (Vec<Pose>, Vec<Velocity>) {
        let rigid = self.frame().rigid;
        rigid.map_or_else(Default::default, |rigid| (rigid.poses.to_vec(), rigid.velocities.to_vec()))
    }

    fn touches(&self) -> Vec<Touch> {
        let frame = self.frame();
        let points = frame.contacts.map(|contacts| contacts.points).unwrap_or_default();
        let touch = |point: &sim::ContactPoint| Touch {
            a: point.a as usize,
            b: point.b as usize,
            position: point.position,
            normal: point.normal,
            normal_impulse: point.normal_impulse_n_s,
            friction_impulse: Some(point.friction_impulse_n_s),
        };
        points.iter().map(touch).collect()
    }
}

#[cfg(feature = "validate")]
pub(super) struct Rapier {
    pub(super) baseline: baseline::Baseline,
    pub(super) entities: usize,
}

#[cfg(feature = "validate")]
impl Running for Rapier {
    fn advance(&mut self) -> Result<bool, String> {
        Ok(self.baseline.step())
    }

    fn state(&self) -> (Vec<Pose>, Vec<Velocity>) {
        let state = |index| {
            let (pose, velocity, _) = self.baseline.state(index);
            (pose, velocity)
        };
        (0..self.entities).map(state).unzip()
    }

    fn touches(&self) -> Vec<Touch> {
        let touch = |touch: baseline::Touch| Touch {
            a: touch.a,
            b: touch.b,
            position: touch.position,
            normal: touch.normal,
            normal_impulse: touch.normal_impulse,
            friction_impulse: Some(touch.friction_impulse),
        };
        self.baseline.touches().into_iter().map(touch).collect()
    }
}
