//! How far does a change reach? A model's fingerprint covers every entry of rules and overrides that its answer rests
//! on, and none else: the phrases found in its names and what they claim, the rules that hold, what people say of it,
//! the entries of what it is taken for, and the presets that any of them refers to. A new alias or rule changes the fingerprint of the
//! models that it is found in. What is in the code and in no file belongs to the caller's key.

use std::collections::BTreeSet;

use crate::names::evidence::{Evidence, category_of};
use crate::names::lexicon::Target;
use crate::names::signal::Signal;
use crate::rules::overrides::Overlay;
use crate::rules::print::Print;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{CategoryId, PresetId, Setting, SubcategoryId, What};

/// What one answer rests on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Hexadecimal. Another one: the answer may differ.
    pub content: String,
    /// Hexadecimal. Another one: the same answer, but its reasons stand on other lines.
    pub places: String,
}

/// Walks what was consulted; each entry counts once, where it is first met.
pub(crate) struct Reader<'r> {
    rules: &'r Ruleset,
    content: blake3::Hasher,
    places: blake3::Hasher,
    presets: BTreeSet<PresetId>,
}

impl<'r> Reader<'r> {
    #[must_use]
    pub fn new(rules: &'r Ruleset) -> Self {
        let mut reader = Self {
            rules,
            content: blake3::Hasher::new(),
            places: blake3::Hasher::new(),
            presets: BTreeSet::new(),
        };
        reader.places.update(rules.file.as_bytes());
        reader.print(rules.base);
        for kind in &rules.kinds {
            reader.preset(kind.preset);
        }
        reader
    }

    /// What lost is only named in the answer: its entry counts no further.
    pub fn evidence(&mut self, evidence: &Evidence) {
        for candidate in &evidence.candidates {
            self.named(candidate.target);
            self.places.update(candidate.by.place().as_bytes());
            self.content
                .update(&candidate.confidence.to_bits().to_le_bytes())
                .update(&(candidate.letters as u64).to_le_bytes())
                .update(candidate.because.as_bytes());
        }
        for word in &evidence.materials {
            self.preset(word.preset);
            let place = match word.signal {
                Signal::Name => 0,
                Signal::Tag => 1,
                Signal::Node => 2,
                Signal::Material => 3,
                Signal::Folder(level) => 4 + u16::from(level),
            };
            self.content.update(&place.to_le_bytes()).update(&[u8::from(word.head)]);
            // The line of the alias lies inside the preset's entry.
        }
    }

    pub fn overlay(&mut self, overlay: &Overlay) {
        self.entry(overlay.print, &overlay.settings);
        for part in &overlay.parts {
            self.settings(&part.settings);
        }
    }

    /// An entry with its settings.
    pub fn entry(&mut self, print: Print, settings: &[Setting]) {
        self.print(print);
        if let Some(first) = settings.first() {
            self.places.update(first.by.file.as_bytes());
        }
        self.settings(settings);
    }

    fn settings(&mut self, settings: &[Setting]) {
        for setting in settings {
            match setting.what {
                What::Preset(preset) | What::Contents { preset, .. } => self.preset(preset),
                What::Category(id) => self.named(Target::Category(id)),
                What::Subcategory(id) => self.named(Target::Subcategory(id)),
                What::Kind(_)
                | What::MassModel(_)
                | What::Anchored(_)
                | What::Unit { .. }
                | What::ColliderTolerance { .. }
                | What::Attribute(..) => {}
            }
        }
    }

    fn named(&mut self, target: Target) {
        let rules = self.rules;
        self.content.update(rules.categories[category_of(rules, target)].name.as_bytes());
        if let Target::Subcategory(id) = target {
            self.content.update(&[0]).update(rules.subcategories[id].name.as_bytes());
        }
        self.content.update(&[0]);
    }

    /// The thing that the model is taken for, with all that its entry says.
    pub fn winner(&mut self, category: CategoryId, subcategory: Option<SubcategoryId>) {
        let rules = self.rules;
        if let Some(subcategory) = subcategory.map(|id| &rules.subcategories[id]) {
            self.entry(subcategory.print, &subcategory.settings);
        }
        let category = &rules.categories[category];
        self.entry(category.print, &category.settings);
    }

    fn preset(&mut self, id: PresetId) {
        self.content.update(self.rules.presets[id].name.as_bytes());
        if self.presets.insert(id) {
            self.print(self.rules.presets[id].print);
        }
    }

    fn print(&mut self, print: Print) {
        self.content.update(&print.content);
        self.places.update(&print.places);
    }

    #[must_use]
    pub fn finish(self) -> Reach {
        let hex = |hasher: blake3::Hasher| hasher.finalize().to_hex().to_string();
        Reach { content: hex(self.content), places: hex(self.places) }
    }
}
