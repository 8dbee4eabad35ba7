//! `catalog.yaml`, read: what kinds of things there are and how they behave.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use crate::answer::resolve;
use crate::attribute::{ATTRIBUTES, AttributeId, Kind, Layer, attribute_id};
use crate::names::lexicon::{Lexicon, Target};
use crate::names::tokens::NoiseWords;
use crate::rules::category::{self, Category, Subcategory};
use crate::rules::preset::{self, Figure, Pair, Preset};
use crate::rules::print::Print;
use crate::rules::rule::{self, Rule};
use crate::rules::settings::{Author, Names, PresetId, Setting, figure};
use crate::text::error::MapError;
use crate::text::reader::{Fields, Reader};
use crate::text::yaml::{self, Node};

/// The shipped catalogue.
const EMBEDDED: &str = include_str!("../../../catalog.yaml");

const SECTIONS: [&str; 9] =
    ["version", "sources", "defaults", "kinds", "presets", "pairs", "categories", "rules", "words"];

/// What every model of a kind has.
#[derive(Clone, Debug)]
pub struct KindSpec {
    pub kind: Kind,
    /// Where nothing better is known.
    pub preset: PresetId,
    /// In the order of [`ATTRIBUTES`].
    pub attributes: Vec<AttributeId>,
}

/// A catalogue with every reference resolved.
#[derive(Clone, Debug)]
pub struct Ruleset {
    text: Arc<str>,
    pub file: Arc<str>,
    /// Key to full reference.
    pub sources: HashMap<Arc<str>, Arc<str>>,
    /// Built-in defaults, by attribute.
    pub defaults: [Option<Figure>; ATTRIBUTES.len()],
    /// Rigid, soft, fluid.
    pub kinds: [KindSpec; 3],
    /// Of kinds and defaults, on which every answer rests.
    pub base: Print,
    pub presets: Vec<Preset>,
    pub pairs: Vec<Pair>,
    pub categories: Vec<Category>,
    pub subcategories: Vec<Subcategory>,
    pub rules: Vec<Rule>,
    pub names: Names,
    pub noise: NoiseWords,
    /// Colours, owners and states that are things as well (orange, kids, fossil): behind a noun they are its adjective.
    pub adjectives: NoiseWords,
    /// Nouns of many senses: box, plate, figure.
    pub vague: NoiseWords,
    /// Names of whole classes: crustacean, candy.
    pub general: NoiseWords,
    /// By subcategory: it is a liquid, and so rather the contents than the thing.
    pub liquid: Vec<bool>,
    pub lexicon: Lexicon,
}

/// How much a catalogue knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Stats {
    pub categories: usize,
    pub subcategories: usize,
    pub aliases: usize,
    pub presets_rigid: usize,
    pub presets_soft: usize,
    pub presets_fluid: usize,
    pub rules: usize,
    pub pairs: usize,
    pub sources: usize,
}

impl Ruleset {
    /// The catalogue that is built in.
    ///
    /// # Errors
    /// None in a tested build: the shipped file is parsed by the tests.
    pub fn embedded() -> Result<Self, MapError> {
        Self::parse("catalog.yaml", EMBEDDED)
    }

