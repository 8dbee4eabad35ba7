//! Words that stand in no list as they are, and what they most likely mean.

use crate::names::lexicon::Entry;
use crate::rules::ruleset::Ruleset;

/// The entry that an unknown word points at, and how clearly.
pub(crate) fn guess<'r>(rules: &'r Ruleset, word: &str) -> Option<(&'r Entry, f64)> {
    // A word that is known to be one of many senses is no slip of another: a cover is no clover.
    if rules.vague.contains(word) {
        return None;
    }
    compound(rules, word).or_else(|| prefixed(rules, word)).or_else(|| misspelt(rules, word))
}

/// A word whose ending is known: the ending is the head.
fn compound<'r>(rules: &'r Ruleset, word: &str) -> Option<(&'r Entry, f64)> {
    if word.len() < 7 {
        return None;
    }
    for cut in 3..word.len() - 2 {
        let Some(entry) = rules.lexicon.find_word(&word[cut..]).filter(|entry| !entry.claims.is_empty())
        else {
            continue;
        };
        // dollars-tack: the first half of a compound is no plural.
        let first = &word[..cut];
        if rules.lexicon.find_word(first).is_some() && crate::names::plural::fold(first) == first {
            return Some((entry, 0.85));
        }
        if word.len() - cut >= 5 {
            return Some((entry, 0.6));
        }
    }
    None
}

/// Endings that make another word of a word: a bulletin is no bullet.
const DERIVED: [&str; 14] =
    ["al", "an", "ar", "ed", "ee", "en", "er", "ic", "in", "ly", "ol", "on", "or", "y"];

/// A known word with a few letters or a word that says nothing glued on: `forkliftnew`, `bearanimated`.
fn prefixed<'r>(rules: &'r Ruleset, word: &str) -> Option<(&'r Entry, f64)> {
    (4..word.len()).rev().find_map(|cut| {
        let rest = &word[cut..];
        let says_nothing = rest.len() >= 3 && rules.noise.contains(rest);
        let few_letters = rest.len() <= 2 && cut >= 6 && !DERIVED.contains(&rest);
        if !(says_nothing || few_letters) {
            return None;
        }
        let entry = rules.lexicon.find_word(&word[..cut])?;
        (!entry.claims.is_empty()).then_some((entry, 0.75))
    })
}

/// One slip of the hand away from one known word, and from one only.
fn misspelt<'r>(rules: &'r Ruleset, word: &str) -> Option<(&'r Entry, f64)> {
    let mut found: Option<&Entry> = None;
    for (key, entry) in rules.lexicon.near(word) {
        // The last letter is where other words begin: brando is no brandy. One letter in place of another makes another
        // word as often as a slip (ballet, bullet; chloride, chlorine), unless it is a vowel of a long word.
        let same_end = word.bytes().last() == key.bytes().last();
        let slip =
            word.len() != key.len() || swapped(word, key) || (word.len() >= 8 && same_consonants(word, key));
        if !same_end || !slip || strsim::osa_distance(word, key) != 1 {
            continue;
        }
        if found.is_some_and(|known| !std::ptr::eq(known, entry)) {
            return None;
        }
        found = Some(entry);
    }
    found.map(|entry| (entry, 0.8))
}

/// The same letters in another order.
fn swapped(one: &str, other: &str) -> bool {
    let sum = |word: &str| word.bytes().map(u32::from).sum::<u32>();
    sum(one) == sum(other)
}

/// Alike but for vowels.
fn same_consonants(one: &str, other: &str) -> bool {
    let consonants =
        |word: &str| word.bytes().filter(|letter| !b"aeiouy".contains(letter)).collect::<Vec<u8>>();
    consonants(one) == consonants(other)
}
