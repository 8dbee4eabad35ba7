//! The runtime layer: every model that moves is tried, unless the catalogue knows how that ends.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context as _, Result};
use importer::Catalogue;
use mapper::Mapped;
use rayon::prelude::*;

use super::adopt;
use super::case::Case;
use super::gate::{Request, Seen};
use super::observation::Observation;
use super::place::Places;
use super::prove::{self, Proof, Trials};
use crate::pipeline::{self, Job, Progress, staged};

/// Stage of the layer in the catalogue.
const STAGE: &str = "prove";

/// Adds what the trials show, and how many were made.
pub(super) fn proofs(
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
    progress.begin(STAGE, tried.len());
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
    let stacks = request.policy.stacks(case.subject());
    let input = trials.key(key.0, &standing.physics, &case.preset, stacks);
    if catalogue.stage(model, STAGE)?.is_some_and(|row| row.input_key == input) {
        known.fetch_add(1, Ordering::Relaxed);
    }
    let proof: Result<Proof, _> = staged(catalogue, model, STAGE, &input, || {
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
            vec![place_of(adopt::failure(model, STAGE, &failure), &mapped, &request.places, &case.file)]
        }
    })
}

fn place_of(observation: Observation, mapped: &Mapped, places: &Places, file: &Path) -> Observation {
    match &mapped.preset_by {
        Some(by) => observation.at(places.of(by, Some(file))).because(&by.by),
        None => observation,
    }
}
