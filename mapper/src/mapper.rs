//! From facts to physics: the whole way for one model, without touching a file.

use std::sync::Arc;

use crate::attribute::{
    ATTRIBUTES, Attribute, AttributeId, DENSITY, Layer, MASS, MassModel, Provenance, Value, interned, round,
};
use crate::category::Range;
use crate::consistency;
use crate::decide::{Decision, decide};
use crate::facts::ModelFacts;
use crate::lexicon::Target;
use crate::mapped::{Contents, Finding, Mapped, Scale};
use crate::mass::{self, Geometry, Load};
use crate::matcher::{Evidence, Signal, gather, size_range};
use crate::overrides::{Overlay, Override, Overrides, SetValue, Sidecar};
use crate::resolve::{Chain, Resolved, kind_of, lay_preset, resolve};
use crate::rule::Rule;
use crate::ruleset::Ruleset;
use crate::scale;
use crate::settings::{Setting, What};
use crate::tags::Tags;

/// Rules and project overrides; maps any number of models, from any number of threads.
#[derive(Clone, Debug)]
pub struct Mapper {
    rules: Ruleset,
    overrides: Overrides,
    tags: Tags,
}

impl Mapper {
    #[must_use]
    pub fn new(rules: Ruleset, overrides: Overrides) -> Self {
        Self { rules, overrides, tags: Tags::default() }
    }

    /// The same with tags of models, which are read beside those that a model brings.
    #[must_use]
    pub fn with_tags(self, tags: Tags) -> Self {
        Self { tags, ..self }
    }

    #[must_use]
    pub fn tags(&self) -> &Tags {
        &self.tags
    }

    #[must_use]
    pub fn rules(&self) -> &Ruleset {
        &self.rules
    }

    #[must_use]
    pub fn overrides(&self) -> &Overrides {
        &self.overrides
    }

    /// Category, kind, scale and every attribute of a model.
    #[must_use]
    pub fn map(&self, facts: &ModelFacts, cli: &[SetValue]) -> Mapped {
        self.map_with_sidecar(facts, None, cli)
    }

    /// The same with the file beside the model.
    #[must_use]
    pub fn map_with_sidecar(
        &self,
        facts: &ModelFacts,
        sidecar: Option<&Sidecar>,
        cli: &[SetValue],
    ) -> Mapped {
        let rules = &self.rules;
        let tagged = self.tagged(facts);
        let facts = tagged.as_ref().unwrap_or(facts);
        let evidence = gather(rules, facts);
        let mut matched: Vec<&Rule> =
            rules.rules.iter().filter(|rule| rule.when.holds(rules, facts, &evidence)).collect();
        // Stable: within one specificity the order of the file stays, and the later line wins.
        matched.sort_by_key(|rule| rule.specificity);
        let sure = sureness(&evidence, &matched);
        let mut entries: Vec<&Override> = self
            .overrides
            .entries
            .iter()
            .filter(|entry| entry.place.layer > Layer::Proposal || entry.confidence > sure)
            .filter(|entry| entry.matches(&facts.model))
            .collect();
        // Below people's, and the surer later.
        entries.sort_by(|a, b| a.place.layer.cmp(&b.place.layer).then(a.confidence.total_cmp(&b.confidence)));
        let overlays: Vec<(&Overlay, f64)> = entries
            .into_iter()
            .map(|entry| (&entry.overlay, entry.confidence))
            .chain(sidecar.map(|sidecar| (&sidecar.overlay, 1.0)))
            .chain(cli.iter().map(|set| (&set.overlay, 1.0)))
            .collect();
        let voiced: Vec<(&Setting, f64)> = overlays
            .iter()
            .flat_map(|(overlay, confidence)| overlay.settings.iter().map(|setting| (setting, *confidence)))
            .collect();
        let decision = decide(rules, &evidence, &matched, &voiced);
        let overlays: Vec<&Overlay> = overlays.into_iter().map(|(overlay, _)| overlay).collect();

        let mut settings: Vec<&Setting> = Vec::with_capacity(16);
        if let Some(category) = decision.category {
            settings.extend(&rules.categories[category].settings);
        }
        if let Some(subcategory) = decision.subcategory {
            settings.extend(&rules.subcategories[subcategory].settings);
        }
        let base = settings.len();
        settings.extend(matched.iter().flat_map(|rule| &rule.set));
        settings.extend(voiced.iter().map(|(setting, _)| *setting));
        let word = self.material_word(facts, &evidence, &settings, decision.category.is_some());
        if let Some(word) = &word {
            settings.insert(base, word);
        }
        let resolved = resolve(rules, &settings);
        self.finish(facts, decision, resolved, &overlays)
    }

