//! The taxonomy: categories, their subcategories, and the words by which people call them.

use std::collections::HashMap;
use std::sync::Arc;

use crate::attribute::{Layer, Provenance};
use crate::rules::print::Print;
use crate::rules::settings::{self, Author, CategoryId, Names, Setting, SubcategoryId, What};
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::Node;

/// A word or phrase and where it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Alias {
    pub text: Arc<str>,
    pub place: Provenance,
}

/// Lowest and highest of real things, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
    pub place: Provenance,
}

/// Things that behave alike.
#[derive(Clone, Debug)]
pub struct Category {
    pub name: Arc<str>,
    /// One of the coarse groups of the WordNet crosswalk, for reports.
    pub group: Option<Arc<str>>,
    pub aliases: Vec<Alias>,
    pub settings: Vec<Setting>,
    /// m, longest extent; for subcategories that give none.
    pub size: Option<Range>,
    /// kg; for subcategories that give none.
    pub mass: Option<Range>,
    pub place: Provenance,
    pub subcategories: Vec<SubcategoryId>,
    /// Without its subcategories.
    pub print: Print,
}

/// One kind of thing.
#[derive(Clone, Debug)]
pub struct Subcategory {
    pub name: Arc<str>,
    pub category: CategoryId,
    /// WordNet 3.0: `armchair.n.01`.
    pub synset: Option<Arc<str>>,
    pub group: Option<Arc<str>>,
    /// The name itself first, dashes as spaces.
    pub aliases: Vec<Alias>,
    pub settings: Vec<Setting>,
    /// m, longest extent of real ones.
    pub size: Option<Range>,
    /// kg, of real ones.
    pub mass: Option<Range>,
    pub place: Provenance,
    pub print: Print,
}

impl Alias {
    pub fn read<'d>(reader: &mut Reader<'d>, node: Option<&'d Node>, author: &Author) -> Vec<Self> {
        let Some(node) = node else { return Vec::new() };
        let mut aliases = Vec::new();
        for item in reader.one_or_more(node) {
            if let Some(text) = reader.text(item) {
                aliases.push(Self { text: text.into(), place: author.at(item) });
            }
        }
        aliases
    }
}

impl Range {
    fn read<'d>(
        reader: &mut Reader<'d>,
        fields: Fields<'d>,
        name: &str,
        dimension: Dimension,
        author: &Author,
    ) -> Option<Self> {
        let node = fields.get(name)?;
        let [low, high] = reader.range(node, dimension)?;
        if low <= 0.0 {
            reader.fault(
                node,
                "CAT008",
                format!("a {dimension} of {low}"),
                "must be above zero",
                String::new(),
            );
            return None;
        }
        Some(Self { low, high, place: author.at(node) })
    }

    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// How many times outside the range a value is: 1 inside it.
    #[must_use]
    pub fn excess(&self, value: f64) -> f64 {
        if value <= 0.0 {
            return f64::INFINITY;
        }
        (self.low / value).max(value / self.high).max(1.0)
    }

    #[must_use]
    pub fn middle(&self) -> f64 {
        (self.low * self.high).sqrt()
    }
}

const CATEGORY_KEYS: [&str; 6] = ["subcategories", "aliases", "group", "size", "mass", "note"];
const SUBCATEGORY_KEYS: [&str; 6] = ["synset", "aliases", "group", "size", "mass", "note"];

/// First walk: the names alone, so that settings anywhere may refer to them.
pub(crate) fn read_names<'d>(reader: &mut Reader<'d>, node: &'d Node, names: &mut Names) {
    let Some(entries) = reader.map(node) else { return };
    let mut next = 0;
    for (key, value) in entries.iter() {
        let category: Arc<str> = key.text().into();
        names.categories.insert(Arc::clone(&category), names.categories.len());
        let Some(fields) = reader.map(value) else { continue };
        let Some(subcategories) = fields.get("subcategories").and_then(|node| reader.map(node)) else {
            continue;
        };
        for (key, _) in subcategories.iter() {
            let id = next;
            next += 1;
            names.subcategories.insert(format!("{category}/{}", key.text()).into(), Some(id));
            let bare = names.subcategories.entry(key.text().into()).or_insert(Some(id));
            if *bare != Some(id) {
                *bare = None;
            }
        }
    }
}

