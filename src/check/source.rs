//! What the name of one side of a diff stands for: a lock file, a catalogue, rules, a folder of models, or what git has
//! of them.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context as _, Result, anyhow, bail};
use importer::Catalogue;
use mapper::{Mapper, Ruleset};
use rayon::prelude::*;

use super::changed::GitTree;
use super::entry::{Entry, Locked};
use super::gate;
use super::lock::Lock;
use super::remap::{MapInput, mapper_at};
use super::side::{Maps, Side};
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

/// What was found under a name, read, and not yet asked about any model.
pub enum Source {
    Folder,
    Lock(Lock),
    Catalogue(PathBuf),
    Rules {
        mapper: Box<Mapper>,
        /// Why they are asked, for who gets no answer.
        why: Option<String>,
    },
}

impl Source {
    /// # Errors
    /// Nothing of that name is there, or it cannot be read.
    pub fn of(name: &str, around: &Around<'_>) -> Result<Self> {
        let path = Path::new(name);
        if path.is_dir() {
            return Ok(Self::Folder);
        }
        if !path.is_file() {
            return Self::of_git(name, around);
        }
        let mut head = Vec::new();
        fs::File::open(path)
            .and_then(|file| file.take(16).read_to_end(&mut head))
            .with_context(|| format!("cannot read {name}"))?;
        if head == SQLITE {
            return Ok(Self::Catalogue(path.to_path_buf()));
        }
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
        // A lock that a merge has left its marks in is told as what it is.
        let by_name = path.extension().is_some_and(|extension| extension == "lock");
        if by_name || text.starts_with('<') || text.starts_with("# physique") {
            return locked(path, &text);
        }
        let today = &around.job.mapper;
        let mapper = Mapper::new(Ruleset::parse(name, &text)?, today.overrides().clone());
        Ok(Self::Rules { mapper: Box::new(mapper.with_tags(today.tags().clone())), why: None })
    }

    /// The lock file of a commit, else its rules on today's models.
    fn of_git(name: &str, around: &Around<'_>) -> Result<Self> {
        let from =
            around.catalog.or(around.overrides.first().map(PathBuf::as_path)).unwrap_or(around.lock_file);
        let tree = GitTree::open(from, name).with_context(|| {
            format!("{name:?} is no lock file, catalogue, rules file or folder, and no git reference")
        })?;
        if let Some(text) = tree.text(around.lock_file) {
            return locked(&around.lock_file.with_extension(format!("lock at {name}")), &text);
        }
        let mapper = mapper_at(&tree, around.catalog, around.overrides, &around.job.mapper)?;
        let why = format!("{name} has no {}, which would say it all", around.lock_file.display());
        Ok(Self::Rules { mapper: Box::new(mapper), why: Some(why) })
    }

    /// What it says of every model.
    ///
    /// # Errors
    /// The catalogue cannot be read, or there is none for the rules to map.
    pub fn side(self, around: &Around<'_>, progress: &dyn Progress) -> Result<Side> {
        match self {
            Self::Folder => {
                let lock = gate::lock(around.job, true, progress)?;
                Ok(Side { lock, maps: Maps::Stored(pipeline::open(around.job)?) })
            }
            Self::Lock(lock) => Ok(Side { lock, maps: Maps::Nothing }),
            Self::Catalogue(path) => stored(&path, around),
            Self::Rules { mapper, why: None } => by_rules(mapper, around),
            Self::Rules { mapper, why: Some(why) } => by_rules(mapper, around).context(why),
        }
    }
}

fn locked(path: &Path, text: &str) -> Result<Source> {
    let lock = Lock::parse(path, text).map_err(|fault| {
        let place = fault.place.map_or_else(String::new, |place| place.to_string());
        anyhow!("{place}: {}", fault.message)
    })?;
    Ok(Source::Lock(lock))
}

/// What a catalogue's own mapping says.
fn stored(path: &Path, around: &Around<'_>) -> Result<Side> {
    let catalogue = Catalogue::open(path)?;
    let keys: BTreeMap<String, _> =
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
fn by_rules(mapper: Box<Mapper>, around: &Around<'_>) -> Result<Side> {
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
    Ok(Side { lock, maps: Maps::Rules(mapper, catalogue) })
}
