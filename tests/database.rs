//! The shared models, where this machine has them: every category model through the whole flow.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use util::{count, run_to, shared_models};

/// Models in category folders; the rest are the hard cases.
const CATEGORY_MODELS: usize = 215;
const HARD_CASES: usize = 136;

/// Of measured sizes and volumes against the independent reader's.
const TOLERANCE: f64 = 1e-5;

/// The rows of a CSV file without quotes that hide commas in the columns asked for, by column.
fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    lines
        .map(|line| {
            header.iter().map(|name| (*name).to_owned()).zip(line.split(',').map(str::to_owned)).collect()
        })
        .collect()
}

#[test]
fn every_category_model_comes_through_and_every_hard_case_is_read_or_refused_by_name() {
    let Some(models) = shared_models() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let models = models.display().to_string();
    let summary = run_to(folder.path(), &[0, 1], &["run", &models, "--format", "json", "--no-record"]).json();
    assert_eq!(count(&summary, "found") as usize, CATEGORY_MODELS + HARD_CASES);

    let failures = summary["failures"].as_array().expect("failures");
    for failure in failures {
        let text = |field: &str| failure[field].as_str().unwrap_or_default().to_owned();
        assert!(!text("reason").is_empty() && !text("way_out").is_empty(), "{failure:#}");
        assert_ne!(text("code"), "panic", "{failure:#}");
        let file = text("file");
        assert!(file.starts_with("hard/"), "{file} failed: {failure:#}");
    }
    assert_eq!(count(&summary, "failed") as usize, failures.len());
    assert!(failures.len() < HARD_CASES, "every hard case was refused");
    assert_eq!(count(&summary, "mapped"), count(&summary, "imported"));
    assert_eq!(
        count(&summary, "rigid") + count(&summary, "soft") + count(&summary, "fluid"),
        count(&summary, "mapped")
    );
    let simulated = count(&summary, "simulated");
    assert!(
        count(&summary, "settled") * 100 >= simulated * 95,
        "{} of {simulated} rest",
        count(&summary, "settled")
    );
    assert!(count(&summary, "settled_in_rapier") * 100 >= simulated * 95);
}

#[test]
fn measures_are_those_of_the_independent_reader() {
    let Some(models) = shared_models() else { return };
    let facts = models.join("FACTS.csv");
    if !facts.is_file() {
        println!("skipped: {} is not there", facts.display());
        return;
    }
    let mut compared = 0;
    for row in table(&facts) {
        let field = |name: &str| row.get(name).map(String::as_str).unwrap_or_default();
        let closed = field("watertight") == "yes" && !field("flags").contains("skin");
        if field("path").starts_with("hard/") || !closed {
            continue;
        }
        let path = models.join(field("path"));
        // Colliders are another test's matter, and take most of an import's time.
        let options =
            importer::Options { hull_vertices: 16, max_decomposition_triangles: 0, ..Default::default() };
        let asset =
            importer::import(&path, &options).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let measures = &asset.measures;
        assert!(measures.closed, "{} is not closed", field("path"));
        assert_eq!(measures.triangles.to_string(), field("triangles"), "{}", field("path"));
        let near = |found: f64, name: &str| {
            let Ok(expected) = field(name).parse::<f64>() else { return };
            let off = (found - expected).abs() / expected.abs().max(f64::MIN_POSITIVE);
            assert!(off <= TOLERANCE, "{} {name}: {found} instead of {expected}", field("path"));
        };
        for (axis, name) in ["size_x", "size_y", "size_z"].into_iter().enumerate() {
            near(measures.size()[axis], name);
        }
        if field("winding_consistent") == "yes" && field("inside_out_bodies") == "0" {
            near(measures.signed_volume.expect("a volume"), "volume");
        }
        compared += 1;
    }
    assert!(compared >= 50, "only {compared} closed models were compared");
    println!("{compared} closed models agree");
}

#[test]
fn a_second_run_on_an_unchanged_folder_says_the_same() {
    let Some(models) = shared_models() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let models = models.join("food").display().to_string();
    let read = |name: &str| fs::read(folder.path().join("physique-out").join(name)).expect("an output");
    let run = || run_to(folder.path(), &[0, 1], &["run", &models, "--format", "json", "--no-record"]).json();
    let first: Value = run();
    let cold = [read("attributes.json"), read("validation.csv")];
    let second = run();
    assert_eq!([read("attributes.json"), read("validation.csv")], cold);
    assert_eq!((&first["failures"], &first["breaches"]), (&second["failures"], &second["breaches"]));
}
