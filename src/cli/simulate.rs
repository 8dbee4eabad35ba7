//! `physique simulate`: a scene file, or one model dropped.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use anyhow::{Context, Result, anyhow, bail};
use mapper::scene::Placement;
use mapper::{Mapped, Mapper, SetValue};
use serde::Serialize;
use sim::{FrameSink, RunLimit, Scene, Settings};

use super::End;
use super::args::{Format, Global, SimulateArgs};
use super::one::one;
use super::{interrupt, job, output};
use crate::simulate::{Explained, PosesSink, Simulated, simulate as run, simulate_explained};
use crate::validate::{Parameter, Verdict};

/// How long a scene runs that does not say.
const DEFAULT_TIME_S: f64 = 10.0;

/// A scene with what it says of itself, and the models in it.
pub(super) struct Loaded {
    pub scene: Scene,
    pub dt_s: Option<f64>,
    pub duration_s: Option<f64>,
    /// For the viewer: entity, file, and where the file's geometry lies in the body.
    models: Vec<(usize, PathBuf, Placement)>,
    /// Of a single model.
    mapped: Option<(String, Mapped)>,
}

/// What is told at the end.
#[derive(Serialize)]
struct Told {
    #[serde(flatten)]
    simulated: Simulated,
    interrupted: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    explained: Option<Explained>,
    #[serde(skip_serializing_if = "Option::is_none")]
    poses: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recording: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rapier: Option<Compared>,
}

#[derive(Serialize)]
struct Compared {
    parameters: Vec<Parameter>,
    verdicts: Vec<Verdict>,
    agree: usize,
}

/// # Errors
/// The scene is refused, or a file cannot be read or written.
pub(super) fn simulate(global: &Global, args: &SimulateArgs) -> Result<End> {
    let stop = interrupt::flag();
    let loaded = load(global, args)?;
    let defaults = Settings::default();
    let settings = Settings {
        dt_s: args.dt.or(loaded.dt_s).unwrap_or(defaults.dt_s),
        substeps: args.substeps.unwrap_or(defaults.substeps),
        sleeping: !args.no_sleep,
        contact_hertz: args.contact_hertz.unwrap_or(defaults.contact_hertz),
        ..defaults
    };
    let limit = RunLimit {
        max_time_s: args.time.or(loaded.duration_s).unwrap_or(DEFAULT_TIME_S),
        stop_at_rest: args.until_rest,
    };
    let mut poses = args
        .poses
        .as_ref()
        .map(|path| File::create(path).with_context(|| format!("cannot write {}", path.display())))
        .transpose()?
        .map(PosesSink::new);
    let recording = args.record.clone().or_else(|| Some(global.out.as_ref()?.join("recording.rrd")));
    let mut recorder = Recorder::open(global, args, recording.as_deref(), &loaded)?;

    let mut sinks: Vec<&mut dyn FrameSink> = Vec::new();
    if let Some(poses) = &mut poses {
        sinks.push(poses);
    }
    if let Some(sink) = recorder.sink() {
        sinks.push(sink);
    }
    let (simulated, explained) = if args.explain {
        let (simulated, explained) = simulate_explained(&loaded.scene, &settings, &limit, &mut sinks, stop)?;
        (simulated, Some(explained))
    } else {
        (run(&loaded.scene, &settings, &limit, &mut sinks, stop)?, None)
    };
    if let (Some(poses), Some(path)) = (poses, &args.poses) {
        poses.finish().with_context(|| format!("cannot write {}", path.display()))?;
    }
    recorder.finish()?;

    let interrupted = stop.load(Ordering::Relaxed);
    let rapier = if args.validate && !interrupted {
        Some(compare(&loaded.scene, &settings, &limit, &simulated)?)
    } else {
        None
    };
    let findings = rapier.as_ref().is_some_and(|compared| compared.agree < compared.verdicts.len());
    let told = Told {
        simulated,
        interrupted,
        explained,
        poses: args.poses.as_ref().map(|path| path.display().to_string()),
        recording: recording.map(|path| path.display().to_string()),
        rapier,
    };
    match global.format {
        Format::Json => output::json(&told)?,
        _ => output::result(|out| text(out, &told))?,
    }
    Ok(match (interrupted, findings) {
        (true, _) => End::Interrupted,
        (false, true) => End::Findings,
        (false, false) => End::Clean,
    })
}

