//! What people say of single models: project files with globs, and a sidecar beside the model.
//!
//! A project file:
//! ```yaml
//! version: 1
//! overrides:
//!   - match: "furniture/**/chair_*.glb"     # or a list; case is ignored
//!     set: { preset: oak, mass: 4.2 kg }
//!     parts:                                # by name (glob) or index
//!       "Seat*": { preset: upholstery }
//! ```
//! A file with `proposed_by: NAME` holds a machine's proposals: its entries carry a `confidence`, stand below
//! everything that people wrote, and are heard for a model only where that is above the confidence of every rule
//! and alias that says what the model is. A sidecar `chair.physics.yaml` holds the keys of `set` and `parts` by
//! themselves, and with `title` and `tags` what a database knows of the model: words to be read as its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use globset::GlobMatcher;

use crate::attribute::{Layer, Provenance};
use crate::mapped::Finding;
use crate::names::evidence::THRESHOLD;
use crate::rules::print::Print;
use crate::rules::rule::glob;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{self, Author, Setting};
use crate::text::error::MapError;
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::{self, Node};

/// Settings of the whole model and of its parts.
#[derive(Clone, Debug)]
pub struct Overlay {
    pub settings: Vec<Setting>,
    pub parts: Vec<PartOverlay>,
    pub print: Print,
}

/// Settings of the parts that a selector names.
#[derive(Clone, Debug)]
pub struct PartOverlay {
    pub selector: PartSelector,
    pub settings: Vec<Setting>,
}

/// Which parts are meant.
#[derive(Clone, Debug)]
pub enum PartSelector {
    Index(u32),
    Name(Box<GlobMatcher>),
}

impl PartSelector {
    #[must_use]
    pub fn matches(&self, index: usize, name: &str) -> bool {
        match self {
            Self::Index(wanted) => *wanted as usize == index,
            Self::Name(glob) => glob.is_match(name),
        }
    }
}

/// One entry of a project file.
#[derive(Clone, Debug)]
pub struct Override {
    globs: Vec<GlobMatcher>,
    /// 1 for people.
    pub confidence: f64,
    pub overlay: Overlay,
    pub place: Provenance,
}

impl Override {
    #[must_use]
    pub fn matches(&self, model: &str) -> bool {
        self.globs.iter().any(|glob| glob.is_match(model))
    }
}

/// Project files, in order: a later entry beats an earlier one.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    pub entries: Vec<Override>,
    text: String,
}

/// The file beside a model.
#[derive(Clone, Debug)]
pub struct Sidecar {
    pub overlay: Overlay,
    pub title: Option<String>,
    pub tags: Vec<String>,
    text: Arc<str>,
}

/// One `--set NAME=VALUE`.
#[derive(Clone, Debug)]
pub struct SetValue {
    pub overlay: Overlay,
}

/// `chair.glb` has `chair.physics.yaml` beside it.
#[must_use]
pub fn sidecar_path(model: &Path) -> PathBuf {
    model.with_extension("physics.yaml")
}

impl Overrides {
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// # Errors
    /// A file that cannot be read or holds a fault; every fault has its place.
    pub fn load(files: &[PathBuf], rules: &Ruleset) -> Result<Self, MapError> {
        let mut all = Self::default();
        for path in files {
            let text = std::fs::read_to_string(path)
                .map_err(|error| MapError::Read { path: path.clone(), reason: error.to_string() })?;
            all = all.and(Self::parse(&path.display().to_string(), &text, rules)?);
        }
        Ok(all)
    }

    /// # Errors
    /// No valid override file; every fault has its place.
    pub fn parse(file: &str, text: &str, rules: &Ruleset) -> Result<Self, MapError> {
        let doc = yaml::parse(file, text)?;
        let mut reader = Reader::new(&doc);
        let mut all = Self { entries: Vec::new(), text: text.to_owned() };
        if let Some(top) = reader.fields(&doc.root, &["version", "overrides", "proposed_by"]) {
            let machine = top.get("proposed_by").and_then(|node| reader.text(node));
            for item in top.get("overrides").and_then(|node| reader.list(node)).unwrap_or_default() {
                all.entries.extend(entry(&mut reader, item, rules, machine));
            }
        }
        reader.finish(all)
    }

    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.entries.extend(other.entries);
        self.text.push_str(&other.text);
        self
    }

    /// The text of all files: what a result depends on.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Entries whose globs match none of these models.
    #[must_use]
    pub fn unmatched(&self, models: &[&str]) -> Vec<Finding> {
        let idle = self.entries.iter().filter(|entry| !models.iter().any(|model| entry.matches(model)));
        idle.map(|entry| Finding {
            code: "MAP020".into(),
            message: "this override matches no model".to_owned(),
            place: Some(entry.place.clone()),
        })
        .collect()
    }
}

