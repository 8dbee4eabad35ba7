//! Colours, sRGB and alpha: neutral ground, saturated signals.

use rerun::{AlbedoFactor, Color, Rgba32};
use sim::SleepState;

pub(crate) const GROUND: [u8; 4] = [92, 97, 106, 255];
pub(crate) const GRID: [u8; 4] = [255, 255, 255, 30];
pub(crate) const STATIC: [u8; 4] = [132, 136, 143, 255];
pub(crate) const CONTACT: [u8; 4] = [255, 70, 60, 255];
pub(crate) const IMPULSE: [u8; 4] = [255, 205, 60, 255];
pub(crate) const KINETIC: [u8; 4] = [232, 98, 78, 255];
pub(crate) const POTENTIAL: [u8; 4] = [86, 154, 240, 255];
pub(crate) const TOTAL: [u8; 4] = [225, 225, 225, 255];
pub(crate) const PENETRATION: [u8; 4] = [240, 180, 70, 255];
pub(crate) const COUNT: [u8; 4] = [120, 200, 140, 255];
pub(crate) const LABEL: [u8; 4] = [225, 228, 232, 255];
pub(crate) const STILL_PAD: [u8; 4] = [66, 94, 132, 255];
pub(crate) const EMPTY_PAD: [u8; 4] = [52, 55, 61, 255];
pub(crate) const BACKDROP: [u8; 4] = [46, 50, 57, 255];

/// Shades of bodies that nobody gave a colour, so that neighbours differ under the colour of their state.
const SHADES: [u8; 4] = [255, 222, 240, 206];

/// Shade of the `index`-th body without a visual.
pub(crate) fn body(index: usize) -> [u8; 4] {
    let shade = SHADES[index % SHADES.len()];
    [shade, shade, shade, 255]
}

/// The three states as solid colours: red active, green wants to sleep, grey asleep.
pub(crate) fn state(state: SleepState) -> [u8; 4] {
    match state {
        SleepState::Active => [226, 74, 62, 255],
        SleepState::Drowsy => [84, 190, 96, 255],
        SleepState::Asleep => [140, 144, 150, 255],
    }
}

/// The same, muted, for the pad under a model.
pub(crate) fn pad(sleep: SleepState) -> [u8; 4] {
    match sleep {
        SleepState::Active => [172, 62, 54, 255],
        SleepState::Drowsy => [62, 134, 74, 255],
        SleepState::Asleep => [98, 102, 110, 255],
    }
}

/// The same for the see-through collider overlay.
pub(crate) fn overlay(sleep: SleepState) -> [u8; 4] {
    let [r, g, b, _] = state(sleep);
    [r, g, b, 110]
}

/// Factor on a visual's own colours: tinted while it moves, its own once asleep.
pub(crate) fn tint(sleep: SleepState) -> [u8; 4] {
    match sleep {
        SleepState::Active => [255, 178, 166, 255],
        SleepState::Drowsy => [186, 255, 186, 255],
        SleepState::Asleep => [255, 255, 255, 255],
    }
}

/// Colour times factor, as the viewer multiplies them but for its gamma.
pub(crate) fn times(color: [u8; 4], factor: [u8; 4]) -> [u8; 4] {
    std::array::from_fn(|i| {
        let product = u16::from(color[i]) * u16::from(factor[i]) / 255;
        u8::try_from(product).unwrap_or(u8::MAX)
    })
}

pub(crate) fn color([r, g, b, a]: [u8; 4]) -> Color {
    Color::from_unmultiplied_rgba(r, g, b, a)
}

pub(crate) fn albedo([r, g, b, a]: [u8; 4]) -> AlbedoFactor {
    AlbedoFactor::from(Rgba32::from_unmultiplied_rgba(r, g, b, a))
}