    /// # Errors
    /// The file cannot be read, or is no valid catalogue; every fault has its place.
    pub fn load(path: &Path) -> Result<Self, MapError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| MapError::Read { path: path.to_owned(), reason: error.to_string() })?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// # Errors
    /// No valid catalogue; every fault has its place.
    pub fn parse(file: &str, text: &str) -> Result<Self, MapError> {
        let doc = yaml::parse(file, text)?;
        let mut reader = Reader::new(&doc);
        let Some(top) = reader.fields(&doc.root, &SECTIONS) else { return Err(faults(reader)) };
        let sources = read_sources(&mut reader, top);
        let mut names = Names::default();
        let presets =
            top.get("presets").map_or_else(Vec::new, |node| preset::read(&mut reader, node, &sources));
        for (id, preset) in presets.iter().enumerate() {
            names.presets.insert(Arc::clone(&preset.name), id);
        }
        if let Some(node) = top.get("categories") {
            category::read_names(&mut reader, node, &mut names);
        }
        let defaults = read_defaults(&mut reader, top, &sources);
        let kinds = read_kinds(&mut reader, top, &names);
        let (categories, subcategories) = top
            .get("categories")
            .map_or_else(Default::default, |node| category::read(&mut reader, node, &names, &sources));
        let pairs = top
            .get("pairs")
            .map_or_else(Vec::new, |node| preset::read_pairs(&mut reader, node, &names, &sources));
        let [noise, adjectives, vague, general] = read_words(&mut reader, top);
        let liquid =
            subcategories.iter().map(|sub| is_liquid(&presets, &categories[sub.category], sub)).collect();
        let mut lexicon = build_lexicon(&presets, &categories, &subcategories);
        let rules = top
            .get("rules")
            .map_or_else(Vec::new, |node| rule::read(&mut reader, node, &names, &sources, &mut lexicon));
        if let Some(version) = top.get("version")
            && version.text() != "1"
        {
            reader.fault(
                version,
                "CAT003",
                "only version 1 is known".to_owned(),
                "here",
                "write `version: 1`".to_owned(),
            );
        }
        let Some(kinds) = kinds else { return Err(faults(reader)) };
        let base: Vec<&Node> = ["kinds", "defaults"].iter().filter_map(|name| top.get(name)).collect();
        let base = Print::of(&base, "");
        reader.finish(Self {
            text: Arc::clone(&doc.text),
            file: Arc::clone(&doc.file),
            sources,
            defaults,
            kinds,
            base,
            presets,
            pairs,
            categories,
            subcategories,
            rules,
            names,
            noise,
            adjectives,
            vague,
            general,
            liquid,
            lexicon,
        })
    }

    /// The file's text: what a result depends on.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    #[must_use]
    pub fn kind(&self, kind: Kind) -> &KindSpec {
        &self.kinds[kind as usize]
    }

    /// The coarse group of a target: its own, else its category's.
    #[must_use]
    pub fn group(&self, target: Target) -> Option<&str> {
        match target {
            Target::Category(id) => self.categories[id].group.as_deref(),
            Target::Subcategory(id) => {
                let subcategory = &self.subcategories[id];
                subcategory
                    .group
                    .as_ref()
                    .or(self.categories[subcategory.category].group.as_ref())
                    .map(|group| &**group)
            }
        }
    }

    #[must_use]
    pub fn preset(&self, name: &str) -> Option<&Preset> {
        self.names.presets.get(name).and_then(|id| self.presets.get(*id))
    }

    #[must_use]
    pub fn stats(&self) -> Stats {
        let presets = |kind| self.presets.iter().filter(|preset| preset.kind == kind).count();
        Stats {
            categories: self.categories.len(),
            subcategories: self.subcategories.len(),
            aliases: self.subcategories.iter().map(|sub| sub.aliases.len()).sum(),
            presets_rigid: presets(Kind::Rigid),
            presets_soft: presets(Kind::Soft),
            presets_fluid: presets(Kind::Fluid),
            rules: self.rules.len(),
            pairs: self.pairs.len(),
            sources: self.sources.len(),
        }
    }
}

fn faults(reader: Reader<'_>) -> MapError {
    match reader.finish(()) {
        Err(error) => error,
        Ok(()) => MapError::Invalid(Vec::new()),
    }
}

fn read_sources<'d>(reader: &mut Reader<'d>, top: Fields<'d>) -> HashMap<Arc<str>, Arc<str>> {
    let mut sources = HashMap::new();
    let Some(entries) = top.get("sources").and_then(|node| reader.map(node)) else { return sources };
    for (key, value) in entries.iter() {
        if let Some(text) = reader.text(value) {
            sources.insert(key.text().into(), text.into());
        }
    }
    sources
}

fn read_defaults<'d>(
    reader: &mut Reader<'d>,
    top: Fields<'d>,
    sources: &HashMap<Arc<str>, Arc<str>>,
) -> [Option<Figure>; ATTRIBUTES.len()] {
    let mut defaults = [const { None }; ATTRIBUTES.len()];
    let known: Vec<&str> = ATTRIBUTES.iter().map(|spec| spec.name).collect();
    let Some(fields) = top.get("defaults").and_then(|node| reader.fields(node, &known)) else {
        return defaults;
    };
    let author = Author { layer: Layer::BuiltIn, file: Arc::clone(&reader.doc.file), by: "default".into() };
    for (key, node) in fields.iter() {
        let Some(id) = attribute_id(key.text()) else { continue };
        defaults[id] = figure(reader, node, id, sources).map(|(value, cites)| {
            let mut by = author.at(node);
            by.cites = cites;
            Figure { value, by }
        });
    }
    defaults
}

