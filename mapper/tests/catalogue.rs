//! The shipped catalogue: read, complete, sound, and read alike by a second parser.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::path::Path;

use mapper::{Kind, Ruleset, check_rules};

fn root() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn embedded() -> Ruleset {
    Ruleset::embedded().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_catalogue_is_as_large_as_promised() {
    let stats = embedded().stats();
    assert!(stats.categories >= 128, "{stats:?}");
    assert!(stats.subcategories >= 418, "{stats:?}");
    assert!(stats.presets_rigid >= 70 && stats.presets_soft >= 25 && stats.presets_fluid >= 25, "{stats:?}");
}

#[test]
fn every_preset_has_every_attribute_of_its_kind_and_a_source_for_each() {
    let rules = embedded();
    let mut missing = Vec::new();
    for preset in &rules.presets {
        for id in &rules.kind(preset.kind).attributes {
            let spec = &mapper::ATTRIBUTES[*id];
            if spec.name == "mass" {
                continue;
            }
            match &preset.figures[*id] {
                None => missing.push(format!("{}: no {}", preset.name, spec.name)),
                Some(figure) if figure.by.cites.is_none() => {
                    missing.push(format!("{}: {} without source", preset.name, spec.name));
                }
                Some(_) => {}
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn every_subcategory_has_synset_size_and_mass() {
    let rules = embedded();
    let mut missing = Vec::new();
    for subcategory in &rules.subcategories {
        let category = &rules.categories[subcategory.category];
        let size = subcategory.size.as_ref().or(category.size.as_ref());
        let mass = subcategory.mass.as_ref().or(category.mass.as_ref());
        if subcategory.synset.is_none() || size.is_none() || mass.is_none() {
            missing.push(subcategory.name.to_string());
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn static_analysis_finds_nothing() {
    let findings: Vec<String> = check_rules(&embedded())
        .into_iter()
        .map(|finding| {
            let place = finding.place.map_or_else(String::new, |place| place.place());
            format!("{place}: {} {}", finding.code, finding.message)
        })
        .collect();
    assert!(findings.is_empty(), "{findings:#?}");
}

#[test]
fn the_floor_of_the_drop_test_is_in_it() {
    let concrete = embedded().surface("concrete").expect("a preset named concrete");
    assert!(concrete.friction > 0.3 && concrete.restitution < 0.9, "{concrete:?}");
    assert_eq!(embedded().kind(Kind::Fluid).kind, Kind::Fluid);
}

/// Scalars as text, so that two parsers can be compared.
fn flatten(value: &serde_yaml::Value, path: &str, out: &mut Vec<(String, String)>) {
    match value {
        serde_yaml::Value::Mapping(map) => {
            for (key, value) in map {
                flatten(value, &format!("{path}/{}", scalar(key)), out);
            }
        }
        serde_yaml::Value::Sequence(items) => {
            for (index, value) in items.iter().enumerate() {
                flatten(value, &format!("{path}/{index}"), out);
            }
        }
        other => out.push((path.to_owned(), scalar(other))),
    }
}

fn scalar(value: &serde_yaml::Value) -> String {
    match value {
        serde_yaml::Value::String(text) => text.clone(),
        serde_yaml::Value::Number(number) => number.to_string(),
        serde_yaml::Value::Bool(value) => value.to_string(),
        _ => String::new(),
    }
}

#[test]
fn a_second_parser_reads_the_same() {
    for file in ["catalog.yaml", "mapper/tests/data/scene.yaml"] {
        let text = std::fs::read_to_string(root().join(file)).unwrap();
        let value: serde_yaml::Value =
            serde_yaml::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let mut theirs = Vec::new();
        flatten(&value, "", &mut theirs);
        let ours = mapper::yaml_scalars(file, &text).unwrap();
        assert_eq!(ours.len(), theirs.len(), "{file}");
        for ((our_path, our_text), (their_path, their_text)) in ours.iter().zip(&theirs) {
            assert_eq!(our_path, their_path, "{file}");
            // The other parser has made numbers of numbers.
            let same =
                our_text == their_text || our_text.parse::<f64>().ok() == their_text.parse::<f64>().ok();
            assert!(same, "{file}: {our_path}: {our_text:?} against {their_text:?}");
        }
    }
}

#[test]
fn the_schema_beside_the_catalogue_is_the_one_that_the_tool_writes() {
    let written = std::fs::read_to_string(root().join("catalog.schema.json")).unwrap();
    let made = mapper::schema::catalogue(&embedded());
    assert!(written == made, "catalog.schema.json is stale: run `physique schema`");
}
