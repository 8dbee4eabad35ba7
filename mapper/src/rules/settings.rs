//! What a layer may set: the same words in a category, a rule, an override and on the command line.

use std::collections::HashMap;
use std::sync::Arc;

use crate::attribute::{ATTRIBUTES, AttributeId, Kind, Layer, MassModel, Provenance, attribute_id};
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::{Data, Node};

/// Index into the ruleset's presets.
pub(crate) type PresetId = usize;
/// Index into the ruleset's categories.
pub(crate) type CategoryId = usize;
/// Index into the ruleset's subcategories.
pub(crate) type SubcategoryId = usize;

/// Keys that [`read`] understands besides the names of attributes.
pub(crate) const KEYS: [&str; 9] = [
    "category",
    "subcategory",
    "kind",
    "preset",
    "mass_model",
    "anchored",
    "contents",
    "unit",
    "collider_tolerance",
];

/// What a file unit may be.
pub(crate) const LENGTH_UNITS: [(&str, f64); 5] =
    [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("in", 0.0254), ("ft", 0.3048)];

/// One thing set, and by whom.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    pub what: What,
    pub by: Provenance,
}

/// What can be set.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    Category(CategoryId),
    Subcategory(SubcategoryId),
    Kind(Kind),
    Preset(PresetId),
    MassModel(MassModel),
    Anchored(bool),
    /// What it holds: a preset that fills this share of the enclosed volume.
    Contents {
        preset: PresetId,
        fill: f64,
    },
    Unit {
        name: Arc<str>,
        metres: f64,
    },
    /// Error that its collider may have.
    ColliderTolerance {
        metres: f64,
    },
    /// In SI.
    Attribute(AttributeId, f64),
}

/// The names that settings may refer to.
#[derive(Clone, Debug, Default)]
pub struct Names {
    pub presets: HashMap<Arc<str>, PresetId>,
    pub categories: HashMap<Arc<str>, CategoryId>,
    /// `armchair` and `seating/armchair`; a bare name that two categories use is `None`.
    pub subcategories: HashMap<Arc<str>, Option<SubcategoryId>>,
}

impl Names {
    /// Sorted, so that a did-you-mean does not hang on hashing.
    fn sorted<'a, V>(map: &'a HashMap<Arc<str>, V>) -> impl Iterator<Item = &'a str> + use<'a, V> {
        let mut names: Vec<&str> = map.keys().map(|name| &**name).collect();
        names.sort_unstable();
        names.into_iter()
    }

    pub fn preset<'d>(&self, reader: &mut Reader<'d>, node: &'d Node) -> Option<PresetId> {
        let name = reader.text(node)?;
        let found = self.presets.get(name).copied();
        if found.is_none() {
            reader.unknown(node, "preset", Self::sorted(&self.presets));
        }
        found
    }

    pub fn category<'d>(&self, reader: &mut Reader<'d>, node: &'d Node) -> Option<CategoryId> {
        let name = reader.text(node)?;
        let found = self.categories.get(name).copied();
        if found.is_none() {
            reader.unknown(node, "category", Self::sorted(&self.categories));
        }
        found
    }

    pub fn subcategory<'d>(&self, reader: &mut Reader<'d>, node: &'d Node) -> Option<SubcategoryId> {
        let name = reader.text(node)?;
        match self.subcategories.get(name) {
            Some(Some(found)) => Some(*found),
            Some(None) => {
                let help = "write `category/subcategory`".to_owned();
                reader.fault(
                    node,
                    "CAT005",
                    format!("`{name}` stands in several categories"),
                    "ambiguous",
                    help,
                );
                None
            }
            None => {
                reader.unknown(node, "subcategory", Self::sorted(&self.subcategories));
                None
            }
        }
    }
}

/// Who is writing: enters every provenance that comes out.
#[derive(Clone, Debug)]
pub struct Author {
    pub layer: Layer,
    pub file: Arc<str>,
    pub by: Arc<str>,
}

impl Author {
    #[must_use]
    pub fn at(&self, node: &Node) -> Provenance {
        Provenance {
            layer: self.layer,
            file: Arc::clone(&self.file),
            line: node.span.line,
            column: node.span.column,
            by: Arc::clone(&self.by),
            cites: None,
        }
    }
}

/// All keys that settings may have, with others that stand in the same map.
#[must_use]
pub(crate) fn known<'a>(others: &[&'a str]) -> Vec<&'a str> {
    let attributes = ATTRIBUTES.iter().map(|spec| spec.name);
    KEYS.into_iter().chain(attributes).chain(others.iter().copied()).collect()
}

/// Reads every setting of a map, in its order. `skip`: keys that mean something else here.
pub(crate) fn read<'d>(
    reader: &mut Reader<'d>,
    fields: Fields<'d>,
    names: &Names,
    author: &Author,
    sources: &HashMap<Arc<str>, Arc<str>>,
    skip: &[&str],
) -> Vec<Setting> {
    let mut settings = Vec::new();
    for (key, value) in fields.iter() {
        let name = key.text();
        if skip.contains(&name) {
            continue;
        }
        let mut by = author.at(value);
        let what = match name {
            "category" => names.category(reader, value).map(What::Category),
            "subcategory" => names.subcategory(reader, value).map(What::Subcategory),
            "kind" => kind(reader, value).map(What::Kind),
            "preset" => names.preset(reader, value).map(What::Preset),
            "mass_model" => mass_model(reader, value).map(What::MassModel),
            "anchored" => reader.boolean(value).map(What::Anchored),
            "contents" => contents(reader, value, names),
            "unit" => unit(reader, value),
            "collider_tolerance" => reader
                .bounded(value, Dimension::Length, 1e-6, 1e3)
                .map(|metres| What::ColliderTolerance { metres }),
            _ => attribute_id(name).and_then(|id| {
                let (value, cites) = figure(reader, value, id, sources)?;
                by.cites = cites;
                Some(What::Attribute(id, value))
            }),
        };
        settings.extend(what.map(|what| Setting { what, by }));
    }
    settings
}

