//! Which layers run.

use super::rule::Layer;

/// Any of the three layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers([bool; 3]);

impl Layers {
    pub const ALL: Self = Self([true; 3]);

    #[must_use]
    pub fn only(layers: &[Layer]) -> Self {
        Self(Layer::ALL.map(|layer| layers.contains(&layer)))
    }

    #[must_use]
    pub const fn holds(self, layer: Layer) -> bool {
        self.0[layer as usize]
    }

    #[must_use]
    pub fn and(self, wanted: impl Fn(Layer) -> bool) -> Self {
        Self(Layer::ALL.map(|layer| self.holds(layer) && wanted(layer)))
    }

    /// `static, data`
    #[must_use]
    pub fn written(self) -> String {
        let names = Layer::ALL.into_iter().filter(|layer| self.holds(*layer)).map(Layer::name);
        names.collect::<Vec<_>>().join(", ")
    }
}
