//! `physique report`: speed against error, on scenes of the gallery or of the user's.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::Ordering;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use sim::gallery;

use super::End;
use super::args::{Format, Global, ReportArgs};
use super::{interrupt, job, one, output, report_colliders, simulate};
use crate::bench::{
    Budget, Effort, Engine, Machine, Overview, Programs, Report, Row, Sheet, Subject, Tosses, dog, length_m,
    run, write_report, write_sheet,
};
use crate::validate::Parameter;

/// How long a scene file runs that does not say, s.
const DEFAULT_TIME_S: f64 = 10.0;

/// # Errors
/// A scene is not there or is refused, or a result cannot be written.
pub(super) fn report(global: &Global, args: &ReportArgs) -> Result<End> {
    if let Some(models) = &args.colliders.colliders {
        return report_colliders::report(global, &args.colliders, models);
    }
    if args.list {
        return list(global);
    }
    let begun = Instant::now();
    let stop = interrupt::flag();
    let programs = programs(global, args)?;
    let machine = Machine::here(&programs);
    let budget = args
        .budget
        .as_deref()
        .map(Budget::parse)
        .transpose()
        .map_err(|reason| anyhow!("--budget: {reason}"))?;
    let effort =
        Effort { rounds: args.rounds, sweep: !args.quick || budget.is_some(), seconds: args.seconds };
    let mut report = Report { machine, parameters: parameters(), sheets: Vec::new(), seconds: 0.0 };
    for subject in subjects(global, args)? {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let sheet = run(&subject, &effort, &programs, stop);
        if global.format == Format::Text {
            output::result(|out| {
                write_sheet(out, &sheet)?;
                budget.map_or(Ok(()), |budget| write_advice(out, &sheet, budget))
            })?;
        }
        report.sheets.push(sheet);
        report.seconds = begun.elapsed().as_secs_f64();
        // After every scene, so that nothing is lost when the run is killed.
        if let Some(folder) = &global.out {
            write_report(folder, &report).with_context(|| format!("cannot write {}", folder.display()))?;
        }
    }
    if global.format == Format::Json {
        output::json(&report)?;
    }
    if global.format == Format::Text && report.sheets.len() > 1 {
        output::result(|out| writeln!(out, "{}", Overview::of(&report.sheets)))?;
    }
    if let (Some(folder), Format::Text) = (&global.out, global.format) {
        output::result(|out| writeln!(out, "report   {}", folder.join("report.html").display()))?;
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
            writeln!(out, "{DOG:<20} a dog of a model database on 115,200 triangles; needs --models")?;
            writeln!(out, "{TOSSES:<20} real tosses of a cube; needs --tosses")
        })?;
    }
    Ok(End::Clean)
}

/// Scenes that need files.
const DOG: &str = "seed-dog";
const TOSSES: &str = "cube-tosses";

/// Scenes by name, by the start of a name with `*`, or by file.
fn subjects(global: &Global, args: &ReportArgs) -> Result<Vec<Subject>> {
    let mut subjects = Vec::new();
    if args.scenes.is_empty() {
        subjects.extend(gallery::all().map(Subject::of));
        subjects.extend(with_files(global, args, DOG)?);
        subjects.extend(with_files(global, args, TOSSES)?);
        return Ok(subjects);
    }
    for name in &args.scenes {
        let path = Path::new(name);
        if let Some(start) = name.strip_suffix('*') {
            subjects
                .extend(gallery::all().filter(|exhibit| exhibit.name.starts_with(start)).map(Subject::of));
        } else if let Some(exhibit) = gallery::by_name(name) {
            subjects.push(Subject::of(exhibit));
        } else if [DOG, TOSSES].contains(&name.as_str()) {
            subjects.extend(with_files(global, args, name)?);
        } else if path.is_file() {
            subjects.push(from_file(global, args, path)?);
        } else {
            bail!(
                "{name}: neither a scene of the gallery nor a file; `physique report --list` names the scenes"
            );
        }
    }
    if subjects.is_empty() {
        bail!("no scene to run; `physique report --list` names those of the gallery");
    }
    Ok(subjects)
}

/// A scene that needs files, or a notice that they are not there.
fn with_files(global: &Global, args: &ReportArgs, name: &str) -> Result<Option<Subject>> {
    let folder = |flag: &Option<PathBuf>, variable: &str, flag_name: &str| {
        let folder = flag.clone().or_else(|| std::env::var_os(variable).map(PathBuf::from));
        if folder.is_none() && !global.quiet {
            output::notice(&format!("{name} is left out: name its folder with {flag_name} or {variable}"));
        }
        folder
    };
    if name == TOSSES {
        let Some(folder) = folder(&args.tosses, "PHYSIQUE_TOSSES", "--tosses") else { return Ok(None) };
        return Ok(Some(Subject::tosses(Tosses::load(&folder)?)));
    }
    let Some(folder) = folder(&args.models, "PHYSIQUE_MODELS", "--models") else { return Ok(None) };
    let path = folder.join("animals/dog.stl");
    if !path.is_file() {
        output::notice(&format!("{name} is left out: {} is not there", path.display()));
        return Ok(None);
    }
    let (mapper, _, sets) = job::mapping(global, &args.mapping, &folder)?;
    let found = one::one(&path, Some(&folder), &job::db(global), &mapper, &sets)?;
    let entity = mapper::scene::drop_entity(&found.model, &found.asset, &found.mapped, mapper.rules())
        .map_err(|error| anyhow!("{}. {}", error.reason(), error.way_out()))?;
    Ok(Some(dog::on_terrain(entity)))
}

