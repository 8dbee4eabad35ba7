//! An engine with one choice of settings, and a scene under way in it.

use serde::{Deserialize, Serialize};
use sim::{Event, Pose, Scene, Settings, Velocity, World};

#[cfg(feature = "validate")]
use crate::validate::Baseline;

/// Whose solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    Physique,
    Rapier,
}

/// An engine and its settings; what is not named here stays at the engine's default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    pub engine: Engine,
    /// s
    pub dt_s: f64,
    /// Substeps, which rapier calls solver iterations.
    pub substeps: u32,
    /// Frequency of the contact springs over the engine's default.
    pub stiffness: f64,
    pub sleeping: bool,
}

impl Engine {
    /// Those of this build.
    #[must_use]
    pub fn all() -> Vec<Self> {
        if cfg!(feature = "validate") { vec![Self::Physique, Self::Rapier] } else { vec![Self::Physique] }
    }

    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Physique => "Physique",
            Self::Rapier => "rapier",
        }
    }

    /// The engine's own number of substeps.
    #[must_use]
    pub fn default_substeps(self) -> u32 {
        match self {
            Self::Physique => Settings::default().substeps,
            #[cfg(feature = "validate")]
            Self::Rapier => Baseline::default_iterations(),
            #[cfg(not(feature = "validate"))]
            Self::Rapier => 0,
        }
    }
}

impl Setup {
    /// The engine as it comes, awake.
    #[must_use]
    pub fn default_of(engine: Engine, dt_s: f64) -> Self {
        Self { engine, dt_s, substeps: engine.default_substeps(), stiffness: 1.0, sleeping: false }
    }

    #[must_use]
    pub fn is_default(&self) -> bool {
        *self == Self::default_of(self.engine, self.dt_s)
    }

    /// `8 substeps`, `16 substeps, 4x stiffer`.
    #[must_use]
    pub fn label(&self) -> String {
        let word = match self.engine {
            Engine::Physique => "substeps",
            Engine::Rapier => "iterations",
        };
        let stiffer =
            if self.stiffness == 1.0 { String::new() } else { format!(", {}x stiffer", self.stiffness) };
        let sleeping = if self.sleeping { ", sleeping" } else { "" };
        format!("{} {word}{stiffer}{sleeping}", self.substeps)
    }

    /// The solver's settings that stand for this setup.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let defaults = Settings::default();
        let stiffness = if self.engine == Engine::Physique { self.stiffness } else { 1.0 };
        Settings {
            dt_s: self.dt_s,
            substeps: self.substeps,
            sleeping: self.sleeping,
            contact_hertz: defaults.contact_hertz * stiffness,
            ..defaults
        }
    }

    /// Builds the scene in the engine.
    ///
    /// # Errors
    /// The engine refuses the scene: why.
    pub fn open(&self, scene: &Scene) -> Result<Box<dyn Running>, String> {
        match self.engine {
            Engine::Physique => {
                let world = World::new(scene, &self.settings()).map_err(|error| error.to_string())?;
                Ok(Box::new(world))
            }
            #[cfg(feature = "validate")]
            Engine::Rapier => {
                let baseline = Baseline::stiffer(scene, &self.settings(), self.stiffness)?;
                Ok(Box::new(Rapier { baseline, entities: scene.entities.len() }))
            }
            #[cfg(not(feature = "validate"))]
            Engine::Rapier => Err("this build has no rapier; build with the feature validate".to_owned()),
        }
    }
}

/// A scene under way.
pub trait Running {
    /// One step; true where an action of the scene took effect in it.
    fn advance(&mut self) -> bool;
    /// World from body and velocity of every entity of the scene.
    fn state(&self) -> (Vec<Pose>, Vec<Velocity>);
}

impl Running for World {
    fn advance(&mut self) -> bool {
        self.step();
        self.frame().events.iter().any(|event| matches!(event, Event::Acted { .. }))
    }

    fn state(&self) -> (Vec<Pose>, Vec<Velocity>) {
        let rigid = self.frame().rigid;
        rigid.map_or_else(Default::default, |rigid| (rigid.poses.to_vec(), rigid.velocities.to_vec()))
    }
}

#[cfg(feature = "validate")]
struct Rapier {
    baseline: Baseline,
    entities: usize,
}

#[cfg(feature = "validate")]
impl Running for Rapier {
    fn advance(&mut self) -> bool {
        self.baseline.step()
    }

    fn state(&self) -> (Vec<Pose>, Vec<Velocity>) {
        (0..self.entities)
            .map(|index| {
                let (pose, velocity, _) = self.baseline.state(index);
                (pose, velocity)
            })
            .unzip()
    }
}
