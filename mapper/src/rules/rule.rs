//! Rules beyond aliases: when this holds, set that.

use std::collections::HashMap;
use std::sync::Arc;

use globset::{GlobBuilder, GlobMatcher};

use crate::attribute::{Layer, Provenance};
use crate::facts::ModelFacts;
use crate::names::evidence::{Evidence, category_of};
use crate::names::lexicon::{Lexicon, Target, WordId};
use crate::names::signal::Signal;
use crate::rules::print::Print;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{self, Author, CategoryId, Names, PresetId, Setting, SubcategoryId};
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::Node;

/// A rule with its conditions compiled.
#[derive(Clone, Debug)]
pub struct Rule {
    pub name: Arc<str>,
    pub when: Condition,
    pub set: Vec<Setting>,
    /// 0 to 1: of the category it sets.
    pub confidence: f64,
    /// Number of predicates: of two rules the more specific wins.
    pub specificity: u32,
    pub place: Provenance,
    pub print: Print,
}

/// What must hold. A predicate on a fact that is not known does not hold.
#[derive(Clone, Debug)]
pub enum Condition {
    All(Vec<Self>),
    Any(Vec<Self>),
    Not(Box<Self>),
    Path(Box<GlobMatcher>),
    /// One of these words stands in the path, the name or the tags.
    Word(Vec<WordId>),
    /// An alias of this subcategory stands in the file's name or the display name.
    Alias(SubcategoryId),
    /// The same for any subcategory of this category.
    AliasOfCategory(CategoryId),
    /// A word of this preset stands in a material name.
    Material(Vec<PresetId>),
    /// m, longest extent, in the unit that the file states.
    Size([f64; 2]),
    /// Longest extent over shortest.
    Aspect([f64; 2]),
    Closed(bool),
    Bodies([f64; 2]),
    /// Hull volume over mesh volume.
    HullRatio([f64; 2]),
    Extension(Vec<Box<str>>),
}

const PREDICATES: [&str; 13] = [
    "all",
    "any",
    "not",
    "path",
    "word",
    "alias",
    "material",
    "size",
    "aspect",
    "closed",
    "bodies",
    "hull_ratio",
    "extension",
];

impl Condition {
    /// Rank of the work of asking.
    fn cost(&self) -> u32 {
        match self {
            Self::All(parts) | Self::Any(parts) => parts.iter().map(Self::cost).max().unwrap_or(0) + 1,
            Self::Not(part) => part.cost(),
            Self::Path(_) => 100,
            _ => 1,
        }
    }

    fn weight(&self) -> u32 {
        match self {
            Self::All(parts) => parts.iter().map(Self::weight).sum(),
            Self::Any(parts) => parts.iter().map(Self::weight).min().unwrap_or(0),
            Self::Not(part) => part.weight(),
            _ => 1,
        }
    }
}

impl Condition {
    /// Does it hold for this model?
    #[must_use]
    pub fn holds(&self, rules: &Ruleset, facts: &ModelFacts, evidence: &Evidence) -> bool {
        let inside = |value: Option<f64>, range: &[f64; 2]| {
            value.is_some_and(|value| (range[0]..=range[1]).contains(&value))
        };
        match self {
            Self::All(parts) => parts.iter().all(|part| part.holds(rules, facts, evidence)),
            Self::Any(parts) => parts.iter().any(|part| part.holds(rules, facts, evidence)),
            Self::Not(part) => !part.holds(rules, facts, evidence),
            Self::Path(glob) => glob.is_match(&facts.model),
            Self::Word(words) => words.iter().any(|word| evidence.words.binary_search(word).is_ok()),
            Self::Alias(id) => evidence.mentioned.binary_search(&Target::Subcategory(*id)).is_ok(),
            Self::AliasOfCategory(id) => {
                evidence.mentioned.iter().any(|target| category_of(rules, *target) == *id)
            }
            Self::Material(presets) => evidence
                .materials
                .iter()
                .any(|word| word.signal == Signal::Material && presets.contains(&word.preset)),
            Self::Size(range) => {
                inside(facts.longest().map(|longest| longest * facts.metres_per_unit), range)
            }
            Self::Aspect(range) => inside(facts.aspect(), range),
            Self::Closed(wanted) => facts.shape.is_some_and(|shape| shape.closed == *wanted),
            Self::Bodies(range) => inside(facts.shape.map(|shape| shape.bodies as f64), range),
            Self::HullRatio(range) => inside(facts.hull_ratio(), range),
            Self::Extension(extensions) => {
                let (_, extension) = facts.stem();
                extensions.iter().any(|wanted| **wanted == *extension)
            }
        }
    }
}

