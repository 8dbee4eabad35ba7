//! What a model's answer rests on, gathered before the answer is made: so that whoever keeps answers can ask first
//! whether a change of the rules reaches this model.

use std::borrow::Cow;
use std::sync::Arc;

use crate::answer::consistency;
use crate::answer::decide::{Decision, decide};
use crate::answer::material;
use crate::answer::reach::{Reach, Reader};
use crate::answer::resolve::{Chain, Resolved, resolve};
use crate::answer::scale;
use crate::answer::stated;
use crate::answer::weigh::{Weighing, parts};
use crate::attribute::{ATTRIBUTES, Attribute, AttributeId, Layer, Value, interned};
use crate::facts::ModelFacts;
use crate::mapped::{ColliderTolerance, Contents, Finding, Mapped, Scale};
use crate::names::evidence::{Evidence, gather, size_range};
use crate::names::lexicon::Target;
use crate::rules::category::Range;
use crate::rules::overrides::{Overlay, Override, Overrides, SetValue, Sidecar};
use crate::rules::rule::Rule;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{Setting, What};

/// Everything of rules and overrides that speaks of one model.
pub struct Consulted<'m> {
    rules: &'m Ruleset,
    facts: Cow<'m, ModelFacts>,
    evidence: Evidence,
    /// Rules that hold, the more specific later.
    matched: Vec<&'m Rule>,
    /// Lowest first.
    voices: Vec<Voice<'m>>,
}

/// What somebody says of this model, and how sure they are: 1 for people.
struct Voice<'m> {
    overlay: &'m Overlay,
    confidence: f64,
}

impl<'m> Consulted<'m> {
    #[must_use]
    pub(crate) fn new(
        rules: &'m Ruleset,
        overrides: &'m Overrides,
        facts: Cow<'m, ModelFacts>,
        sidecar: Option<&'m Sidecar>,
        cli: &'m [SetValue],
    ) -> Self {
        let evidence = gather(rules, &facts);
        let mut matched: Vec<&Rule> =
            rules.rules.iter().filter(|rule| rule.when.holds(rules, &facts, &evidence)).collect();
        // Stable: within one specificity the order of the file stays, and the later line wins.
        matched.sort_by_key(|rule| rule.specificity);
        let sure = sureness(&evidence, &matched);
        let mut entries: Vec<&Override> = overrides
            .entries
            .iter()
            .filter(|entry| entry.place.layer > Layer::Proposal || entry.confidence > sure)
            .filter(|entry| entry.matches(&facts.model))
            .collect();
        // Below people's, and the surer later.
        entries.sort_by(|a, b| a.place.layer.cmp(&b.place.layer).then(a.confidence.total_cmp(&b.confidence)));
        let voices = entries
            .into_iter()
            .map(|entry| Voice { overlay: &entry.overlay, confidence: entry.confidence })
            .chain(sidecar.map(|sidecar| Voice { overlay: &sidecar.overlay, confidence: 1.0 }))
            .chain(cli.iter().map(|set| Voice { overlay: &set.overlay, confidence: 1.0 }))
            .collect();
        Self { rules, facts, evidence, matched, voices }
    }

    /// Fingerprint of all that the answer rests on, the model's facts left out.
    #[must_use]
    pub fn reach(&self) -> Reach {
        let mut reader = Reader::new(self.rules);
        reader.evidence(&self.evidence);
        let decision = self.decide();
        if let Some(category) = decision.category {
            reader.winner(category, decision.subcategory);
        }
        for rule in &self.matched {
            reader.entry(rule.print, &rule.set);
        }
        for voice in &self.voices {
            reader.overlay(voice.overlay);
        }
        reader.finish()
    }

    /// What people and machines say of the whole model, lowest first, with how sure they are.
    fn voiced(&self) -> Vec<(&'m Setting, f64)> {
        let of = |voice: &Voice<'m>| voice.overlay.settings.iter().zip(std::iter::repeat(voice.confidence));
        self.voices.iter().flat_map(of).collect()
    }

    fn decide(&self) -> Decision {
        decide(self.rules, &self.evidence, &self.matched, &self.voiced())
    }

    /// Category, kind, scale and every attribute of the model.
    #[must_use]
    pub fn answer(&self) -> Mapped {
        let rules = self.rules;
        let voiced = self.voiced();
        let decision = self.decide();
        let mut settings: Vec<&Setting> = Vec::with_capacity(16);
        if let Some(category) = decision.category {
            settings.extend(&rules.categories[category].settings);
        }
        if let Some(subcategory) = decision.subcategory {
            settings.extend(&rules.subcategories[subcategory].settings);
        }
        let base = settings.len();
        settings.extend(self.matched.iter().flat_map(|rule| &rule.set));
        // The file's own word stands above a machine's and below people's.
        let stated = stated::settings(&self.facts);
        let below = voiced.partition_point(|(setting, _)| setting.by.layer < Layer::File);
        settings.extend(voiced[..below].iter().map(|(setting, _)| *setting));
        settings.extend(&stated);
        settings.extend(voiced[below..].iter().map(|(setting, _)| *setting));
        let word = material::word(rules, &self.facts, &self.evidence, &settings, decision.category.is_some());
        if let Some(word) = &word {
            settings.insert(base, word);
        }
        let resolved = resolve(rules, &settings);
        let misfits = consistency::misfits(rules, resolved.kind, &settings);
        let mut mapped = self.finish(decision, resolved);
        mapped.findings.extend(misfits);
        mapped
    }

