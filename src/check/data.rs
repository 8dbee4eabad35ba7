//! The data layer: what was measured and mapped, model by model, from the catalogue where nothing changed.

use std::path::Path;
use std::sync::atomic::Ordering;

use anyhow::Result;
use importer::Catalogue;
use rayon::prelude::*;

use super::adopt;
use super::case::Case;
use super::gate::Request;
use super::observation::Observation;
use super::observe::{Look, Ranges};
use super::place::{Place, slashed};
use crate::pipeline::{self, Job, Key, Progress, staged};

/// Stage of the layer in the catalogue.
const STAGE: &str = "check";

/// Part of every key: raise it when a look would show another thing on the same input.
const VERSION: &str = "looks 2";

/// What is seen of all models, in their order; of none any more once the job is stopped.
pub(super) fn looks(
    request: &Request<'_>,
    job: &Job<'_>,
    catalogue: &Catalogue,
    cases: &[Case],
    progress: &dyn Progress,
) -> Result<Vec<Observation>> {
    progress.begin(STAGE, cases.len());
    let looks: Vec<Vec<Observation>> = cases
        .par_iter()
        .with_max_len(1)
        .map(|case| {
            if job.stop.load(Ordering::Relaxed) {
                return Ok(Vec::new());
            }
            let looked = look(request, job, catalogue, case);
            progress.advance();
            looked
        })
        .collect::<Result<_>>()?;
    Ok(looks.into_iter().flatten().collect())
}

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
    let input = Key::new(STAGE)
        .with(VERSION)
        .with(key.0)
        .with(job.options.fingerprint())
        .with(&standing.whole)
        .with(format!("{ranges:?}"))
        .with(slashed(&case.file))
        .with(format!("{:?}", request.places.catalog))
        .finish();
    let looked = staged(catalogue, model, STAGE, &input, || {
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
        Err(failure) => seen.push(adopt::failure(model, STAGE, &failure)),
    }
    Ok(seen)
}

/// The mapper names the sidecar without its folder, and the line and column behind it.
fn in_sidecar(model: &Path, place: &str) -> Place {
    let mut numbers = place.rsplit(':').map_while(|number| number.parse().ok());
    let (column, line) = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    Place { line, column, ..Place::file(&mapper::sidecar_path(model)) }
}
