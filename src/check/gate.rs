//! The gate itself: the layers one after the other, then the policy.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use anyhow::{Result, bail};
use importer::ModelRow;

use super::case::{self, Case};
use super::changed::GitTree;
use super::drift::drift;
use super::layer_set::Layers;
use super::lock::Lock;
use super::observation::Observation;
use super::place::Places;
use super::policy::Policy;
use super::report::{Report, Runtime};
use super::rule::Layer;
use super::{adopt, data, judge, observe, runtime, touched};
use crate::pipeline::{self, Job, Progress};
use crate::report::Line;

/// Which models are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Models {
    /// None: rules and overrides alone.
    None,
    /// Those of the job's folder, imported as far as they changed.
    Folder,
    /// Those that the catalogue has, as it has them.
    Catalogue,
}

/// What to check, and by which policy.
pub struct Request<'a> {
    /// Mapper, models and catalogue; absent where rules or overrides cannot be read.
    pub job: Option<Job<'a>>,
    /// Why they cannot be read.
    pub faults: Vec<Observation>,
    pub models: Models,
    pub places: Places,
    /// Project override files, for the suppressions in their comments.
    pub overrides: Vec<PathBuf>,
    pub policy: Policy,
    pub layers: Layers,
    /// Lock file to hold the mapping against.
    pub locked: Option<PathBuf>,
    pub baseline: Option<PathBuf>,
    /// Only what changed since this commit, with its name.
    pub changed_since: Option<(GitTree, String)>,
}

/// Runs the layers and judges what they show. Observations come in the order of the models whatever the threads do.
///
/// # Errors
/// Only what leaves nothing to say: the catalogue cannot be opened, the folder not listed, git not asked.
pub fn check(request: &Request<'_>, progress: &dyn Progress) -> Result<Report> {
    let start = Instant::now();
    let mut seen = Seen { observations: request.faults.clone(), ..Seen::default() };
    let mut lap = start;
    let mut seconds_a_layer = Vec::new();
    let mut clock = |layer: &'static str| {
        seconds_a_layer.push((layer, lap.elapsed().as_secs_f64()));
        lap = Instant::now();
    };
    let layers = request.layers.and(|layer| layer == Layer::Static || request.models != Models::None);
    if let Some(job) = &request.job {
        if layers.holds(Layer::Static) {
            let (rules, overrides) = (job.mapper.rules(), job.mapper.overrides());
            seen.observations.extend(observe::rules(rules, overrides, &job.drop.floor, &request.places));
        }
        clock("static");
        if request.models != Models::None && (layers.holds(Layer::Data) || layers.holds(Layer::Runtime)) {
            models(request, job, layers, progress, &mut seen, &mut clock)?;
        }
    }
    let stopped = request.job.as_ref().is_some_and(|job| job.stop.load(Ordering::Relaxed));
    let mut report = Report {
        findings: Vec::new(),
        models: Vec::new(),
        layers,
        profile: request.policy.profile.clone(),
        fail_on: request.policy.fail_on,
        suppressed: 0,
        accepted: 0,
        exceeded: Vec::new(),
        runtime: std::mem::take(&mut seen.runtime),
        measured: BTreeMap::new(),
        changed_since: request.changed_since.as_ref().map(|(_, name)| name.clone()),
        built_in: built_in(request),
        seconds_a_layer,
        seconds: 0.0,
        stopped,
    };
    judge::judge(request, layers, seen, &mut report);
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// What the layers have seen.
#[derive(Default)]
pub(super) struct Seen {
    pub observations: Vec<Observation>,
    pub cases: Vec<Case>,
    /// Models that were simulated.
    pub proven: BTreeSet<String>,
    pub runtime: Runtime,
}

fn models(
    request: &Request<'_>,
    job: &Job<'_>,
    layers: Layers,
    progress: &dyn Progress,
    seen: &mut Seen,
    clock: &mut dyn FnMut(&'static str),
) -> Result<()> {
    let catalogue = pipeline::open(job)?;
    let lines = pipeline::mapped_lines(job, &catalogue, request.models == Models::Folder, progress)?;
    clock("import and map");
    some(&lines, job)?;
    let names: Vec<String> = lines.iter().map(|(row, _)| row.model.clone()).collect();
    let mut cases = case::cases(&catalogue, lines)?;
    if layers.holds(Layer::Data) {
        whole_database(request, job, &cases, &names, seen)?;
    }
    if let Some((tree, _)) = &request.changed_since {
        let touched = touched::touched(request, job, tree, &catalogue, &cases)?;
        seen.observations.retain(|observation| touched.keeps(observation));
        cases.retain(|case| touched.models.contains(&case.row.model));
    }
    if layers.holds(Layer::Data) {
        seen.observations.extend(data::looks(request, job, &catalogue, &cases, progress)?);
        clock("data");
    }
    if layers.holds(Layer::Runtime) {
        runtime::proofs(request, job, &catalogue, &cases, progress, seen)?;
        clock("runtime");
    }
    catalogue.flush()?;
    seen.cases = cases;
    Ok(())
}

/// The lock of a job's models, imported as far as they changed, or as the catalogue has them.
///
/// # Errors
/// The folder cannot be listed, or the catalogue not read or written.
pub fn lock(job: &Job<'_>, import_models: bool, progress: &dyn Progress) -> Result<Lock> {
    let catalogue = pipeline::open(job)?;
    let lines = pipeline::mapped_lines(job, &catalogue, import_models, progress)?;
    some(&lines, job)?;
    let mut lock = Lock::new(job.mapper.rules());
    lock.entries = case::entries(&case::cases(&catalogue, lines)?);
    Ok(lock)
}

/// A gate that sees nothing must not be green: a wrong folder, or large files that were not fetched, would pass.
fn some(lines: &[(ModelRow, Line)], job: &Job<'_>) -> Result<()> {
    if lines.is_empty() && !job.stop.load(Ordering::Relaxed) {
        let place = if job.models.as_os_str().is_empty() { &job.db } else { &job.models };
        bail!("{}: there is no model in it", place.display());
    }
    Ok(())
}

/// What only all models together show.
fn whole_database(
    request: &Request<'_>,
    job: &Job<'_>,
    cases: &[Case],
    names: &[String],
    seen: &mut Seen,
) -> Result<()> {
    if request.models == Models::Folder {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let idle = job.mapper.overrides().unmatched(&names);
        seen.observations
            .extend(idle.iter().filter_map(|found| adopt::finding(found, &request.places, None)));
        let files: Vec<&Path> = cases.iter().map(|case| case.file.as_path()).collect();
        if job.models.is_dir() {
            seen.observations.extend(observe::missing_sidecars(&job.models, &files));
        }
    }
    if request.changed_since.is_none() {
        let standings: Vec<observe::Standing<'_>> = cases.iter().map(Case::standing).collect();
        seen.observations.extend(observe::across(&standings));
    }
    if let Some(file) = &request.locked {
        let mut now = Lock::new(job.mapper.rules());
        now.entries = case::entries(cases);
        match fs::read_to_string(file) {
            Err(error) => {
                let place = super::Place::file(file);
                seen.observations
                    .push(Observation::fact("LCK001", format!("cannot be read: {error}")).at(Some(place)));
            }
            Ok(text) => match Lock::parse(file, &text) {
                Err(fault) => seen.observations.push(*fault),
                Ok(locked) => seen.observations.extend(drift(file, &locked, &now)),
            },
        }
    }
    Ok(())
}

fn built_in(request: &Request<'_>) -> Option<String> {
    let job = request.job.as_ref().filter(|_| request.places.catalog.is_none())?;
    Some(job.mapper.rules().text().to_owned())
}