fn entry<'d>(
    reader: &mut Reader<'d>,
    item: &'d Node,
    rules: &Ruleset,
    machine: Option<&str>,
) -> Option<Override> {
    let fields = reader.fields(item, &["match", "set", "parts", "confidence", "note"])?;
    let Some(matching) = fields.get("match") else {
        let help = "add `match: \"folder/**\"`".to_owned();
        reader.fault(item, "CAT007", "an override without `match`".to_owned(), "here", help);
        return None;
    };
    let mut globs = Vec::new();
    for node in reader.one_or_more(matching) {
        globs.push(*glob(reader, node)?);
    }
    let (layer, by) = match machine {
        Some(name) => (Layer::Proposal, format!("proposal:{name}")),
        None => (
            Layer::Project,
            format!("override:{}", reader.one_or_more(matching).first().map_or("", Node::text)),
        ),
    };
    let author = Author { layer, file: Arc::clone(&reader.doc.file), by: by.into() };
    let confidence = match fields.get("confidence") {
        Some(node) => reader.bounded(node, Dimension::Pure, 0.0, 1.0)?,
        None => 1.0,
    };
    let print = Print::of(&[item], "");
    let mut overlay = Overlay { settings: Vec::new(), parts: Vec::new(), print };
    if let Some(set) = fields.get("set") {
        let set = reader.fields(set, &settings::known(&[]))?;
        overlay.settings = settings::read(reader, set, &rules.names, &author, &rules.sources, &[]);
    }
    overlay.parts = parts(reader, fields, rules, &author);
    // A proposal that its own author doubts is no proposal.
    let heard = machine.is_none() || confidence >= THRESHOLD;
    heard.then(|| Override { globs, confidence, overlay, place: author.at(item) })
}

fn parts<'d>(
    reader: &mut Reader<'d>,
    fields: Fields<'d>,
    rules: &Ruleset,
    author: &Author,
) -> Vec<PartOverlay> {
    let mut overlays = Vec::new();
    let Some(map) = fields.get("parts").and_then(|node| reader.map(node)) else { return overlays };
    for (key, value) in map.iter() {
        let selector = match key.text().parse() {
            Ok(index) => PartSelector::Index(index),
            Err(_) => match glob(reader, key) {
                Some(glob) => PartSelector::Name(glob),
                None => continue,
            },
        };
        let Some(set) = reader.fields(value, &settings::known(&[])) else { continue };
        for name in ["category", "subcategory", "kind", "anchored", "contents", "unit", "collider_tolerance"]
        {
            if let Some((key, _)) = set.pair(name) {
                reader.fault(
                    key,
                    "CAT002",
                    format!("`{name}` belongs to the whole model"),
                    "here",
                    String::new(),
                );
            }
        }
        let author = Author { by: format!("{} part {}", author.by, key.text()).into(), ..author.clone() };
        let settings = settings::read(reader, set, &rules.names, &author, &rules.sources, &[]);
        overlays.push(PartOverlay { selector, settings });
    }
    overlays
}

fn overlay<'d>(reader: &mut Reader<'d>, rules: &Ruleset, author: &Author) -> Overlay {
    let root = &reader.doc.root;
    let mut overlay = Overlay { settings: Vec::new(), parts: Vec::new(), print: Print::of(&[root], "") };
    let others = ["parts", "version", "note", "title", "tags"];
    if let Some(fields) = reader.fields(root, &settings::known(&others)) {
        overlay.settings = settings::read(reader, fields, &rules.names, author, &rules.sources, &others);
        overlay.parts = parts(reader, fields, rules, author);
    }
    overlay
}

impl Sidecar {
    /// # Errors
    /// No valid sidecar; every fault has its place.
    pub fn parse(file: &str, text: &str, rules: &Ruleset) -> Result<Self, MapError> {
        let doc = yaml::parse(file, text)?;
        let mut reader = Reader::new(&doc);
        let author = Author { layer: Layer::Sidecar, file: Arc::clone(&doc.file), by: "sidecar".into() };
        let overlay = overlay(&mut reader, rules, &author);
        let (mut title, mut tags) = (None, Vec::new());
        if let Some(fields) = reader.map(&doc.root) {
            title = fields.get("title").and_then(|node| reader.text(node)).map(str::to_owned);
            for item in fields.get("tags").map_or(&[][..], |node| reader.one_or_more(node)) {
                tags.extend(reader.text(item).map(str::to_owned));
            }
        }
        reader.finish(Self { overlay, title, tags, text: Arc::clone(&doc.text) })
    }

    /// The sidecar of a model, `None` where there is no such file.
    ///
    /// # Errors
    /// It is there and cannot be read, or holds a fault.
    pub fn load(model: &Path, rules: &Ruleset) -> Result<Option<Self>, MapError> {
        let path = sidecar_path(model);
        match std::fs::read_to_string(&path) {
            Ok(text) => {
                let name =
                    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
                Self::parse(&name, &text, rules).map(Some)
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(MapError::Read { path, reason: error.to_string() }),
        }
    }

    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

impl SetValue {
    /// `mass=2.4 kg`, `preset=oak`, `unit=cm`, `part.Water*.density=998 kg/m3`.
    ///
    /// # Errors
    /// No `=`, an unknown name, or a value that does not fit it.
    pub fn parse(text: &str, rules: &Ruleset) -> Result<Self, MapError> {
        let (name, value) = text.split_once('=').unwrap_or((text, ""));
        let (name, value) = (name.trim(), value.trim());
        let (part, name) = match name.strip_prefix("part.").and_then(|rest| rest.rsplit_once('.')) {
            Some((part, name)) => (Some(part), name),
            None => (None, name),
        };
        let line = match part {
            Some(part) => format!("parts: {{ {}: {{ {name}: {value} }} }}", quoted(part)),
            None => format!("{name}: {value}"),
        };
        let doc = yaml::parse("--set", &line)?;
        let mut reader = Reader::new(&doc);
        let author = Author { layer: Layer::CommandLine, file: Arc::clone(&doc.file), by: "--set".into() };
        let mut overlay = overlay(&mut reader, rules, &author);
        let parts = overlay.parts.iter_mut().flat_map(|part| &mut part.settings);
        for setting in overlay.settings.iter_mut().chain(parts) {
            (setting.by.line, setting.by.column) = (0, 0);
        }
        reader.finish(Self { overlay })
    }
}

/// A YAML string with nothing in it taken as syntax.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}
