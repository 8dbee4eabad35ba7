//! Every word and phrase that the catalogue knows, and what it stands for.

use std::collections::HashMap;

use crate::attribute::Provenance;
use crate::names::tokens::{NoiseWords, Tokens};
use crate::rules::settings::{CategoryId, PresetId, SubcategoryId};

/// Longest phrase, words.
pub(crate) const MAX_WORDS: usize = 6;

/// What a phrase names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Target {
    Subcategory(SubcategoryId),
    /// The category alone: weaker than any of its subcategories.
    Category(CategoryId),
}

/// A phrase that names something.
#[derive(Clone, Debug)]
pub struct Claim {
    pub target: Target,
    pub alias: Box<str>,
    pub place: Provenance,
}

/// Index of a word that a rule asks for.
pub(crate) type WordId = u32;

/// All that one phrase stands for.
#[derive(Clone, Debug, Default)]
pub struct Entry {
    pub claims: Vec<Claim>,
    pub presets: Vec<(PresetId, Provenance)>,
    pub words: Vec<WordId>,
}

/// A key and the entry it leads to.
type Spelling = (Box<str>, usize);

/// Phrases by their glued letters.
#[derive(Clone, Debug, Default)]
pub struct Lexicon {
    entries: HashMap<Box<str>, usize>,
    /// By the singulars of the same phrases.
    folded: HashMap<Box<str>, usize>,
    /// Long single keys that name a thing, by first letter and length.
    spelling: HashMap<(u8, usize), Vec<Spelling>>,
    list: Vec<Entry>,
    next_word: WordId,
}

impl Lexicon {
    fn entry(&mut self, phrase: &str) -> Option<&mut Entry> {
        let tokens = Tokens::of(phrase, &NoiseWords::default());
        let raw = tokens.raw(0, tokens.len());
        if raw.is_empty() {
            return None;
        }
        let next = self.list.len();
        let at = *self.entries.entry(raw.into()).or_insert(next);
        if at == next {
            self.list.push(Entry::default());
        }
        self.folded.entry(tokens.folded(0, tokens.len()).into()).or_insert(at);
        self.list.get_mut(at)
    }

    pub fn claim(&mut self, phrase: &str, target: Target, place: &Provenance) {
        if let Some(entry) = self.entry(phrase)
            && !entry.claims.iter().any(|claim| claim.target == target)
        {
            entry.claims.push(Claim { target, alias: phrase.into(), place: place.clone() });
        }
    }

    pub fn material(&mut self, phrase: &str, preset: PresetId, place: &Provenance) {
        if let Some(entry) = self.entry(phrase)
            && !entry.presets.iter().any(|(known, _)| *known == preset)
        {
            entry.presets.push((preset, place.clone()));
        }
    }

    /// The same phrase has the same id.
    pub fn word(&mut self, phrase: &str) -> WordId {
        let id = self.next_word;
        if let Some(entry) = self.entry(phrase) {
            if let Some(known) = entry.words.first() {
                return *known;
            }
            entry.words.push(id);
        }
        self.next_word += 1;
        id
    }

    /// What the words `from..to` stand for: as written, else in the singular.
    #[must_use]
    pub fn find(&self, tokens: &Tokens, from: usize, to: usize) -> Option<&Entry> {
        let at = self
            .entries
            .get(tokens.raw(from, to))
            .or_else(|| self.folded.get(tokens.folded(from, to)))
            .or_else(|| self.entries.get(tokens.folded(from, to)))?;
        self.list.get(*at)
    }

    /// A single glued word, as written or in the singular.
    #[must_use]
    pub fn find_word(&self, word: &str) -> Option<&Entry> {
        let at = self.entries.get(word).or_else(|| self.folded.get(&*crate::names::plural::fold(word)))?;
        self.list.get(*at)
    }

    /// Prepares [`Self::near`]: to be called when every claim is in.
    pub(crate) fn index_spelling(&mut self) {
        let mut keys: Vec<(&Box<str>, usize)> = self.entries.iter().map(|(key, at)| (key, *at)).collect();
        keys.sort_unstable();
        for (key, at) in keys {
            let claims = self.list.get(at).is_some_and(|entry| !entry.claims.is_empty());
            if let Some(first) = key.bytes().next()
                && claims
                && key.len() >= 6
                && key.is_ascii()
            {
                self.spelling.entry((first, key.len())).or_default().push((key.clone(), at));
            }
        }
    }

    /// Known words of about this length with the same first letter, sorted.
    pub(crate) fn near(&self, word: &str) -> impl Iterator<Item = (&str, &Entry)> {
        let first = word.bytes().next().unwrap_or_default();
        let lengths = word.len().saturating_sub(1)..=word.len() + 1;
        lengths
            .filter_map(move |length| self.spelling.get(&(first, length)))
            .flatten()
            .filter_map(|(key, at)| Some((&**key, self.list.get(*at)?)))
    }

    /// Every entry, in the order of the catalogue.
    pub fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.list.iter()
    }
}
