//! The stages that drop a rigid model onto a floor in our solver and in rapier.

use anyhow::{Context, Result};
use importer::{Asset, Catalogue, Failure, ModelRow};
use mapper::{Mapped, Ruleset};
use serde::{Deserialize, Serialize};
use sim::{FrameSink, RunLimit, Scene, Surface, measure};

use super::key::Key;
use super::stage::staged;
use super::{Job, failure, map};
use crate::report::{Line, Standing};
use crate::settle::{Outcome, Trace};
#[cfg(feature = "validate")]
use crate::validate::{self, Comparison, Verdict};
use importer::catch_panic;

/// These stages' names in the catalogue.
pub(super) const DROP: &str = "drop";
#[cfg(feature = "validate")]
pub(super) const VALIDATE: &str = "validate";

/// How models are dropped.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub solver: sim::Settings,
    /// s, after which a drop that has not come to rest is given up.
    pub max_time_s: f64,
    /// Preset whose surface the floor has.
    pub floor: String,
    /// Whether to compare with rapier.
    pub validate: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            solver: sim::Settings::default(),
            max_time_s: 60.0,
            floor: "concrete".to_owned(),
            validate: cfg!(feature = "validate"),
        }
    }
}

/// A drop in our solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dropped {
    pub mass_kg: f64,
    /// Collision shapes of the body.
    pub shapes: usize,
    pub outcome: Outcome,
}

/// A sink that a recording hands out for one model.
pub(super) type Sink = Box<dyn FrameSink + Send>;

/// Everything a drop needs apart from its model.
pub(super) struct Stage<'a> {
    catalogue: &'a Catalogue,
    settings: &'a Settings,
    rules: &'a Ruleset,
    floor: Surface,
}

impl<'a> Stage<'a> {
    /// # Errors
    /// The rules do not have the preset of the floor.
    pub(super) fn new(job: &'a Job<'_>, catalogue: &'a Catalogue) -> Result<Self> {
        let floor = &job.drop.floor;
        let rules = job.mapper.rules();
        let surface = rules.surface(floor).with_context(|| {
            format!("the rules have no preset {floor:?} for the floor; name one that they have with --floor")
        })?;
        Ok(Self { catalogue, settings: &job.drop, rules, floor: surface })
    }

    /// What a drop of this model depends on; `None` for a model that is not dropped.
    pub(super) fn key(&self, row: &ModelRow, line: &Line) -> Option<String> {
        let standing = line.standing.as_ref().filter(|standing| standing.is_dropped())?;
        let key = Key::new(DROP)
            .with(row.key?.0)
            .with(&standing.physics)
            .with(format!("{:?} {:?}", self.settings.solver, self.floor_against(standing)))
            .with(self.settings.max_time_s.to_le_bytes());
        Some(key.finish())
    }

    /// The floor's coefficients, and those known of it against the model's material. The materials' numbers are
    /// left out: a preset put into the catalogue before them changes nothing here.
    fn floor_against(&self, standing: &Standing) -> [Option<f64>; 5] {
        let preset = standing.preset.as_deref();
        let known = preset.and_then(|preset| self.rules.known_pair(&self.settings.floor, preset));
        let Surface { friction, restitution, rolling_resistance, .. } = self.floor;
        let known = [known.and_then(|pair| pair.friction), known.and_then(|pair| pair.restitution)];
        [Some(friction), Some(restitution), Some(rolling_resistance), known[0], known[1]]
    }

    /// The model's line with how it came to rest and what rapier says, or with the failure. With a `sink` the
    /// drop is simulated also when its result is known.
    ///
    /// # Errors
    /// The catalogue cannot be read or written.
    pub(super) fn drop(&self, row: &ModelRow, line: &Line, mut sink: Option<Sink>) -> Result<Line> {
        let Some(key) = self.key(row, line) else { return Ok(line.clone()) };
        let dropped = staged(self.catalogue, &row.model, DROP, &key, || {
            let scene = self.scene(row)?;
            self.simulate(&scene, sink.take())
        })?;
        if let Some(sink) = sink {
            // Only for the recording: the result is the stored one. What fails here failed then.
            drop(catch_panic(|| self.scene(row).and_then(|scene| self.simulate(&scene, Some(sink)))));
        }
        let dropped = match dropped {
            Ok(dropped) => dropped,
            Err(failure) => return Ok(line.failed(DROP, failure)),
        };
        let mut line = line.clone();
        self.compare(row, &key, &dropped, &mut line)?;
        line.dropped = Some(dropped);
        Ok(line)
    }

