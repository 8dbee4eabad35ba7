//! What is wrong with files that people write: named with its place, the way out, and never a panic.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use std::fmt::Write;

use common::{SMALL, rules};
use mapper::{MapError, Overrides, Ruleset, SetValue, Sidecar, Tags, read_table};
use proptest::prelude::*;

fn first(error: &MapError) -> (&'static str, u32, u32) {
    let diagnostic = &error.diagnostics()[0];
    (diagnostic.code, diagnostic.line, diagnostic.column)
}

#[test]
fn faults_name_their_place_and_the_way_out() {
    for (from, to, code, help) in [
        ("preset: oak\n", "preset: oka\n", "CAT005", "did you mean `oak`?"),
        ("7850 kg/m3", "7850", "CAT004", "write `7850 kg/m3`"),
        ("7850 kg/m3", "7850 kg", "CAT004", "units of density"),
        (
            "    friction_dynamic: 0.35",
            "    friction_dynamc: 0.35",
            "CAT002",
            "did you mean `friction_dynamic`?",
        ),
        ("kind: soft, aliases", "kind: sotf, aliases", "CAT005", "did you mean `soft`?"),
        ("source: book", "source: bok", "CAT005", "did you mean `book`?"),
        ("fill: 0.1 }", "fill: 1.1 }", "CAT008", ""),
        ("[70 cm, 1.1 m]", "[70 cm, 0.1 m]", "CAT008", "swap them"),
        ("chair.n.01", "chair", "CAT003", "armchair.n.01"),
        ("    preset: oak\n", "    preset: oak\n    preset: oak\n", "CAT006", ""),
        ("subcategory: toy,", "subcategory: toyy,", "CAT005", "did you mean"),
        ("word: toy }", "wrod: toy }", "CAT002", "did you mean `word`?"),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "{from}");
        let error = Ruleset::parse("bad.yaml", &text).unwrap_err();
        let (found, line, _) = first(&error);
        let changed = text.lines().zip(SMALL.lines()).position(|(new, old)| new != old).unwrap() + 1;
        assert_eq!(found, code, "{error}");
        assert_eq!(line as usize, changed, "{error}");
        let shown = error.to_string();
        assert!(shown.contains(&format!("bad.yaml:{line}:")) && shown.contains('^'), "{shown}");
        assert!(shown.contains(help), "{shown}");
    }
    // A carriage return by itself, which YAML takes for the end of a line.
    let (code, line, _) = first(&Overrides::parse("a", "{ a: \"b\rc\": d }", &rules()).unwrap_err());
    assert_eq!((code, line), ("CAT001", 1));
    assert!(SetValue::parse("mass=2.4", &rules()).is_err());
    assert!(
        SetValue::parse("mas=2.4 kg", &rules()).unwrap_err().to_string().contains("did you mean `mass`?")
    );
    assert!(SetValue::parse("mass", &rules()).is_err());
    let deep = "[".repeat(10_000);
    assert!(Ruleset::parse("deep.yaml", &deep).is_err());
    assert!(Ruleset::parse("alias.yaml", "a: &a [1]\nb: *a\n").is_err());
}

