//! The whole flow on the demo's own models and on broken ones.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;
use std::path::Path;

use serde_json::Value;
use util::{count, files, run_to};

/// Drops and their comparison are deterministic; whether one model in some breaks a law of the drop is not what
/// these tests ask, so findings are allowed where counts are checked.
const RAN: [i32; 2] = [0, 1];

fn demo(folder: &Path, more: &[&str]) -> Value {
    let mut args = vec!["demo", "--format", "json"];
    args.extend(more);
    run_to(folder, &RAN, &args).json()
}

/// The outputs that must not depend on whether results were known: everything but times and the recording,
/// whose bytes hold the clock.
fn outputs(out: &Path) -> Vec<(String, Vec<u8>)> {
    let bytes = |name: &str| fs::read(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut summary: Value = serde_json::from_slice(&bytes("summary.json")).expect("JSON");
    // What the run itself did; the rest is what came of it.
    for field in ["seconds", "seconds_a_stage", "mapped_anew"] {
        summary[field] = Value::Null;
    }
    vec![
        ("attributes.json".to_owned(), bytes("attributes.json")),
        ("validation.csv".to_owned(), bytes("validation.csv")),
        ("summary.json".to_owned(), summary.to_string().into_bytes()),
    ]
}

#[test]
fn the_demo_goes_through_every_stage_and_a_second_run_changes_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("physique-demo");
    let first = demo(folder.path(), &[]);
    let models = count(&first, "found");
    assert!(models >= 12, "{models} models");
    assert_eq!(
        (count(&first, "imported"), count(&first, "mapped"), count(&first, "failed")),
        (models, models, 0)
    );
    assert_eq!(count(&first, "uncategorized"), 0, "{first:#}");
    for kind in ["rigid", "soft", "fluid", "anchored"] {
        assert!(count(&first, kind) > 0, "no {kind} model");
    }
    assert_eq!(count(&first, "rigid") + count(&first, "soft") + count(&first, "fluid"), models);
    assert_eq!(count(&first, "simulated"), count(&first, "rigid") - count(&first, "anchored"));
    assert!(count(&first, "settled") * 100 >= count(&first, "simulated") * 90, "{first:#}");
    assert!(count(&first, "agree_with_rapier") * 100 >= count(&first, "simulated") * 75, "{first:#}");
    let attributes: Value =
        serde_json::from_slice(&fs::read(out.join("attributes.json")).expect("attributes")).expect("JSON");
    assert_eq!(attributes.as_array().map(Vec::len), usize::try_from(models).ok());

    let cold = outputs(&out);
    let recording = out.join("recording.rrd");
    let written = |path: &Path| fs::metadata(path).and_then(|facts| facts.modified()).ok();
    let (before, bytes) = (written(&recording), fs::metadata(&recording).expect("a recording").len());
    assert!(bytes > 100_000, "the recording has {bytes} bytes");
    let second = demo(folder.path(), &[]);
    assert_eq!((count(&first, "mapped_anew"), count(&second, "mapped_anew")), (models, 0));
    assert_eq!(second["findings"], first["findings"]);
    assert_eq!(outputs(&out), cold);
    assert_eq!(written(&recording), before, "an unchanged recording was written again");

    // From nothing, elsewhere: the same again. Paths are part of the outputs, so the folders are named alike.
    let other = tempfile::tempdir().expect("a temporary folder");
    demo(other.path(), &["--threads", "1"]);
    assert_eq!(
        outputs(&other.path().join("physique-demo")),
        cold,
        "one thread gives another result than many"
    );
}

