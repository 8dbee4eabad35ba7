//! Plurals and singulars of English words.

use std::borrow::Cow;

/// Words that look like plurals and name one thing, or a thing of another name than their singular. Sorted.
const ONE: [&str; 50] = [
    "abdomen",
    "albumen",
    "binoculars",
    "blinds",
    "boxers",
    "briefs",
    "clippers",
    "clothes",
    "compass",
    "flats",
    "forceps",
    "fries",
    "glasses",
    "goods",
    "greens",
    "grits",
    "irons",
    "jacks",
    "jeans",
    "leggings",
    "lens",
    "molasses",
    "news",
    "overalls",
    "pajamas",
    "panties",
    "pants",
    "pliers",
    "ramen",
    "rhinoceros",
    "scissors",
    "series",
    "shears",
    "shorts",
    "sms",
    "species",
    "specimen",
    "spirits",
    "suds",
    "sunglasses",
    "sweets",
    "swiss",
    "thermos",
    "tights",
    "tongs",
    "trousers",
    "tweezers",
    "whiskey",
    "woods",
    "yes",
];

/// Plurals without an s.
const WITHOUT_S: [&str; 10] =
    ["cacti", "children", "feet", "fungi", "geese", "mice", "octopi", "oxen", "people", "teeth"];

/// The singular of a lower-case English word, by the pluralizer library; kept where the word only looks like a plural.
#[must_use]
pub(crate) fn fold(word: &str) -> Cow<'_, str> {
    let with_s = word.strip_suffix('s').is_some_and(|stem| {
        stem.len() >= 3 && !stem.ends_with(['s', 'u', 'i']) || word.ends_with("ies") && stem.len() >= 3
    });
    let plural = word.is_ascii() && (with_s || word.ends_with("men") || WITHOUT_S.contains(&word));
    if !plural || ONE.binary_search(&word).is_ok() {
        return Cow::Borrowed(word);
    }
    match word {
        // The library cuts these as if they were Latin or without their e.
        "dominoes" => Cow::Borrowed("domino"),
        "lenses" => Cow::Borrowed("lens"),
        _ => Cow::Owned(pluralizer::pluralize(word, 1, false)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plurals_fold_and_lookalikes_do_not() {
        for (plural, singular) in [
            ("mugs", "mug"),
            ("boxes", "box"),
            ("berries", "berry"),
            ("tomatoes", "tomato"),
            ("dishes", "dish"),
            ("benches", "bench"),
            ("glass", "glass"),
            ("glasses", "glasses"),
            ("bus", "bus"),
            ("buses", "bus"),
            ("tennis", "tennis"),
            ("knives", "knife"),
            ("bookshelves", "bookshelf"),
            ("leaves", "leaf"),
            ("houses", "house"),
            ("gas", "gas"),
            ("pies", "pie"),
            ("cookies", "cookie"),
            ("vases", "vase"),
            ("women", "woman"),
            ("teeth", "tooth"),
            ("canvas", "canvas"),
            ("iris", "iris"),
            ("lenses", "lens"),
            ("ramen", "ramen"),
        ] {
            assert_eq!(fold(plural), singular);
        }
    }

    #[test]
    fn the_words_that_are_kept_are_sorted() {
        assert!(ONE.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