    fn finish(&self, decision: Decision, mut resolved: Resolved) -> Mapped {
        let (rules, facts) = (self.rules, &*self.facts);
        let target = match (decision.subcategory, decision.category) {
            (Some(id), _) => Some(Target::Subcategory(id)),
            (None, Some(id)) => Some(Target::Category(id)),
            (None, None) => None,
        };
        let what = target.map_or("thing", |target| name_of(rules, target));
        let size = target.and_then(|target| size_range(rules, target));
        let mass_range = target.and_then(|target| mass_range(rules, target));
        let scale = match &resolved.unit {
            Some((unit, metres, by)) => Scale {
                metres_per_unit: *metres,
                unit: Arc::clone(unit),
                reason: format!("set by {} at {}", by.by, by.place()),
                suspect: false,
                inferred: false,
            },
            None => scale::infer(facts, size, what),
        };
        let contents = resolved.contents.as_ref().and_then(|(preset, fill, by)| {
            let preset = &rules.presets[*preset];
            let density_kg_m3 = preset.number("density")?;
            Some(Contents { preset: Arc::clone(&preset.name), fill: *fill, density_kg_m3, by: by.clone() })
        });
        let mut findings: Vec<Finding> = Vec::new();
        let overlays: Vec<&Overlay> = self.voices.iter().map(|voice| voice.overlay).collect();
        let parts = parts(rules, facts, &resolved, &overlays);
        let weigh = Weighing {
            facts,
            scale: &scale,
            size,
            mass_range,
            contents: contents.as_ref(),
            parts: &parts,
            is_content: target.is_some_and(|target| is_content(rules, target)),
        };
        weigh.into_chain(&mut resolved, &mut findings);

        let spec = rules.kind(resolved.kind);
        let mut attributes: Vec<Attribute> = Vec::with_capacity(spec.attributes.len());
        for id in &spec.attributes {
            attributes.extend(attribute(*id, None, std::mem::take(&mut resolved.chains[*id])));
        }
        for (index, part) in parts.into_iter().enumerate() {
            let Some(part) = part else { continue };
            for (id, chain) in part.chains.into_iter().enumerate() {
                attributes.extend(attribute(id, u32::try_from(index).ok(), chain));
            }
        }
        let mut mapped = Mapped {
            category: decision.category.map(|id| Arc::clone(&rules.categories[id].name)),
            subcategory: decision.subcategory.map(|id| Arc::clone(&rules.subcategories[id].name)),
            synset: decision.subcategory.and_then(|id| rules.subcategories[id].synset.clone()),
            kind: resolved.kind,
            preset: resolved.preset.as_ref().map(|(id, _)| Arc::clone(&rules.presets[*id].name)),
            preset_by: resolved.preset.map(|(_, by)| by),
            confidence: decision.confidence,
            mass_model: resolved.mass_model.0,
            mass_model_by: resolved.mass_model.1,
            contents,
            anchored: resolved.anchored,
            scale,
            collider_tolerance: resolved
                .collider_tolerance
                .map(|(metres, by)| ColliderTolerance { metres, by }),
            attributes,
            trace: decision.trace,
            findings,
        };
        consistency::check(rules, facts, &mut mapped);
        mapped
    }
}

/// Food, drink, and what they come in.
fn is_content(rules: &Ruleset, target: Target) -> bool {
    rules.group(target).is_some_and(|group| {
        let kinds = ["food", "packaged", "beverage", "can_jar", "bottle", "substance", "toiletry"];
        kinds.iter().any(|kind| group.starts_with(kind))
    })
}

/// How sure the catalogue is of what the model is.
fn sureness(evidence: &Evidence, matched: &[&Rule]) -> f64 {
    let names = |rule: &&&Rule| {
        rule.set.iter().any(|setting| matches!(setting.what, What::Category(_) | What::Subcategory(_)))
    };
    let rules = matched.iter().filter(names).map(|rule| rule.confidence);
    evidence.candidates.first().map(|best| best.confidence).into_iter().chain(rules).fold(0.0, f64::max)
}

fn attribute(id: AttributeId, part: Option<u32>, mut chain: Chain) -> Option<Attribute> {
    let (value, provenance) = chain.pop()?;
    let (name, unit) = interned(id);
    let overrode = chain.into_iter().rev().map(|(value, by)| (Value::Number(value), by)).collect();
    Some(Attribute {
        name,
        class: ATTRIBUTES[id].class,
        value: Value::Number(value),
        unit,
        part,
        provenance,
        overrode,
    })
}

fn name_of(rules: &Ruleset, target: Target) -> &str {
    match target {
        Target::Subcategory(id) => &rules.subcategories[id].name,
        Target::Category(id) => &rules.categories[id].name,
    }
}

fn mass_range(rules: &Ruleset, target: Target) -> Option<&Range> {
    match target {
        Target::Category(id) => rules.categories[id].mass.as_ref(),
        Target::Subcategory(id) => {
            let subcategory = &rules.subcategories[id];
            subcategory.mass.as_ref().or(rules.categories[subcategory.category].mass.as_ref())
        }
    }
}
