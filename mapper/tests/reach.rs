//! A changed rule maps again only the models that it reaches, and every one of them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::{SMALL, facts, mapper_of, solid};
use mapper::{Mapped, Mapper, ModelFacts, Overrides, Ruleset};
use proptest::prelude::*;

const NAMES: [&str; 16] = [
    "steel_chair.glb",
    "dog_bowl.glb",
    "Dog.glb",
    "toy_dog.glb",
    "Lamp_Table.glb",
    "oak stool.glb",
    "plate07.glb",
    "fishknife.glb",
    "mugg.glb",
    "bowls/0042.glb",
    "qwertz.glb",
    "foam/table.glb",
    "a/b/knife fish.glb",
    "bowl of water.glb",
    "gizmo.glb",
    "chair_orange.glb",
];

fn models() -> Vec<ModelFacts> {
    NAMES.iter().map(|name| solid(facts(name, 0.9), 0.01)).collect()
}

/// The answer without the lines where its reasons stand.
fn without_places(mapped: &Mapped) -> String {
    let mut value = serde_json::to_value(mapped).unwrap();
    strip(&mut value);
    value.to_string()
}

fn strip(value: &mut serde_json::Value) {
    match value {
        serde_json::Value::Object(map) => {
            map.remove("line");
            map.remove("column");
            map.values_mut().for_each(strip);
        }
        serde_json::Value::Array(items) => items.iter_mut().for_each(strip),
        serde_json::Value::String(text) => {
            // `catalog.yaml:12` inside a sentence.
            while let Some(at) = text.find(".yaml:") {
                let digits = text[at + 6..].bytes().take_while(u8::is_ascii_digit).count();
                text.replace_range(at + 5..at + 6 + digits, "");
            }
        }
        _ => {}
    }
}

fn mapper(text: &str) -> Option<Mapper> {
    Ruleset::parse("small.yaml", text).ok().map(|rules| Mapper::new(rules, Overrides::none()))
}

/// Of how many models the fingerprint differs.
fn reached(before: &Mapper, after: &Mapper) -> Vec<&'static str> {
    NAMES
        .into_iter()
        .zip(models())
        .filter(|(_, facts)| {
            before.consult(facts, None, &[]).reach().content
                != after.consult(facts, None, &[]).reach().content
        })
        .map(|(name, _)| name)
        .collect()
}

#[test]
fn a_change_reaches_what_it_speaks_of() {
    let before = mapper(SMALL).unwrap();
    for (from, to, expected) in [
        // A comment, and a rule for a word that no model has.
        ("categories:\n", "# ours\ncategories:\n", &[][..]),
        ("rules:\n", "rules:\n  - { name: n, when: { word: zebra }, set: { kind: soft } }\n", &[]),
        // An alias that one model has: what was a misspelling of nothing is a thing.
        (
            "bowl: { size",
            "bowl: { aliases: [gizmo], size",
            &["dog_bowl.glb", "bowls/0042.glb", "bowl of water.glb", "gizmo.glb"],
        ),
        // The fallback of every soft or fluid thing is no word of a chair; each answer rests on the kinds, though.
        // What a dog is counts for a dog, and not for a bowl or a toy that it could have been.
        ("      dog: { size: [40 cm", "      dog: { size: [41 cm", &["Dog.glb"]),
        (
            "{ word: toy }, set: { subcategory: toy, restitution: 0.45 }",
            "{ word: toy }, set: { subcategory: toy, restitution: 0.4 }",
            &["toy_dog.glb"],
        ),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "{from}");
        let mut found = reached(&before, &mapper(&text).unwrap());
        // The order of a change's models is that of the list above.
        found.sort_by_key(|name| expected.iter().position(|known| known == name));
        assert_eq!(found, expected, "{to}");
    }
}

#[test]
fn what_moves_down_a_line_keeps_its_content_and_not_its_places() {
    let (before, after) =
        (mapper(SMALL).unwrap(), mapper(&SMALL.replacen("categories:", "\ncategories:", 1)).unwrap());
    let chair = &models()[0];
    let (was, is) = (before.consult(chair, None, &[]).reach(), after.consult(chair, None, &[]).reach());
    assert_eq!(was.content, is.content);
    assert_ne!(was.places, is.places);
    assert_eq!(was, before.consult(chair, None, &[]).reach());
}

#[test]
fn overrides_reach_the_models_that_they_match() {
    let none = mapper_of("");
    let some = mapper_of("overrides:\n  - { match: '*chair*', set: { preset: steel } }\n");
    assert_eq!(reached(&none, &some), ["steel_chair.glb", "chair_orange.glb"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever is changed: the same content gives the same answer, the same places too the same lines.
    #[test]
    fn an_unreached_model_has_the_answer_that_it_had(at in 0..SMALL.len(), cut in 0usize..14, put in "[a-z0-9 ,.:{}\n]{0,8}") {
        let text = format!("{}{put}{}", &SMALL[..at], &SMALL[(at + cut).min(SMALL.len())..]);
        let before = mapper(SMALL).unwrap();
        if let Some(after) = mapper(&text) {
            for facts in models() {
                let (one, two) = (before.consult(&facts, None, &[]), after.consult(&facts, None, &[]));
                let (was, is) = (one.reach(), two.reach());
                if was.content == is.content {
                    prop_assert_eq!(without_places(&one.answer()), without_places(&two.answer()), "{}", facts.model);
                }
                if was == is {
                    prop_assert_eq!(one.answer(), two.answer(), "{}", facts.model);
                }
            }
        }
    }
}
