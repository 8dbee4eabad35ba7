//! `physique map`: what each model is, as a table and as attributes.json.

use std::fs;
use std::io::{self, Write};

use anyhow::{Context, Result, bail};

use super::End;
use super::args::{Format, Global, MapArgs};
use super::progress::Bars;
use super::{job, output, run};
use crate::pipeline::{self, Upto};
use crate::report::{Line, Summary, write_attributes};

/// # Errors
/// The folder cannot be listed, the rules are not right, or the results cannot be written.
pub(super) fn map(global: &Global, args: &MapArgs) -> Result<End> {
    let Some(models) = &args.models else { return table_of_names(global, args) };
    let job = job::job(global, models, &args.mapping, None, None, Upto::Map)?;
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

/// A table of names, text and sizes, mapped without a mesh.
fn table_of_names(global: &Global, args: &MapArgs) -> Result<End> {
    let Some(table) = &args.table else { bail!("name a folder of models, one model, or a --table") };
    let csv = fs::read_to_string(table).with_context(|| format!("cannot read {}", table.display()))?;
    let (mapper, _, sets) = job::mapping(global, &args.mapping, table)?;
    let answers = mapper::map_table(&mapper, &table.display().to_string(), &csv, &sets)?;
    match &global.out {
        Some(file) if file.is_dir() => {
            bail!("{} is a folder; with --table, --out names the file of answers", file.display())
        }
        Some(file) => output::file(file, |to| Ok(to.write_all(answers.as_bytes())?))?,
        None => output::result(|out| out.write_all(answers.as_bytes()))?,
    }
    Ok(End::Clean)
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