    /// With the manifest's tags of this model; `None` where there are none.
    fn tagged(&self, facts: &ModelFacts) -> Option<ModelFacts> {
        let tags = self.tags.of(&facts.model);
        (!tags.is_empty()).then(|| {
            let mut facts = facts.clone();
            facts.tags.extend_from_slice(tags);
            facts
        })
    }

    /// A material named in name, folders, tags or materials becomes the preset, where it is of the right kind.
    fn material_word(
        &self,
        facts: &ModelFacts,
        evidence: &Evidence,
        settings: &[&Setting],
        categorized: bool,
    ) -> Option<Setting> {
        let kind = kind_of(&self.rules.presets, settings);
        let fits = |preset: usize| !categorized || self.rules.presets[preset].kind == kind;
        let named = evidence.materials.iter().find(|word| {
            !matches!(word.signal, Signal::Material | Signal::Node)
                && fits(word.preset)
                && !(word.head && categorized && word.signal == Signal::Name)
        });
        let word = match named {
            Some(word) => word,
            None => self.dominant_material(facts, evidence, &fits)?,
        };
        let by = Provenance { layer: Layer::Rule, by: "rule:material-word".into(), ..word.by.clone() };
        Some(Setting { what: What::Preset(word.preset), by })
    }

    /// The one material that the file's material names agree on, or that covers most of the surface.
    fn dominant_material<'e>(
        &self,
        facts: &ModelFacts,
        evidence: &'e Evidence,
        fits: &dyn Fn(usize) -> bool,
    ) -> Option<&'e crate::matcher::MaterialWord> {
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

    fn finish(
        &self,
        facts: &ModelFacts,
        decision: Decision,
        mut resolved: Resolved,
        overlays: &[&Overlay],
    ) -> Mapped {
        let rules = &self.rules;
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
            },
            None => scale::infer(facts, size, what),
        };
        let contents = resolved.contents.as_ref().and_then(|(preset, fill, by)| {
            let preset = &rules.presets[*preset];
            let density_kg_m3 = preset.number("density")?;
            Some(Contents { preset: Arc::clone(&preset.name), fill: *fill, density_kg_m3, by: by.clone() })
        });
        let mut findings: Vec<Finding> = Vec::new();
        let parts = self.parts(facts, &resolved, overlays);
        let weigh =
            Weighing { facts, scale: &scale, size, mass_range, contents: contents.as_ref(), parts: &parts };
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
            attributes,
            trace: decision.trace,
            findings,
        };
        consistency::check(rules, facts, &mut mapped);
        mapped
    }

    /// What overlays say of single parts; `None` where nothing was said.
    fn parts(
        &self,
        facts: &ModelFacts,
        resolved: &Resolved,
        overlays: &[&Overlay],
    ) -> Vec<Option<PartValues>> {
        let all = overlays.iter().flat_map(|overlay| &overlay.parts);
        if all.clone().next().is_none() {
            return Vec::new();
        }
        let mut parts = Vec::with_capacity(facts.parts.len());
        for (index, part) in facts.parts.iter().enumerate() {
            let mut values: Option<PartValues> = None;
            for overlay in all.clone().filter(|overlay| overlay.selector.matches(index, &part.name)) {
                let values = values.get_or_insert(PartValues {
                    chains: [const { Vec::new() }; ATTRIBUTES.len()],
                    mass_model: resolved.mass_model.0,
                });
                for setting in &overlay.settings {
                    match &setting.what {
                        What::Preset(id) => {
                            lay_preset(
                                &self.rules,
                                *id,
                                setting.by.layer,
                                Some(&setting.by),
                                &mut values.chains,
                            );
                        }
                        What::MassModel(model) => values.mass_model = *model,
                        What::Attribute(id, value) => values.chains[*id].push((*value, setting.by.clone())),
                        _ => {}
                    }
                }
            }
            parts.push(values);
        }
        parts
    }
}

