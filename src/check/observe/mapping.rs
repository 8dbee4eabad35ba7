//! What a model was taken for, and how sure that is.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use importer::AssetKey;
use mapper::{Kind, Layer, sidecar_path};

use super::super::observation::Observation;
use super::super::place::Place;
use super::Look;

/// Attributes of a rigid thing that no default should decide.
const CHOSEN: [&str; 3] = ["density", "friction_dynamic", "restitution"];

pub(super) fn see(look: &Look<'_>, seen: &mut Vec<Observation>) {
    let mapped = look.mapped;
    if mapped.category.is_some() {
        let winner = mapped.trace.iter().find(|trace| trace.won);
        let because = winner.map_or("", |trace| trace.because.as_str());
        let message = format!("taken for {}: {because}", look.what());
        let observation = look.measured("MAP021", mapped.confidence, message);
        seen.push(match winner {
            Some(trace) => look.set_by(observation, &trace.by),
            None => observation,
        });
    }
    // What nobody could categorize has a finding of its own.
    if mapped.kind == Kind::Rigid && mapped.category.is_some() {
        for name in CHOSEN {
            let Some(attribute) = mapped.attribute(name) else { continue };
            let by = &attribute.provenance;
            if by.layer <= Layer::Kind {
                let value = attribute.value.number().unwrap_or(f64::NAN);
                let message = format!("{name} {value} is the {} of {}", by.layer, by.place());
                seen.push(look.set_by(look.fact("ATT007", message), by));
            }
        }
    }
}

/// What a line of the whole database is compared by.
#[derive(Clone, Debug)]
pub struct Standing<'a> {
    pub model: &'a str,
    pub asset: Option<AssetKey>,
    /// Category, subcategory and preset; `None` where it was not mapped.
    pub mapped: Option<[&'a str; 3]>,
}

/// What only the whole database shows: its coverage, and the same bytes mapped apart.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "counts of models")]
pub fn across(lines: &[Standing<'_>]) -> Vec<Observation> {
    let mut seen = Vec::new();
    let mapped: Vec<&Standing<'_>> = lines.iter().filter(|line| line.mapped.is_some()).collect();
    let without =
        mapped.iter().filter(|line| line.mapped.is_some_and(|[category, ..]| category.is_empty())).count();
    if !mapped.is_empty() {
        let share = without as f64 * 100.0 / mapped.len() as f64;
        let message = format!("{without} of {} models are uncategorized", mapped.len());
        seen.push(Observation::measured("MAP022", share, message));
    }
    let mut first: BTreeMap<AssetKey, &Standing<'_>> = BTreeMap::new();
    for line in mapped {
        let Some(asset) = line.asset else { continue };
        match first.get(&asset) {
            Some(earlier) if earlier.mapped != line.mapped => {
                let written = |line: &Standing<'_>| {
                    let [category, subcategory, preset] = line.mapped.unwrap_or_default();
                    format!("{category}/{subcategory} of {preset}")
                };
                let message =
                    format!("is {}, and as {} it is {}", written(line), earlier.model, written(earlier));
                seen.push(Observation::fact("MAP025", message).of(line.model));
            }
            Some(_) => {}
            None => drop(first.insert(asset, line)),
        }
    }
    seen
}

/// Sidecars below `root` beside which there is no model.
#[must_use]
pub fn missing_sidecars(root: &Path, models: &[&Path]) -> Vec<Observation> {
    let wanted: std::collections::BTreeSet<_> = models.iter().map(|model| sidecar_path(model)).collect();
    let mut folders = vec![root.to_path_buf()];
    let mut seen = Vec::new();
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries.flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(path);
            } else if name.to_string_lossy().ends_with(".physics.yaml") && !wanted.contains(&path) {
                let message = "there is no model beside this sidecar".to_owned();
                seen.push(Observation::fact("IMP011", message).at(Some(Place::file(&path))));
            }
        }
    }
    seen.sort_by(|a, b| a.place.cmp(&b.place));
    seen
}
