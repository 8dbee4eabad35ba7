//! What all names of a model say together: everything that it could be, and how surely.

use crate::answer::scale;
use crate::attribute::Provenance;
use crate::facts::ModelFacts;
use crate::names::lexicon::{Target, WordId};
use crate::names::reading::{self, Vote};
use crate::names::signal::{Signal, signals};
use crate::names::tokens::Tokens;
use crate::rules::category::Range;
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{CategoryId, PresetId};

/// Below this the answer is `uncategorized`.
pub(crate) const THRESHOLD: f64 = 0.50;

/// What is left of what a folder names where the file's own name says something of the same group.
const SAID_BY_NAME: f64 = 0.85;

/// Something the model could be.
#[derive(Clone, Debug)]
pub struct Candidate {
    pub target: Target,
    pub confidence: f64,
    pub by: Provenance,
    pub because: String,
    /// Letters of the phrase: the longer says more.
    pub letters: usize,
}

/// A material word and the strength of its place: the lower the stronger.
#[derive(Clone, Debug)]
pub struct MaterialWord {
    pub preset: PresetId,
    pub signal: Signal,
    pub by: Provenance,
    /// It is the head of the name: then it is more likely a thing (an iron, a glass) than a material.
    pub head: bool,
}

/// All that the names say.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Best first.
    pub candidates: Vec<Candidate>,
    pub materials: Vec<MaterialWord>,
    /// Rule words found in path, name or tags; sorted.
    pub words: Vec<WordId>,
    /// Everything that any alias in the file's or the display name names, head or not; sorted.
    pub mentioned: Vec<Target>,
}

/// Reads the names of a model against the catalogue.
#[must_use]
pub(crate) fn gather(rules: &Ruleset, facts: &ModelFacts) -> Evidence {
    let mut evidence = Evidence::default();
    let mut votes: Vec<Vote> = Vec::new();
    for (signal, text) in signals(facts) {
        let tokens = Tokens::of(text, &rules.noise);
        if !tokens.is_empty() {
            reading::read(rules, signal, &tokens, &mut evidence, &mut votes);
        }
    }
    evidence.words.sort_unstable();
    evidence.words.dedup();
    evidence.mentioned.sort_unstable();
    evidence.mentioned.dedup();
    evidence.materials.sort_by_key(|word| word.signal);
    evidence.candidates = weigh(rules, facts, votes);
    evidence
}

/// Sums the votes for each target, lets the size speak, and sorts.
fn weigh(rules: &Ruleset, facts: &ModelFacts, votes: Vec<Vote>) -> Vec<Candidate> {
    let mut targets: Vec<Target> = votes.iter().map(|vote| vote.target).collect();
    targets.sort_unstable();
    targets.dedup();
    let named: Vec<Option<&str>> = votes
        .iter()
        .filter(|vote| vote.signal == Signal::Name && vote.strength >= THRESHOLD)
        .map(|vote| rules.group(vote.target))
        .collect();
    let mut candidates: Vec<Candidate> = Vec::with_capacity(targets.len());
    for target in targets {
        let own = votes.iter().filter(|vote| vote.target == target);
        let Some(best) = own.clone().reduce(|best, vote| {
            if (vote.strength, vote.letters) > (best.strength, best.letters) { vote } else { best }
        }) else {
            continue;
        };
        let mut doubt = 1.0 - best.strength;
        let mut heard: Vec<Signal> = vec![best.signal];
        for vote in &votes {
            if heard.contains(&vote.signal) || vote.signal == Signal::Material {
                continue;
            }
            let share = support(rules, target, vote.target);
            if share > 0.0 {
                heard.push(vote.signal);
                doubt *= 1.0 - share * vote.strength;
            }
        }
        let range = size_range(rules, target);
        let fit = size_fit(facts, range);
        // `animals/husky.glb`: the folder says what the name says, less exactly.
        let group = rules.group(target);
        let coarse = matches!(best.signal, Signal::Folder(_)) && group.is_some() && named.contains(&group);
        let share = if coarse { SAID_BY_NAME } else { 1.0 };
        candidates.push(Candidate {
            target,
            confidence: ((1.0 - doubt) * fit * share).clamp(0.0, 0.99),
            by: best.by.clone(),
            because: format!("\"{}\" in {}", best.phrase, best.signal.place()),
            letters: best.letters,
        });
    }
    candidates.sort_by(|a, b| {
        b.confidence.total_cmp(&a.confidence).then(b.letters.cmp(&a.letters)).then(a.target.cmp(&b.target))
    });
    candidates
}

/// How much a vote for `other` also speaks for `target`.
fn support(rules: &Ruleset, target: Target, other: Target) -> f64 {
    if target == other {
        return 0.6;
    }
    let (one, two) = (category_of(rules, target), category_of(rules, other));
    if one == two { if matches!(other, Target::Category(_)) { 0.45 } else { 0.25 } } else { 0.0 }
}

/// The category of a target.
#[must_use]
pub(crate) fn category_of(rules: &Ruleset, target: Target) -> CategoryId {
    match target {
        Target::Category(id) => id,
        Target::Subcategory(id) => rules.subcategories[id].category,
    }
}

/// The size range of a target: its own, else its category's.
#[must_use]
pub(crate) fn size_range(rules: &Ruleset, target: Target) -> Option<&Range> {
    match target {
        Target::Category(id) => rules.categories[id].size.as_ref(),
        Target::Subcategory(id) => {
            let subcategory = &rules.subcategories[id];
            subcategory.size.as_ref().or(rules.categories[subcategory.category].size.as_ref())
        }
    }
}

/// 1 where the size is right in the stated unit, less where only another unit would make it so.
fn size_fit(facts: &ModelFacts, range: Option<&Range>) -> f64 {
    let (Some(longest), Some(range)) = (facts.longest(), range) else { return 0.97 };
    let excess = range.excess(longest * facts.metres_per_unit);
    if excess <= 1.0 {
        1.0
    } else if excess <= scale::SLACK {
        0.96
    } else if !facts.unit_stated || excess > 30.0 {
        0.90
    } else {
        0.84
    }
}
