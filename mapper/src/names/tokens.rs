//! Names into words: split at case, digits and punctuation, inflections folded.

use std::collections::HashSet;

use crate::names::plural::fold;

/// Longest name that is looked at, bytes; what follows is dropped.
const MAX_BYTES: usize = 400;

/// What a token is to the matcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    Word,
    /// Digits, a version (`v2`), or a single letter.
    Index,
    /// Says nothing of what the thing is: `lowpoly`, `red`, a brand.
    Noise,
    /// `of`, `with`, …: the head noun stands before it.
    Joint,
}

/// One word, lower case.
#[derive(Clone, Copy, Debug)]
pub struct Token {
    raw: (u32, u32),
    folded: (u32, u32),
    pub kind: TokenKind,
    /// A comma, bracket or semicolon stands before it: the head stands in the stretch before.
    pub after_break: bool,
    /// A comma or semicolon stands before it, which no phrase spans; it spans a bracket: `pan (metal container)`.
    pub after_comma: bool,
}

/// The words of one name, kept glued together so that a phrase is a slice.
#[derive(Clone, Debug, Default)]
pub struct Tokens {
    raw: String,
    folded: String,
    pub list: Vec<Token>,
}

/// What stood between two words.
#[derive(Clone, Copy, Debug, Default)]
struct Gap {
    comma: bool,
    bracket: bool,
}

/// Units of measure: behind a number they are part of it (`12 fl oz`, `18in`).
const MEASURES: [&str; 18] = [
    "cl", "cm", "fl", "floz", "ft", "gal", "gr", "in", "inch", "inches", "kg", "lb", "lbs", "ltr", "ml",
    "mm", "oz", "pcs",
];

/// Words that carry no category, from the catalogue.
#[derive(Clone, Debug, Default)]
pub struct NoiseWords {
    words: HashSet<String>,
}

impl NoiseWords {
    pub fn insert(&mut self, word: &str) {
        self.words.insert(word.to_lowercase());
    }

    #[must_use]
    pub fn contains(&self, word: &str) -> bool {
        self.words.contains(word)
    }
}

impl Tokens {
    /// Splits a name into its words.
    #[must_use]
    pub fn of(name: &str, noise: &NoiseWords) -> Self {
        let mut tokens = Self::default();
        let mut end = name.len().min(MAX_BYTES);
        while !name.is_char_boundary(end) {
            end -= 1;
        }
        let name = &name[..end];
        let mut start = None;
        let mut gap = Gap::default();
        let mut chars = name.char_indices().peekable();
        let mut previous: Option<char> = None;
        while let Some((at, this)) = chars.next() {
            if !this.is_alphanumeric() {
                if let Some(from) = start.take() {
                    tokens.push(&name[from..at], noise, &mut gap);
                }
                // An apostrophe is part of the word: men's, d'oeuvre.
                gap.comma |= matches!(this, ',' | ';' | '|' | ':');
                gap.bracket |= matches!(this, '(' | ')' | '[' | ']');
                previous = None;
                continue;
            }
            let next = chars.peek().map(|(_, next)| *next);
            if let (Some(from), Some(before)) = (start, previous)
                && splits(before, this, next)
            {
                tokens.push(&name[from..at], noise, &mut gap);
                start = Some(at);
            }
            start.get_or_insert(at);
            previous = Some(this);
        }
        if let Some(from) = start {
            tokens.push(&name[from..], noise, &mut gap);
        }
        tokens
    }

    fn push(&mut self, word: &str, noise: &NoiseWords, gap: &mut Gap) {
        let offset = |text: &String| u32::try_from(text.len()).unwrap_or(u32::MAX);
        let raw_start = offset(&self.raw);
        for upper in word.chars() {
            self.raw.extend(upper.to_lowercase());
        }
        let raw = (raw_start, offset(&self.raw));
        let lower = &self.raw[raw.0 as usize..];
        // The s of "men's", split off at the apostrophe, and the likes of it.
        let index = lower.chars().count() == 1 || lower.starts_with(|first: char| first.is_ascii_digit());
        let counted = self.list.last().is_some_and(|before| before.kind == TokenKind::Index);
        let kind = if index || (counted && MEASURES.contains(&lower)) {
            TokenKind::Index
        } else if matches!(
            lower,
            "of" | "with"
                | "for"
                | "in"
                | "on"
                | "and"
                | "from"
                | "by"
                | "at"
                | "to"
                | "w"
                | "without"
                | "containing"
        ) {
            TokenKind::Joint
        } else if noise.contains(lower) {
            TokenKind::Noise
        } else {
            TokenKind::Word
        };
        let folded_start = offset(&self.folded);
        self.folded.push_str(&fold(lower));
        let folded = (folded_start, offset(&self.folded));
        let Gap { comma, bracket } = std::mem::take(gap);
        self.list.push(Token { raw, folded, kind, after_break: comma || bracket, after_comma: comma });
    }

    /// Words `from..to` glued: `coffee mug`, `CoffeeMug` and `coffeemug` all give `coffeemug`.
    #[must_use]
    pub fn raw(&self, from: usize, to: usize) -> &str {
        match (self.list.get(from), self.list.get(to.wrapping_sub(1))) {
            (Some(first), Some(last)) => &self.raw[first.raw.0 as usize..last.raw.1 as usize],
            _ => "",
        }
    }

    /// The same with every word folded to its singular.
    #[must_use]
    pub fn folded(&self, from: usize, to: usize) -> &str {
        match (self.list.get(from), self.list.get(to.wrapping_sub(1))) {
            (Some(first), Some(last)) => &self.folded[first.folded.0 as usize..last.folded.1 as usize],
            _ => "",
        }
    }

    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Words that could name a thing.
    #[must_use]
    pub fn words(&self) -> usize {
        self.list.iter().filter(|token| token.kind == TokenKind::Word).count()
    }
}

fn splits(before: char, this: char, next: Option<char>) -> bool {
    let digit = |c: char| c.is_numeric();
    if digit(before) != digit(this) {
        return true;
    }
    // aB | GLTFModel -> GLTF Model
    (before.is_lowercase() && this.is_uppercase())
        || (before.is_uppercase() && this.is_uppercase() && next.is_some_and(char::is_lowercase))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn words(name: &str) -> Vec<String> {
        let tokens = Tokens::of(name, &NoiseWords::default());
        (0..tokens.len()).map(|at| tokens.raw(at, at + 1).to_owned()).collect()
    }

    #[test]
    fn names_split_at_case_digits_and_punctuation() {
        assert_eq!(words("Dining_Table_21_2"), ["dining", "table", "21", "2"]);
        assert_eq!(words("cakeBirthday"), ["cake", "birthday"]);
        assert_eq!(words("HTTPServer"), ["http", "server"]);
        assert_eq!(words("b04_offshore"), ["b", "04", "offshore"]);
        assert_eq!(words("stairs-wide.v2"), ["stairs", "wide", "v", "2"]);
        assert_eq!(words("ÉtagèreÄpfel"), ["étagère", "äpfel"]);
    }

    proptest! {
        #[test]
        fn any_unicode_splits_into_words_that_glue_back(name in any::<String>()) {
            let tokens = Tokens::of(&name, &NoiseWords::default());
            let glued: String = (0..tokens.len()).map(|at| tokens.raw(at, at + 1)).collect();
            prop_assert_eq!(tokens.raw(0, tokens.len()), glued);
            let folded: String = (0..tokens.len()).map(|at| tokens.folded(at, at + 1)).collect();
            prop_assert_eq!(tokens.folded(0, tokens.len()), folded);
        }
    }
}
