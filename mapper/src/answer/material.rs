//! The material that names speak of: it becomes the preset, where it is of the right kind.

use crate::answer::resolve::kind_of;
use crate::attribute::{Layer, Provenance};
use crate::facts::ModelFacts;
use crate::names::evidence::{Evidence, MaterialWord};
use crate::names::signal::Signal;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{Setting, What};

/// A material named in name, folders, tags or materials, as a rule's setting. `settings` are those of the category
/// and above, lowest first.
#[must_use]
pub(crate) fn word(
    rules: &Ruleset,
    facts: &ModelFacts,
    evidence: &Evidence,
    settings: &[&Setting],
    categorized: bool,
) -> Option<Setting> {
    let kind = kind_of(&rules.presets, settings);
    let fits = |preset: usize| !categorized || rules.presets[preset].kind == kind;
    let named = evidence.materials.iter().find(|word| {
        !matches!(word.signal, Signal::Material | Signal::Node)
            && fits(word.preset)
            && !(word.head && categorized && word.signal == Signal::Name)
    });
    let word = match named {
        Some(word) => word,
        None => dominant(facts, evidence, &fits)?,
    };
    let by = Provenance { layer: Layer::Rule, by: "rule:material-word".into(), ..word.by.clone() };
    Some(Setting { what: What::Preset(word.preset), by })
}

/// The one material that the file's material names agree on.
fn dominant<'e>(
    facts: &ModelFacts,
    evidence: &'e Evidence,
    fits: &dyn Fn(usize) -> bool,
) -> Option<&'e MaterialWord> {
    let words: Vec<_> = evidence
        .materials
        .iter()
        .filter(|word| word.signal == Signal::Material && fits(word.preset))
        .collect();
    let first = *words.first()?;
    // Unnamed materials beside a named one may be anything.
    let all_named = facts.materials.len() <= words.len();
    (all_named && words.iter().all(|word| word.preset == first.preset)).then_some(first)
}
