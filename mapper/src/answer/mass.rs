//! How heavy? Density and geometry by the mass model, held against what such things weigh.

use crate::attribute::MassModel;
use crate::facts::{ModelFacts, ShapeFacts};
use crate::rules::category::Range;

/// Share of its bounding box that an ordinary thing encloses, where there is no mesh to ask: between the
/// ball's 0.52 and a chair's 0.2.
const BOX_FILL: f64 = 0.42;
/// Surface of an ordinary thing over that of its bounding box.
const BOX_AREA: f64 = 0.80;
/// Share of the hull that a hollow thing can hold.
const HOLLOW: f64 = 0.85;

/// Volumes in m³ and an area in m²; what the mass models work on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Geometry {
    pub volume_m3: Option<f64>,
    pub area_m2: Option<f64>,
    pub hull_m3: Option<f64>,
    /// Not measured on a closed surface.
    pub rough: bool,
}

/// What a vessel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Load {
    pub density: f64,
    pub fill: f64,
}

impl Geometry {
    /// Of a mesh, in metres.
    #[must_use]
    pub(crate) fn of_shape(shape: &ShapeFacts, metres_per_unit: f64) -> Self {
        let cubed = metres_per_unit.powi(3);
        Self {
            volume_m3: shape.volume.map(|volume| volume * cubed),
            area_m2: shape.area.map(|area| area * metres_per_unit.powi(2)),
            hull_m3: shape.hull_volume.or(shape.volume).map(|volume| volume * cubed),
            rough: shape.volume_is_hull || shape.volume.is_none(),
        }
    }

    /// Of a box of which nothing but the extents is known.
    #[must_use]
    pub(crate) fn of_extents(sides: [f64; 3]) -> Self {
        let [a, b, c] = sides;
        Self {
            volume_m3: Some(a * b * c * BOX_FILL),
            area_m2: Some(2.0 * (a * b + b * c + c * a) * BOX_AREA),
            hull_m3: Some(a * b * c * BOX_FILL * 1.4),
            rough: true,
        }
    }

    /// The best that a model offers, `None` where nothing is known of its shape.
    #[must_use]
    pub(crate) fn of_model(facts: &ModelFacts, metres_per_unit: f64) -> Option<Self> {
        let of_box =
            facts.sorted_extents().map(|sides| Self::of_extents(sides.map(|side| side * metres_per_unit)));
        let Some(shape) = &facts.shape else { return of_box };
        let mut own = Self::of_shape(shape, metres_per_unit);
        own.area_m2 = own.area_m2.or_else(|| of_box?.area_m2);
        Some(own)
    }
}

/// kg by the mass model; `None` where the geometry lacks what it needs.
#[must_use]
pub(crate) fn by_model(
    model: MassModel,
    density: f64,
    geometry: Option<Geometry>,
    load: Option<Load>,
) -> Option<f64> {
    let own = match model {
        MassModel::Fixed { mass_kg } => return Some(mass_kg),
        MassModel::Solid => density * geometry?.volume_m3?,
        MassModel::Fill { fraction } => {
            // A fill fraction is that of the space which the thing takes up; an open surface takes up its hull.
            density * geometry?.volume_m3? * fraction
        }
        MassModel::Shell { thickness_m } => {
            let geometry = geometry?;
            let sheet = geometry.area_m2? * thickness_m;
            // A wall cannot be more than the thing is thick.
            density * geometry.hull_m3.map_or(sheet, |hull| sheet.min(hull))
        }
    };
    let held =
        load.and_then(|load| Some(load.density * load.fill * HOLLOW * geometry?.hull_m3?)).unwrap_or(0.0);
    let total = own + held;
    (total.is_finite() && total > 0.0).then_some(total)
}

/// How far mass follows size within a kind of thing: with all of it, the largest of a kind would be the heaviest of
/// the kind, but the large ones are often the light ones of their size. Fitted on the development set.
const FOLLOWS: f64 = 0.65;

