//! One side of a diff: a lock file, a catalogue, rules, a folder of models, or what git has of them.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context as _, Result, anyhow, bail};
use importer::{Asset, Catalogue};
use mapper::{Mapped, Mapper, Ruleset};
use rayon::prelude::*;

use super::changed::GitTree;
use super::gate;
use super::lock::{self, Entry, Lock, Locked};
use super::observe::{Look, Ranges};
use super::place::Places;
use super::policy::{Policy, Subject};
use super::prove::{self, Trials};
use super::remap::{MapInput, mapper_at};
use super::severity::Severity;
use crate::pipeline::{self, Job, Progress};

const SQLITE: &[u8] = b"SQLite format 3\0";

/// What names of sides are looked up in.
pub struct Around<'a> {
    /// Today's rules, overrides and catalogue of models.
    pub job: &'a Job<'a>,
    pub catalog: Option<&'a Path>,
    pub overrides: &'a [PathBuf],
    pub lock_file: &'a Path,
    /// The models of the catalogue, read when a side first needs them.
    pub inputs: OnceLock<Vec<MapInput>>,
}

impl Around<'_> {
    fn inputs(&self, catalogue: &Catalogue) -> Result<&[MapInput]> {
        if self.inputs.get().is_none() {
            // Nobody else fills it: sides are made one after the other.
            let _ = self.inputs.set(MapInput::all(catalogue)?);
        }
        Ok(self.inputs.get().map_or(&[], Vec::as_slice))
    }
}

/// A mapping of every model, from wherever.
pub struct Side {
    pub lock: Lock,
    maps: Maps,
}

enum Maps {
    /// A lock file says what was mapped, and nothing of the assets.
    Nothing,
    /// As it is stored.
    Stored(Catalogue),
    /// By these rules.
    Rules(Box<Mapper>, Catalogue),
}

/// The side of that name.
///
/// # Errors
/// Nothing of that name is there, or it cannot be read.
pub fn side(name: &str, around: &Around<'_>, progress: &dyn Progress) -> Result<Side> {
    let path = Path::new(name);
    if path.is_dir() {
        let catalogue = pipeline::open(around.job)?;
        return Ok(Side { lock: gate::lock(around.job, true, progress)?, maps: Maps::Stored(catalogue) });
    }
    if !path.is_file() {
        return of_git(name, around);
    }
    let mut head = Vec::new();
    fs::File::open(path)
        .and_then(|file| file.take(16).read_to_end(&mut head))
        .with_context(|| format!("cannot read {name}"))?;
    if head == SQLITE {
        return stored(path, around);
    }
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
    // A lock that a merge has left its marks in is told as what it is.
    if text.starts_with('<') || text.starts_with("# physique") {
        return locked(path, &text);
    }
    let today = &around.job.mapper;
    let mapper = Mapper::new(Ruleset::parse(name, &text)?, today.overrides().clone());
    by_rules(mapper.with_tags(today.tags().clone()), around)
}

fn locked(path: &Path, text: &str) -> Result<Side> {
    let lock = Lock::parse(path, text).map_err(|fault| {
        let place = fault.place.map_or_else(String::new, |place| place.to_string());
        anyhow!("{place}: {}", fault.message)
    })?;
    Ok(Side { lock, maps: Maps::Nothing })
}

/// What a catalogue's own mapping says.
fn stored(path: &Path, around: &Around<'_>) -> Result<Side> {
    let catalogue = Catalogue::open(path)?;
    let keys: std::collections::BTreeMap<String, _> =
        catalogue.models()?.into_iter().filter_map(|row| Some((row.model, row.key?))).collect();
    let entries = catalogue
        .stages("map")?
        .par_iter()
        .filter_map(|row| {
            let mapped: Locked = serde_json::from_str(&row.result).ok()?;
            Some((row.model.clone(), Entry::new(keys.get(&row.model)?, &mapped)))
        })
        .collect();
    let mut lock = Lock::new(around.job.mapper.rules());
    lock.entries = entries;
    Ok(Side { lock, maps: Maps::Stored(catalogue) })
}

/// The models of the catalogue, mapped by these rules.
fn by_rules(mapper: Mapper, around: &Around<'_>) -> Result<Side> {
    let job = around.job;
    if !job.db.is_file() {
        bail!(
            "there are no models to map by these rules: {} is not there; name a catalogue with --db, or make one with \
             `physique map MODELS`",
            job.db.display()
        );
    }
    let catalogue = Catalogue::open(&job.db)?;
    let mut lock = Lock::new(mapper.rules());
    lock.entries = around
        .inputs(&catalogue)?
        .par_iter()
        .map(|input| (input.facts.model.clone(), input.entry(&mapper, &job.sets)))
        .collect();
    Ok(Side { lock, maps: Maps::Rules(Box::new(mapper), catalogue) })
}