fn load(global: &Global, args: &SimulateArgs) -> Result<Loaded> {
    let path = &args.scene;
    if !path.is_file() {
        bail!("{}: no such file; name a scene (.yaml) or a model", path.display());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mapper, _, sets) = job::mapping(global, &args.mapping, folder)?;
    let db = job::db(global);
    let is_scene = path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
    if is_scene {
        load_scene(path, &db, &mapper, &sets)
    } else {
        load_model(path, &db, &mapper, &sets, &args.floor)
    }
}

pub(super) fn load_scene(path: &Path, db: &Path, mapper: &Mapper, sets: &[SetValue]) -> Result<Loaded> {
    let mut resolver = |model: &Path| {
        let one = one(model, None, db, mapper, sets).map_err(|error| format!("{error:#}"))?;
        Ok((one.asset, one.mapped))
    };
    let file = mapper::scene_file::load(path, mapper.rules(), &mut resolver)?;
    Ok(Loaded {
        scene: file.scene,
        dt_s: file.dt_s,
        duration_s: file.duration_s,
        models: file.models.into_iter().map(|model| (model.entity, model.path, model.placement)).collect(),
        mapped: None,
    })
}

fn load_model(path: &Path, db: &Path, mapper: &Mapper, sets: &[SetValue], floor: &str) -> Result<Loaded> {
    let one = one(path, None, db, mapper, sets)?;
    if one.mapped.kind != mapper::Kind::Rigid {
        bail!(
            "{}: it is {}, and only rigid bodies are simulated yet; see `physique explain` for why it is, or set \
             kind=rigid with --set",
            path.display(),
            one.mapped.kind
        );
    }
    let floor = mapper
        .rules()
        .surface(floor)
        .ok_or_else(|| anyhow!("the rules have no preset {floor:?} for the floor; name one with --floor"))?;
    let because = |error: mapper::scene::SceneError| anyhow!("{}. {}", error.reason(), error.way_out());
    let scene = mapper::scene::drop_scene(&one.model, &one.asset, &one.mapped, floor, mapper.rules())
        .map_err(because)?;
    let placement = mapper::scene::placement(&one.model, &one.asset, &one.mapped).map_err(because)?;
    Ok(Loaded {
        scene,
        dt_s: None,
        duration_s: None,
        models: vec![(1, path.to_path_buf(), placement)],
        mapped: Some((one.model, one.mapped)),
    })
}

#[cfg(feature = "validate")]
fn compare(scene: &Scene, settings: &Settings, limit: &RunLimit, ours: &Simulated) -> Result<Compared> {
    use crate::validate::{judge, parameters, run_rapier};

    let rapier = run_rapier(scene, settings, limit.max_time_s, limit.stop_at_rest)
        .map_err(|reason| anyhow!(reason))?;
    let verdicts = judge(scene, &ours.bodies, &rapier);
    let agree = verdicts.iter().filter(|verdict| verdict.agrees).count();
    Ok(Compared { parameters: parameters(Some(scene), settings), verdicts, agree })
}

#[cfg(not(feature = "validate"))]
fn compare(_: &Scene, _: &Settings, _: &RunLimit, _: &Simulated) -> Result<Compared> {
    bail!("this build cannot compare with rapier: build with --features validate")
}

