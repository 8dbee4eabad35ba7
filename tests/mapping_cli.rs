//! Rules and values as scripts handle them: tables, tags, `set`, `get`, `check --rules`.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;
use std::path::Path;

use util::{run_to, workspace};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// A tetrahedron: closed, so that mass follows from it.
fn model(folder: &Path, name: &str) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().expect("a parent")).expect("its folder");
    let text = "v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(path, text).expect("a model");
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("a file that the command wrote")
}

#[test]
fn a_table_is_mapped_without_meshes_the_same_way_twice() {
    let folder = folder();
    let table = "id,name,dim_x,kind\n1,oak armchair,0.9,fluid\n2,xyzzy,,\n3,coffee mug,95,\n";
    fs::write(folder.path().join("in.csv"), table).expect("a table");
    let printed = run_to(folder.path(), &[0], &["map", "--table", "in.csv"]).stdout;
    run_to(folder.path(), &[0], &["map", "--table", "in.csv", "--out", "out.csv"]);
    assert_eq!(printed, text(folder.path(), "out.csv"));
    let rows: Vec<Vec<&str>> = printed.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..6], ["id", "category", "subcategory", "synset", "group", "kind"]);
    assert_eq!((rows[1][2], rows[1][5]), ("armchair", "rigid"), "the truth columns are not read");
    assert_eq!((rows[2][1], rows[2][2]), ("", ""));
    assert_eq!((rows[3][2], rows[3][8]), ("coffee-mug", "mm"));
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 2, "something else was written");
}

#[test]
fn a_fault_of_a_table_has_its_place() {
    let folder = folder();
    fs::write(folder.path().join("in.csv"), "id,name\n1\n").expect("a table");
    let run = run_to(folder.path(), &[2], &["map", "--table", "in.csv", "--out", "out.csv"]);
    assert!(run.stderr.contains("in.csv:2"), "{}", run.stderr);
    assert!(!folder.path().join("out.csv").exists());
    run_to(folder.path(), &[2], &["map"]);
    run_to(folder.path(), &[2], &["map", "models", "--table", "in.csv"]);
    run_to(folder.path(), &[2], &["map", "--table", "in.csv", "--out", "."]);
}

#[test]
fn what_set_writes_get_reads_and_a_wrong_value_changes_nothing() {
    let folder = folder();
    let root = folder.path();
    model(root, "a/thing.obj");
    fs::write(root.join("a/thing.physics.yaml"), "# weighed\npreset: oak # ours\n").expect("a sidecar");
    run_to(root, &[0], &["set", "a/thing.obj", "mass=2.4kg", "category=chair"]);
    let expected = "# weighed\npreset: oak # ours\nmass: 2.4kg\ncategory: chair\n";
    assert_eq!(text(root, "a/thing.physics.yaml"), expected);
    let mass = run_to(root, &[0], &["get", "a/thing.obj", "mass"]).stdout;
    assert_eq!(mass, "2.4 kg  thing.physics.yaml:3 by sidecar\n");
    let all = run_to(root, &[0], &["get", "a/thing.obj"]).stdout;
    for expected in ["category             chair", "preset               oak", "density"] {
        assert!(all.contains(expected), "no {expected:?} in: {all}");
    }
    let json = run_to(root, &[0], &["get", "a/thing.obj", "mass", "--format", "json"]).json();
    assert_eq!((json[0]["value"].as_f64(), json[0]["unit"].as_str()), (Some(2.4), Some("kg")));

    for wrong in ["mass=2.4", "mas=2 kg", "preset=oke", "mass"] {
        let run = run_to(root, &[2], &["set", "a/thing.obj", wrong]);
        assert!(!run.stderr.is_empty());
    }
    assert_eq!(text(root, "a/thing.physics.yaml"), expected);
    run_to(root, &[2], &["set", "a/none.obj", "mass=1 kg"]);
    let run = run_to(root, &[2], &["get", "a/thing.obj", "colour"]);
    assert!(run.stderr.contains("mass"), "{}", run.stderr);
}

#[test]
fn a_project_file_gets_an_entry_that_get_obeys() {
    let folder = folder();
    let root = folder.path();
    model(root, "a/thing.obj");
    let set = ["set", "a/thing.obj", "mass=3 kg", "--project", "overrides.yaml"];
    run_to(root, &[0], &set);
    assert_eq!(
        text(root, "overrides.yaml"),
        "overrides:\n  - match: 'a/thing.obj'\n    set: { mass: 3 kg }\n"
    );
    let get = ["get", "a/thing.obj", "mass", "--root", ".", "--overrides", "overrides.yaml"];
    assert!(run_to(root, &[0], &get).stdout.starts_with("3 kg  overrides.yaml:3 "));
    let set = ["set", "a/thing.obj", "mass=4 kg", "--project", "overrides.yaml", "--glob", "a/**"];
    run_to(root, &[0], &set);
    assert!(run_to(root, &[0], &get).stdout.starts_with("4 kg  overrides.yaml:5 "));
    assert!(!root.join("a/thing.physics.yaml").exists());
}

