//! The looks of the demo's models. The names carry the words that the mapper looks for.

use super::glb::Material;

const fn opaque(name: &'static str, [red, green, blue]: [f32; 3], metallic: f32, roughness: f32) -> Material {
    Material { name, color: [red, green, blue, 1.0], metallic, roughness }
}

const fn clear(name: &'static str, [red, green, blue]: [f32; 3], opacity: f32) -> Material {
    Material { name, color: [red, green, blue, opacity], metallic: 0.0, roughness: 0.1 }
}

pub(super) const OAK: Material = opaque("oak", [0.50, 0.29, 0.12], 0.0, 0.7);
pub(super) const PINE: Material = opaque("pine", [0.74, 0.51, 0.27], 0.0, 0.8);
pub(super) const STEEL: Material = opaque("steel", [0.56, 0.58, 0.60], 1.0, 0.35);
pub(super) const CAST_IRON: Material = opaque("cast iron", [0.10, 0.10, 0.11], 0.9, 0.6);
pub(super) const BRASS: Material = opaque("brass", [0.72, 0.50, 0.16], 1.0, 0.3);
pub(super) const CERAMIC: Material = opaque("ceramic", [0.72, 0.20, 0.13], 0.0, 0.3);
pub(super) const PORCELAIN: Material = opaque("porcelain", [0.86, 0.85, 0.80], 0.0, 0.2);
pub(super) const GLASS: Material = clear("glass", [0.55, 0.78, 0.70], 0.55);
pub(super) const RUBBER: Material = opaque("rubber", [0.75, 0.09, 0.08], 0.0, 0.9);
pub(super) const LINEN: Material = opaque("linen", [0.88, 0.80, 0.62], 0.0, 0.95);
pub(super) const PAPER: Material = opaque("paper", [0.20, 0.34, 0.58], 0.0, 0.9);
pub(super) const COTTON: Material = opaque("cotton", [0.26, 0.52, 0.66], 0.0, 0.95);
pub(super) const PILLOW: Material = opaque("pillow cotton", [0.90, 0.88, 0.84], 0.0, 0.95);
pub(super) const PLUSH: Material = opaque("plush", [0.45, 0.26, 0.13], 0.0, 1.0);
pub(super) const FOAM: Material = opaque("foam", [0.92, 0.76, 0.20], 0.0, 1.0);
pub(super) const WATER: Material = clear("water", [0.25, 0.52, 0.86], 0.6);
pub(super) const MILK: Material = clear("milk", [0.95, 0.94, 0.88], 0.95);
pub(super) const HONEY: Material = clear("honey", [0.85, 0.48, 0.05], 0.85);
pub(super) const BARK: Material = opaque("bark", [0.28, 0.18, 0.10], 0.0, 0.95);
pub(super) const LEAVES: Material = opaque("leaves", [0.16, 0.42, 0.12], 0.0, 0.9);
