//! One name read against the catalogue: the phrases in it. Phrases win over the words in them, longest first. Where a
//! name says nothing, the folders above it do.

use crate::attribute::Provenance;
use crate::names::evidence::{Evidence, MaterialWord};
use crate::names::head::{Hit, doubt, rank};
use crate::names::lexicon::{Claim, Entry, MAX_WORDS, Target};
use crate::names::signal::Signal;
use crate::names::spelling::guess;
use crate::names::tokens::{TokenKind, Tokens};
use crate::rules::ruleset::Ruleset;

/// A phrase that speaks for something the model could be.
pub(crate) struct Vote {
    pub target: Target,
    pub signal: Signal,
    pub strength: f64,
    pub letters: usize,
    pub by: Provenance,
    pub phrase: Box<str>,
}

/// Adds what one name says.
pub(crate) fn read(
    rules: &Ruleset,
    signal: Signal,
    tokens: &Tokens,
    evidence: &mut Evidence,
    votes: &mut Vec<Vote>,
) {
    let named = signal != Signal::Material;
    let mut hits: Vec<Hit<'_>> = Vec::new();
    let count = tokens.len();
    let mut material_spans: Vec<(usize, usize)> = Vec::new();
    let mut materials: Vec<(usize, usize, MaterialWord)> = Vec::new();
    for from in 0..count {
        for to in (from + 1..=count.min(from + MAX_WORDS)).rev() {
            if tokens.list[from + 1..to].iter().any(|token| token.after_comma) {
                continue;
            }
            if tokens.list[from..to].iter().all(|token| token.kind == TokenKind::Index) {
                continue;
            }
            // A phrase may take in a bracket whole (`pan (metal container)`), not a part of it.
            let spans = tokens.list[from + 1..to].iter().any(|token| token.after_break);
            if spans && tokens.list.get(to).is_some_and(|next| !next.after_break) {
                continue;
            }
            let Some(entry) = rules.lexicon.find(tokens, from, to) else { continue };
            note(entry, named && signal != Signal::Node, evidence);
            if !entry.presets.is_empty() && !material_spans.iter().any(|(a, b)| *a <= from && to <= *b) {
                material_spans.push((from, to));
                let head = named && !tokens.list[to..].iter().any(|token| token.kind == TokenKind::Word);
                materials.extend(entry.presets.iter().map(|(preset, by)| {
                    (from, to, MaterialWord { preset: *preset, signal, by: by.clone(), head })
                }));
            }
            let claims = !entry.claims.is_empty() && !enumerates(tokens, from, to);
            if claims && !hits.iter().any(|hit| hit.from <= from && to <= hit.to) {
                let liquid = entry.claims.iter().all(|claim| match claim.target {
                    Target::Subcategory(id) => rules.liquid[id],
                    Target::Category(_) => false,
                });
                let word = tokens.raw(from, to);
                // The iron of cast iron is no thing.
                let of_material = material_spans.iter().any(|(a, b)| *a <= from && to <= *b);
                let adjective = liquid || of_material || rules.adjectives.contains(word);
                let clarity = if numbered_primitive(tokens, from, to) { 0.42 } else { 1.0 };
                hits.push(Hit { claims: &entry.claims, from, to, adjective, liquid, clarity });
            }
        }
    }
    // The paper of a paper towel is no choice of material.
    materials.retain(|(from, to, _)| {
        !hits.iter().any(|hit| hit.from <= *from && *to <= hit.to && hit.to - hit.from > to - from)
    });
    evidence.materials.extend(materials.into_iter().map(|(.., word)| word));
    reversed(rules, tokens, &mut hits);
    if hits.is_empty() && signal == Signal::Name {
        unknown_words(rules, tokens, &mut hits);
    }
    rank(rules, tokens, &mut hits);
    doubt(rules, tokens, &mut hits);
    for hit in &hits {
        for claim in hit.claims {
            votes.push(Vote {
                target: claim.target,
                signal,
                strength: signal.weight() * hit.clarity * sharing(rules, hit.claims),
                letters: tokens.raw(hit.from, hit.to).len(),
                by: claim.place.clone(),
                phrase: claim.alias.clone(),
            });
            if signal == Signal::Name {
                evidence.mentioned.push(claim.target);
            }
        }
    }
}