fn text(out: &mut dyn Write, told: &Told) -> io::Result<()> {
    let s = &told.simulated;
    let ms = &s.ms_per_step;
    writeln!(
        out,
        "{}: {} entities, {} steps of {:.6} s with {} small steps each",
        s.scene, s.entities, s.steps, s.dt_s, s.substeps
    )?;
    writeln!(
        out,
        "  ms a step          median {:.4}, mean {:.4}, p99 {:.4}, max {:.4}",
        ms.median, ms.mean, ms.p99, ms.max
    )?;
    writeln!(out, "  deepest overlap    {:.4} mm", s.max_penetration_m * 1e3)?;
    writeln!(out, "  rise of energy     {:.3e} J", s.max_energy_rise_j)?;
    match s.settled_at_s {
        Some(at) => writeln!(out, "  at rest            from {at:.2} s on")?,
        None => writeln!(out, "  at rest            not within {:.2} s", s.time_s)?,
    }
    writeln!(out, "  state hash         {}", s.state_hash)?;
    if let Some(explained) = &told.explained {
        explained.text(out)?;
    }
    if let Some(rapier) = &told.rapier {
        comparison(out, rapier)?;
    }
    for (what, path) in [("poses", &told.poses), ("recording", &told.recording)] {
        if let Some(path) = path {
            writeln!(out, "  {what:<18} {path}")?;
        }
    }
    #[cfg(feature = "viewer")]
    if let Some(recording) = &told.recording {
        writeln!(out, "  look at it         {}", viewer::open_command(Path::new(recording)))?;
    }
    if told.interrupted {
        writeln!(out, "Stopped before the end.")?;
    }
    Ok(())
}

fn comparison(out: &mut dyn Write, rapier: &Compared) -> io::Result<()> {
    writeln!(out, "\n  {:38}{:28}rapier", "", "physique")?;
    for row in &rapier.parameters {
        writeln!(out, "  {:38}{:28}{}", row.name, row.ours, row.rapier)?;
    }
    writeln!(out, "\n  {} of {} bodies rest alike in both", rapier.agree, rapier.verdicts.len())?;
    for verdict in rapier.verdicts.iter().filter(|verdict| !verdict.agrees) {
        writeln!(out, "  {}: {}", verdict.name, verdict.remark)?;
    }
    writeln!(out)
}

/// A recording of the scene, where one is wanted.
#[cfg(feature = "viewer")]
struct Recorder(Option<viewer::RerunSink>);

#[cfg(feature = "viewer")]
impl Recorder {
    fn open(global: &Global, args: &SimulateArgs, file: Option<&Path>, loaded: &Loaded) -> Result<Self> {
        if file.is_none() && !args.view {
            return Ok(Self(None));
        }
        if let Some(folder) = file.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        let mut visuals = Vec::new();
        for (entity, path, placement) in &loaded.models {
            let source = importer::read(path, &super::job::import_options())?;
            let preset = loaded.mapped.as_ref().and_then(|(_, mapped)| mapped.preset.as_deref());
            let meshes = crate::pipeline::visual::meshes(&source, preset, placement);
            visuals.push(viewer::Visual { entity: *entity, meshes });
        }
        let info = loaded
            .mapped
            .as_ref()
            .map_or_else(String::new, |(model, mapped)| crate::pipeline::visual::info(model, mapped));
        let output = viewer::Output { file: file.map(Path::to_path_buf), view: args.view, connect: None };
        let sink = viewer::Recording::new(output, loaded.scene.name.clone(), visuals, info).open()?;
        if !global.quiet {
            sink.notices().iter().for_each(|notice| output::notice(notice));
        }
        Ok(Self(Some(sink)))
    }

    fn sink(&mut self) -> Option<&mut dyn FrameSink> {
        self.0.as_mut().map(|sink| sink as &mut dyn FrameSink)
    }

    fn finish(self) -> Result<()> {
        if let Some(sink) = self.0 {
            sink.finish()?;
        }
        Ok(())
    }
}

#[cfg(not(feature = "viewer"))]
struct Recorder;

#[cfg(not(feature = "viewer"))]
impl Recorder {
    fn open(_: &Global, args: &SimulateArgs, file: Option<&Path>, loaded: &Loaded) -> Result<Self> {
        let _ = (&loaded.models, &loaded.mapped);
        if file.is_some() || args.view {
            bail!("this build writes no recordings: build with --features viewer");
        }
        Ok(Self)
    }

    fn sink(&mut self) -> Option<&mut dyn FrameSink> {
        None
    }

    fn finish(self) -> Result<()> {
        Ok(())
    }
}
