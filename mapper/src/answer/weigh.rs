//! The mass of a model in its place among what was said of it: by the mass model, by the range of its kind, or part by
//! part.

use crate::answer::amount::{self, Stated};
use crate::answer::mass::{self, Geometry, Load};
use crate::answer::resolve::{Chain, Resolved, lay_preset};
use crate::attribute::{ATTRIBUTES, DENSITY, Layer, MASS, MassModel, Provenance, round};
use crate::facts::ModelFacts;
use crate::mapped::{Contents, Finding, Scale};
use crate::rules::category::Range;
use crate::rules::overrides::Overlay;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::What;

/// What overlays say of one part.
pub(crate) struct PartValues {
    pub chains: [Chain; ATTRIBUTES.len()],
    pub mass_model: MassModel,
}

/// All that the mass of a model hangs on.
pub(crate) struct Weighing<'a> {
    pub facts: &'a ModelFacts,
    pub scale: &'a Scale,
    pub size: Option<&'a Range>,
    pub mass_range: Option<&'a Range>,
    pub contents: Option<&'a Contents>,
    pub parts: &'a [Option<PartValues>],
    /// It is sold by what it holds: food, drink and what they come in. Of another vessel a volume is what goes in.
    pub is_content: bool,
}

impl Weighing<'_> {
    /// Puts the computed mass into its place in the chain: at the layer of the mass model.
    pub fn into_chain(self, resolved: &mut Resolved, findings: &mut Vec<Finding>) {
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
            let of_material = of_material(model, range, &resolved.chains[DENSITY]);
            let range = of_material.as_ref().unwrap_or(range);
            let longest_m = self.facts.longest().map(|longest| longest * self.scale.metres_per_unit);
            let share = if longest_m.is_none() { mass::share_of_words(self.facts) } else { None };
            let by_range = mass::by_size(range, self.size, longest_m, share);
            // What is of one material through and through cannot weigh more than its hull filled with it: such a range
            // is that of larger things.
            let measured = geometry.filter(|geometry| !geometry.rough && model == MassModel::Solid);
            let most = measured.and_then(|geometry| geometry.hull_m3).map(|hull_m3| density * hull_m3);
            let typical = most.map_or(by_range, |most| by_range.min(most));
            let outside = computed.filter(|mass_kg| !range.contains(*mass_kg));
            if let Some(mass_kg) = outside {
                findings.push(Finding {
                    code: "MAP003".into(),
                    message: format!(
                        "the mass model set at {} gives {} kg, such things weigh {} to {} kg by {}{}",
                        model_by.place(),
                        round(mass_kg),
                        round(range.low),
                        round(range.high),
                        range.place.place(),
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
            } else if outside.is_some() && typical < by_range {
                Some("mass-range: no more than its hull of this material")
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
            if let Some((mass_kg, phrase)) = self.stated(range, density).filter(|_| !by_people) {
                let by = format!("mass-stated: \"{phrase}\" in its names");
                entries.push((mass_kg, Provenance { layer, by: by.into(), ..range.place.clone() }));
            }
        }
        let chain = &mut resolved.chains[MASS];
        let at = chain.partition_point(|(_, by)| by.layer < layer);
        chain.splice(at..at, entries);
    }

    /// The mass that the model's names state, where such things may have it: a rope for 100 kg does not weigh that.
    fn stated(&self, range: &Range, density: f64) -> Option<(f64, String)> {
        let amount = amount::stated(self.facts)?;
        let mass_kg = match amount.of {
            Stated::MassKg(mass_kg) => mass_kg,
            Stated::VolumeM3(volume) => {
                let density = self.contents.map_or(density, |contents| contents.density_kg_m3);
                self.is_content.then_some(volume * density.clamp(700.0, 1500.0))?
            }
        };
        (range.excess(mass_kg) <= 2.0).then_some((mass_kg, amount.phrase))
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

/// The range of a solid thing that is made of something else than its kind usually is: a plastic bolt weighs an eighth
/// of a steel one. Of what is hollow the heavier material makes thinner walls, and the range stays.
fn of_material(model: MassModel, range: &Range, densities: &Chain) -> Option<Range> {
    let (density, _) = densities.last()?;
    let (usual, _) = densities.iter().rev().find(|(_, by)| by.layer < Layer::Rule)?;
    let ratio = density / usual;
    (model == MassModel::Solid && (ratio - 1.0).abs() > 0.01).then(|| Range {
        low: range.low * ratio,
        high: range.high * ratio,
        place: range.place.clone(),
    })
}

/// What overlays say of single parts; `None` where nothing was said.
#[must_use]
pub(crate) fn parts(
    rules: &Ruleset,
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
                        lay_preset(rules, *id, setting.by.layer, Some(&setting.by), &mut values.chains);
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
