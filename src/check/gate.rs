//! The gate itself: the layers one after the other, then the policy.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result};
use importer::{Catalogue, ModelRow};
use mapper::{Kind, Mapped};
use rayon::prelude::*;

use super::baseline::Baseline;
use super::changed::GitTree;
use super::drift::drift;
use super::finding::Finding;
use super::layer_set::Layers;
use super::lock::{Entry, Lock, Locked};
use super::observation::Observation;
use super::observe::{self, Look, Ranges};
use super::place::{Places, slashed};
use super::policy::{Policy, Subject};
use super::prove::{self, Proof, Trials};
use super::report::{Looked, Report, Runtime};
use super::rule::{Layer, Rule};
use super::{adopt, suppression, touched};
use crate::pipeline::{self, Job, Key, Progress, staged};
use crate::report::Line;

/// Stages of the gate in the catalogue.
const LOOK: &str = "check";
const PROVE: &str = "prove";

/// Part of every key: raise it when a look would show another thing on the same input.
const VERSION: &str = "looks 1";

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

/// A model on its way through the layers.
pub(super) struct Case {
    pub row: ModelRow,
    pub line: Line,
    /// Its file, as seen from here.
    pub file: PathBuf,
    /// Subcategory and preset; the category is in the line.
    pub subcategory: String,
    pub preset: String,
    pub entry: Option<Entry>,
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
    judge(request, layers, seen, &mut report);
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

#[derive(Default)]
struct Seen {
    observations: Vec<Observation>,
    cases: Vec<Case>,
    proven: BTreeSet<String>,
    runtime: Runtime,
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
    let names: Vec<String> = lines.iter().map(|(row, _)| row.model.clone()).collect();
    let mut cases = cases(&catalogue, lines)?;
    if layers.holds(Layer::Data) {
        whole_database(request, job, &cases, &names, seen)?;
    }
    if let Some((tree, _)) = &request.changed_since {
        let touched = touched::touched(request, job, tree, &catalogue, &cases)?;
        seen.observations.retain(|observation| touched.keeps(observation));
        cases.retain(|case| touched.models.contains(&case.row.model));
    }
    if layers.holds(Layer::Data) {
        progress.begin(LOOK, cases.len());
        let looks: Vec<Vec<Observation>> = cases
            .par_iter()
            .with_max_len(1)
            .map(|case| {
                if job.stop.load(Ordering::Relaxed) {
                    return Ok(Vec::new());
                }
                let looked = look(request, job, &catalogue, case);
                progress.advance();
                looked
            })
            .collect::<Result<_>>()?;
        seen.observations.extend(looks.into_iter().flatten());
        clock("data");
    }
    if layers.holds(Layer::Runtime) {
        prove_all(request, job, &catalogue, &cases, progress, seen)?;
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
    let mut lock = Lock::new(job.mapper.rules());
    lock.entries = entries(&cases(&catalogue, lines)?);
    Ok(lock)
}

fn cases(catalogue: &Catalogue, lines: Vec<(ModelRow, Line)>) -> Result<Vec<Case>> {
    let here = std::env::current_dir().unwrap_or_default();
    lines
        .into_par_iter()
        .map(|(row, line)| {
            let path = row.path();
            let file = path.strip_prefix(&here).map_or_else(|_| path.clone(), Path::to_path_buf);
            let mapped: Option<Locked> = line
                .standing
                .as_ref()
                .map(|_| pipeline::mapped_part(catalogue, &row.model))
                .transpose()?
                .flatten();
            let entry = row.key.zip(mapped.as_ref()).map(|(key, mapped)| Entry::new(&key, mapped));
            let category = entry.as_ref().map_or("", |entry| entry.category.as_str());
            let subcategory = category.split_once('/').map_or("", |(_, sub)| sub).to_owned();
            let preset = entry.as_ref().map_or_else(String::new, |entry| entry.preset.clone());
            Ok(Case { row, line, file, subcategory, preset, entry })
        })
        .collect()
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
        now.entries = entries(cases);
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

fn entries(cases: &[Case]) -> BTreeMap<String, Entry> {
    cases.iter().filter_map(|case| Some((case.row.model.clone(), case.entry.clone()?))).collect()
}

/// Everything that the data layer sees of one model, from the catalogue where nothing changed.
fn look(
    request: &Request<'_>,
    job: &Job<'_>,
    catalogue: &Catalogue,
    case: &Case,
) -> Result<Vec<Observation>> {
    let model = &case.row.model;
    let mut seen = Vec::new();
    if let Some((stage, failure)) = &case.line.failure {
        let failed = adopt::failure(model, stage, failure);
        seen.push(if *stage == "map" {
            failed.at(Some(in_sidecar(&case.file, &failure.place)))
        } else {
            failed
        });
    }
    let (Some(standing), Some(key)) = (&case.line.standing, case.row.key) else { return Ok(seen) };
    let Some(mapped) = pipeline::mapped(catalogue, model)? else { return Ok(seen) };
    let ranges = Ranges::of(job.mapper.rules(), &mapped);
    let input = Key::new(LOOK)
        .with(VERSION)
        .with(key.0)
        .with(job.options.fingerprint())
        .with(&standing.whole)
        .with(format!("{ranges:?}"))
        .with(slashed(&case.file))
        .with(format!("{:?}", request.places.catalog))
        .finish();
    let looked = staged(catalogue, model, LOOK, &input, || {
        let asset = catalogue
            .asset(&key)
            .map_err(|error| pipeline::of_catalogue(&error))?
            .ok_or_else(pipeline::missing_asset)?;
        let body = mapper::scene::drop_entity(model, &asset, &mapped, job.mapper.rules());
        let look = Look {
            model,
            file: &case.file,
            asset: &asset,
            mapped: &mapped,
            places: &request.places,
            ranges: &ranges,
            collider: mapper::scene::collider(&asset, &mapped),
            body: &body,
        };
        Ok(look.observations())
    })?;
    match looked {
        Ok(looked) => seen.extend(looked),
        Err(failure) => seen.push(adopt::failure(model, LOOK, &failure)),
    }
    Ok(seen)
}

/// The mapper names the sidecar without its folder, and the line and column behind it.
fn in_sidecar(model: &Path, place: &str) -> super::Place {
    let mut numbers = place.rsplit(':').map_while(|number| number.parse().ok());
    let (column, line) = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    super::Place { line, column, ..super::Place::file(&mapper::sidecar_path(model)) }
}

fn prove_all(
    request: &Request<'_>,
    job: &Job<'_>,
    catalogue: &Catalogue,
    cases: &[Case],
    progress: &dyn Progress,
    seen: &mut Seen,
) -> Result<()> {
    let floor = &job.drop.floor;
    let surface = job.mapper.rules().surface(floor).with_context(|| {
        format!("the rules have no preset {floor:?} for the floor; name one that they have with --floor")
    })?;
    let trials = Trials {
        solver: job.drop.solver,
        floor: floor.clone(),
        surface,
        rules: job.mapper.rules(),
        rapier: job.drop.validate,
    };
    for case in cases {
        if let Some(why) = case.left_out() {
            *seen.runtime.left_out.entry(why).or_default() += 1;
        }
    }
    let mut tried: Vec<&Case> = cases.iter().filter(|case| case.left_out().is_none()).collect();
    // Those with many shapes take longest: begun last they would keep the other threads waiting.
    tried.sort_by_cached_key(|case| std::cmp::Reverse(fs::metadata(&case.file).map_or(0, |meta| meta.len())));
    progress.begin(PROVE, tried.len());
    let known = AtomicUsize::new(0);
    let proofs: Mutex<BTreeMap<&str, Vec<Observation>>> = Mutex::default();
    tried.par_iter().with_max_len(1).try_for_each(|case| -> Result<()> {
        if job.stop.load(Ordering::Relaxed) {
            return Ok(());
        }
        let looked = proof(request, &trials, catalogue, case, &known)?;
        progress.advance();
        proofs.lock().unwrap_or_else(PoisonError::into_inner).insert(&case.row.model, looked);
        Ok(())
    })?;
    let proofs = proofs.into_inner().unwrap_or_else(PoisonError::into_inner);
    seen.runtime.unchanged = known.into_inner();
    seen.runtime.simulated = proofs.len() - seen.runtime.unchanged;
    seen.proven = proofs.keys().map(|model| (*model).to_owned()).collect();
    seen.observations.extend(proofs.into_values().flatten());
    Ok(())
}

fn proof(
    request: &Request<'_>,
    trials: &Trials<'_>,
    catalogue: &Catalogue,
    case: &Case,
    known: &AtomicUsize,
) -> Result<Vec<Observation>> {
    let model = &case.row.model;
    let (Some(standing), Some(key)) = (&case.line.standing, case.row.key) else { return Ok(Vec::new()) };
    let Some(mapped) = pipeline::mapped(catalogue, model)? else { return Ok(Vec::new()) };
    let stacks = case.stacks(&request.policy);
    let input = trials.key(key.0, &standing.physics, &case.preset, stacks);
    if catalogue.stage(model, PROVE)?.is_some_and(|row| row.input_key == input) {
        known.fetch_add(1, Ordering::Relaxed);
    }
    let proof: Result<Proof, _> = staged(catalogue, model, PROVE, &input, || {
        let asset = catalogue
            .asset(&key)
            .map_err(|error| pipeline::of_catalogue(&error))?
            .ok_or_else(pipeline::missing_asset)?;
        trials.prove(model, &asset, &mapped, stacks)
    })?;
    Ok(match proof {
        Ok(proof) => prove::observations(&proof, model, &case.file, &mapped, &request.places),
        Err(failure) if matches!(failure.code.as_str(), "no-mass" | "no-collider" | "no-extent") => {
            Vec::new()
        }
        Err(failure) => {
            vec![place_of(adopt::failure(model, PROVE, &failure), &mapped, &request.places, &case.file)]
        }
    })
}

fn place_of(observation: Observation, mapped: &Mapped, places: &Places, file: &Path) -> Observation {
    match &mapped.preset_by {
        Some(by) => observation.at(places.of(by, Some(file))).because(&by.by),
        None => observation,
    }
}

impl Case {
    fn category(&self) -> &str {
        self.line.standing.as_ref().and_then(|standing| standing.category.as_deref()).unwrap_or_default()
    }

    fn standing(&self) -> observe::Standing<'_> {
        observe::Standing {
            model: &self.row.model,
            asset: self.row.key,
            mapped: self.line.standing.as_ref().map(|_| [self.category(), &self.subcategory, &self.preset]),
        }
    }

    fn stacks(&self, policy: &Policy) -> bool {
        policy.stack.iter().any(|name| name == self.category() || *name == self.subcategory)
    }

    /// Why it is not simulated; `None` where it is.
    fn left_out(&self) -> Option<&'static str> {
        match &self.line.standing {
            None => Some("not mapped"),
            Some(standing) if standing.kind == Kind::Soft => Some("soft"),
            Some(standing) if standing.kind == Kind::Fluid => Some("fluid"),
            Some(standing) if standing.anchored => Some("fixed in place"),
            Some(_) => None,
        }
    }
}

/// From observations to findings: policy, suppressions, baseline, limits, in this order.
fn judge(request: &Request<'_>, layers: Layers, seen: Seen, report: &mut Report) {
    let Seen { observations, cases, proven, .. } = seen;
    let policy = &request.policy;
    let by_name: BTreeMap<&str, &Case> = cases.iter().map(|case| (case.row.model.as_str(), case)).collect();
    report.models = cases
        .iter()
        .map(|case| Looked {
            model: case.row.model.clone(),
            file: slashed(&case.file),
            category: case.category().to_owned(),
            proven: proven.contains(&case.row.model),
        })
        .collect();
    let judged = |observation: Observation| -> Option<Finding> {
        let case = by_name.get(observation.model.as_str());
        let subject = case.map_or_else(Subject::default, |case| Subject {
            model: &case.row.model,
            category: case.category(),
            subcategory: &case.subcategory,
        });
        let mut finding = policy.judge(observation, subject)?;
        if let Some(case) = case {
            finding.model_file = Some(slashed(&case.file));
            case.category().clone_into(&mut finding.category);
        }
        Some(finding)
    };
    for observation in &observations {
        if let (Some(value), Some(rule)) = (observation.value, Rule::find(&observation.code)) {
            report.measured.entry(rule.code).or_default().push(value);
        }
    }
    let mut findings: Vec<Finding> = observations.into_iter().filter_map(&judged).collect();

    let (mut suppressions, faults) = comments(request);
    suppressions.extend(policy.suppressions.iter().cloned());
    let whole = request.changed_since.is_none() && request.job.is_some() && !report.stopped;
    let (suppressed, idle) = suppression::apply(&mut findings, &suppressions, layers, whole);
    report.suppressed = suppressed;
    findings.extend(faults.into_iter().chain(idle).filter_map(&judged));

    if let Some(file) = &request.baseline {
        let text = fs::read_to_string(file).unwrap_or_default();
        match Baseline::parse(file, &text) {
            Err(fault) => findings.extend(judged(*fault)),
            Ok(baseline) => {
                let whole = whole && layers == Layers::ALL;
                let (accepted, aged) = baseline.apply(&mut findings, whole);
                report.accepted = accepted;
                findings.extend(aged.into_iter().filter_map(&judged));
            }
        }
    }
    policy.apply_limits(&mut findings, cases.len());
    let exceeded = |limit: &&super::Limit| {
        findings.iter().any(|f| {
            limit.selector.matches(f.rule, super::Severity::Warning) && f.severity == super::Severity::Error
        })
    };
    report.exceeded = policy.limits.iter().filter(exceeded).copied().collect();
    findings.sort_by(|a, b| a.order().cmp(&b.order()));
    report.findings = findings;
}

/// Suppressions in the comments of the rules and the override files.
fn comments(request: &Request<'_>) -> (Vec<suppression::Suppression>, Vec<Observation>) {
    let mut found = (Vec::new(), Vec::new());
    for file in request.places.catalog.iter().chain(&request.overrides) {
        let Ok(text) = fs::read_to_string(file) else { continue };
        let (suppressions, faults) = suppression::in_comments(&slashed(file), &text);
        found.0.extend(suppressions);
        found.1.extend(faults);
    }
    found
}

fn built_in(request: &Request<'_>) -> Option<String> {
    let job = request.job.as_ref().filter(|_| request.places.catalog.is_none())?;
    Some(job.mapper.rules().text().to_owned())
}