/// `volume 4`, `part_02`: it counts pieces of a series, and names nothing.
fn enumerates(tokens: &Tokens, from: usize, to: usize) -> bool {
    const SERIES: [&str; 12] = [
        "chapter", "element", "form", "group", "number", "page", "part", "piece", "point", "stage", "unit",
        "volume",
    ];
    let counted = tokens.list.get(to).is_some_and(|next| next.kind == TokenKind::Index);
    counted && from > 0 && to == from + 1 && SERIES.contains(&tokens.raw(from, to))
}

/// `Box007`, `plane_03`: what modelling programs call a thing that nobody has named.
fn numbered_primitive(tokens: &Tokens, from: usize, to: usize) -> bool {
    const PRIMITIVES: [&str; 14] = [
        "box",
        "capsule",
        "circle",
        "cone",
        "cube",
        "cylinder",
        "geosphere",
        "group",
        "line",
        "plane",
        "shape",
        "sphere",
        "torus",
        "tube",
    ];
    to == from + 1
        && PRIMITIVES.contains(&tokens.raw(from, to))
        && tokens.list.get(to).is_some_and(|_| {
            let next = tokens.raw(to, to + 1);
            next.len() >= 2 && next.bytes().all(|digit| digit.is_ascii_digit())
        })
}

/// A word that several things are called by makes each of them less likely.
fn sharing(rules: &Ruleset, claims: &[Claim]) -> f64 {
    let others = claims.iter().filter(|claim| {
        match claim.target {
        Target::Subcategory(_) => true,
        // A category that goes by the name of one of its own is no other thing.
        Target::Category(id) => !claims.iter().any(|other| {
            matches!(other.target, Target::Subcategory(own) if rules.subcategories[own].category == id)
        }),
    }
    });
    match others.count() {
        0 | 1 => 1.0,
        2 => 0.93,
        _ => 0.88,
    }
}

fn note(entry: &Entry, named: bool, evidence: &mut Evidence) {
    if named {
        evidence.words.extend(&entry.words);
    }
}

/// `Lamp_Table`, `Bed_Bunk`: game assets put the head first, so two neighbours are also read backwards.
fn reversed<'r>(rules: &'r Ruleset, tokens: &Tokens, hits: &mut Vec<Hit<'r>>) {
    let mut key = String::new();
    for from in 0..tokens.len().saturating_sub(1) {
        let pair = &tokens.list[from..from + 2];
        if pair.iter().any(|token| token.kind == TokenKind::Index) || pair[1].after_break {
            continue;
        }
        // A genitive is no head put first: a cat's house is no house cat.
        if tokens.raw(from, from + 1) != tokens.folded(from, from + 1) {
            continue;
        }
        // A phrase that reads well forwards is not turned around.
        if hits.iter().any(|hit| hit.from <= from && from + 2 <= hit.to) {
            continue;
        }
        key.clear();
        key.push_str(tokens.folded(from + 1, from + 2));
        key.push_str(tokens.folded(from, from + 1));
        let Some(entry) = rules.lexicon.find_word(&key) else { continue };
        if entry.claims.is_empty() {
            continue;
        }
        hits.retain(|hit| hit.to <= from || hit.from >= from + 2);
        hits.push(Hit {
            claims: &entry.claims,
            from,
            to: from + 2,
            adjective: false,
            liquid: false,
            clarity: 0.97,
        });
    }
}

/// Words that stand in no list as they are: `gamecontroller`, `forkliftnew`, `baloon`.
fn unknown_words<'r>(rules: &'r Ruleset, tokens: &Tokens, hits: &mut Vec<Hit<'r>>) {
    for (at, token) in tokens.list.iter().enumerate() {
        let word = tokens.raw(at, at + 1);
        let unnamed = numbered_primitive(tokens, at, at + 1);
        if token.kind != TokenKind::Word || word.len() < 5 || !word.is_ascii() || unnamed {
            continue;
        }
        if let Some((entry, clarity)) = guess(rules, word) {
            hits.push(Hit {
                claims: &entry.claims,
                from: at,
                to: at + 1,
                adjective: false,
                liquid: false,
                clarity,
            });
        }
    }
}
