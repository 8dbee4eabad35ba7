//! Plurals and singulars of English words.

use std::borrow::Cow;

/// Plurals that no rule gets right, and words that only look like plurals. Sorted.
const IRREGULAR: [(&str, &str); 102] = [
    ("aircraft", "aircraft"),
    ("alias", "alias"),
    ("analysis", "analysis"),
    ("asparagus", "asparagus"),
    ("atlas", "atlas"),
    ("axes", "ax"),
    ("axis", "axis"),
    ("barracks", "barracks"),
    ("binoculars", "binoculars"),
    ("blinds", "blinds"),
    ("bookshelves", "bookshelf"),
    ("boxers", "boxers"),
    ("brass", "brass"),
    ("briefs", "briefs"),
    ("bus", "bus"),
    ("cactus", "cactus"),
    ("calves", "calf"),
    ("canvas", "canvas"),
    ("chess", "chess"),
    ("children", "child"),
    ("chips", "chip"),
    ("citrus", "citrus"),
    ("clippers", "clippers"),
    ("clothes", "clothes"),
    ("compass", "compass"),
    ("cookies", "cookie"),
    ("dominoes", "domino"),
    ("feet", "foot"),
    ("flats", "flats"),
    ("forceps", "forceps"),
    ("fries", "fries"),
    ("fungi", "fungus"),
    ("gallows", "gallows"),
    ("gas", "gas"),
    ("geese", "goose"),
    ("glasses", "glasses"),
    ("goods", "goods"),
    ("greens", "greens"),
    ("grits", "grits"),
    ("haggis", "haggis"),
    ("halves", "half"),
    ("hummus", "hummus"),
    ("iris", "iris"),
    ("irons", "irons"),
    ("jacks", "jacks"),
    ("jeans", "jeans"),
    ("knives", "knife"),
    ("leaves", "leaf"),
    ("leggings", "leggings"),
    ("lens", "lens"),
    ("lenses", "lens"),
    ("lives", "life"),
    ("loaves", "loaf"),
    ("mattress", "mattress"),
    ("men", "man"),
    ("mice", "mouse"),
    ("molasses", "molasses"),
    ("movies", "movie"),
    ("news", "news"),
    ("octopi", "octopus"),
    ("octopus", "octopus"),
    ("overalls", "overalls"),
    ("oxen", "ox"),
    ("pajamas", "pajamas"),
    ("pancreas", "pancreas"),
    ("panties", "panties"),
    ("pants", "pants"),
    ("people", "person"),
    ("pies", "pie"),
    ("pliers", "pliers"),
    ("rhinoceros", "rhinoceros"),
    ("scarves", "scarf"),
    ("scissors", "scissors"),
    ("series", "series"),
    ("shears", "shears"),
    ("sheaves", "sheaf"),
    ("shelves", "shelf"),
    ("shoes", "shoe"),
    ("shorts", "shorts"),
    ("smoothies", "smoothie"),
    ("species", "species"),
    ("spirits", "spirits"),
    ("suds", "suds"),
    ("sunglasses", "sunglasses"),
    ("sweets", "sweets"),
    ("swiss", "swiss"),
    ("teeth", "tooth"),
    ("thermos", "thermos"),
    ("thieves", "thief"),
    ("ties", "tie"),
    ("tights", "tights"),
    ("toes", "toe"),
    ("tongs", "tongs"),
    ("trousers", "trousers"),
    ("tweezers", "tweezers"),
    ("walrus", "walrus"),
    ("whiskey", "whiskey"),
    ("wives", "wife"),
    ("wolves", "wolf"),
    ("women", "woman"),
    ("woods", "woods"),
    ("zombies", "zombie"),
];

/// The singular of a lower-case English word, by rule and a table of exceptions.
#[must_use]
pub(crate) fn fold(word: &str) -> Cow<'_, str> {
    if let Ok(found) = IRREGULAR.binary_search_by(|(plural, _)| (*plural).cmp(word)) {
        return Cow::Borrowed(IRREGULAR[found].1);
    }
    let Some(stem) = word.strip_suffix('s') else { return Cow::Borrowed(word) };
    if stem.chars().count() < 3 || stem.ends_with(['s', 'u', 'i']) || !word.is_ascii() {
        return Cow::Borrowed(word);
    }
    if let Some(stem) = word.strip_suffix("ies") {
        if stem.len() >= 2 {
            return Cow::Owned(format!("{stem}y"));
        }
        return Cow::Borrowed(&word[..word.len() - 1]);
    }
    for ending in ["sses", "shes", "ches", "xes", "zzes", "oes"] {
        if word.ends_with(ending) {
            return Cow::Borrowed(&word[..word.len() - 2]);
        }
    }
    Cow::Borrowed(stem)
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
            ("tennis", "tennis"),
            ("knives", "knife"),
            ("houses", "house"),
            ("gas", "gas"),
            ("pies", "pie"),
            ("vases", "vase"),
        ] {
            assert_eq!(fold(plural), singular);
        }
    }

    #[test]
    fn the_table_of_exceptions_is_sorted() {
        assert!(IRREGULAR.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}
