//! `physique report`: speed against error, on scenes of the gallery or of the user's.

use std::path::Path;
use std::sync::atomic::Ordering;

use anyhow::{Result, bail};
use sim::gallery;

use super::End;
use super::args::{Format, Global, ReportArgs};
use super::{interrupt, job, output, simulate};
use crate::bench::{Engine, Setup, Sheet, Subject, run, write_sheet};

/// How long a scene file runs that does not say, s.
const DEFAULT_TIME_S: f64 = 10.0;

/// # Errors
/// A scene is not there or is refused, or a result cannot be written.
pub(super) fn report(global: &Global, args: &ReportArgs) -> Result<End> {
    if args.list {
        return list(global);
    }
    let stop = interrupt::flag();
    let subjects = subjects(global, args)?;
    let mut sheets: Vec<Sheet> = Vec::new();
    for subject in subjects {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let sheet = run(&subject, &setups(args, subject.dt_s), args.rounds, stop);
        if global.format == Format::Text {
            output::result(|out| write_sheet(out, &sheet))?;
        }
        sheets.push(sheet);
    }
    if global.format == Format::Json {
        output::json(&sheets)?;
    }
    if let Some(folder) = &global.out {
        output::file(&folder.join("report.json"), |out| Ok(serde_json::to_writer_pretty(out, &sheets)?))?;
    }
    Ok(if stop.load(Ordering::Relaxed) { End::Interrupted } else { End::Clean })
}

fn list(global: &Global) -> Result<End> {
    if global.format == Format::Json {
        let names: Vec<_> = gallery::all().map(|exhibit| (exhibit.name, exhibit.about)).collect();
        output::json(&names)?;
    } else {
        output::result(|out| {
            for exhibit in gallery::all() {
                writeln!(out, "{:<20} {}", exhibit.name, exhibit.about)?;
            }
            Ok(())
        })?;
    }
    Ok(End::Clean)
}

/// Scenes by name, by the start of a name with `*`, or by file.
fn subjects(global: &Global, args: &ReportArgs) -> Result<Vec<Subject>> {
    if args.scenes.is_empty() {
        return Ok(gallery::all().map(Subject::of).collect());
    }
    let mut subjects = Vec::new();
    for name in &args.scenes {
        let path = Path::new(name);
        if let Some(start) = name.strip_suffix('*') {
            subjects
                .extend(gallery::all().filter(|exhibit| exhibit.name.starts_with(start)).map(Subject::of));
        } else if let Some(exhibit) = gallery::by_name(name) {
            subjects.push(Subject::of(exhibit));
        } else if path.is_file() {
            subjects.push(from_file(global, args, path)?);
        } else {
            bail!(
                "{name}: neither a scene of the gallery nor a file; `physique report --list` names the scenes"
            );
        }
    }
    if subjects.is_empty() {
        bail!("no scene of the gallery has such a name; `physique report --list` names them");
    }
    Ok(subjects)
}

fn from_file(global: &Global, args: &ReportArgs, path: &Path) -> Result<Subject> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mapper, _, sets) = job::mapping(global, &args.mapping, folder)?;
    let loaded = simulate::load_scene(path, &job::db(global), &mapper, &sets)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let duration_s = loaded.duration_s.unwrap_or(DEFAULT_TIME_S);
    let dt_s = loaded.dt_s.unwrap_or(sim::Settings::default().dt_s);
    Ok(Subject::scene(name, loaded.scene, duration_s, dt_s))
}

/// The engines as they come, and with `--sweep` what they make of more work and stiffer contacts.
fn setups(args: &ReportArgs, dt_s: f64) -> Vec<Setup> {
    let mut setups = Vec::new();
    for engine in Engine::all() {
        let default = Setup::default_of(engine, dt_s);
        setups.push(default);
        if args.sweep {
            let steps = [2, 4, 8, 16].map(|substeps| Setup { substeps, ..default });
            let stiff = [8, 16].map(|substeps| Setup { substeps, stiffness: 4.0, ..default });
            setups.extend(steps.into_iter().chain(stiff).filter(|setup| *setup != default));
        }
    }
    setups
}
