//! `physique lock`: what the mapping says of every model, a line a model.

use anyhow::Result;

use super::End;
use super::args::{Global, LockArgs};
use super::progress::Bars;
use super::{job, output};
use crate::check;
use crate::pipeline::Upto;
use crate::report::plural;

/// # Errors
/// Rules or overrides are not right, the folder cannot be listed, or the lock file not written.
pub(super) fn lock(global: &Global, args: &LockArgs) -> Result<End> {
    let models = args.models.clone().unwrap_or_else(|| job::root_in(&job::db(global)));
    let job = job::job(global, &models, &args.mapping, None, None, Upto::Map)?;
    job::start_threads(global)?;
    let bars = Bars::new(global);
    let lock = check::lock_of(&job, args.models.is_some(), &bars)?;
    bars.finish();
    if job.stop.load(std::sync::atomic::Ordering::Relaxed) {
        // Half a lock would lock the other half out.
        return Ok(End::Interrupted);
    }
    output::file(&args.output, |to| Ok(to.write_all(lock.text().as_bytes())?))?;
    if !global.quiet {
        output::notice(&format!("{} in {}", plural(lock.entries.len(), "model"), args.output.display()));
    }
    Ok(End::Clean)
}
