//! What the eyes see: rules and overrides, then one model after the other.

mod collider;
mod geometry;
mod mapping;
mod mass;
mod rules;

use std::path::Path;

use importer::collider::Candidate;
use importer::{Asset, Note};
use mapper::scene::SceneError;
use mapper::{Mapped, Provenance, Range, Ruleset};
use sim::Entity;

use super::adopt;
use super::observation::Observation;
use super::place::{Place, Places};

pub use mapping::{Standing, across, missing_sidecars};
pub use rules::rules;

/// One model with everything that is known of it.
pub struct Look<'a> {
    pub model: &'a str,
    /// As it was named from the command line.
    pub file: &'a Path,
    pub asset: &'a Asset,
    pub mapped: &'a Mapped,
    pub places: &'a Places,
    pub ranges: &'a Ranges,
    /// The collider that stands for it.
    pub collider: Option<&'a Candidate>,
    /// The body that it becomes.
    pub body: &'a Result<Entity, SceneError>,
}

/// Sizes and masses of the real things that a model stands for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranges {
    pub size: Option<Range>,
    pub mass: Option<Range>,
}

impl Ranges {
    #[must_use]
    pub fn of(rules: &Ruleset, mapped: &Mapped) -> Self {
        let Some(category) = &mapped.category else { return Self::default() };
        let Some(category_id) = rules.names.categories.get(category) else { return Self::default() };
        let own = mapped.subcategory.as_ref().and_then(|name| {
            let id = rules.names.subcategories.get(format!("{category}/{name}").as_str()).copied()??;
            rules.subcategories.get(id)
        });
        let category = &rules.categories[*category_id];
        Self {
            size: own.and_then(|own| own.size.clone()).or_else(|| category.size.clone()),
            mass: own.and_then(|own| own.mass.clone()).or_else(|| category.mass.clone()),
        }
    }
}

impl Look<'_> {
    /// Everything that the data layer sees of the model.
    #[must_use]
    pub fn observations(&self) -> Vec<Observation> {
        let mut seen = Vec::new();
        let found = |found| adopt::finding(found, self.places, Some((self.model, self.file)));
        seen.extend(self.mapped.findings.iter().filter_map(found));
        mapping::see(self, &mut seen);
        geometry::see(self, &mut seen);
        mass::see(self, &mut seen);
        collider::see(self, &mut seen);
        seen.extend(self.asset.notes.iter().filter_map(of_note).map(|seen| seen.of(self.model)));
        seen
    }

    fn place(&self, by: &Provenance) -> Option<Place> {
        self.places.of(by, Some(self.file))
    }

    fn fact(&self, code: &str, message: impl Into<String>) -> Observation {
        Observation::fact(code, message).of(self.model)
    }

    fn measured(&self, code: &str, value: f64, message: impl Into<String>) -> Observation {
        Observation::measured(code, value, message).of(self.model)
    }

    /// With the place and the cause that a value has.
    fn set_by(&self, observation: Observation, by: &Provenance) -> Observation {
        observation.at(self.place(by)).because(&by.by)
    }

    /// `a mug`, or `a thing` where nobody knows.
    fn what(&self) -> &str {
        self.mapped.subcategory.as_deref().or(self.mapped.category.as_deref()).unwrap_or("thing")
    }

    fn a_thing(&self) -> String {
        mapper::with_article(self.what())
    }
}

/// A note of the reader as a finding; `None` for what another rule says.
fn of_note(note: &Note) -> Option<Observation> {
    let code = match note.code.as_str() {
        "unit-assumed" => "GEO009",
        "up-assumed" => "GEO010",
        "faces-dropped" | "broken-reference" | "bad-number" => "GEO016",
        _ => "IMP010",
    };
    let place = if note.place.is_empty() { String::new() } else { format!("{}: ", note.place) };
    let name = if code == "IMP010" { format!("[{}] ", note.code) } else { String::new() };
    Some(Observation::fact(code, format!("{name}{place}{}", note.message)))
}
