//! `physique diff`: what changed between two mappings, in words.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, bail};
use mapper::Mapper;

use super::End;
use super::args::{DiffArgs, Format, Global};
use super::progress::Bars;
use super::{check, job, output};
use crate::check::diff::{Codes, Diff};
use crate::check::prove::Trials;
use crate::check::side::Side;
use crate::check::source::{Around, Source};
use crate::check::{Places, Policy};
use crate::pipeline::{Job, Upto};

/// # Errors
/// A side is not there or cannot be read.
pub(super) fn diff(global: &Global, args: &DiffArgs) -> Result<End> {
    let folders: Vec<&Path> =
        [&args.before, &args.after].into_iter().map(Path::new).filter(|path| path.is_dir()).collect();
    let models =
        folders.first().map_or_else(|| job::root_in(&job::db(global)), |folder| folder.to_path_buf());
    if folders.len() > 1 {
        bail!("both sides are folders; compare the lock or the catalogue of one with the other");
    }
    let job = job::job(global, &models, &args.mapping, None, None, Upto::Map)?;
    job::start_threads(global)?;
    let overrides = job::override_files(&args.mapping, &models);
    let around = Around {
        job: &job,
        catalog: global.catalog.as_deref(),
        overrides: &overrides,
        lock_file: &args.lock_file,
        inputs: OnceLock::new(),
    };
    let bars = Bars::new(global);
    let (before, after) =
        rayon::join(|| Source::of(&args.before, &around), || Source::of(&args.after, &around));
    let before = before?.side(&around, &bars)?;
    let after = after?.side(&around, &bars)?;
    bars.finish();
    let places = Places { catalog: global.catalog.clone() };
    let place = |cause: &str| match after.mapper() {
        Some(mapper) if Path::new(&args.after).is_file() => {
            place(mapper, &Places { catalog: Some(PathBuf::from(&args.after)) }, cause)
        }
        of_commit => place(of_commit.unwrap_or(&job.mapper), &places, cause),
    };
    let none = (Codes::new(), Codes::new());
    let mut diff = Diff::new(&before.lock, &after.lock, &place, (&none.0, &none.1));
    if args.check {
        let codes = codes(&job, &check::configured(&args.policy)?, &diff, &before, &after)?;
        diff = Diff::new(&before.lock, &after.lock, &place, (&codes.0, &codes.1));
    }
    match global.format {
        Format::Json => output::json(&diff)?,
        Format::Markdown => output::result(|out| out.write_all(diff.markdown().as_bytes()))?,
        _ => output::result(|out| out.write_all(diff.text().as_bytes()))?,
    }
    Ok(if diff.is_empty() { End::Clean } else { End::Findings })
}

/// What fails on either side, of the models that differ.
fn codes(job: &Job<'_>, policy: &Policy, diff: &Diff, before: &Side, after: &Side) -> Result<(Codes, Codes)> {
    if !(before.knows_models() && after.knows_models()) {
        bail!(
            "--check needs models on both sides: a lock file has none; name catalogues, rules or git references"
        );
    }
    let models: BTreeSet<&str> =
        diff.groups.iter().flat_map(|group| &group.models).map(String::as_str).collect();
    let floor = &job.drop.floor;
    let surface =
        job.mapper.rules().surface(floor).with_context(|| format!("the rules have no preset {floor:?}"))?;
    let trials = Trials {
        solver: job.drop.solver,
        floor: floor.clone(),
        surface,
        rules: job.mapper.rules(),
        rapier: false,
    };
    Ok((before.codes(&models, job, policy, &trials)?, after.codes(&models, job, policy, &trials)?))
}

/// Where a cause is written in these rules and overrides.
fn place(mapper: &Mapper, places: &Places, cause: &str) -> Option<String> {
    let rules = mapper.rules();
    let (kind, name) = cause.split_once(':')?;
    let by = match kind {
        "preset" => &rules.preset(name)?.place,
        "rule" => &rules.rules.iter().find(|rule| &*rule.name == name)?.place,
        "subcategory" => &rules.subcategories.iter().find(|sub| &*sub.name == name)?.place,
        "category" => &rules.categories.iter().find(|category| &*category.name == name)?.place,
        _ => &mapper.overrides().entries.iter().find(|entry| &*entry.place.by == cause)?.place,
    };
    let place = places.of(by, None)?;
    Some(crate::check::Place { column: 0, ..place }.to_string())
}