/// The lock file of a commit, else its rules on today's models.
fn of_git(name: &str, around: &Around<'_>) -> Result<Side> {
    let from = around.catalog.or(around.overrides.first().map(PathBuf::as_path)).unwrap_or(around.lock_file);
    let tree = GitTree::open(from, name).with_context(|| {
        format!("{name:?} is no lock file, catalogue, rules file or folder, and no git reference")
    })?;
    if let Some(text) = tree.text(around.lock_file) {
        return locked(&around.lock_file.with_extension(format!("lock at {name}")), &text);
    }
    let mapper = mapper_at(&tree, around.catalog, around.overrides, &around.job.mapper)?;
    by_rules(mapper, around)
        .with_context(|| format!("{name} has no {}, which would say it all", around.lock_file.display()))
}

impl Side {
    /// Whether models can be looked at and simulated: a lock file holds no shapes.
    #[must_use]
    pub fn knows_models(&self) -> bool {
        !matches!(self.maps, Maps::Nothing)
    }

    /// Codes of the rules that these models fail, warnings and errors, simulated too.
    ///
    /// # Errors
    /// The catalogue cannot be read.
    pub fn codes(
        &self,
        models: &BTreeSet<&str>,
        job: &Job<'_>,
        policy: &Policy,
        trials: &Trials<'_>,
    ) -> Result<super::diff::Codes> {
        let rules = match &self.maps {
            Maps::Rules(mapper, _) => mapper.rules(),
            _ => job.mapper.rules(),
        };
        let of_model = |model: &&str| -> Result<Option<(String, BTreeSet<&'static str>)>> {
            let found = self.model(model, job)?;
            Ok(found.map(|(asset, mapped)| {
                ((*model).to_owned(), failing(model, &asset, &mapped, rules, policy, trials))
            }))
        };
        let models: Vec<&str> = models.iter().copied().collect();
        let codes: Vec<Option<_>> = models.par_iter().with_max_len(1).map(of_model).collect::<Result<_>>()?;
        Ok(codes.into_iter().flatten().collect())
    }

    fn model(&self, model: &str, job: &Job<'_>) -> Result<Option<(Asset, Mapped)>> {
        let (Maps::Stored(catalogue) | Maps::Rules(_, catalogue)) = &self.maps else { return Ok(None) };
        let Some(row) = catalogue.model(model)? else { return Ok(None) };
        let Some(asset) = row.key.and_then(|key| catalogue.asset(&key).transpose()).transpose()? else {
            return Ok(None);
        };
        let mapped = match &self.maps {
            Maps::Rules(mapper, _) => {
                MapInput::of(catalogue, &row)?.and_then(|input| input.mapped(mapper, &job.sets).ok())
            }
            _ => pipeline::mapped(catalogue, model)?,
        };
        Ok(mapped.map(|mapped| (asset, mapped)))
    }
}

fn failing(
    model: &str,
    asset: &Asset,
    mapped: &Mapped,
    rules: &Ruleset,
    policy: &Policy,
    trials: &Trials<'_>,
) -> BTreeSet<&'static str> {
    let (file, places) = (Path::new(model), Places { catalog: None });
    let body = mapper::scene::drop_entity(model, asset, mapped, rules);
    let collider = mapper::scene::collider(asset, mapped);
    let ranges = Ranges::of(rules, mapped);
    let look = Look { model, file, asset, mapped, places: &places, ranges: &ranges, collider, body: &body };
    let mut seen = look.observations();
    let subject = Subject {
        model,
        category: mapped.category.as_deref().unwrap_or_default(),
        subcategory: mapped.subcategory.as_deref().unwrap_or_default(),
    };
    if mapped.kind == mapper::Kind::Rigid
        && !mapped.anchored
        && let Ok(proof) = trials.prove(model, asset, mapped, policy.stacks(subject))
    {
        seen.extend(prove::observations(&proof, model, file, mapped, &places));
    }
    let judged = seen.into_iter().filter_map(|seen| policy.judge(seen, subject));
    judged.filter(|finding| finding.severity >= Severity::Warning).map(|finding| finding.rule.code).collect()
}

/// Name of the lock file when nothing is said.
#[must_use]
pub fn default_lock() -> PathBuf {
    PathBuf::from(lock::DEFAULT_FILE)
}