/// Second walk: everything else. Ids are those of [`read_names`].
pub(crate) fn read<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    names: &Names,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> (Vec<Category>, Vec<Subcategory>) {
    let mut categories: Vec<Category> = Vec::new();
    let mut subcategories: Vec<Subcategory> = Vec::new();
    let category_keys = settings::known(&CATEGORY_KEYS);
    let subcategory_keys = settings::known(&SUBCATEGORY_KEYS);
    let Some(entries) = reader.map(node) else { return (categories, subcategories) };
    for (key, value) in entries.iter() {
        let name: Arc<str> = key.text().into();
        let author = Author {
            layer: Layer::Category,
            file: Arc::clone(&reader.doc.file),
            by: format!("category:{name}").into(),
        };
        let fields = reader.fields(value, &category_keys);
        let id = categories.len();
        let mut category = Category {
            name: Arc::clone(&name),
            group: None,
            aliases: Vec::new(),
            settings: Vec::new(),
            size: None,
            mass: None,
            place: author.at(key),
            subcategories: Vec::new(),
            print: Print::of(&[key, value], "subcategories"),
        };
        let Some(fields) = fields else {
            categories.push(category);
            continue;
        };
        category.group = fields.get("group").and_then(|node| reader.text(node)).map(Into::into);
        category.aliases = Alias::read(reader, fields.get("aliases"), &author);
        category.settings = read_settings(reader, fields, names, &author, sources, &CATEGORY_KEYS);
        category.size = Range::read(reader, fields, "size", Dimension::Length, &author);
        category.mass = Range::read(reader, fields, "mass", Dimension::Mass, &author);
        let children = fields.get("subcategories").and_then(|node| reader.map(node));
        for (key, value) in children.iter().flat_map(|children| children.iter()) {
            let name: Arc<str> = key.text().into();
            let author = Author {
                layer: Layer::Subcategory,
                file: Arc::clone(&reader.doc.file),
                by: format!("subcategory:{name}").into(),
            };
            category.subcategories.push(subcategories.len());
            let place = author.at(key);
            let own = Alias { text: name.replace('-', " ").into(), place: place.clone() };
            let mut subcategory = Subcategory {
                name,
                category: id,
                synset: None,
                group: None,
                aliases: vec![own],
                settings: Vec::new(),
                size: None,
                mass: None,
                place,
                print: Print::of(&[key, value], ""),
            };
            if let Some(fields) = reader.fields(value, &subcategory_keys) {
                subcategory.synset = fields.get("synset").and_then(|node| synset(reader, node));
                subcategory.group = fields.get("group").and_then(|node| reader.text(node)).map(Into::into);
                subcategory.aliases.extend(Alias::read(reader, fields.get("aliases"), &author));
                subcategory.settings =
                    read_settings(reader, fields, names, &author, sources, &SUBCATEGORY_KEYS);
                subcategory.size = Range::read(reader, fields, "size", Dimension::Length, &author);
                subcategory.mass = Range::read(reader, fields, "mass", Dimension::Mass, &author);
            }
            subcategories.push(subcategory);
        }
        categories.push(category);
    }
    (categories, subcategories)
}

fn read_settings<'d>(
    reader: &mut Reader<'d>,
    fields: Fields<'d>,
    names: &Names,
    author: &Author,
    sources: &HashMap<Arc<str>, Arc<str>>,
    skip: &[&str],
) -> Vec<Setting> {
    for name in ["category", "subcategory"] {
        if let Some((key, _)) = fields.pair(name) {
            reader.fault(key, "CAT002", format!("`{name}` cannot be set here"), "here", String::new());
        }
    }
    let mut found = settings::read(reader, fields, names, author, sources, skip);
    found.retain(|setting| !matches!(setting.what, What::Category(_) | What::Subcategory(_)));
    found
}

/// `word.n.01`
fn synset<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<Arc<str>> {
    let text = reader.text(node)?;
    let mut parts = text.rsplitn(3, '.');
    let number = parts.next().unwrap_or_default();
    let class = parts.next().unwrap_or_default();
    let word = parts.next().unwrap_or_default();
    let well_formed = number.len() == 2
        && number.bytes().all(|digit| digit.is_ascii_digit())
        && matches!(class, "n" | "v" | "a" | "s" | "r")
        && !word.is_empty();
    if !well_formed {
        let help = "write it as WordNet 3.0 does: `armchair.n.01`".to_owned();
        reader.fault(node, "CAT003", format!("`{text}` is no synset"), "here", help);
        return None;
    }
    Some(text.into())
}
