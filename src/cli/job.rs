//! From flags to a job.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use importer::Catalogue;
use mapper::{Mapper, Overrides, Ruleset, SetValue, Tags};

use super::args::{Dropping, Global, Mapping, Showing};
use super::interrupt;
use crate::pipeline::{Inputs, Job, RecordTo, Settings, Upto};

/// Where results go when nothing is said.
pub(super) const DEFAULT_OUT: &str = "physique-out";

/// Name of the project override file that is found by itself.
const PROJECT_OVERRIDES: &str = "overrides.yaml";

/// Name of the file of a machine's proposals that is found by itself.
const PROPOSALS: &str = "proposals.yaml";

/// How models are imported: the same for a batch and for one model, so that what is stored is found again.
pub(super) fn import_options() -> importer::Options {
    importer::Options {
        shapes: Some(mapper::shapes_file::READER),
        alone: std::env::current_exe().ok().map(|program| importer::Alone {
            program,
            arguments: vec!["import-alone".to_owned()],
            seconds: 300,
            memory_bytes: 4 << 30,
        }),
        ..importer::Options::default()
    }
}

/// The folder of the results.
pub(super) fn out(global: &Global) -> PathBuf {
    global.out.clone().unwrap_or_else(|| PathBuf::from(DEFAULT_OUT))
}

/// The catalogue's file.
pub(super) fn db(global: &Global) -> PathBuf {
    global.db.clone().unwrap_or_else(|| out(global).join("catalogue.db"))
}

/// The rules that `--catalog` names, or the built-in ones.
///
/// # Errors
/// The file is not there or not right; the message shows the place.
pub(super) fn rules(global: &Global) -> Result<Ruleset> {
    Ok(match &global.catalog {
        Some(file) => Ruleset::load(file)?,
        None => Ruleset::embedded()?,
    })
}

/// Mapper, the texts it was made from, and the values of the command line.
///
/// # Errors
/// A rule, override or `--set` is not right; the message shows the place.
pub(super) fn mapping(
    global: &Global,
    mapping: &Mapping,
    models: &Path,
) -> Result<(Mapper, Inputs, Vec<SetValue>)> {
    let rules = rules(global)?;
    let files = override_files(mapping, models);
    let mut inputs =
        Inputs { rules: rules.text().to_owned(), sets: mapping.set.clone(), overrides: Vec::new() };
    for file in &files {
        let text = fs::read_to_string(file)
            .with_context(|| format!("cannot read the override file {}", file.display()))?;
        inputs.overrides.push(format!("{}\n{text}", file.display()));
    }
    let overrides = Overrides::load(&files, &rules)?;
    let sets = mapping.set.iter().map(|text| SetValue::parse(text, &rules)).collect::<Result<_, _>>()?;
    let tags = mapping.tags.as_deref().map(Tags::load).transpose()?.unwrap_or_default();
    Ok((Mapper::new(rules, overrides).with_tags(tags), inputs, sets))
}

/// Override files that are named, else those that lie in the folder of models.
pub(super) fn override_files(mapping: &Mapping, models: &Path) -> Vec<PathBuf> {
    let mut files = mapping.overrides.clone();
    if files.is_empty() {
        let beside = [PROPOSALS, PROJECT_OVERRIDES].map(|name| models.join(name));
        files.extend(beside.into_iter().filter(|file| file.is_file()));
    }
    files
}

/// Folder that most models of a catalogue are from, as seen from here: where their overrides lie when nobody names a
/// folder; this folder, where there is no such catalogue.
pub(super) fn root_in(db: &Path) -> PathBuf {
    let mut counts: BTreeMap<PathBuf, usize> = BTreeMap::new();
    // What cannot be read is told by who needs more of it than this.
    let rows =
        db.is_file().then(|| Catalogue::open(db).and_then(|catalogue| catalogue.models()).ok()).flatten();
    for row in rows.into_iter().flatten() {
        *counts.entry(row.root).or_default() += 1;
    }
    let most = counts.into_iter().max_by_key(|(_, models)| *models).map(|(root, _)| root);
    let here = std::env::current_dir().unwrap_or_default();
    let root = most.map(|root| root.strip_prefix(&here).map_or_else(|_| root.clone(), Path::to_path_buf));
    root.filter(|root| !root.as_os_str().is_empty()).unwrap_or_else(|| PathBuf::from("."))
}

/// The job of `run`, `import`, `map` and `demo`.
///
/// # Errors
/// The folder of models is not there, or rules and overrides are not right.
pub(super) fn job(
    global: &Global,
    models: &Path,
    mapping_flags: &Mapping,
    dropping: Option<&Dropping>,
    showing: Option<&Showing>,
    upto: Upto,
) -> Result<Job<'static>> {
    if !models.exists() {
        bail!("{}: no such file or folder; name a folder of models or one model", models.display());
    }
    let (mapper, inputs, sets) = mapping(global, mapping_flags, models)?;
    let mut drop = Settings::default();
    if let Some(flags) = dropping {
        drop.max_time_s = flags.time;
        drop.floor.clone_from(&flags.floor);
        drop.validate &= !flags.no_validate;
    }
    let record = match showing {
        Some(showing) if !showing.no_record && cfg!(feature = "viewer") => {
            RecordTo { file: Some(out(global).join("recording.rrd")), view: showing.view }
        }
        Some(showing) if showing.view => bail!("this build has no viewer: build with --features viewer"),
        _ => RecordTo::default(),
    };
    Ok(Job {
        models: models.to_path_buf(),
        db: db(global),
        options: import_options(),
        mapper,
        inputs,
        sets,
        drop,
        record,
        shard: importer::Shard::WHOLE,
        threads: global.threads,
        upto,
        stop: interrupt::flag(),
    })
}

/// Sets the number of threads of everything that runs on rayon.
///
/// # Errors
/// The threads cannot be started.
pub(super) fn start_threads(global: &Global) -> Result<()> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(global.threads)
        // Convex hulls recurse; the default of a spawned thread is a quarter of the main thread's.
        .stack_size(16 << 20)
        .build_global()
        .context("cannot start threads; give fewer with --threads")
}
