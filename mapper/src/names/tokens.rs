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

impl Gap {
    /// With what stands in `between`. A dash between blanks parts a name as brackets do (`Sword - game ready`), and so
    /// do three underscores, which is what some exporters make of ` & ` and ` + `.
    fn with(self, between: &str) -> Self {
        // Titles quote the name of a thing behind what it is: `Pistol "Viper"`.
        let quote = [" \"", " “", " «"].iter().any(|opened| between.contains(opened));
        let dash = between.len() >= 3 && between.trim_matches([' ', '_']).starts_with(['-', '–', '—']);
        Self {
            comma: self.comma || between.contains([',', ';', '|', ':']),
            bracket: self.bracket
                || between.contains(['(', ')', '[', ']'])
                || between.contains("___")
                || dash
                || quote,
        }
    }
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
        let mut from = 0;
        let mut gap = Gap::default();
        while from < name.len() {
            let rest = &name[from..];
            let run = rest.find(|this: char| !this.is_alphanumeric()).unwrap_or(rest.len());
            if run > 0 {
                tokens.run(&rest[..run], noise, &mut gap);
                from += run;
                continue;
            }
            let between = rest.find(char::is_alphanumeric).unwrap_or(rest.len());
            gap = gap.with(&rest[..between]);
            from += between;
        }
        tokens
    }

    /// The words of a run of letters and digits. An identifier is none: it would be split into chance words.
    fn run(&mut self, run: &str, noise: &NoiseWords, gap: &mut Gap) {
        let mut cuts = Vec::with_capacity(4);
        let mut chars = run.char_indices().peekable();
        let mut previous: Option<char> = None;
        while let Some((at, this)) = chars.next() {
            let next = chars.peek().map(|(_, next)| *next);
            if previous.is_some_and(|before| splits(before, this, next)) {
                cuts.push(at);
            }
            previous = Some(this);
        }
        if is_identifier(run, &cuts) {
            return;
        }
        let mut from = 0;
        for to in cuts.into_iter().chain([run.len()]) {
            self.push(&run[from..to], noise, gap);
            from = to;
        }
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
        let joint = matches!(
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
        );
        let kind = if counted && MEASURES.contains(&lower) {
            TokenKind::Index
        } else if joint && !(index && self.list.is_empty()) {
            TokenKind::Joint
        } else if index {
            TokenKind::Index
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

/// Is a run of letters and digits a key of some database, and no words: a hexadecimal hash, Amazon's ten (`B0…`), or
/// random letters of both cases (`zoWBjc0jbTs`)? `cuts` are where it would be split into words.
fn is_identifier(run: &str, cuts: &[usize]) -> bool {
    let count = |of: fn(&u8) -> bool| run.bytes().filter(of).count();
    let (digits, upper, lower) =
        (count(u8::is_ascii_digit), count(u8::is_ascii_uppercase), count(u8::is_ascii_lowercase));
    if run.len() < 8 || digits + upper + lower < run.len() {
        return false;
    }
    let hexadecimal = run.bytes().all(|byte| byte.is_ascii_hexdigit());
    if hexadecimal && digits >= 2 && upper + lower >= 2 && cuts.len() >= 3 {
        return true;
    }
    if run.len() == 10 && run.starts_with("B0") && lower == 0 && upper >= 2 {
        return true;
    }
    if run.len() < 10 || upper < 2 || lower < 2 {
        return false;
    }
    // Words run on are longer than two letters each, and have vowels.
    let pieces = cuts.len() + 1;
    let mut from = 0;
    let unspeakable = cuts.iter().copied().chain([run.len()]).any(|to| {
        let piece = &run[from..to];
        from = to;
        piece.len() >= 3
            && piece.bytes().all(|byte| byte.is_ascii_alphabetic() && !b"aeiouyAEIOUY".contains(&byte))
    });
    run.len() * 5 < pieces * 12 || (unspeakable && run.len() < pieces * 3)
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

    #[test]
    fn identifiers_are_no_words() {
        for (name, expected) in [
            ("STACKING_BEAR_V04KKgGBn2A", &["stacking", "bear"][..]),
            ("Avengers_Thor_PLlrpYniaeB", &["avengers", "thor"]),
            ("B07HSJN1FQ", &[]),
            ("f1d93c76a0b24e5d", &[]),
            ("chair_3fa94b2c", &["chair"]),
            // Words, names of products and numbers.
            ("iPhone11Pro", &["i", "phone", "11", "pro"]),
            ("RedHotDogBun", &["red", "hot", "dog", "bun"]),
            ("SpiderMan12Inch", &["spider", "man", "12", "inch"]),
            ("decade2000", &["decade", "2000"]),
            ("HDMI2VGA", &["hdmi", "2", "vga"]),
        ] {
            assert_eq!(words(name), expected, "{name}");
        }
    }

    #[test]
    fn dashes_between_blanks_part_a_name() {
        let breaks = |name: &str| -> Vec<bool> {
            Tokens::of(name, &NoiseWords::default()).list.iter().map(|token| token.after_break).collect()
        };
        assert_eq!(breaks("Sword - ready"), [false, true]);
        assert_eq!(breaks("glock___lamp"), [false, true]);
        assert_eq!(breaks("table_-_lamp"), [false, true]);
        assert_eq!(breaks("table-lamp __x_y"), [false; 4]);
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
