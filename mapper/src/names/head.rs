//! Which of the phrases in a name is the thing, and how clearly.
//!
//! English puts the head noun last (a dog bowl is a bowl), before `of` and `with` (a box of flour is a box),
//! and before the first comma of an inverted entry (`Pears, raw, red`).

use crate::names::lexicon::Claim;
use crate::names::tokens::{TokenKind, Tokens};
use crate::rules::ruleset::Ruleset;

/// What is left of a noun of many senses where nothing supports one of them.
const VAGUE: f64 = 0.43;
/// The same for one that stands last, where English puts what a name is of.
const VAGUE_HEAD: f64 = 0.58;

/// A phrase of the catalogue in a name.
pub(crate) struct Hit<'r> {
    pub claims: &'r [Claim],
    pub from: usize,
    pub to: usize,
    /// A material, a colour or a liquid as well as a thing: oak, orange, vodka. Beside another noun it is what
    /// that is made of, looks like or holds.
    pub adjective: bool,
    pub liquid: bool,
    /// Multiplies the weight: how likely this phrase is the head.
    pub clarity: f64,
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
pub(crate) fn rank(rules: &Ruleset, tokens: &Tokens, hits: &mut [Hit<'_>]) {
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
    // A vodka bottle is a bottle, and so is a bottle of vodka; but beef broth is broth, and duck soup no duck.
    let broth = noun.zip(last).filter(|(noun, last)| {
        let of = |hit: &Hit<'_>, kind: &str| {
            let mut groups = hit.claims.iter().map(|claim| rules.group(claim.target));
            groups.all(|group| group.is_some_and(|group| group.starts_with("food") || group == kind))
        };
        noun < last
            && hits[*last].liquid
            && (of(&hits[*noun], "food") || (of(&hits[*noun], "animal") && of(&hits[*last], "food")))
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

/// A noun of many senses means little beside words that nobody knows, or with a number for a name.
pub(crate) fn doubt(rules: &Ruleset, tokens: &Tokens, hits: &mut [Hit<'_>]) {
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
