//! The indefinite article before a name of the catalogue.

/// Names that begin with a vowel and sound as if with a consonant, and the other way round.
const AS_CONSONANT: [&str; 6] = ["uni", "uku", "ute", "eu", "one", "use"];
const AS_VOWEL: [&str; 2] = ["hour", "heir"];

/// `a mug`, `an axe`
#[must_use]
pub fn with_article(noun: &str) -> String {
    let begins = |list: &[&str]| list.iter().any(|start| noun.starts_with(start));
    let vowel = begins(&AS_VOWEL) || (noun.starts_with(['a', 'e', 'i', 'o', 'u']) && !begins(&AS_CONSONANT));
    format!("{} {noun}", if vowel { "an" } else { "a" })
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_article_follows_the_sound() {
        let nouns = ["mug", "ax", "umbrella", "unicycle", "ukulele", "hourglass", "onion"];
        assert_eq!(
            nouns.map(super::with_article),
            ["a mug", "an ax", "an umbrella", "a unicycle", "a ukulele", "an hourglass", "an onion"]
        );
    }
}