/// kg that things of this kind and size weigh: between the ends of the mass range as the size is between the
/// ends of its own, both on a logarithmic scale, drawn towards the middle.
///
/// `share`: 0 for a small one of its kind, 1 for a large one, where words say so and no size does.
#[must_use]
pub(crate) fn by_size(mass: &Range, size: Option<&Range>, longest_m: Option<f64>, share: Option<f64>) -> f64 {
    let place = match (size, longest_m) {
        (Some(size), Some(longest)) if size.high > size.low * 1.01 => {
            let raw = ((longest / size.low).ln() / (size.high / size.low).ln()).clamp(0.0, 1.0);
            0.5 + (raw - 0.5) * FOLLOWS
        }
        _ => share.unwrap_or(0.5),
    };
    mass.low * (mass.high / mass.low).powf(place)
}

/// Where among its kind words put a thing: `small`, `large`; `None` where none is said.
#[must_use]
pub(crate) fn share_of_words(facts: &ModelFacts) -> Option<f64> {
    const WORDS: [(&str, f64); 10] = [
        ("miniature", 0.05),
        ("mini", 0.1),
        ("tiny", 0.05),
        ("extra", 0.9),
        ("jumbo", 0.95),
        ("giant", 0.95),
        ("small", 0.2),
        ("medium", 0.5),
        ("large", 0.75),
        ("big", 0.75),
    ];
    let texts = facts.tags.iter().chain(facts.title.as_ref());
    let mut words = texts.flat_map(|text| text.split(|letter: char| !letter.is_ascii_alphabetic()));
    words.find_map(|word| {
        let known = WORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(word));
        known.map(|(_, share)| *share)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(side: f64) -> ShapeFacts {
        ShapeFacts {
            volume: Some(side.powi(3)),
            volume_is_hull: false,
            area: Some(6.0 * side * side),
            hull_volume: Some(side.powi(3)),
            closed: true,
            bodies: 1,
            spread: None,
        }
    }

    fn close(a: Option<f64>, b: f64) {
        assert!(a.is_some_and(|a| (a - b).abs() <= 1e-9 * b), "{a:?} {b}");
    }

    #[test]
    fn mass_models_have_their_closed_forms() {
        // A cube of 20 units of 1 cm: 0.2 m.
        let geometry = Some(Geometry::of_shape(&cube(20.0), 0.01));
        close(by_model(MassModel::Solid, 7850.0, geometry, None), 7850.0 * 0.008);
        close(by_model(MassModel::Fill { fraction: 0.1 }, 700.0, geometry, None), 5.6 * 0.1);
        close(
            by_model(MassModel::Shell { thickness_m: 0.002 }, 7850.0, geometry, None),
            7850.0 * 0.24 * 0.002,
        );
        close(by_model(MassModel::Fixed { mass_kg: 3.0 }, 1.0, None, None), 3.0);
        // A wall thicker than the cube leaves the cube.
        close(by_model(MassModel::Shell { thickness_m: 1.0 }, 1000.0, geometry, None), 8.0);
        let water = Some(Load { density: 1000.0, fill: 0.5 });
        close(
            by_model(MassModel::Shell { thickness_m: 0.002 }, 7850.0, geometry, water),
            7850.0 * 0.24 * 0.002 + 1000.0 * 0.5 * HOLLOW * 0.008,
        );
    }

    #[test]
    fn without_geometry_only_a_fixed_mass_is_known() {
        assert_eq!(by_model(MassModel::Solid, 1000.0, None, None), None);
        let flat = ShapeFacts { volume: None, hull_volume: None, ..cube(1.0) };
        let geometry = Some(Geometry::of_shape(&flat, 1.0));
        assert_eq!(by_model(MassModel::Solid, 1000.0, geometry, None), None);
        close(by_model(MassModel::Shell { thickness_m: 0.001 }, 1000.0, geometry, None), 6.0);
    }
}