#[test]
fn static_analysis_finds_what_cannot_be_right() {
    let with = |rules: &str| {
        let text = format!("{SMALL}{rules}");
        let rules = Ruleset::parse("small.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
        mapper::check_rules(&rules).iter().map(|finding| finding.code.to_string()).collect::<Vec<_>>()
    };
    let before = with("");
    for (rule, code) in [
        (
            "  - { name: a, when: { aspect: [2, 3], all: [{ aspect: [4, 5] }] }, set: { kind: soft } }\n",
            "RUL002",
        ),
        ("  - { name: a, when: { bodies: [0, 0.5] }, set: { kind: soft } }\n", "RUL002"),
        ("  - { name: a, when: { word: toy }, set: { restitution: 0.1, subcategory: toy } }\n", "RUL003"),
        ("  - { name: a, when: { word: x }, set: { category: dish }, confidence: 0.1 }\n", "RUL004"),
    ] {
        let mut after = with(rule);
        for known in &before {
            let at = after.iter().position(|code| code == known).expect("a finding went away");
            after.remove(at);
        }
        assert_eq!(after, [code], "{rule}");
    }
    let text = SMALL.replace("aliases: [bar stool]", "aliases: [bar stool, chair]");
    let rules = Ruleset::parse("small.yaml", &text).unwrap();
    assert!(mapper::check_rules(&rules).iter().any(|finding| &*finding.code == "RUL001"));
}

#[test]
fn rules_that_go_round_in_a_circle_are_found() {
    let with = |rules: &str| {
        let rules = Ruleset::parse("small.yaml", &format!("{SMALL}{rules}")).unwrap();
        mapper::check_rules(&rules)
            .into_iter()
            .filter(|finding| &*finding.code == "RUL011")
            .collect::<Vec<_>>()
    };
    assert!(with("").is_empty());
    let there = "  - { name: there, when: { alias: bowl }, set: { subcategory: plate } }\n";
    let further =
        "  - { name: further, when: { any: [{ alias: plate }, { word: x }] }, set: { subcategory: toy } }\n";
    let back = "  - { name: back, when: { alias: toy, not: { word: y } }, set: { subcategory: bowl } }\n";
    assert!(with(&format!("{there}{further}")).is_empty());
    let found = with(&format!("{there}{further}{back}"));
    assert_eq!(found.len(), 1, "{found:?}");
    for part in ["`there`", "`further`", "`back`", "small.yaml:"] {
        assert!(found[0].message.contains(part), "{found:?}");
    }
    // A rule on a whole category that sets one of its own is no circle.
    assert!(with("  - { name: own, when: { alias: dish }, set: { subcategory: bowl } }\n").is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn mutated_yaml_is_refused_with_a_place_or_read(at in 0..SMALL.len(), cut in 0usize..12, put in "[ -~\n\t#é{}\\[\\]:]{0,6}") {
        let from = (0..=at).rev().find(|byte| SMALL.is_char_boundary(*byte)).unwrap_or(0);
        let to = (from + cut).min(SMALL.len());
        let text = format!("{}{put}{}", &SMALL[..from], &SMALL[to..]);
        if let Err(error) = Ruleset::parse("mutated.yaml", &text) {
            prop_assert!(!error.diagnostics().is_empty());
            let lines = text.lines().count() as u32 + 1;
            for diagnostic in error.diagnostics() {
                prop_assert!(diagnostic.line <= lines, "{}", diagnostic.place());
            }
            let mut shown = String::new();
            write!(shown, "{error}").unwrap();
            prop_assert!(shown.contains("mutated.yaml"));
        }
    }

    #[test]
    fn no_text_makes_a_reader_of_files_panic(text in "[ -~\n\t:\\-\\[\\]{}é\"']{0,120}") {
        let rules = rules();
        for error in [
            Overrides::parse("o.yaml", &text, &rules).err(),
            Sidecar::parse("s.yaml", &text, &rules).err(),
            Tags::parse("t", &text).err(),
            read_table("t.csv", &text).err(),
            SetValue::parse(&text, &rules).err(),
        ].into_iter().flatten() {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    /// Words of the real grammar put together at random come nearer to what people get wrong than bytes do.
    #[test]
    fn no_sentence_of_the_grammar_makes_the_catalogue_panic(
        words in prop::collection::vec(prop::sample::select(vec![
            "categories", "subcategories", "presets", "rules", "kinds", "chair", "oak", "when", "set", "all", "not", "alias",
            "word", "size", "mass", "mass_model", "shell", "fill", "[", "]", "{", "}", ":", ",", "-", "\n", "\n  ", "\n    ",
            "\n      ", " ", "7850 kg/m3", "2 mm", "0.5", "rigid", "~", "'", "\"", "**/a", "path", "contents", "source", "#",
        ]), 0..60),
    ) {
        let text: String = words.concat();
        if let Err(error) = Ruleset::parse("g.yaml", &format!("{SMALL}{text}")) {
            prop_assert!(error.to_string().contains("g.yaml"));
        }
    }
}
