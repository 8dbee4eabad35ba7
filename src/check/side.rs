//! One side of a diff: a mapping of every model, and what of it fails.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Result;
use importer::{Asset, Catalogue};
use mapper::{Mapped, Mapper, Ruleset};
use rayon::prelude::*;

use super::diff::Codes;
use super::lock::Lock;
use super::observe::{Look, Ranges};
use super::place::Places;
use super::policy::{Policy, Subject};
use super::prove::{self, Trials};
use super::remap::MapInput;
use super::severity::Severity;
use crate::pipeline::{self, Job};

/// A mapping of every model, from wherever.
pub struct Side {
    pub lock: Lock,
    pub(super) maps: Maps,
}

/// Who maps.
pub(super) enum Maps {
    /// A lock file says what was mapped, and nothing of the assets.
    Nothing,
    /// As it is stored.
    Stored(Catalogue),
    /// By these rules.
    Rules(Box<Mapper>, Catalogue),
}

impl Side {
    /// Whether models can be looked at and simulated: a lock file holds no shapes.
    #[must_use]
    pub fn knows_models(&self) -> bool {
        !matches!(self.maps, Maps::Nothing)
    }

    /// Its own rules, where it has any.
    #[must_use]
    pub fn mapper(&self) -> Option<&Mapper> {
        match &self.maps {
            Maps::Rules(mapper, _) => Some(mapper),
            _ => None,
        }
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
    ) -> Result<Codes> {
        let rules = self.mapper().unwrap_or(&job.mapper).rules();
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