#[test]
fn the_shipped_rules_have_no_fault_and_a_fault_is_found_at_its_place() {
    let folder = folder();
    let root = folder.path();
    let run = run_to(root, &[0], &["check", "--rules"]);
    assert!(run.stdout.starts_with("0 errors, 0 warnings, "), "{}", run.stdout);

    let catalogue = fs::read_to_string(workspace().join("catalog.yaml")).expect("the catalogue");
    let from = "aliases: [armchair, ";
    assert!(catalogue.contains(from));
    let line = 1 + catalogue[..catalogue.find(from).unwrap_or(0)].matches('\n').count();
    let twice = catalogue.replacen(from, "aliases: [bathtub, armchair, ", 1);
    fs::write(root.join("rules.yaml"), twice).expect("a catalogue");
    let args = ["check", "--rules", "--catalog", "rules.yaml"];
    let found = run_to(root, &[1], &[&args[..], &["--fail-on", "warning"]].concat()).stdout;
    assert!(found.contains("warning[MAP008]") && found.contains(&format!("rules.yaml:{line}")), "{found}");
    let json = run_to(root, &[0], &[&args[..], &["--format", "json", "--select", "MAP008"]].concat()).json();
    assert_eq!(json["findings"][0]["code"], "MAP008");
    assert!(json["findings"][0]["line"] == line && json["findings"][0]["column"].is_u64());
    run_to(root, &[2], &["check"]);
}

#[test]
fn an_override_that_matches_nothing_is_found() {
    let folder = folder();
    let root = folder.path();
    model(root, "models/a.obj");
    let entries =
        "overrides:\n  - { match: a.obj, set: { mass: 1 kg } }\n  - { match: b.obj, set: { mass: 1 kg } }\n";
    fs::write(root.join("models/overrides.yaml"), entries).expect("overrides");
    let args = ["check", "models", "--layer", "static,data", "--format", "concise", "--select", "MAP015"];
    let found = run_to(root, &[1], &[&args[..], &["--deny", "warnings"]].concat()).stdout;
    assert!(found.starts_with("models/overrides.yaml:3:5: MAP015 error: "), "{found}");
    assert!(found.lines().nth(1).is_some_and(|line| line.starts_with("1 error, 0 warnings")), "{found}");
}

#[test]
fn tags_of_a_manifest_say_what_a_model_is() {
    let folder = folder();
    let root = folder.path();
    model(root, "models/x1.obj");
    fs::write(root.join("tags.csv"), "path,tags\nx1.obj,armchair; oak\n").expect("tags");
    fs::write(root.join("tags.json"), r#"{ "x1.obj": ["coffee mug"] }"#).expect("tags");
    let category = |tags: &str| {
        let run = run_to(root, &[0, 1], &["map", "models", "--tags", tags, "--out", "out"]);
        run.stdout.lines().next().unwrap_or_default().to_owned()
    };
    assert!(category("tags.csv").contains("chair"), "{}", category("tags.csv"));
    // The same catalogue: other tags are another input.
    assert!(category("tags.json").contains("cup-and-mug"), "{}", category("tags.json"));
}

#[test]
fn a_proposal_is_heard_where_it_is_surer_than_the_rules() {
    let folder = folder();
    let root = folder.path();
    model(root, "models/x1.obj");
    model(root, "models/armchair.obj");
    let proposals = "proposed_by: vision\noverrides:\n  - { match: '*.obj', confidence: 0.8, set: { preset: steel, mass: 5 kg } }\n";
    fs::write(root.join("models/proposals.yaml"), proposals).expect("proposals");
    let get = |model: &str, name: &str| {
        run_to(root, &[0], &["get", &format!("models/{model}"), name, "--root", "models"]).stdout
    };
    assert!(get("x1.obj", "mass").starts_with("5 kg  models/proposals.yaml:3 by proposal:vision"));
    assert!(!get("armchair.obj", "mass").contains("proposal"), "{}", get("armchair.obj", "mass"));
    fs::write(root.join("models/overrides.yaml"), "overrides:\n  - { match: x1.obj, set: { mass: 1 kg } }\n")
        .expect("overrides");
    assert!(get("x1.obj", "mass").starts_with("1 kg  models/overrides.yaml:2 "));
    assert!(get("x1.obj", "preset").starts_with("steel "));
}