fn read_kinds<'d>(reader: &mut Reader<'d>, top: Fields<'d>, names: &Names) -> Option<[KindSpec; 3]> {
    let Some(node) = top.get("kinds") else {
        let help = "each of rigid, soft and fluid has a `preset` and its `attributes`".to_owned();
        let root = &reader.doc.root;
        reader.fault(root, "CAT007", "no `kinds:`".to_owned(), "in this file", help);
        return None;
    };
    let fields = reader.fields(node, &["rigid", "soft", "fluid"])?;
    let mut specs = Vec::new();
    for kind in Kind::ALL {
        let Some(spec) = fields.get(&kind.to_string()) else {
            reader.fault(node, "CAT007", format!("no kind `{kind}`"), "here", format!("add `{kind}:`"));
            continue;
        };
        let Some(spec_fields) = reader.fields(spec, &["preset", "attributes", "note"]) else { continue };
        let preset = spec_fields.get("preset").and_then(|node| names.preset(reader, node));
        let mut attributes = Vec::new();
        for item in spec_fields.get("attributes").and_then(|node| reader.list(node)).unwrap_or_default() {
            match attribute_id(item.text()) {
                Some(id) => attributes.push(id),
                None => reader.unknown(item, "attribute", ATTRIBUTES.iter().map(|spec| spec.name)),
            }
        }
        attributes.sort_unstable();
        if let Some(preset) = preset {
            specs.push(KindSpec { kind, preset, attributes });
        } else {
            reader.fault(
                spec,
                "CAT007",
                format!("kind `{kind}` has no preset to fall back on"),
                "here",
                String::new(),
            );
        }
    }
    specs.try_into().ok()
}

/// Words without a category (brands among them), colours and qualities that are things as well, nouns of many senses,
/// and names of classes.
fn read_words<'d>(reader: &mut Reader<'d>, top: Fields<'d>) -> [NoiseWords; 4] {
    let mut lists: [NoiseWords; 4] = Default::default();
    let keys = ["noise", "brands", "colours", "qualities", "vague", "general"];
    let Some(fields) = top.get("words").and_then(|node| reader.fields(node, &keys)) else { return lists };
    for (key, list) in fields.iter() {
        // A brand says nothing of what a thing is; where it is a thing as well (an apple), it is an adjective of others.
        let into: &[usize] = match key.text() {
            "brands" => &[0, 1],
            "colours" | "qualities" => &[1],
            "vague" => &[2],
            "general" => &[3],
            _ => &[0],
        };
        for item in reader.list(list).unwrap_or_default() {
            if let Some(word) = reader.text(item) {
                into.iter().for_each(|list| lists[*list].insert(word));
            }
        }
    }
    lists
}

fn is_liquid(presets: &[Preset], category: &Category, subcategory: &Subcategory) -> bool {
    let settings: Vec<&Setting> = category.settings.iter().chain(&subcategory.settings).collect();
    resolve::kind_of(presets, &settings) == Kind::Fluid
}

fn build_lexicon(presets: &[Preset], categories: &[Category], subcategories: &[Subcategory]) -> Lexicon {
    let mut lexicon = Lexicon::default();
    for (id, subcategory) in subcategories.iter().enumerate() {
        for alias in &subcategory.aliases {
            lexicon.claim(&alias.text, Target::Subcategory(id), &alias.place);
        }
    }
    for (id, category) in categories.iter().enumerate() {
        lexicon.claim(&category.name.replace('-', " "), Target::Category(id), &category.place);
        for alias in &category.aliases {
            lexicon.claim(&alias.text, Target::Category(id), &alias.place);
        }
    }
    for (id, preset) in presets.iter().enumerate() {
        for alias in &preset.aliases {
            lexicon.material(&alias.text, id, &alias.place);
        }
    }
    lexicon.index_spelling();
    lexicon
}
