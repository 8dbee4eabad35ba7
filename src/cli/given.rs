//! What the paths on the gate's command line are: models, rules, overrides or sidecars.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use mapper::parse_yaml;

use super::args::{Global, Mapping};
use crate::check::config;

/// What the paths of the command line are.
#[derive(Default)]
pub(super) struct Given {
    /// Folder, or one model.
    pub(super) models: Option<PathBuf>,
    pub(super) catalog: Option<PathBuf>,
    pub(super) overrides: Vec<PathBuf>,
    pub(super) sidecars: Vec<PathBuf>,
}

impl Given {
    /// # Errors
    /// A path is not there, or two hold the same kind of thing.
    pub(super) fn of(paths: &[PathBuf]) -> Result<Self> {
        let mut given = Self::default();
        for path in paths {
            if !path.exists() {
                bail!(
                    "{}: no such file or folder; name a folder of models, a model, or YAML files",
                    path.display()
                );
            }
            if path.is_file() && is_text_of_rules(path) {
                given.take_yaml(path)?;
            } else if let Some(other) = given.models.replace(path.clone()) {
                bail!(
                    "both {} and {} hold models; check one folder at a time, each with a catalogue of its own (--db)",
                    other.display(),
                    path.display()
                );
            }
        }
        Ok(given)
    }

    /// Which of the three a YAML file is shows its name or its keys.
    fn take_yaml(&mut self, path: &Path) -> Result<()> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.ends_with(".physics.yaml") {
            self.sidecars.push(path.to_path_buf());
            return Ok(());
        }
        if name == config::DEFAULT_FILE {
            return Ok(());
        }
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        // What is no YAML is told by who reads it for what it is.
        let keys = parse_yaml(&name, &text).ok().and_then(|doc| match doc.root.data {
            mapper::Data::Map(pairs) => {
                Some(pairs.iter().map(|(key, _)| key.text().to_owned()).collect::<Vec<_>>())
            }
            _ => None,
        });
        let has = |wanted: &[&str]| keys.iter().flatten().any(|key| wanted.contains(&key.as_str()));
        let by_text =
            || text.lines().any(|line| line.starts_with("overrides:") || line.starts_with("proposed_by:"));
        if has(&["overrides", "proposed_by"]) || (keys.is_none() && by_text()) {
            self.overrides.push(path.to_path_buf());
        } else if let Some(other) = self.catalog.replace(path.to_path_buf()) {
            bail!(
                "both {} and {} hold rules; check one catalogue at a time",
                other.display(),
                path.display()
            );
        }
        Ok(())
    }

    /// Flags with what the paths say on top.
    pub(super) fn laid_over(&self, global: &Global, mapping: &Mapping) -> (Global, Mapping) {
        let mut global = global.clone();
        let mut mapping = mapping.clone();
        if self.catalog.is_some() {
            global.catalog.clone_from(&self.catalog);
        }
        mapping.overrides.extend(self.overrides.iter().cloned());
        (global, mapping)
    }
}

/// YAML, unless it describes a model.
fn is_text_of_rules(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let ends = |ends: [&str; 2]| ends.iter().any(|end| name.ends_with(end));
    ends([".yaml", ".yml"]) && !ends([".shapes.yaml", ".shapes.yml"])
}
