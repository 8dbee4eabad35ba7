//! One name read against the catalogue: the phrases in it, which of them is the head, and how clearly.
//!
//! English puts the head noun last (a dog bowl is a bowl), before `of` and `with` (a box of flour is a box),
//! and before the first comma of an inverted entry (`Pears, raw, red`). Phrases win over the words in them,
//! longest first. Where a name says nothing, the folders above it do.

use crate::attribute::Provenance;
use crate::names::evidence::{Evidence, MaterialWord};
use crate::names::lexicon::{Claim, Entry, MAX_WORDS, Target};
use crate::names::signal::Signal;
use crate::names::spelling::guess;
use crate::names::tokens::{TokenKind, Tokens};
use crate::rules::ruleset::Ruleset;

/// What is left of a noun of many senses where nothing supports one of them.
const VAGUE: f64 = 0.43;
/// The same for one that stands last, where English puts what a name is of.
const VAGUE_HEAD: f64 = 0.58;

struct Hit<'r> {
    claims: &'r [Claim],
    from: usize,
    to: usize,
    /// A material, a colour or a liquid as well as a thing: oak, orange, vodka. Beside another noun it is what
    /// that is made of, looks like or holds.
    adjective: bool,
    liquid: bool,
    /// Multiplies the weight: how likely this phrase is the head.
    clarity: f64,
}

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

/// A noun of many senses means little beside words that nobody knows, or with a number for a name.
fn doubt(rules: &Ruleset, tokens: &Tokens, hits: &mut [Hit<'_>]) {
    let spans: Vec<(usize, usize)> = hits.iter().map(|hit| (hit.from, hit.to)).collect();
    let covered = |at: usize| spans.iter().any(|(from, to)| *from <= at && at < *to);
    let foreign =
        tokens.list.iter().enumerate().any(|(at, token)| {
            token.kind == TokenKind::Word && !covered(at) && !is_adjective(rules, tokens, at)
        });
    let last_word = tokens.list.iter().rposition(|token| token.kind == TokenKind::Word);
    for hit in hits.iter_mut() {
        let numbered = tokens.list.get(hit.to).is_some_and(|token| token.kind == TokenKind::Index);
        if (foreign || numbered) && rules.vague.contains(tokens.folded(hit.from, hit.to)) {
            // Behind words that nobody knows it is still the head: `master chef can`.
            let head = !numbered && last_word.is_some_and(|last| hit.from <= last && last < hit.to);
            hit.clarity *= if head { VAGUE_HEAD } else { VAGUE };
        }
    }
}

/// A colour or a material: it says of what kind a thing is, and not what.
fn is_adjective(rules: &Ruleset, tokens: &Tokens, at: usize) -> bool {
    let known = rules.lexicon.find(tokens, at, at + 1);
    rules.adjectives.contains(tokens.raw(at, at + 1)) || known.is_some_and(|entry| !entry.presets.is_empty())
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

fn is_food(rules: &Ruleset, claim: &Claim) -> bool {
    rules.group(claim.target).is_some_and(|group| group.starts_with("food"))
}

/// The coarse group of all that a phrase may name, where they share one.
fn group<'r>(rules: &'r Ruleset, hit: &Hit<'r>) -> Option<&'r str> {
    let mut groups = hit.claims.iter().map(|claim| rules.group(claim.target));
    let first = groups.next()??;
    groups.all(|other| other == Some(first)).then_some(first)
}

/// `stove 4 burners`, `table 12 persons`: how many of something it has.
fn counted(tokens: &Tokens, hit: &Hit<'_>) -> bool {
    let number = hit.from.checked_sub(1).map(|before| tokens.raw(before, hit.from));
    let plural = tokens.raw(hit.from, hit.to) != tokens.folded(hit.from, hit.to);
    plural && number.and_then(|number| number.parse::<u32>().ok()).is_some_and(|number| number > 1)
}

/// Gives each hit its clarity by its place in the name.
fn rank(rules: &Ruleset, tokens: &Tokens, hits: &mut [Hit<'_>]) {
    hits.sort_by_key(|hit| (hit.from, hit.to));
    // The head stands last in the first stretch, between breaks and joints, that names anything.
    let stretch_of = |at: usize| {
        tokens.list[..=at]
            .iter()
            .enumerate()
            .filter(|(index, token)| *index > 0 && (token.after_break || token.kind == TokenKind::Joint))
            .count()
    };
    let Some(first) = hits.iter().map(|hit| stretch_of(hit.from)).min() else { return };
    let here = |hit: &Hit<'_>| stretch_of(hit.from) == first;
    let first_noun = hits.iter().position(|hit| here(hit) && !hit.adjective);
    let noun = hits.iter().enumerate().rposition(|(at, hit)| {
        here(hit) && !hit.adjective && (Some(at) == first_noun || !counted(tokens, hit))
    });
    let last = hits.iter().rposition(here);
    // A vodka bottle is a bottle, and so is a bottle of vodka; but beef broth is broth.
    let broth = noun.zip(last).filter(|(noun, last)| {
        noun < last && hits[*last].liquid && hits[*noun].claims.iter().all(|claim| is_food(rules, claim))
    });
    let Some(mut head) = broth.map(|(_, last)| last).or(noun).or(last) else { return };
    // `mallard duck`, `fern plant`: the class behind the thing.
    if rules.general.contains(tokens.folded(hits[head].from, hits[head].to))
        && let Some(before) = head.checked_sub(1)
        && hits[before].to == hits[head].from
        && let Some(class) = group(rules, &hits[head])
        && group(rules, &hits[before]) == Some(class)
    {
        head = before;
    }
    // `Crustaceans, shrimp`: the class first, then the thing.
    if rules.general.contains(tokens.folded(hits[head].from, hits[head].to)) && hits.len() > head + 1 {
        let next = head + 1;
        if tokens.list[hits[next].from].after_break {
            head = next;
        }
    }
    let head_to = hits[head].to;
    let adjective_at = |at: usize| {
        is_adjective(rules, tokens, at)
            || hits.iter().any(|hit| hit.adjective && hit.from <= at && at < hit.to)
    };
    let trailing = tokens
        .list
        .iter()
        .enumerate()
        .skip(head_to)
        .take_while(|(_, token)| !token.after_break && token.kind != TokenKind::Joint)
        .filter(|(at, token)| token.kind == TokenKind::Word && !adjective_at(*at))
        .count();
    for (index, hit) in hits.iter_mut().enumerate() {
        if index == head {
            hit.clarity *= match trailing {
                0 => 1.0,
                1 => 0.84,
                2 => 0.58,
                _ => 0.5,
            };
        } else if index < head {
            // The nearer to the head, the more it is a mere adjective; the first word may be a head put first.
            hit.clarity *= if index == 0 && hit.from == 0 { 0.62 } else { 0.5 };
        } else {
            hit.clarity *= 0.45;
        }
    }
}
