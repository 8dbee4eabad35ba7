//! `physique import`: models into the catalogue.

use anyhow::Result;

use super::End;
use super::args::{Global, ImportAloneArgs, ImportArgs, Mapping};
use super::progress::Bars;
use super::{job, output, run};
use crate::pipeline::{self, Upto};
use crate::report::Summary;

/// # Errors
/// The folder cannot be listed or the catalogue not written.
pub(super) fn import(global: &Global, args: &ImportArgs) -> Result<End> {
    let mut job = job::job(global, &args.models, &Mapping::default(), None, None, Upto::Import)?;
    job.shard = args.dividing.shard();
    job.options.with_colliders = !args.no_colliders;
    let bars = Bars::new(global);
    let report = pipeline::run(&job, &bars)?;
    bars.finish();
    let db = job.db.display().to_string();
    let summary = Summary::of(&report, &[("catalogue", db.clone())]);
    run::tell(global, &summary, &[("catalogue".to_owned(), db)])?;
    Ok(run::end(&summary))
}

/// # Errors
/// The answer cannot be written.
pub(super) fn import_alone(args: &ImportAloneArgs) -> Result<End> {
    output::json(&importer::Answer::of(&args.model, &job::import_options()))?;
    Ok(End::Clean)
}