/// `720 kg/m3` or `{ value: 720 kg/m3, source: wood-handbook }`: value in SI, and the full reference.
pub(crate) fn figure<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    id: AttributeId,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> Option<(f64, Option<Arc<str>>)> {
    let spec = &ATTRIBUTES[id];
    let Data::Map(_) = node.data else {
        return Some((reader.bounded(node, spec.dimension, spec.min, spec.max)?, None));
    };
    let fields = reader.fields(node, &["value", "source", "note"])?;
    let cites = fields.get("source").and_then(|source| cite(reader, source, sources));
    let Some(value) = fields.get("value") else {
        reader.fault(node, "CAT007", "the key `value` is missing".to_owned(), "here", String::new());
        return None;
    };
    Some((reader.bounded(value, spec.dimension, spec.min, spec.max)?, cites))
}

fn cite<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> Option<Arc<str>> {
    let mut cited: Vec<Arc<str>> = Vec::new();
    for item in reader.one_or_more(node) {
        let name = reader.text(item)?;
        if let Some((key, _)) = sources.get_key_value(name) {
            cited.push(Arc::clone(key));
        } else {
            let mut known: Vec<&str> = sources.keys().map(|key| &**key).collect();
            known.sort_unstable();
            reader.unknown(item, "source", known.into_iter());
            return None;
        }
    }
    match cited.as_slice() {
        [one] => Some(Arc::clone(one)),
        several => Some(several.join(", ").into()),
    }
}

pub(crate) fn kind<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<Kind> {
    let name = reader.text(node)?;
    let kind = Kind::parse(name);
    if kind.is_none() {
        reader.unknown(node, "kind", ["rigid", "soft", "fluid"].into_iter());
    }
    kind
}

/// `solid`, `{ shell: 3 mm }`, `{ fill: 0.12 }` or `{ fixed: 12 kg }`, the last three with an optional `range`.
pub(crate) fn mass_model<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<MassModel> {
    if let Data::Scalar { text, .. } = &node.data {
        if text == "solid" {
            return Some(MassModel::Solid);
        }
        reader.unknown(node, "mass model", ["solid"].into_iter());
        return None;
    }
    let fields = reader.fields(node, &["solid", "shell", "fill", "fixed", "range"])?;
    let (value, model, dimension) = if let Some(value) = fields.get("shell") {
        let thickness_m = reader.bounded(value, Dimension::Length, 1e-6, 10.0)?;
        (thickness_m, MassModel::Shell { thickness_m }, Dimension::Length)
    } else if let Some(value) = fields.get("fill") {
        let fraction = reader.bounded(value, Dimension::Pure, 1e-6, 1.0)?;
        (fraction, MassModel::Fill { fraction }, Dimension::Pure)
    } else if let Some(value) = fields.get("fixed") {
        let mass_kg = reader.bounded(value, Dimension::Mass, 1e-9, 1e12)?;
        (mass_kg, MassModel::Fixed { mass_kg }, Dimension::Mass)
    } else {
        let help = "write `solid`, `{ shell: 3 mm }`, `{ fill: 0.12 }` or `{ fixed: 12 kg }`".to_owned();
        reader.fault(node, "CAT007", "a mass model without a model".to_owned(), "here", help);
        return None;
    };
    if let Some(range) = fields.get("range") {
        let [low, high] = reader.range(range, dimension)?;
        if !(low..=high).contains(&value) {
            reader.fault(
                range,
                "CAT008",
                format!("{value} lies outside its own range"),
                "here",
                String::new(),
            );
            return None;
        }
    }
    Some(model)
}

fn contents<'d>(reader: &mut Reader<'d>, node: &'d Node, names: &Names) -> Option<What> {
    let fields = reader.fields(node, &["preset", "fill"])?;
    let (Some(preset), Some(fill)) = (fields.get("preset"), fields.get("fill")) else {
        let help = "write `{ preset: water, fill: 0.5 }`".to_owned();
        reader.fault(node, "CAT007", "contents need a preset and a fill".to_owned(), "here", help);
        return None;
    };
    let preset = names.preset(reader, preset)?;
    Some(What::Contents { preset, fill: reader.bounded(fill, Dimension::Pure, 0.0, 1.0)? })
}

/// `cm`, or a length that one file unit is worth: `2.5 cm`.
fn unit<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<What> {
    let text = reader.text(node)?;
    if let Some((name, metres)) = LENGTH_UNITS.iter().find(|(name, _)| *name == text) {
        return Some(What::Unit { name: (*name).into(), metres: *metres });
    }
    if !text.starts_with(|first: char| first.is_ascii_digit()) {
        reader.unknown(node, "unit", LENGTH_UNITS.iter().map(|(name, _)| *name));
        return None;
    }
    let metres = reader.bounded(node, Dimension::Length, 1e-6, 1e6)?;
    Some(What::Unit { name: text.into(), metres })
}
