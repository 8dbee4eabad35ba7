//! What the solver is told of presets in contact: surfaces, and the pairs that are known.

use std::collections::BTreeSet;

use sim::{MaterialPair, Scene, Surface};

use crate::rules::preset::{Figure, Pair};
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::PresetId;

impl Ruleset {
    /// Dynamic friction, restitution and rolling resistance of a preset, as a contact sees them; of its material, so
    /// that the scene's pairs apply.
    #[must_use]
    pub fn surface(&self, preset: &str) -> Option<Surface> {
        let id = *self.names.presets.get(preset)?;
        let preset = &self.presets[id];
        Some(Surface {
            friction: preset.number("friction_dynamic")?,
            restitution: preset.number("restitution")?,
            rolling_resistance: preset.number("rolling_resistance").unwrap_or(0.0),
            material: Some(material(id)),
        })
    }

    /// Dynamic friction and restitution known of two presets in contact.
    #[must_use]
    pub fn known_pair(&self, one: &str, other: &str) -> Option<MaterialPair> {
        let id = |name| self.names.presets.get(name).copied();
        let (one, other) = (id(one)?, id(other)?);
        let between = [one.min(other), one.max(other)];
        self.pairs.iter().find(|pair| pair.between == between).map(contact)
    }

    /// Gives a scene what is known of the materials that are in it.
    pub fn lay_pairs(&self, scene: &mut Scene) {
        let materials: BTreeSet<u32> = scene
            .entities
            .iter()
            .flat_map(|entity| &entity.shapes)
            .filter_map(|shape| shape.surface.material)
            .collect();
        let there = |pair: &MaterialPair| pair.between.iter().all(|material| materials.contains(material));
        scene.pairs = self.pairs.iter().map(contact).filter(there).collect();
    }
}

/// A preset's number as a material of a scene.
fn material(preset: PresetId) -> u32 {
    u32::try_from(preset).unwrap_or(u32::MAX)
}

fn contact(pair: &Pair) -> MaterialPair {
    let value = |figure: &Option<Figure>| figure.as_ref().map(|figure| figure.value);
    MaterialPair {
        between: pair.between.map(material),
        friction: value(&pair.friction_dynamic),
        restitution: value(&pair.restitution),
    }
}
