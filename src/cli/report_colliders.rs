//! `physique report --colliders MODELS`: what stands for each model, how wrong it is and what it costs.

use std::fs;
use std::path::Path;
use std::sync::atomic::Ordering;

use anyhow::{Context, Result};
use importer::Options;

use super::End;
use super::args::{ColliderArgs, Format, Global};
use super::{interrupt, output};
use crate::report::colliders::{self, Plan, Row, Tool};

/// # Errors
/// The folder cannot be listed, or a result not written.
pub(super) fn report(global: &Global, args: &ColliderArgs, models: &Path) -> Result<End> {
    let options = Options { collider_tolerance: args.tolerance, ..Options::default() };
    for folder in global.out.iter().flat_map(|out| [out.join("pictures"), out.join("pieces")]) {
        fs::create_dir_all(&folder).with_context(|| format!("cannot write {}", folder.display()))?;
    }
    let plan = Plan { models: models.to_path_buf(), options, piles: args.piles, out: global.out.clone() };
    let stop = interrupt::flag();
    let rows = colliders::measure(&plan, stop, |rows| {
        for row in rows.iter().filter(|row| row.tool == Tool::Physique && !global.quiet) {
            output::notice(&line(row));
        }
    })?;
    if let Some(folder) = &global.out {
        colliders::write_csv(&folder.join("colliders.csv"), &rows)?;
        colliders::write_page(folder, &rows, args.tolerance)?;
    }
    if global.format == Format::Json {
        output::json(&rows)?;
    } else {
        output::result(|out| {
            colliders::write_summary(out, &rows, args.tolerance)?;
            match &global.out {
                Some(folder) => writeln!(out, "page      {}", folder.join("colliders.html").display()),
                None => Ok(()),
            }
        })?;
    }
    Ok(if stop.load(Ordering::Relaxed) { End::Interrupted } else { End::Clean })
}

fn line(row: &Row) -> String {
    format!(
        "{}: {}, {} pieces, {:.2} of the tolerance, {:.2} s",
        row.model, row.shape, row.pieces, row.excess, row.seconds
    )
}
