//! An engine with one choice of settings.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use sim::{Scene, Settings, World};

use super::clock::cpu_time;
use super::running::Running;
#[cfg(feature = "validate")]
use super::{remote::Remote, running::Rapier};
#[cfg(feature = "validate")]
use baseline::{Baseline, Defaults};

/// Whose solver, in which build.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    Physique,
    Rapier,
    /// rapier's build with eight lanes, a program of its own.
    RapierSimd8,
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

/// What runs here besides this process.
#[derive(Clone, Debug, Default)]
pub struct Programs {
    /// The runner built with `simd8`, where there is one.
    pub simd8: Option<PathBuf>,
}

impl Programs {
    /// The engines that can run.
    #[must_use]
    pub fn engines(&self) -> Vec<Engine> {
        let mut engines = vec![Engine::Physique];
        if cfg!(feature = "validate") {
            engines.push(Engine::Rapier);
            if self.simd8.is_some() {
                engines.push(Engine::RapierSimd8);
            }
        }
        engines
    }
}

impl Engine {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Physique => "Physique",
            Self::Rapier => "rapier",
            Self::RapierSimd8 => "rapier simd8",
        }
    }

    /// The engine's own number of substeps.
    #[must_use]
    pub fn default_substeps(self) -> u32 {
        match self {
            Self::Physique => Settings::default().substeps,
            #[cfg(feature = "validate")]
            Self::Rapier | Self::RapierSimd8 => Defaults::new().iterations,
            #[cfg(not(feature = "validate"))]
            Self::Rapier | Self::RapierSimd8 => 0,
        }
    }
}

impl Setup {
    /// The engine as it comes, awake.
    #[must_use]
    pub fn default_of(engine: Engine, dt_s: f64) -> Self {
        Self { engine, dt_s, substeps: engine.default_substeps(), stiffness: 1.0, sleeping: false }
    }

    /// The same with more and less work, and with stiffer contacts.
    #[must_use]
    pub fn sweep_of(engine: Engine, dt_s: f64) -> Vec<Self> {
        let default = Self::default_of(engine, dt_s);
        let steps = [1, 2, 4, 8, 16].map(|substeps| Self { substeps, ..default });
        let stiff = [8, 16].map(|substeps| Self { substeps, stiffness: 4.0, ..default });
        steps.into_iter().chain(stiff).filter(|setup| *setup != default).collect()
    }

    #[must_use]
    pub fn is_default(&self) -> bool {
        *self == Self::default_of(self.engine, self.dt_s)
    }

    /// `8 substeps`, `16 substeps, 4x stiffer`.
    #[must_use]
    pub fn label(&self) -> String {
        let word = if self.engine == Engine::Physique { "substeps" } else { "iterations" };
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

    /// Builds the scene in the engine, to be stepped `steps` times.
    ///
    /// # Errors
    /// The engine refuses the scene, or its program is not there: why.
    pub fn open(&self, scene: &Scene, steps: usize, programs: &Programs) -> Result<Box<dyn Running>, String> {
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
            #[cfg(feature = "validate")]
            Engine::RapierSimd8 => Ok(Box::new(Remote::states(self, scene, steps, programs)?)),
            #[cfg(not(feature = "validate"))]
            Engine::Rapier | Engine::RapierSimd8 => {
                let _ = (steps, programs);
                Err("this build has no rapier; build with the feature validate".to_owned())
            }
        }
    }

    /// CPU time of every step, ms; nothing else is done between steps.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn step_times(&self, scene: &Scene, steps: usize, programs: &Programs) -> Result<Vec<f64>, String> {
        #[cfg(feature = "validate")]
        if self.engine == Engine::RapierSimd8 {
            return super::remote::step_times(self, scene, steps, programs);
        }
        let mut running = self.open(scene, steps, programs)?;
        let mut times = Vec::with_capacity(steps);
        for _ in 0..steps {
            let begin = cpu_time();
            running.advance()?;
            times.push(cpu_time().saturating_sub(begin).as_secs_f64() * 1e3);
        }
        Ok(times)
    }
}
