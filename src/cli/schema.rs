//! `physique schema`: JSON Schemas for editors, which know the categories and presets of the rules in use.

use anyhow::Result;

use super::End;
use super::args::{Global, SchemaArgs, SchemaOf};
use super::{job, output};

/// # Errors
/// The rules are not right, or stdout cannot be written.
pub(super) fn schema(global: &Global, args: &SchemaArgs) -> Result<End> {
    let rules = job::rules(global)?;
    let text = match args.of {
        SchemaOf::Catalog => mapper::schema::catalogue(&rules),
        SchemaOf::Overrides => mapper::schema::overrides(&rules),
        SchemaOf::Sidecar => mapper::schema::sidecar(&rules),
        SchemaOf::Scene => mapper::schema::scene(&rules),
    };
    output::result(|out| writeln!(out, "{}", text.trim_end()))?;
    Ok(End::Clean)
}