struct PartValues {
    chains: [Chain; ATTRIBUTES.len()],
    mass_model: MassModel,
}

/// All that the mass of a model hangs on.
struct Weighing<'a> {
    facts: &'a ModelFacts,
    scale: &'a Scale,
    size: Option<&'a Range>,
    mass_range: Option<&'a Range>,
    contents: Option<&'a Contents>,
    parts: &'a [Option<PartValues>],
}

impl Weighing<'_> {
    /// Puts the computed mass into its place in the chain: at the layer of the mass model.
    fn into_chain(self, resolved: &mut Resolved, findings: &mut Vec<Finding>) {
        let (model, model_by) = resolved.mass_model.clone();
        let Some((density, density_by)) = resolved.chains[DENSITY].last().cloned() else { return };
        let geometry = Geometry::of_model(self.facts, self.scale.metres_per_unit);
        let load =
            self.contents.map(|contents| Load { density: contents.density_kg_m3, fill: contents.fill });
        let computed =
            self.sum_of_parts(model, density).or_else(|| mass::by_model(model, density, geometry, load));
        let layer = model_by.layer;
        let mut entries: Chain = Vec::new();
        if let Some(mass_kg) = computed {
            let summed = if self.parts.iter().any(Option::is_some) { ", summed over parts" } else { "" };
            let by = match model {
                MassModel::Fixed { .. } => format!("mass-model:{model}"),
                _ => format!("mass-model:{model} x density at {}{summed}", density_by.place()),
            };
            entries.push((mass_kg, Provenance { by: by.into(), ..model_by.clone() }));
        }
        // What people said of density or mass model is taken at its word.
        let by_people =
            layer.max(density_by.layer) >= Layer::Project || self.parts.iter().any(Option::is_some);
        if let Some(range) = self.mass_range {
            let longest_m = self.facts.longest().map(|longest| longest * self.scale.metres_per_unit);
            let share = if longest_m.is_none() { mass::share_of_words(self.facts) } else { None };
            let typical = mass::by_size(range, self.size, longest_m, share);
            let outside = computed.filter(|mass_kg| !range.contains(*mass_kg));
            if let Some(mass_kg) = outside {
                findings.push(Finding {
                    code: "MAP003".into(),
                    message: format!(
                        "the mass model gives {} kg, such things weigh {} to {} kg{}",
                        round(mass_kg),
                        round(range.low),
                        round(range.high),
                        if by_people { "" } else { "; their range is used" }
                    ),
                    place: Some(model_by.clone()),
                });
            }
            let fixed = matches!(model, MassModel::Fixed { .. });
            let rough = !fixed && geometry.is_none_or(|geometry| geometry.rough);
            let why = if computed.is_none() {
                Some("mass-range: no geometry for the mass model")
            } else if by_people {
                None
            } else if outside.is_some() {
                Some("mass-range: the mass model leads outside it")
            } else if rough {
                Some("mass-range: the volume is only estimated")
            } else {
                None
            };
            if let Some(by) = why {
                entries.push((typical, Provenance { layer, by: by.into(), ..range.place.clone() }));
            }
        }
        let chain = &mut resolved.chains[MASS];
        let at = chain.partition_point(|(_, by)| by.layer < layer);
        chain.splice(at..at, entries);
    }

    /// Where a part has its own density or mass model, each part is weighed by itself.
    fn sum_of_parts(&self, model: MassModel, density: f64) -> Option<f64> {
        if !self.parts.iter().any(Option::is_some) {
            return None;
        }
        let mut total = 0.0;
        for (part, values) in self.facts.parts.iter().zip(self.parts) {
            let geometry = Some(Geometry::of_shape(&part.shape, self.scale.metres_per_unit));
            let own = values.as_ref();
            let fixed = own.and_then(|values| values.chains[MASS].last());
            total += match fixed {
                Some((mass_kg, _)) => *mass_kg,
                None => {
                    let density = own
                        .and_then(|values| values.chains[DENSITY].last())
                        .map_or(density, |(value, _)| *value);
                    mass::by_model(own.map_or(model, |values| values.mass_model), density, geometry, None)?
                }
            };
        }
        (total > 0.0).then_some(total)
    }
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
