//! An amount that a model's own names state: `dumbbell 10 kg`, `Raisinets 35 oz`, `cola can 330 ml`.

use crate::facts::ModelFacts;

/// What is stated, and in which words.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Amount {
    pub phrase: String,
    pub of: Stated,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stated {
    MassKg(f64),
    VolumeM3(f64),
}

/// Unit as written, its worth in kg or m³. Fluid ounces are those of the United States.
const UNITS: [(&str, Stated); 20] = [
    ("kg", Stated::MassKg(1.0)),
    ("kilogram", Stated::MassKg(1.0)),
    ("kilograms", Stated::MassKg(1.0)),
    ("g", Stated::MassKg(1e-3)),
    ("gr", Stated::MassKg(1e-3)),
    ("gram", Stated::MassKg(1e-3)),
    ("grams", Stated::MassKg(1e-3)),
    ("lb", Stated::MassKg(0.453_592_37)),
    ("lbs", Stated::MassKg(0.453_592_37)),
    ("pound", Stated::MassKg(0.453_592_37)),
    ("pounds", Stated::MassKg(0.453_592_37)),
    ("oz", Stated::MassKg(0.028_349_523)),
    ("ounce", Stated::MassKg(0.028_349_523)),
    ("ounces", Stated::MassKg(0.028_349_523)),
    ("ml", Stated::VolumeM3(1e-6)),
    ("cl", Stated::VolumeM3(1e-5)),
    ("l", Stated::VolumeM3(1e-3)),
    ("liter", Stated::VolumeM3(1e-3)),
    ("litre", Stated::VolumeM3(1e-3)),
    ("floz", Stated::VolumeM3(2.957_353e-5)),
];

/// The first amount in the file's name, the title or the tags.
#[must_use]
pub(crate) fn stated(facts: &ModelFacts) -> Option<Amount> {
    let (stem, _) = facts.stem();
    let texts = facts.title.iter().chain(&facts.tags).map(String::as_str);
    texts.chain([stem]).find_map(in_text)
}

fn in_text(text: &str) -> Option<Amount> {
    let lower = text.to_ascii_lowercase();
    let parts = split(&lower);
    parts.iter().enumerate().find_map(|(at, (number, after_slash))| {
        let value: f64 = number.parse().ok().filter(|value| *value > 0.0 && !after_slash)?;
        let unit = parts.get(at + 1)?.0;
        let (unit, phrase) = match (unit, parts.get(at + 2)) {
            ("fl", Some(("oz", _))) => ("floz", format!("{number} fl oz")),
            _ => (unit, format!("{number} {unit}")),
        };
        // `2g` is a version as often as an amount.
        if !value.is_finite() || (unit == "g" && value < 5.0) {
            return None;
        }
        let of = match UNITS.iter().find(|(name, _)| *name == unit)?.1 {
            Stated::MassKg(worth) => Stated::MassKg(value * worth),
            Stated::VolumeM3(worth) => Stated::VolumeM3(value * worth),
        };
        Some(Amount { phrase, of })
    })
}

/// Numbers and words, and whether a slash stands before: the 2 of `2-1/2 oz` is no amount of ounces.
fn split(text: &str) -> Vec<(&str, bool)> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut slash = false;
    let kind = |byte: u8, digits: bool| match byte {
        b'.' => digits,
        _ => byte.is_ascii_alphanumeric(),
    };
    let bytes = text.as_bytes();
    for at in 0..=bytes.len() {
        let digits = bytes.get(start).is_some_and(u8::is_ascii_digit);
        let inside = bytes.get(at).is_some_and(|byte| {
            kind(*byte, digits) && (at == start || (byte.is_ascii_digit() || *byte == b'.') == digits)
        });
        if inside {
            continue;
        }
        if at > start {
            parts.push((text[start..at].trim_end_matches('.'), slash));
            slash = false;
        }
        match bytes.get(at) {
            Some(byte) if byte.is_ascii_alphanumeric() => start = at,
            other => {
                slash = other == Some(&b'/');
                start = at + 1;
            }
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn amounts_are_read_from_names() {
        let kg = |text: &str| match in_text(text).map(|amount| amount.of) {
            Some(Stated::MassKg(kg)) => Some((kg * 1e6).round() / 1e6),
            Some(Stated::VolumeM3(m3)) => Some((m3 * 1e9).round() / 1e6),
            None => None,
        };
        for (text, amount) in [
            ("dumbbell_10kg", Some(10.0)),
            ("Nestle_Raisinets_35_oz_992_g", Some(0.992_233)),
            ("item 2.7 oz", Some(0.076_544)),
            ("small 12 fl oz", Some(0.354_882)),
            ("cola can 330ml", Some(0.33)),
            ("chair 2g", None),
            ("2-1/2 oz", None),
            ("box 12", None),
            ("no. 5", None),
            ("é 5kg", Some(5.0)),
        ] {
            assert_eq!(kg(text), amount, "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in any::<String>()) {
            let _ = in_text(&text);
        }
    }
}
