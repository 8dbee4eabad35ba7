//! `physique run`: the whole flow on a folder of models.

use std::path::{Path, PathBuf};

use anyhow::Result;
use importer::Catalogue;

use super::End;
use super::args::{Format, Global, RunArgs};
use super::progress::Bars;
use super::{job, output};
use crate::pipeline::{self, Job, Upto};
use crate::report::{Report, Summary, write_attributes, write_text, write_validation};

/// # Errors
/// The run as a whole could not be done.
pub(super) fn run(global: &Global, args: &RunArgs) -> Result<End> {
    let mut job =
        job::job(global, &args.models, &args.mapping, Some(&args.dropping), Some(&args.showing), Upto::Drop)?;
    job.shard = args.dividing.shard();
    let (summary, how_to_look) = flow(global, &job, &job::out(global))?;
    tell(global, &summary, &how_to_look)?;
    Ok(end(&summary))
}

/// Does the job and writes its files into `out`; the lines say where everything is.
pub(super) fn flow(global: &Global, job: &Job<'_>, out: &Path) -> Result<(Summary, Vec<(String, String)>)> {
    job::start_threads(global)?;
    let bars = Bars::new(global);
    let report = pipeline::run(job, &bars)?;
    bars.finish();
    let files = write_files(job, &report, out)?;
    let shown: Vec<(&str, String)> =
        files.iter().map(|(what, path)| (*what, path.display().to_string())).collect();
    let summary = Summary::of(&report, &shown);
    let summary_file = out.join("summary.json");
    output::file(&summary_file, |to| {
        serde_json::to_writer_pretty(&mut *to, &summary)?;
        Ok(writeln!(to)?)
    })?;
    let mut how_to_look: Vec<(String, String)> =
        shown.into_iter().map(|(what, path)| (what.to_owned(), path)).collect();
    how_to_look.push(("summary".to_owned(), summary_file.display().to_string()));
    if let Some(recording) = &report.recording {
        how_to_look.push(("look at it".to_owned(), open_command(recording)));
    }
    Ok((summary, how_to_look))
}

fn write_files(job: &Job<'_>, report: &Report, out: &Path) -> Result<Vec<(&'static str, PathBuf)>> {
    let mut files = Vec::new();
    if let Some(recording) = &report.recording {
        files.push(("recording", recording.clone()));
    }
    if job.upto >= Upto::Map {
        let catalogue = Catalogue::open(&job.db)?;
        let path = out.join("attributes.json");
        output::file(&path, |to| write_attributes(to, &catalogue, &report.lines))?;
        files.push(("attributes", path));
    }
    if job.upto >= Upto::Drop {
        let path = out.join("validation.csv");
        output::file(&path, |to| Ok(write_validation(to, &report.lines)?))?;
        files.push(("validation", path));
    }
    files.push(("catalogue", job.db.clone()));
    Ok(files)
}

/// The summary on stdout, in the format asked for.
pub(super) fn tell(global: &Global, summary: &Summary, how_to_look: &[(String, String)]) -> Result<()> {
    match global.format {
        Format::Json => output::json(summary),
        _ => output::result(|out| write_text(out, summary, how_to_look)),
    }
}

pub(super) fn end(summary: &Summary) -> End {
    match summary {
        Summary { stopped: true, .. } => End::Interrupted,
        Summary { findings: 0, .. } => End::Clean,
        _ => End::Findings,
    }
}

#[cfg(feature = "viewer")]
fn open_command(recording: &Path) -> String {
    match viewer::viewer_version() {
        Some(_) => viewer::open_command(recording),
        None => format!("{}   (first {})", viewer::open_command(recording), viewer::INSTALL_HINT),
    }
}

#[cfg(not(feature = "viewer"))]
fn open_command(recording: &Path) -> String {
    format!("rerun {}", recording.display())
}