    #[cfg(feature = "validate")]
    fn compare(&self, row: &ModelRow, key: &str, dropped: &Dropped, line: &mut Line) -> Result<()> {
        if !self.settings.validate {
            return Ok(());
        }
        let key = Key::new(VALIDATE).with(key).finish();
        let compared = staged(self.catalogue, &row.model, VALIDATE, &key, || {
            let scene = self.scene(row)?;
            let (verdict, rapier) = self.against_rapier(&scene, dropped)?;
            let agrees_without_restitution = if verdict.agrees {
                None
            } else {
                let dead = validate::without_restitution(&scene);
                Some(self.against_rapier(&dead, &self.simulate(&dead, None)?)?.0.agrees)
            };
            let corners_under = validate::corners_under(&scene, &verdict.ours);
            Ok(Comparison { verdict, rapier, agrees_without_restitution, corners_under })
        })?;
        match compared {
            Ok(comparison) => line.comparison = Some(comparison),
            Err(failure) => *line = line.failed(VALIDATE, failure),
        }
        Ok(())
    }

    #[cfg(feature = "validate")]
    fn against_rapier(&self, scene: &Scene, dropped: &Dropped) -> Result<(Verdict, Outcome), Failure> {
        let refused = |reason| Failure {
            code: "rapier-refused".to_owned(),
            place: String::new(),
            reason,
            way_out: "The drop in our solver stands; leave the comparison out with --no-validate".to_owned(),
        };
        let rapier = validate::run_rapier(scene, &self.settings.solver, self.settings.max_time_s, true)
            .map_err(refused)?;
        let verdict = validate::judge(scene, &dropped.outcome, &rapier).into_iter().next();
        let verdict = verdict.ok_or_else(|| refused("the scene has no body that moves".to_owned()))?;
        Ok((verdict, rapier))
    }

    #[cfg(not(feature = "validate"))]
    #[expect(clippy::unused_self, clippy::unnecessary_wraps, reason = "the signature of the full build")]
    fn compare(&self, _: &ModelRow, _: &str, _: &Dropped, _: &mut Line) -> Result<()> {
        Ok(())
    }

    fn scene(&self, row: &ModelRow) -> Result<Scene, Failure> {
        let (asset, mapped) = stored(self.catalogue, row)?;
        mapper::scene::drop_scene(&row.model, &asset, &mapped, self.floor, self.rules)
            .map_err(|error| failure::of_placing(&error))
    }

    fn simulate(&self, scene: &Scene, sink: Option<Sink>) -> Result<Dropped, Failure> {
        let mut trace = Trace::new(scene);
        let mut sink = sink;
        let mut sinks: Vec<&mut dyn FrameSink> = vec![&mut trace];
        if let Some(sink) = &mut sink {
            sinks.push(sink.as_mut());
        }
        let limit = RunLimit { max_time_s: self.settings.max_time_s, stop_at_rest: true };
        sim::run(scene, &self.settings.solver, &limit, &mut sinks)
            .map_err(|error| failure::of_scene(&error))?;
        let moving = scene.entities.iter().find_map(|entity| Some((measure::mass_of(entity)?, entity)));
        Ok(Dropped {
            mass_kg: moving.map_or(0.0, |(mass, _)| mass.mass_kg),
            shapes: moving.map_or(0, |(_, entity)| entity.shapes.len()),
            outcome: trace.outcome(),
        })
    }
}

/// What the stages before this one made of a model.
pub(super) fn stored(catalogue: &Catalogue, row: &ModelRow) -> Result<(Asset, Mapped), Failure> {
    let asset = map::asset(catalogue, row.key.as_ref().ok_or_else(failure::missing_asset)?)?;
    let mapped = map::stored(catalogue, &row.model).ok().flatten().ok_or_else(failure::missing_asset)?;
    Ok((asset, mapped))
}

impl Standing {
    /// Rigid and free to move. Soft and fluid models are mapped and stored, not simulated yet; what is fixed in
    /// place has nothing to fall.
    #[must_use]
    pub fn is_dropped(&self) -> bool {
        self.kind == mapper::Kind::Rigid && !self.anchored
    }
}
