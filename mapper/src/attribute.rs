//! A value, what it is a value of, and who said so.

use std::fmt;
use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Serialize};

use crate::text::units::Dimension;

/// The paper's three kinds of entity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    Rigid,
    Soft,
    Fluid,
}

/// What an attribute is about (the paper's `attr_kind`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    Inertial,
    Contact,
    Elastic,
    Flow,
}

/// Who may set a value, lowest first: a later layer beats an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    BuiltIn,
    Kind,
    Preset,
    Category,
    Subcategory,
    Rule,
    /// A machine's word, heard only where it is surer than the catalogue.
    Proposal,
    /// The model file itself, by an extension made for physics.
    File,
    Project,
    Sidecar,
    CommandLine,
}

/// Where a value was written down.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    pub layer: Layer,
    /// As the user named it: `catalog.yaml`, `overrides.yaml`, `chair.physics.yaml`, `--set`.
    pub file: Arc<str>,
    /// 1-based; 0 where there is no line (the command line).
    pub line: u32,
    pub column: u32,
    /// The preset, subcategory, rule or override entry that set it: `preset:oak`, `rule:material-word`.
    pub by: Arc<str>,
    /// Where the figure itself comes from, as the catalogue cites it.
    pub cites: Option<Arc<str>>,
}

/// What is known of an attribute before any model is.
#[derive(Clone, Copy, Debug)]
pub struct AttributeSpec {
    pub name: &'static str,
    pub class: Class,
    pub dimension: Dimension,
    /// Values outside are refused, SI.
    pub min: f64,
    pub max: f64,
}

/// Index into [`ATTRIBUTES`]: the fixed order in which attributes are kept and shown.
pub(crate) type AttributeId = usize;

/// Every attribute there is.
///
/// Bounds: aerogel to osmium for density; Poisson's ratio of an isotropic solid lies in (-1, 0.5);
/// silicone on dry glass reaches friction 3; restitution is a loss of energy.
pub const ATTRIBUTES: [AttributeSpec; 11] = {
    use Class::{Contact, Elastic, Flow, Inertial};
    const fn spec(
        name: &'static str,
        class: Class,
        dimension: Dimension,
        min: f64,
        max: f64,
    ) -> AttributeSpec {
        AttributeSpec { name, class, dimension, min, max }
    }
    [
        spec("density", Inertial, Dimension::Density, 0.5, 23_000.0),
        spec("mass", Inertial, Dimension::Mass, 1e-9, 1e12),
        spec("friction_static", Contact, Dimension::Pure, 0.0, 3.0),
        spec("friction_dynamic", Contact, Dimension::Pure, 0.0, 3.0),
        spec("restitution", Contact, Dimension::Pure, 0.0, 1.0),
        spec("rolling_resistance", Contact, Dimension::Pure, 0.0, 1.0),
        spec("youngs_modulus", Elastic, Dimension::Pressure, 1.0, 2e12),
        spec("poisson_ratio", Elastic, Dimension::Pure, -0.999, 0.499_999),
        spec("damping", Elastic, Dimension::Pure, 0.0, 10.0),
        spec("dynamic_viscosity", Flow, Dimension::DynamicViscosity, 1e-6, 1e9),
        spec("surface_tension", Flow, Dimension::SurfaceTension, 1e-4, 2.5),
    ]
};

/// Positions in [`ATTRIBUTES`] that the mapper computes with.
pub(crate) const DENSITY: AttributeId = 0;
pub(crate) const MASS: AttributeId = 1;

static NAMES: LazyLock<Vec<(Arc<str>, Arc<str>)>> = LazyLock::new(|| {
    ATTRIBUTES.iter().map(|spec| (spec.name.into(), spec.dimension.si_unit().into())).collect()
});

/// The attribute of that name.
#[must_use]
pub fn attribute_id(name: &str) -> Option<AttributeId> {
    ATTRIBUTES.iter().position(|spec| spec.name == name)
}

/// Shared name and unit: a million models carry the same few words.
pub(crate) fn interned(id: AttributeId) -> (Arc<str>, Arc<str>) {
    NAMES[id].clone()
}

/// A value in SI units, or a word.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    Number(f64),
    Text(Arc<str>),
}

/// One physical attribute of a model or of one of its parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attribute {
    /// `density`, `mass`, `friction_static`, `friction_dynamic`, `restitution`, `rolling_resistance`,
    /// `youngs_modulus`, `poisson_ratio`, `damping`, `dynamic_viscosity`, `surface_tension`.
    pub name: Arc<str>,
    pub class: Class,
    pub value: Value,
    /// SI: `kg/m3`, `kg`, `Pa`, `Pa.s`, `N/m`, `1` for a pure number.
    pub unit: Arc<str>,
    /// `None`: of the whole model. Else an index into the asset's parts.
    pub part: Option<u32>,
    pub provenance: Provenance,
    /// What it beat, strongest first.
    pub overrode: Vec<(Value, Provenance)>,
}

/// How mass follows from geometry.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MassModel {
    /// Density times enclosed volume.
    Solid,
    /// Density times surface area times thickness.
    Shell { thickness_m: f64 },
    /// Density times enclosed volume times the share of it that is material.
    Fill { fraction: f64 },
    /// Whatever the size.
    Fixed { mass_kg: f64 },
}

impl Provenance {
    /// `catalog.yaml:120`, or the file alone where there is no line.
    #[must_use]
    pub fn place(&self) -> String {
        if self.line == 0 { self.file.to_string() } else { format!("{}:{}", self.file, self.line) }
    }
}

impl Value {
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Text(_) => None,
        }
    }
}

impl Kind {
    pub const ALL: [Self; 3] = [Self::Rigid, Self::Soft, Self::Fluid];

    /// `rigid`, `soft` or `fluid`.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.to_string() == name)
    }
}

impl fmt::Display for MassModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solid => f.write_str("solid"),
            Self::Shell { thickness_m } => write!(f, "shell of {} mm", round(thickness_m * 1000.0)),
            Self::Fill { fraction } => write!(f, "filled to {} %", round(fraction * 100.0)),
            Self::Fixed { mass_kg } => write!(f, "fixed at {mass_kg} kg"),
        }
    }
}

/// To four digits, for people.
pub(crate) fn round(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    let factor = 10f64.powi(digits);
    if factor.is_finite() && factor > 0.0 { (value * factor).round() / factor } else { value }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BuiltIn => "built-in default",
            Self::Kind => "kind",
            Self::Preset => "preset",
            Self::Category => "category",
            Self::Subcategory => "subcategory",
            Self::Rule => "rule",
            Self::Proposal => "proposal",
            Self::File => "model file",
            Self::Project => "project override",
            Self::Sidecar => "sidecar override",
            Self::CommandLine => "command line",
        })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rigid => "rigid",
            Self::Soft => "soft",
            Self::Fluid => "fluid",
        })
    }
}
