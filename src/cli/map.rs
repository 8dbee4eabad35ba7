//! `physique map`: what each model is, as a table and as attributes.json.

use std::io::{self, Write};

use anyhow::Result;

use super::End;
use super::args::{Format, Global, MapArgs};
use super::progress::Bars;
use super::{job, output, run};
use crate::pipeline::{self, Upto};
use crate::report::{Line, Summary, write_attributes};

/// # Errors
/// The folder cannot be listed, the rules are not right, or the results cannot be written.
pub fn map(global: &Global, args: &MapArgs) -> Result<End> {
    let job = job::job(global, &args.models, &args.mapping, None, None, Upto::Map)?;
    job::start_threads(global)?;
    let bars = Bars::new(global);
    let report = pipeline::run(&job, &bars)?;
    bars.finish();
    let attributes = job::out(global).join("attributes.json");
    let catalogue = importer::Catalogue::open(&job.db)?;
    output::file(&attributes, |to| write_attributes(to, &catalogue, &report.lines))?;
    let files =
        [("attributes", attributes.display().to_string()), ("catalogue", job.db.display().to_string())];
    let summary = Summary::of(&report, &files);
    if global.format == Format::Text {
        output::result(|out| table(out, &report.lines))?;
    }
    let how_to_look = files.map(|(what, path)| (what.to_owned(), path));
    run::tell(global, &summary, &how_to_look)?;
    Ok(run::end(&summary))
}

fn table(out: &mut dyn Write, lines: &[Line]) -> io::Result<()> {
    let width = lines.iter().map(|line| line.model.chars().count()).max().unwrap_or(0);
    for line in lines {
        let Some(standing) = &line.standing else { continue };
        let category = standing.category.as_deref().unwrap_or("uncategorized");
        let suspect = if standing.suspect { "  size fits no unit" } else { "" };
        writeln!(out, "{:width$}  {:6}{category}{suspect}", line.model, standing.kind.to_string())?;
    }
    writeln!(out)
}
