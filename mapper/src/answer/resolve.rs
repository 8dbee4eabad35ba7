//! Who has the last word on each value: layers laid over one another, the whole pile kept.
//!
//! Lowest first: built-in default, kind, preset, category, subcategory, rule, proposal, the model file's own physics,
//! project override, sidecar, command line. A preset's values stand at the layer `preset` where the catalogue chose it, and just below the explicit
//! values of its chooser where a rule, an override or the command line did: who writes `preset: steel` for a model
//! wants steel's density. Within a layer the more specific rule, then the later line, wins.

use std::sync::Arc;

use crate::attribute::{ATTRIBUTES, Kind, Layer, MassModel, Provenance};
use crate::rules::preset::Preset;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{PresetId, Setting, What};

/// Values of one attribute, lowest first: the last one holds.
pub(crate) type Chain = Vec<(f64, Provenance)>;

/// Everything but what needs geometry.
#[derive(Clone, Debug)]
pub(crate) struct Resolved {
    pub kind: Kind,
    pub preset: Option<(PresetId, Provenance)>,
    pub mass_model: (MassModel, Provenance),
    pub anchored: bool,
    pub contents: Option<(PresetId, f64, Provenance)>,
    pub unit: Option<(Arc<str>, f64, Provenance)>,
    pub collider_tolerance: Option<(f64, Provenance)>,
    pub chains: [Chain; ATTRIBUTES.len()],
}

/// Lays the settings over one another. They come lowest first.
#[must_use]
pub(crate) fn resolve(rules: &Ruleset, settings: &[&Setting]) -> Resolved {
    let kind = kind_of(&rules.presets, settings);
    let built_in = Provenance {
        layer: Layer::BuiltIn,
        file: Arc::clone(&rules.file),
        line: 0,
        column: 0,
        by: "default".into(),
        cites: None,
    };
    let mut resolved = Resolved {
        kind,
        preset: None,
        mass_model: (MassModel::Solid, built_in),
        anchored: false,
        contents: None,
        unit: None,
        collider_tolerance: None,
        chains: [const { Vec::new() }; ATTRIBUTES.len()],
    };
    for (chain, default) in resolved.chains.iter_mut().zip(&rules.defaults) {
        chain.extend(default.as_ref().map(|figure| (figure.value, figure.by.clone())));
    }
    let spec = rules.kind(kind);
    lay_preset(rules, spec.preset, Layer::Kind, None, &mut resolved.chains);
    // Presets that the catalogue chose stand below every explicit value, so they are laid first. One of another kind
    // gives what it has: upholstery, a soft thing, the density of a chair, a rigid one.
    for setting in settings.iter().filter(|setting| setting.by.layer < Layer::Rule) {
        if let What::Preset(id) = setting.what {
            lay_preset(rules, id, Layer::Preset, None, &mut resolved.chains);
            resolved.preset = Some((id, setting.by.clone()));
        }
    }
    let mut from = 0;
    while from < settings.len() {
        let layer = settings[from].by.layer;
        let to = from + settings[from..].iter().take_while(|setting| setting.by.layer == layer).count();
        lay_layer(rules, layer, &settings[from..to], &mut resolved);
        from = to;
    }
    resolved
}

fn lay_layer(rules: &Ruleset, layer: Layer, settings: &[&Setting], resolved: &mut Resolved) {
    for setting in settings {
        match &setting.what {
            What::Preset(id) if layer >= Layer::Rule => {
                lay_preset(rules, *id, layer, Some(&setting.by), &mut resolved.chains);
                resolved.preset = Some((*id, setting.by.clone()));
            }
            What::MassModel(model) => resolved.mass_model = (*model, setting.by.clone()),
            What::Anchored(anchored) => resolved.anchored = *anchored,
            What::Contents { preset, fill } => resolved.contents = Some((*preset, *fill, setting.by.clone())),
            What::ColliderTolerance { metres } => {
                resolved.collider_tolerance = Some((*metres, setting.by.clone()));
            }
            What::Unit { name, metres } => {
                resolved.unit = Some((Arc::clone(name), *metres, setting.by.clone()))
            }
            _ => {}
        }
    }
    for setting in settings {
        if let What::Attribute(id, value) = setting.what {
            resolved.chains[id].push((value, setting.by.clone()));
        }
    }
}

/// The explicit word of the highest layer; else the kind of the preset. Above the catalogue a preset has the last
/// word over the explicit kinds of lower layers.
#[must_use]
pub(crate) fn kind_of(presets: &[Preset], settings: &[&Setting]) -> Kind {
    kind_by(presets, settings).0
}

/// The same with the setting that decided, `None` where none did.
#[must_use]
pub(crate) fn kind_by<'s>(presets: &[Preset], settings: &[&'s Setting]) -> (Kind, Option<&'s Setting>) {
    let mut kind = (Kind::Rigid, None);
    let mut said = (Layer::BuiltIn, false);
    for setting in settings {
        let layer = setting.by.layer;
        match setting.what {
            What::Kind(explicit) if layer >= said.0 => {
                kind = (explicit, Some(*setting));
                said = (layer, true);
            }
            // A bottle of oil is filled by a liquid and is none; but who writes `preset: water` for a model means it.
            What::Preset(id) if !said.1 || (layer >= Layer::Rule && layer > said.0) => {
                kind = (presets[id].kind, Some(*setting));
                said = (layer, false);
            }
            _ => {}
        }
    }
    kind
}

/// Puts every value of a preset on top, at the layer of whoever chose it.
pub(crate) fn lay_preset(
    rules: &Ruleset,
    id: PresetId,
    layer: Layer,
    chooser: Option<&Provenance>,
    chains: &mut [Chain; ATTRIBUTES.len()],
) {
    let preset = &rules.presets[id];
    let by: Option<Arc<str>> =
        chooser.map(|chooser| format!("preset:{} by {}", preset.name, chooser.by).into());
    for (chain, figure) in chains.iter_mut().zip(&preset.figures) {
        let Some(figure) = figure else { continue };
        let mut provenance = Provenance { layer, ..figure.by.clone() };
        if let Some(by) = &by {
            provenance.by = Arc::clone(by);
        }
        chain.push((figure.value, provenance));
    }
}
