//! The static layer: rules and overrides without a model.

use std::collections::{BTreeMap, BTreeSet};

use mapper::{
    ATTRIBUTES, Figure, Kind, Overrides, Provenance, Ruleset, Setting, What, attribute_id, check_rules,
};

use super::super::adopt;
use super::super::observation::Observation;
use super::super::place::{Place, Places};

/// Faults of rules and overrides. `floor`: the preset that drops land on, which is used by that alone.
#[must_use]
pub fn rules(rules: &Ruleset, overrides: &Overrides, floor: &str, places: &Places) -> Vec<Observation> {
    let mut seen: Vec<Observation> =
        check_rules(rules).iter().filter_map(|found| adopt::finding(found, places, None)).collect();
    let sight = Sight { rules, overrides, places };
    sight.presets(&mut seen);
    sight.pairs(&mut seen);
    sight.settings(&mut seen);
    sight.empty(&mut seen);
    sight.doubled(&mut seen);
    sight.unused_presets(floor, &mut seen);
    sight.unused_sources(&mut seen);
    seen
}

struct Sight<'a> {
    rules: &'a Ruleset,
    overrides: &'a Overrides,
    places: &'a Places,
}

impl Sight<'_> {
    fn at(&self, observation: Observation, by: &Provenance) -> Observation {
        observation.at(self.places.of(by, None)).because(&by.by)
    }

    fn presets(&self, seen: &mut Vec<Observation>) {
        for preset in &self.rules.presets {
            let figure = |name: &str| preset.figures[attribute_id(name)?].as_ref();
            if let (Some(held), Some(sliding)) = (figure("friction_static"), figure("friction_dynamic"))
                && held.value < sliding.value
            {
                let message = format!(
                    "preset `{}`: static friction {} is below dynamic friction {}",
                    preset.name, held.value, sliding.value
                );
                seen.push(self.at(Observation::fact("ATT003", message), &held.by));
            }
            let named = |what: &str| format!("{what} of preset `{}`", preset.name);
            if preset.kind == Kind::Rigid {
                for (name, figure) in
                    [("restitution", figure("restitution")), ("friction_static", figure("friction_static"))]
                {
                    seen.extend(figure.map(|figure| self.beyond(name, figure, &named(name))));
                }
                if let Some(figure) = figure("friction_dynamic") {
                    let message = named("friction_dynamic");
                    seen.push(self.at(Observation::measured("ATT011", figure.value, message), &figure.by));
                }
            }
            for (spec, figure) in ATTRIBUTES.iter().zip(&preset.figures) {
                if let Some(figure) = figure.as_ref().filter(|figure| figure.by.cites.is_none()) {
                    seen.push(self.at(
                        Observation::fact("ATT012", format!("{} cites no source", named(spec.name))),
                        &figure.by,
                    ));
                }
            }
        }
    }

    fn beyond(&self, name: &str, figure: &Figure, message: &str) -> Observation {
        let code = if name == "restitution" { "ATT009" } else { "ATT010" };
        self.at(Observation::measured(code, figure.value, message), &figure.by)
    }

    fn pairs(&self, seen: &mut Vec<Observation>) {
        for pair in &self.rules.pairs {
            let [one, other] = pair.between.map(|id| &self.rules.presets[id].name);
            if let (Some(held), Some(sliding)) = (&pair.friction_static, &pair.friction_dynamic)
                && held.value < sliding.value
            {
                let message = format!(
                    "{one} on {other}: static friction {} is below dynamic friction {}",
                    held.value, sliding.value
                );
                seen.push(self.at(Observation::fact("ATT008", message), &held.by));
            }
        }
    }

    /// Values that categories, rules and overrides set by themselves.
    fn settings(&self, seen: &mut Vec<Observation>) {
        for setting in self.all_settings() {
            let What::Attribute(id, value) = setting.what else { continue };
            let (name, by) = (ATTRIBUTES[id].name, &setting.by);
            let message = format!("{name} set by {}", by.by);
            let code = match name {
                "restitution" => "ATT009",
                "friction_static" => "ATT010",
                "friction_dynamic" => "ATT011",
                _ => continue,
            };
            seen.push(self.at(Observation::measured(code, value, message), by));
        }
    }

    fn all_settings(&self) -> impl Iterator<Item = &Setting> {
        let rules = self.rules;
        let overlays = self.overrides.entries.iter().map(|entry| &entry.overlay);
        (rules.categories.iter().flat_map(|category| &category.settings))
            .chain(rules.subcategories.iter().flat_map(|subcategory| &subcategory.settings))
            .chain(rules.rules.iter().flat_map(|rule| &rule.set))
            .chain(overlays.flat_map(|overlay| {
                overlay.settings.iter().chain(overlay.parts.iter().flat_map(|part| &part.settings))
            }))
    }

    fn empty(&self, seen: &mut Vec<Observation>) {
        for rule in self.rules.rules.iter().filter(|rule| rule.set.is_empty()) {
            seen.push(
                self.at(
                    Observation::fact("MAP017", format!("rule `{}` sets nothing", rule.name)),
                    &rule.place,
                ),
            );
        }
        for entry in &self.overrides.entries {
            if entry.overlay.settings.is_empty()
                && entry.overlay.parts.iter().all(|part| part.settings.is_empty())
            {
                seen.push(self.at(Observation::fact("MAP017", "this override sets nothing"), &entry.place));
            }
        }
    }

    /// Entries of one layer, by the first of their globs: a project file over a proposal is how it is meant.
    fn doubled(&self, seen: &mut Vec<Observation>) {
        let mut first: BTreeMap<(&str, mapper::Layer, String), &Provenance> = BTreeMap::new();
        for entry in &self.overrides.entries {
            for setting in &entry.overlay.settings {
                let key = (&*entry.place.by, entry.place.layer, name_of(&setting.what));
                if entry.place.layer == mapper::Layer::Proposal {
                    continue;
                }
                let name = key.2.clone();
                if let Some(earlier) = first.insert(key, &setting.by) {
                    let message = format!("{name} is set again at {}, which wins", setting.by.place());
                    seen.push(self.at(Observation::fact("MAP016", message), earlier));
                }
            }
        }
    }

    fn unused_presets(&self, floor: &str, seen: &mut Vec<Observation>) {
        let rules = self.rules;
        let mut used: BTreeSet<usize> = rules.kinds.iter().map(|kind| kind.preset).collect();
        used.extend(rules.pairs.iter().flat_map(|pair| pair.between));
        used.extend(self.all_settings().filter_map(|setting| match setting.what {
            What::Preset(id) | What::Contents { preset: id, .. } => Some(id),
            _ => None,
        }));
        for (id, preset) in rules.presets.iter().enumerate() {
            if !used.contains(&id) && preset.aliases.is_empty() && &*preset.name != floor {
                let message = format!("nothing names preset `{}`", preset.name);
                seen.push(self.at(Observation::fact("MAP018", message), &preset.place));
            }
        }
    }

    fn unused_sources(&self, seen: &mut Vec<Observation>) {
        let rules = self.rules;
        let figures = rules.presets.iter().flat_map(|preset| preset.figures.iter().flatten());
        let of_pair = rules.pairs.iter().flat_map(|pair| {
            [&pair.friction_static, &pair.friction_dynamic, &pair.restitution].into_iter().flatten()
        });
        let defaults = rules.defaults.iter().flatten();
        let cited = figures.chain(of_pair).chain(defaults).filter_map(|figure| figure.by.cites.as_deref());
        let set = self.all_settings().filter_map(|setting| setting.by.cites.as_deref());
        let used: BTreeSet<&str> = cited.chain(set).flat_map(|cites| cites.split(", ")).collect();
        let mut idle: Vec<&str> =
            rules.sources.keys().map(|key| &**key).filter(|key| !used.contains(key)).collect();
        idle.sort_unstable();
        for key in idle {
            let place = line_of_source(rules.text(), key).map(|(line, column)| Place {
                built_in: self.places.catalog.is_none(),
                ..Place::at(&rules.file, line, column)
            });
            seen.push(Observation::fact("MAP019", format!("nothing cites `{key}`")).at(place).because(key));
        }
    }
}

/// Where a source is defined: the mapper keeps their texts, not their places.
fn line_of_source(text: &str, key: &str) -> Option<(u32, u32)> {
    let lines = (1_u32..).zip(text.lines()).skip_while(|(_, line)| !line.starts_with("sources:")).skip(1);
    for (number, line) in lines.take_while(|(_, line)| line.starts_with([' ', '#']) || line.is_empty()) {
        let trimmed = line.trim_start();
        if trimmed.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(':')) {
            return Some((number, u32::try_from(line.len() - trimmed.len() + 1).unwrap_or(0)));
        }
    }
    None
}

fn name_of(what: &What) -> String {
    match what {
        What::Category(_) | What::Subcategory(_) => "category",
        What::Kind(_) => "kind",
        What::Preset(_) => "preset",
        What::MassModel(_) => "mass_model",
        What::Anchored(_) => "anchored",
        What::Contents { .. } => "contents",
        What::Unit { .. } => "unit",
        What::ColliderTolerance { .. } => "collider_tolerance",
        What::Attribute(id, _) => ATTRIBUTES[*id].name,
    }
    .to_owned()
}
