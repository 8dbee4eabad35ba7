//! Presets: named attribute sets of materials and liquids, and the friction of known pairs.

use std::collections::HashMap;
use std::sync::Arc;

use crate::attribute::{ATTRIBUTES, Kind, Layer, Provenance, attribute_id};
use crate::rules::category::Alias;
use crate::rules::print::Print;
use crate::rules::settings::{Author, Names, PresetId, figure, kind};
use crate::text::reader::Reader;
use crate::text::units::Dimension;
use crate::text::yaml::Node;

/// A value of a preset or a default, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub value: f64,
    pub by: Provenance,
}

/// A named attribute set.
#[derive(Clone, Debug)]
pub struct Preset {
    pub name: Arc<str>,
    pub kind: Kind,
    /// Material words found in names, tags and material names.
    pub aliases: Vec<Alias>,
    /// By attribute.
    pub figures: [Option<Figure>; ATTRIBUTES.len()],
    pub place: Provenance,
    pub print: Print,
}

/// Friction and restitution of two presets against each other.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Smaller id first.
    pub between: [PresetId; 2],
    pub friction_static: Option<Figure>,
    pub friction_dynamic: Option<Figure>,
    pub restitution: Option<Figure>,
    pub place: Provenance,
}

impl Preset {
    /// The value of an attribute by name, SI.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.figures[attribute_id(name)?].as_ref().map(|figure| figure.value)
    }
}

/// Reads `presets:`.
pub(crate) fn read<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> Vec<Preset> {
    let known: Vec<&str> =
        ATTRIBUTES.iter().map(|spec| spec.name).chain(["kind", "aliases", "note"]).collect();
    let mut presets = Vec::new();
    let Some(entries) = reader.map(node) else { return presets };
    for (key, value) in entries.iter() {
        let name: Arc<str> = key.text().into();
        let author = author(reader, format!("preset:{name}"));
        let Some(fields) = reader.fields(value, &known) else { continue };
        let Some(kind_node) = fields.get("kind") else {
            let message = format!("preset `{name}` has no kind");
            reader.fault(key, "CAT007", message, "here", "add `kind: rigid`".to_owned());
            continue;
        };
        let Some(kind) = kind(reader, kind_node) else { continue };
        let mut figures = [const { None }; ATTRIBUTES.len()];
        for (key, value) in fields.iter() {
            let Some(id) = attribute_id(key.text()) else { continue };
            figures[id] = figure(reader, value, id, sources).map(|(value_si, cites)| Figure {
                value: value_si,
                by: Provenance { cites, ..author.at(value) },
            });
        }
        let aliases = Alias::read(reader, fields.get("aliases"), &author);
        let print = Print::of(&[key, value], "");
        presets.push(Preset { name, kind, aliases, figures, place: author.at(key), print });
    }
    presets
}

/// Reads `pairs:`.
pub(crate) fn read_pairs<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    names: &Names,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for item in reader.list(node).unwrap_or_default() {
        let keys = ["between", "friction_static", "friction_dynamic", "restitution", "source", "note"];
        let Some(fields) = reader.fields(item, &keys) else { continue };
        let Some(between) = fields.get("between") else {
            reader.fault(item, "CAT007", "a pair without `between`".to_owned(), "here", String::new());
            continue;
        };
        let Some([one, other]) = reader.list(between) else {
            reader.fault(between, "CAT003", "expected two presets".to_owned(), "here", String::new());
            continue;
        };
        let (Some(one_id), Some(other_id)) = (names.preset(reader, one), names.preset(reader, other)) else {
            continue;
        };
        let author = author(reader, format!("pair:{}+{}", one.text(), other.text()));
        let cites = fields.get("source").and_then(|source| {
            let name = reader.text(source)?;
            let found = sources.get_key_value(name).map(|(key, _)| Arc::clone(key));
            if found.is_none() {
                let mut known: Vec<&str> = sources.keys().map(|key| &**key).collect();
                known.sort_unstable();
                reader.unknown(source, "source", known.into_iter());
            }
            found
        });
        let mut number = |name: &str, max: f64| {
            let node = fields.get(name)?;
            let value = reader.bounded(node, Dimension::Pure, 0.0, max)?;
            Some(Figure { value, by: Provenance { cites: cites.clone(), ..author.at(node) } })
        };
        pairs.push(Pair {
            between: [one_id.min(other_id), one_id.max(other_id)],
            friction_static: number("friction_static", 3.0),
            friction_dynamic: number("friction_dynamic", 3.0),
            restitution: number("restitution", 1.0),
            place: author.at(item),
        });
    }
    pairs
}

fn author(reader: &Reader<'_>, by: String) -> Author {
    Author { layer: Layer::Preset, file: Arc::clone(&reader.doc.file), by: by.into() }
}
