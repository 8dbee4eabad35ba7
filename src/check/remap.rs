//! Models mapped by other rules than today's: those of a file, or of a commit.

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use importer::{AssetKey, Catalogue, ModelRow};
use mapper::{MapError, Mapped, Mapper, ModelFacts, Overrides, Ruleset, SetValue, Sidecar};
use rayon::prelude::*;

use super::changed::GitTree;
use super::entry::{Entry, Locked};

/// All that a mapper asks of one model, for as many mappers as there are.
pub struct MapInput {
    pub key: AssetKey,
    pub facts: ModelFacts,
    path: PathBuf,
}

impl MapInput {
    /// `None` for a model that could not be imported.
    ///
    /// # Errors
    /// The catalogue cannot be read, or lacks the asset.
    pub fn of(catalogue: &Catalogue, row: &ModelRow) -> Result<Option<Self>> {
        let Some(key) = row.key else { return Ok(None) };
        let asset = catalogue
            .asset_with_hull(&key)?
            .ok_or_else(|| anyhow!("{} is not in the catalogue", row.model))?;
        Ok(Some(Self { key, facts: ModelFacts::new(&row.model, &asset), path: row.path() }))
    }

    /// Of all models of a catalogue, in their order.
    ///
    /// # Errors
    /// As of one.
    pub fn all(catalogue: &Catalogue) -> Result<Vec<Self>> {
        let rows = catalogue.models()?;
        let read: Vec<Option<Self>> =
            rows.par_iter().map(|row| Self::of(catalogue, row)).collect::<Result<_>>()?;
        Ok(read.into_iter().flatten().collect())
    }

    /// # Errors
    /// The model's sidecar makes no sense under these rules.
    pub fn mapped(&self, mapper: &Mapper, sets: &[SetValue]) -> Result<Mapped, MapError> {
        let sidecar = Sidecar::load(&self.path, mapper.rules())?;
        Ok(mapper.map_with_sidecar(&self.facts, sidecar.as_ref(), sets))
    }

    /// Its line of a lock; a sidecar that makes no sense is left out.
    pub fn entry(&self, mapper: &Mapper, sets: &[SetValue]) -> Entry {
        let mapped =
            self.mapped(mapper, sets).unwrap_or_else(|_| mapper.map_with_sidecar(&self.facts, None, sets));
        Entry::new(&self.key, &Locked::from(&mapped))
    }
}

/// The mapper as a commit has it: its rules, where they are a file, its overrides, and today's tags.
///
/// # Errors
/// The rules are not in the commit, or what is there makes no sense.
pub fn mapper_at(
    tree: &GitTree,
    catalog: Option<&Path>,
    overrides: &[PathBuf],
    today: &Mapper,
) -> Result<Mapper> {
    let rules = match catalog {
        Some(file) => {
            let text = tree
                .text(file)
                .ok_or_else(|| anyhow!("{} is not in {}", file.display(), tree.reference()))?;
            Ruleset::parse(&file.display().to_string(), &text)?
        }
        None => today.rules().clone(),
    };
    let mut laid = Overrides::none();
    for file in overrides {
        // A file that is new in the change said nothing before.
        let Some(text) = tree.text(file) else { continue };
        laid = laid.and(Overrides::parse(&file.display().to_string(), &text, &rules)?);
    }
    Ok(Mapper::new(rules, laid).with_tags(today.tags().clone()))
}
