//! The mapper's answer for one model.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::attribute::{Attribute, Kind, Layer, MassModel, Provenance};

/// A model's category, kind, scale and attributes, each with its reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mapped {
    /// `None`: uncategorized, which is an answer and not an error.
    pub category: Option<Arc<str>>,
    pub subcategory: Option<Arc<str>>,
    pub synset: Option<Arc<str>>,
    pub kind: Kind,
    pub preset: Option<Arc<str>>,
    /// Who chose the preset.
    pub preset_by: Option<Provenance>,
    /// 0 to 1.
    pub confidence: f64,
    pub mass_model: MassModel,
    pub mass_model_by: Provenance,
    /// What it holds, counted in the mass.
    pub contents: Option<Contents>,
    /// Fixed in place (a building, a tree): simulated as static.
    pub anchored: bool,
    pub scale: Scale,
    /// Where nobody says: a share of the diagonal, as [`crate::scene::collider_tolerance`] has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collider_tolerance: Option<ColliderTolerance>,
    /// Sorted by part (the whole model first), then by the fixed order of names.
    pub attributes: Vec<Attribute>,
    /// Every rule that matched, the winner first.
    pub trace: Vec<Trace>,
    pub findings: Vec<Finding>,
}

/// A filling: a bottle's water.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contents {
    pub preset: Arc<str>,
    /// Share of the room inside, 0 to 1.
    pub fill: f64,
    pub density_kg_m3: f64,
    pub by: Provenance,
}

/// Error that the collider may have, in the world's measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColliderTolerance {
    pub metres: f64,
    pub by: Provenance,
}

/// What a file unit is worth, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    pub metres_per_unit: f64,
    /// `m`, `cm`, `mm`, `in`, `ft`, or `fitted` for a model made to no unit and fitted to its category's size.
    pub unit: Arc<str>,
    /// One sentence: `stated by the file`, `0.43 file units fit a chair in m`, …
    pub reason: String,
    /// It fits no unit of its category.
    pub suspect: bool,
    /// The unit is the one in which the thing has its size, not the one that the file states or is taken to have.
    #[serde(default)]
    pub inferred: bool,
}

/// One matching rule (or alias) and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    pub by: Provenance,
    /// `"mug" in file name`
    pub because: String,
    pub subcategory: Option<Arc<str>>,
    pub confidence: f64,
    pub won: bool,
    /// Why it lost, empty for the winner.
    pub lost_because: String,
}

/// Something that does not fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// `MAP003`
    pub code: Arc<str>,
    pub message: String,
    pub place: Option<Provenance>,
}

impl Mapped {
    /// An attribute of the whole model.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.part.is_none() && &*attribute.name == name)
    }

    /// Its value in SI.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.attribute(name)?.value.number()
    }

    /// An attribute of one part, else of the whole.
    #[must_use]
    pub fn part_number(&self, part: u32, name: &str) -> Option<f64> {
        let own =
            self.attributes.iter().find(|attribute| attribute.part == Some(part) && &*attribute.name == name);
        own.or_else(|| self.attribute(name))?.value.number()
    }

    /// How many values nobody chose for this model or anything like it.
    #[must_use]
    pub fn defaults_used(&self) -> usize {
        self.attributes.iter().filter(|attribute| attribute.provenance.layer <= Layer::Kind).count()
    }
}
