//! `physique report` as users and scripts see it.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;

use serde_json::Value;
use util::{run_to, shared_models, workspace};

fn json(path: &std::path::Path) -> Value {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_report_is_a_page_of_its_own_with_plots_json_and_csv() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = ["report", "free-fall", "roll-*", "--rounds", "2", "--out", "out", "--quiet"];
    let run = run_to(folder.path(), &[0], &args);
    assert!(run.stdout.contains("free-fall") && run.stdout.contains("report.html"), "{}", run.stdout);
    let out = folder.path().join("out");
    let report = json(&out.join("report.json"));
    let sheets = report["sheets"].as_array().expect("sheets");
    assert_eq!(sheets.len(), 4, "free fall and three that roll");
    for sheet in sheets {
        let rows = sheet["rows"].as_array().expect("rows");
        assert!(rows.len() >= 14, "{}: a sweep of two engines", sheet["scene"]);
        for row in rows {
            let figure = &row["errors"]["figures"][0];
            assert!(
                figure["value"].is_number() && row["ms"]["mean"].as_f64().is_some_and(|ms| ms > 0.0),
                "{row:#}"
            );
        }
        let ours =
            rows.iter().find(|row| row["engine"] == "physique" && row["is_default"] == true).expect("ours");
        assert!(ours["errors"]["figures"][0]["passes"] == true, "{ours:#}");
        assert!(ours["over_rapier"]["upper_95"].is_number());
    }
    let page = fs::read_to_string(out.join("report.html")).expect("a page");
    for outside in ["src=", "<script", "<link", "url("] {
        assert!(!page.contains(outside), "the page needs something else: {outside}");
    }
    assert!(page.matches("<svg").count() == 5 && page.contains("id=\"roll-hoop\""));
    let csv = fs::read_to_string(out.join("report.csv")).expect("a table");
    let columns = csv.lines().next().expect("a head").split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns), "{csv}");
    let plot = fs::read_to_string(out.join("plots/free-fall.svg")).expect("a plot");
    assert!(plot.starts_with("<svg") && plot.contains("Physique"));
}

#[test]
fn a_scene_of_the_user_s_goes_through_and_a_budget_is_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = workspace().join("tests/data/fall.yaml").display().to_string();
    let args = ["report", &scene, "--budget", "1mm", "--rounds", "2", "--quiet"];
    let run = run_to(folder.path(), &[0], &args);
    assert!(run.stdout.contains("to keep to the budget: Physique with --substeps"), "{}", run.stdout);
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0, "something was written unasked");
}

#[test]
fn what_is_not_there_or_not_right_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    for (args, said) in [
        (vec!["report", "no-such-scene"], "--list"),
        (vec!["report", "free-fall", "--budget", "cheap"], "as 1mm or 2ms"),
        (vec!["report", "free-fall", "--simd8", "nowhere"], "nowhere"),
        (vec!["report", "cube-tosses", "--tosses", "nowhere"], "nowhere"),
    ] {
        let run = run_to(folder.path(), &[2], &args);
        assert!(run.stderr.contains(said), "{args:?}: {}", run.stderr);
    }
}

#[test]
fn the_dog_comes_to_the_terrain() {
    let Some(models) = shared_models() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let models = models.display().to_string();
    let args = ["report", "seed-dog", "--models", &models, "--quick", "--rounds", "2", "--seconds", "0.1"];
    let run = run_to(folder.path(), &[0], &[&args[..], &["--format", "json", "--quiet"]].concat());
    let report = run.json();
    let rows = report["sheets"][0]["rows"].as_array().expect("rows");
    assert!(rows.iter().all(|row| row["errors"]["depth_end_m"].is_number()), "{report:#}");
}
