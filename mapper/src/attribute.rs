//! A value, what it is a value of, and who said so.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

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

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BuiltIn => "built-in default",
            Self::Kind => "kind",
            Self::Preset => "preset",
            Self::Category => "category",
            Self::Subcategory => "subcategory",
            Self::Rule => "rule",
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