#[test]
fn only_what_changed_is_done_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("a folder");
    let cube = fs::read(util::workspace().join("tests/data/cube.obj")).expect("the cube");
    for name in ["crate.obj", "box.obj"] {
        fs::write(models.join(name), &cube).expect("a model");
    }
    let run = || run_to(folder.path(), &RAN, &["run", "models", "--format", "json", "--no-record"]).json();
    let mass = |model: &str| {
        let bytes = fs::read(folder.path().join("physique-out/attributes.json")).expect("attributes");
        let all: Value = serde_json::from_slice(&bytes).expect("JSON");
        let found = all.as_array().expect("an array").iter().find(|entry| entry["model"] == model).cloned();
        let attributes = found.expect("the model")["attributes"].clone();
        let mass =
            attributes.as_array().expect("an array").iter().find(|value| value["name"] == "mass").cloned();
        mass.expect("a mass")["value"].as_f64().expect("a number")
    };
    assert_eq!(count(&run(), "simulated"), 2);
    let other = mass("box.obj");
    fs::write(models.join("crate.physics.yaml"), "mass: 4.25 kg\n").expect("a sidecar");
    assert_eq!(count(&run(), "simulated"), 2);
    assert!((mass("crate.obj") - 4.25).abs() < 1e-12 && (mass("box.obj") - other).abs() < 1e-12);
    fs::remove_file(models.join("box.obj")).expect("removed");
    assert_eq!(count(&run(), "found"), 1);
}

#[test]
fn a_broken_file_is_a_failure_and_the_others_go_on() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let models = folder.path().join("models");
    fs::create_dir_all(models.join("deep")).expect("a folder");
    fs::copy(util::workspace().join("tests/data/cube.obj"), models.join("deep/crate.obj")).expect("a model");
    fs::write(models.join("broken.glb"), b"glTF\x02\0\0\0\xff\xff\xff\xffnot much").expect("a file");
    fs::write(models.join("empty.stl"), b"").expect("a file");
    fs::copy(models.join("deep/crate.obj"), models.join("odd.obj")).expect("a model");
    fs::write(models.join("odd.physics.yaml"), "weight: 3 kg\n").expect("a sidecar");

    let summary = run_to(folder.path(), &[1], &["run", "models", "--format", "json", "--no-record"]).json();
    assert_eq!((count(&summary, "found"), count(&summary, "imported"), count(&summary, "failed")), (4, 2, 3));
    assert_eq!((count(&summary, "mapped"), count(&summary, "simulated")), (1, 1));
    let failures = summary["failures"].as_array().expect("failures");
    let stage = |file: &str| {
        let failure = failures.iter().find(|failure| failure["file"] == file);
        let failure = failure.unwrap_or_else(|| panic!("no failure of {file} in {summary:#}"));
        for field in ["reason", "way_out", "code"] {
            assert!(failure[field].as_str().is_some_and(|text| !text.is_empty()), "{file} has no {field}");
        }
        failure["stage"].as_str().unwrap_or_default().to_owned()
    };
    assert_eq!([stage("broken.glb"), stage("empty.stl"), stage("odd.obj")], ["import", "import", "map"]);

    // The failure goes when its cause does.
    fs::write(models.join("odd.physics.yaml"), "mass: 3 kg\n").expect("a sidecar");
    let summary = run_to(folder.path(), &[1], &["run", "models", "--format", "json", "--no-record"]).json();
    assert_eq!((count(&summary, "failed"), count(&summary, "simulated")), (2, 2));
    let text = run_to(folder.path(), &[1], &["run", "models", "--no-record"]);
    for expected in ["broken.glb", "empty.stl", "4 models in models"] {
        assert!(text.stdout.contains(expected), "no {expected:?} in:\n{}", text.stdout);
    }
}

#[test]
fn models_are_never_touched_and_nothing_is_written_elsewhere() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("a folder");
    fs::copy(util::workspace().join("tests/data/cube.obj"), models.join("crate.obj")).expect("a model");
    let before = files(&models);
    run_to(folder.path(), &RAN, &["run", "models", "--out", "results", "--db", "state/known.db", "-q"]);
    assert_eq!(files(&models), before);
    let mut entries: Vec<String> = fs::read_dir(folder.path())
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    entries.sort();
    assert_eq!(entries, ["models", "results", "state"]);
    let names: Vec<String> = files(&folder.path().join("results"))
        .iter()
        .map(|(path, _)| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default())
        .collect();
    assert_eq!(names, ["attributes.json", "recording.rrd", "summary.json", "validation.csv"]);
}