/// Reads `rules:`.
pub(crate) fn read<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    names: &Names,
    sources: &HashMap<Arc<str>, Arc<str>>,
    lexicon: &mut Lexicon,
) -> Vec<Rule> {
    let mut rules: Vec<Rule> = Vec::new();
    for item in reader.list(node).unwrap_or_default() {
        let Some(fields) = reader.fields(item, &["name", "when", "set", "confidence", "note"]) else {
            continue;
        };
        let Some(name) = required(reader, item, fields, "name").and_then(|node| reader.text(node)) else {
            continue;
        };
        if rules.iter().any(|rule| &*rule.name == name) {
            reader.fault(
                item,
                "CAT006",
                format!("a second rule named `{name}`"),
                "here",
                "rename it".to_owned(),
            );
            continue;
        }
        let author = Author {
            layer: Layer::Rule,
            file: Arc::clone(&reader.doc.file),
            by: format!("rule:{name}").into(),
        };
        let when =
            required(reader, item, fields, "when").and_then(|node| condition(reader, node, names, lexicon));
        let Some(set) = required(reader, item, fields, "set") else { continue };
        let Some(set_fields) = reader.fields(set, &settings::known(&[])) else { continue };
        let set = settings::read(reader, set_fields, names, &author, sources, &[]);
        let confidence = match fields.get("confidence") {
            Some(node) => reader.bounded(node, Dimension::Pure, 0.0, 1.0).unwrap_or(0.0),
            None => 0.9,
        };
        let Some(when) = when else { continue };
        let specificity = when.weight();
        rules.push(Rule {
            name: name.into(),
            when,
            set,
            confidence,
            specificity,
            place: author.at(item),
            print: Print::of(&[item], ""),
        });
    }
    rules
}

fn required<'d>(reader: &mut Reader<'d>, item: &'d Node, fields: Fields<'d>, name: &str) -> Option<&'d Node> {
    let found = fields.get(name);
    if found.is_none() {
        reader.fault(item, "CAT007", format!("a rule without `{name}`"), "here", format!("add `{name}:`"));
    }
    found
}

/// Several keys of one map must all hold.
fn condition<'d>(
    reader: &mut Reader<'d>,
    node: &'d Node,
    names: &Names,
    lexicon: &mut Lexicon,
) -> Option<Condition> {
    let fields = reader.fields(node, &PREDICATES)?;
    let mut parts = Vec::new();
    for (key, value) in fields.iter() {
        match predicate(reader, key.text(), value, names, lexicon)? {
            Condition::All(inner) => parts.extend(inner),
            other => parts.push(other),
        }
    }
    match parts.len() {
        0 => {
            let help = "an empty condition would hold for every model".to_owned();
            reader.fault(node, "CAT007", "no condition".to_owned(), "here", help);
            None
        }
        1 => parts.pop(),
        _ => {
            // The cheap predicates first: most rules fail on a word.
            parts.sort_by_key(Condition::cost);
            Some(Condition::All(parts))
        }
    }
}

fn predicate<'d>(
    reader: &mut Reader<'d>,
    name: &str,
    value: &'d Node,
    names: &Names,
    lexicon: &mut Lexicon,
) -> Option<Condition> {
    let mut several = |reader: &mut Reader<'d>| -> Option<Vec<Condition>> {
        let items = reader.list(value)?;
        items.iter().map(|item| condition(reader, item, names, lexicon)).collect()
    };
    Some(match name {
        "all" => {
            let mut parts = several(reader)?;
            parts.sort_by_key(Condition::cost);
            Condition::All(parts)
        }
        "any" => Condition::Any(several(reader)?),
        "not" => Condition::Not(Box::new(condition(reader, value, names, lexicon)?)),
        "path" => {
            let globs: Option<Vec<Condition>> = reader
                .one_or_more(value)
                .iter()
                .map(|item| glob(reader, item).map(Condition::Path))
                .collect();
            let mut globs = globs?;
            if globs.len() == 1 { globs.pop()? } else { Condition::Any(globs) }
        }
        "word" => {
            let mut words = Vec::new();
            for item in reader.one_or_more(value) {
                words.push(lexicon.word(reader.text(item)?));
            }
            Condition::Word(words)
        }
        "alias" => {
            let mut aliases = Vec::new();
            for item in reader.one_or_more(value) {
                aliases.push(match names.categories.get(reader.text(item)?) {
                    Some(category) => Condition::AliasOfCategory(*category),
                    None => Condition::Alias(names.subcategory(reader, item)?),
                });
            }
            if aliases.len() == 1 { aliases.pop()? } else { Condition::Any(aliases) }
        }
        "material" => {
            let mut presets = Vec::new();
            for item in reader.one_or_more(value) {
                presets.push(names.preset(reader, item)?);
            }
            Condition::Material(presets)
        }
        "size" => Condition::Size(reader.range(value, Dimension::Length)?),
        "aspect" => Condition::Aspect(reader.range(value, Dimension::Pure)?),
        "closed" => Condition::Closed(reader.boolean(value)?),
        "bodies" => Condition::Bodies(reader.range(value, Dimension::Pure)?),
        "hull_ratio" => Condition::HullRatio(reader.range(value, Dimension::Pure)?),
        "extension" => {
            let mut extensions = Vec::new();
            for item in reader.one_or_more(value) {
                extensions.push(reader.text(item)?.trim_start_matches('.').to_lowercase().into());
            }
            Condition::Extension(extensions)
        }
        _ => return None,
    })
}

/// A glob on the model's path, case ignored; `*` stays within a folder, `**` does not.
pub(crate) fn glob<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<Box<GlobMatcher>> {
    let pattern = reader.text(node)?;
    match GlobBuilder::new(pattern).case_insensitive(true).literal_separator(true).build() {
        Ok(glob) => Some(Box::new(glob.compile_matcher())),
        Err(error) => {
            reader.fault(node, "CAT003", format!("no glob: {}", error.kind()), "here", String::new());
            None
        }
    }
}
