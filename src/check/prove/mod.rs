//! The runtime layer: what the model does when it is dropped, put down, tilted and stacked, in our engine and in
//! rapier.

mod base;
mod observe;
mod scenes;
mod trials;
mod watch;

use importer::{Asset, Failure};
use mapper::{Mapped, Ruleset};
use serde::{Deserialize, Serialize};
use sim::{Scene, Surface, measure};

use crate::pipeline::{self, Key};
use crate::settle::Outcome;

pub use observe::observations;
pub use scenes::Tilt;

/// Part of every key: raise it when a trial would give another result on the same input.
const VERSION: &str = "trials 4";

/// How models are tried.
#[derive(Clone, Debug)]
pub struct Trials<'a> {
    pub solver: sim::Settings,
    /// Preset of the floor and its surface.
    pub floor: String,
    pub surface: Surface,
    /// For what is known of pairs of materials.
    pub rules: &'a Ruleset,
    /// Whether rapier is asked as well.
    pub rapier: bool,
}

/// How one trial went in both engines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Both<T> {
    pub ours: T,
    /// Absent where rapier was not asked, or refused.
    pub rapier: Option<T>,
}

/// From twice its height to rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drop {
    pub settled: bool,
    /// s from first contact to rest; to the end of the trial where it never came to rest.
    pub rest_after_s: f64,
    /// s that it has for that: by its fall, and by its rolling resistance where it still rolled then.
    pub rests_within_s: f64,
    /// % of the energy of the fall.
    pub energy_rise_percent: f64,
    /// Depth at rest, and the deepest after contact, over the limit of a resting body.
    pub rest_depth: f64,
    pub most_depth: f64,
    pub tunnelled: bool,
    /// How far its centre rose above where it was dropped from, % of the drop.
    pub launch_percent: f64,
    pub quarantined: bool,
    /// What differs in rapier, in a sentence; empty where nothing does or nobody asked.
    pub rapier_differs: String,
}

/// Put down as it was modelled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stand {
    /// By how much it may be tilted before it falls, by the statics of its base, degrees; 0 for a ball.
    pub tips_at_deg: f64,
    /// How far it tilted.
    pub tilt_deg: Both<f64>,
}

/// On a slope, in the pose in which it came to rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Slope {
    /// Of the pair with the floor.
    pub friction: f64,
    /// At 0.8 times the friction: way down the slope in two seconds, % of its size. Absent where it would tip.
    pub hold_percent: Option<Both<f64>>,
    /// At 1.25 times: way down the slope in a second, % of Coulomb's closed form. Absent where it would tip.
    pub slide_percent: Option<Both<f64>>,
}

/// Everything that was tried on a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Proof {
    pub drop: Drop,
    pub stand: Stand,
    /// Awake in its rest pose for two seconds: drift over the limit. Absent where it never came to rest.
    pub stay: Option<Both<f64>>,
    pub slope: Option<Slope>,
    /// Height that the top of three lost, % of its own height.
    pub stack: Option<Both<f64>>,
}

impl Trials<'_> {
    /// What a proof depends on.
    #[must_use]
    pub fn key(&self, asset: [u8; 32], physics: &str, preset: &str, stacks: bool) -> String {
        let Surface { friction, restitution, rolling_resistance, .. } = self.surface;
        let floor = [friction, restitution, rolling_resistance];
        // On the floor, and on its like in a stack. The materials' own numbers are left out: a preset put into the
        // catalogue before them changes nothing here.
        let known = [self.floor.as_str(), preset]
            .map(|other| self.rules.known_pair(other, preset).map(|pair| (pair.friction, pair.restitution)));
        Key::new("prove")
            .with(VERSION)
            .with(asset)
            .with(physics)
            .with(format!("{:?} {floor:?} {known:?} {} {stacks}", self.solver, self.rapier))
            .finish()
    }

    /// Tries one model.
    ///
    /// # Errors
    /// No body can be made of it, or the solver refuses it.
    pub fn prove(&self, model: &str, asset: &Asset, mapped: &Mapped, stacks: bool) -> Result<Proof, Failure> {
        let scene = mapper::scene::drop_scene(model, asset, mapped, self.surface, self.rules)
            .map_err(|error| pipeline::of_placing(&error))?;
        trials::all(self, &scene, stacks)
    }

    /// The run of a scene in rapier; `None` where it is not asked or refuses.
    #[cfg(feature = "validate")]
    fn in_rapier(&self, scene: &Scene, sleeping: bool, time_s: f64) -> Option<Outcome> {
        let settings = sim::Settings { sleeping, ..self.solver };
        if !self.rapier {
            return None;
        }
        crate::validate::run_rapier(scene, &settings, time_s, sleeping).ok()
    }

    #[cfg(not(feature = "validate"))]
    #[expect(clippy::unused_self, reason = "the signature of the full build")]
    fn in_rapier(&self, _: &Scene, _: bool, _: f64) -> Option<Outcome> {
        None
    }
}

/// Extents of the moving body of a scene, m, along its own axes.
fn extents(scene: &Scene) -> [f64; 3] {
    scene.entities.get(scenes::BODY).map_or([0.0; 3], |entity| measure::extents(&entity.shapes))
}
