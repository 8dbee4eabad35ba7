//! `physique demo`: the whole flow on a model database of the project's own making.

use std::path::PathBuf;

use anyhow::{Context, Result};

use super::End;
use super::args::{DemoArgs, Global, Mapping};
use super::{job, output, run};
use crate::demo;
use crate::pipeline::Upto;
use crate::report::plural;

const DEFAULT_OUT: &str = "physique-demo";

/// # Errors
/// The models cannot be written, or the run as a whole not done.
pub(super) fn demo(global: &Global, args: &DemoArgs) -> Result<End> {
    let mut global = global.clone();
    let out = global.out.get_or_insert_with(|| PathBuf::from(DEFAULT_OUT)).clone();
    let root = out.join("models");
    let written = demo::write(&root)
        .with_context(|| format!("cannot write the demo's models below {}", root.display()))?;
    if !global.quiet {
        output::notice(&format!("{} of the demo in {}", plural(written.models, "model"), root.display()));
    }
    let mapping = Mapping::default();
    let job = job::job(&global, &root, &mapping, Some(&args.dropping), Some(&args.showing), Upto::Drop)?;
    let (summary, mut how_to_look) = run::flow(&global, &job, &out)?;
    let stool = root.join("furniture").join("stool.glb");
    how_to_look.push(("why a value".to_owned(), format!("physique explain {}", stool.display())));
    run::tell(&global, &summary, &how_to_look)?;
    Ok(run::end(&summary))
}
