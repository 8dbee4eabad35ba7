//! What a change touches: files that git sees changed, and models that the changed rules map otherwise.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::Result;
use importer::Catalogue;
use mapper::sidecar_path;
use rayon::prelude::*;

use super::case::Case;
use super::changed::GitTree;
use super::entry::{Entry, Locked};
use super::gate::Request;
use super::observation::Observation;
use super::remap::{MapInput, mapper_at};
use crate::pipeline::Job;

/// Files and models of a change.
pub(super) struct Touched {
    pub models: BTreeSet<String>,
    /// Absolute.
    files: BTreeSet<PathBuf>,
}

impl Touched {
    /// Whether what was seen belongs to the change: to a model that it touches, or to a file in it.
    pub fn keeps(&self, observation: &Observation) -> bool {
        if !observation.model.is_empty() {
            return self.models.contains(&observation.model);
        }
        observation.place.as_ref().is_some_and(|place| self.holds(Path::new(&place.file)))
    }

    fn holds(&self, file: &Path) -> bool {
        self.files.contains(&absolute(file))
    }
}

pub(super) fn touched(
    request: &Request<'_>,
    job: &Job<'_>,
    tree: &GitTree,
    catalogue: &Catalogue,
    cases: &[Case],
) -> Result<Touched> {
    let files = tree.changed_files()?.iter().map(|file| absolute(file)).collect();
    let mut touched = Touched { models: BTreeSet::new(), files };
    for case in cases {
        let folder = case.file.parent().unwrap_or(Path::new(""));
        let refers = catalogue.record(&case.row.model)?.map(|record| record.dependencies).unwrap_or_default();
        let refers = refers.iter().any(|dependency| touched.holds(&folder.join(&dependency.path)));
        if refers || touched.holds(&case.file) || touched.holds(&sidecar_path(&case.file)) {
            touched.models.insert(case.row.model.clone());
        }
    }
    let rules = request.places.catalog.iter().chain(&request.overrides);
    if rules.clone().any(|file| touched.holds(file)) {
        let remapped = remapped(request, job, tree, catalogue, cases)?;
        touched.models.extend(remapped);
    }
    Ok(touched)
}

/// Models that the rules of the commit map otherwise than those of today; all, where these cannot be read.
fn remapped(
    request: &Request<'_>,
    job: &Job<'_>,
    tree: &GitTree,
    catalogue: &Catalogue,
    cases: &[Case],
) -> Result<Vec<String>> {
    let all = || Ok(cases.iter().map(|case| case.row.model.clone()).collect());
    let catalog = request.places.catalog.as_deref();
    let Ok(before) = mapper_at(tree, catalog, &request.overrides, &job.mapper) else { return all() };
    let differs = |case: &Case| -> Result<bool> {
        let (Some(input), Some(now)) = (MapInput::of(catalogue, &case.row)?, &case.entry) else {
            return Ok(true);
        };
        let Ok(mapped) = input.mapped(&before, &job.sets) else { return Ok(true) };
        Ok(Entry::new(&input.key, &Locked::from(&mapped)) != *now)
    };
    let differing: Vec<Option<String>> = cases
        .par_iter()
        .map(|case| Ok(differs(case)?.then(|| case.row.model.clone())))
        .collect::<Result<_>>()?;
    Ok(differing.into_iter().flatten().collect())
}

fn absolute(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_path_buf())
}