fn from_file(global: &Global, args: &ReportArgs, path: &Path) -> Result<Subject> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mapper, _, sets) = job::mapping(global, &args.mapping, folder)?;
    let loaded = simulate::load_scene(path, &job::db(global), &mapper, &sets)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let duration_s = loaded.duration_s.unwrap_or(DEFAULT_TIME_S);
    let dt_s = loaded.dt_s.unwrap_or(sim::Settings::default().dt_s);
    Ok(Subject::scene(name, path.display().to_string(), loaded.scene, duration_s, dt_s))
}

#[cfg(feature = "validate")]
fn parameters() -> Vec<Parameter> {
    crate::validate::parameters(None, &sim::Settings { sleeping: false, ..sim::Settings::default() })
        .into_iter()
        .map(|parameter| {
            if parameter.name.starts_with("substeps") {
                let iterations = Engine::Rapier.default_substeps();
                Parameter { rapier: format!("{iterations} (solver iterations, its default)"), ..parameter }
            } else {
                parameter
            }
        })
        .collect()
}

#[cfg(not(feature = "validate"))]
fn parameters() -> Vec<Parameter> {
    Vec::new()
}

/// Where the runner of rapier's other build is, or is put: beside the folder of this program.
fn simd8_target() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    // target/release/physique → target/simd8
    Some(program.parent()?.parent()?.join("simd8"))
}

fn programs(global: &Global, args: &ReportArgs) -> Result<Programs> {
    let name = format!("baseline{}", std::env::consts::EXE_SUFFIX);
    let built = simd8_target().map(|target| target.join("release").join(&name));
    if args.build_simd8 {
        build_simd8()?;
    }
    let simd8 = match &args.simd8 {
        Some(program) if !program.is_file() => bail!("--simd8 {}: no such file", program.display()),
        Some(program) => Some(program.clone()),
        None => built.filter(|program| program.is_file()),
    };
    if simd8.is_none() && cfg!(feature = "validate") && !global.quiet {
        output::notice(
            "rapier's build with eight lanes is not here and is left out; --build-simd8 builds it",
        );
    }
    Ok(Programs { simd8 })
}

/// Builds the runner with eight lanes from the sources of this program.
fn build_simd8() -> Result<()> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
    if !sources.join("baseline").is_dir() {
        bail!("--build-simd8 needs the sources that this program was built from, which are no longer there");
    }
    let target = simd8_target().ok_or_else(|| anyhow!("this program does not know where it is"))?;
    output::notice("building rapier with eight lanes: two minutes or so, once");
    let status = Command::new("cargo")
        .args([
            "build",
            "--release",
            "--locked",
            "--package",
            "baseline",
            "--features",
            "simd8",
            "--target-dir",
        ])
        .arg(&target)
        .env("RUSTFLAGS", "-C target-feature=+avx2,+fma")
        .current_dir(sources)
        .status()
        .context("cargo does not start")?;
    if !status.success() {
        bail!("cargo could not build it: {status}");
    }
    Ok(())
}

/// The settings that keep to a budget, for each engine.
fn write_advice(out: &mut dyn std::io::Write, sheet: &Sheet, budget: Budget) -> std::io::Result<()> {
    for engine in [Engine::Physique, Engine::Rapier, Engine::RapierSimd8] {
        if sheet.default_of(engine).is_none() {
            continue;
        }
        match budget.choose(sheet, engine) {
            Some(row) => writeln!(
                out,
                "  to keep to the budget: {} with {}: {:.4} ms a step, error {:.3} mm",
                engine.name(),
                advice(row),
                row.ms.map_or(0.0, |ms| ms.mean),
                length_m(row).unwrap_or(0.0) * 1e3
            )?,
            None => {
                writeln!(out, "  to keep to the budget: no setting of {} that was tried does", engine.name())?
            }
        }
    }
    Ok(())
}

fn advice(row: &Row) -> String {
    if row.setup.engine == Engine::Physique {
        let hertz = row.setup.settings().contact_hertz;
        format!("--substeps {} --contact-hertz {hertz}", row.setup.substeps)
    } else {
        row.label.clone()
    }
}
