//! `physique check --rules`: faults of the rules and overrides themselves, without mapping a model.

use std::path::Path;

use anyhow::{Context, Result};
use mapper::{Finding, check_rules};
use serde_json::json;

use super::End;
use super::args::{CheckArgs, Format, Global};
use super::{job, output};

/// # Errors
/// The rules cannot be read, or the folder of models cannot be listed.
pub(super) fn check(global: &Global, args: &CheckArgs) -> Result<End> {
    let models = args.models.as_deref();
    let (mapper, _, _) = job::mapping(global, &args.mapping, models.unwrap_or(Path::new(".")))?;
    let mut findings = check_rules(mapper.rules());
    if let Some(root) = models {
        let models = listed(root)?;
        let models: Vec<&str> = models.iter().map(String::as_str).collect();
        findings.extend(mapper.overrides().unmatched(&models));
    }
    if global.format == Format::Json {
        let findings: Vec<_> = findings.iter().map(value).collect();
        output::json(&findings)?;
    } else {
        output::result(|out| {
            for finding in &findings {
                writeln!(out, "{}: [{}] {}", place(finding), finding.code, finding.message)?;
            }
            Ok(())
        })?;
        if !global.quiet {
            let stats = mapper.rules().stats();
            output::notice(&format!(
                "{} findings in {} categories, {} subcategories, {} aliases and {} rules",
                findings.len(),
                stats.categories,
                stats.subcategories,
                stats.aliases,
                stats.rules
            ));
        }
    }
    Ok(if findings.is_empty() { End::Clean } else { End::Findings })
}

/// Models below the root as overrides see them.
fn listed(root: &Path) -> Result<Vec<String>> {
    let found = importer::discover(root).with_context(|| format!("cannot list {}", root.display()))?;
    let base = if root.is_dir() { root } else { root.parent().unwrap_or(root) };
    Ok(found
        .iter()
        .map(|path| path.strip_prefix(base).unwrap_or(path))
        .map(|path| path.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/"))
        .collect())
}

/// `catalog.yaml:120:7`
fn place(finding: &Finding) -> String {
    finding.place.as_ref().map_or_else(String::new, |at| format!("{}:{}:{}", at.file, at.line, at.column))
}

fn value(finding: &Finding) -> serde_json::Value {
    let at = finding.place.as_ref();
    json!({
        "code": finding.code,
        "message": finding.message,
        "file": at.map(|at| &at.file),
        "line": at.map(|at| at.line),
        "column": at.map(|at| at.column),
    })
}
