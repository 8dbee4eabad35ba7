//! What ARCHITECTURE.md promises: which way the crates point, who may name what, how long a file may be.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use util::workspace;

/// A hard stop: a longer file holds more than one noun.
const MOST_LINES: usize = 600;

const CRATES: [&str; 6] = ["physique", "baseline", "importer", "mapper", "sim", "viewer"];

/// Which of our crates each may depend on.
const ARROWS: [(&str, &[&str]); 6] = [
    ("physique", &["baseline", "importer", "mapper", "sim", "viewer"]),
    ("baseline", &["sim"]),
    ("importer", &[]),
    ("mapper", &["importer", "sim"]),
    ("sim", &[]),
    ("viewer", &["sim"]),
];

/// Crates that the solver's normal tree must never hold.
const NOT_IN_SIM: [&str; 8] =
    ["rapier3d", "rerun", "gltf", "rusqlite", "serde_yaml", "yaml_serde", "saphyr", "clap"];

/// A crate's name in code, and the only places that may hold it.
const NAMED_IN: [(&str, &[&str]); 6] = [
    ("rerun", &["viewer/"]),
    ("rapier3d", &["baseline/"]),
    ("rusqlite", &["importer/"]),
    ("gltf", &["importer/"]),
    ("serde_yaml", &["mapper/"]),
    ("parry3d", &["importer/", "sim/src/collide/parry.rs", "sim/examples/narrow_phase.rs"]),
];

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .current_dir(workspace())
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo's JSON")
}

/// Names of a package's normal and optional dependencies.
fn dependencies(metadata: &Value, package: &str) -> BTreeSet<String> {
    let packages = metadata["packages"].as_array().expect("packages");
    let is_ours = |entry: &&Value| entry["name"] == package && entry["source"].is_null();
    let package = packages.iter().find(is_ours).unwrap_or_else(|| panic!("no package {package}"));
    let normal = package["dependencies"].as_array().expect("dependencies").iter();
    normal
        .filter(|dependency| dependency["kind"].is_null())
        .filter_map(|dependency| dependency["name"].as_str().map(str::to_owned))
        .collect()
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Every source file of ours, by its path in the workspace with forward slashes.
fn sources() -> BTreeMap<String, String> {
    let mut found = Vec::new();
    for folder in ["src", "tests", "baseline", "importer", "mapper", "sim", "viewer"] {
        rust_files(&workspace().join(folder), &mut found);
    }
    found
        .into_iter()
        .map(|path| {
            let text =
                fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let below = path.strip_prefix(workspace()).expect("inside the workspace");
            (below.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/"), text)
        })
        .collect()
}

#[test]
fn crates_point_one_way() {
    let metadata = metadata();
    let ours = BTreeSet::from(CRATES.map(str::to_owned));
    for (package, allowed) in ARROWS {
        let found: BTreeSet<String> = dependencies(&metadata, package).intersection(&ours).cloned().collect();
        let allowed: BTreeSet<String> = allowed.iter().map(|name| (*name).to_owned()).collect();
        assert!(found.is_subset(&allowed), "{package} depends on {:?}", found.difference(&allowed));
    }
}

#[test]
fn the_solver_s_tree_is_free_of_files_and_engines() {
    let metadata = metadata();
    let names: BTreeMap<&str, &str> = metadata["packages"]
        .as_array()
        .expect("packages")
        .iter()
        .filter_map(|package| Some((package["id"].as_str()?, package["name"].as_str()?)))
        .collect();
    let edges: BTreeMap<&str, Vec<&str>> = metadata["resolve"]["nodes"]
        .as_array()
        .expect("nodes")
        .iter()
        .filter_map(|node| {
            let normal = node["deps"].as_array()?.iter().filter(|dependency| {
                dependency["dep_kinds"]
                    .as_array()
                    .is_some_and(|kinds| kinds.iter().any(|kind| kind["kind"].is_null()))
            });
            Some((node["id"].as_str()?, normal.filter_map(|dependency| dependency["pkg"].as_str()).collect()))
        })
        .collect();
    let sim = names.iter().find(|(id, name)| **name == "sim" && id.starts_with("path+")).map(|(id, _)| *id);
    let mut waiting = vec![sim.expect("the package sim")];
    let mut tree = BTreeSet::new();
    while let Some(id) = waiting.pop() {
        if tree.insert(names[id]) {
            waiting.extend(&edges[id]);
        }
    }
    assert!(tree.len() > 1, "sim has no dependencies at all: the walk is wrong");
    for name in NOT_IN_SIM {
        assert!(!tree.contains(name), "{name} is in sim's tree");
    }
}

#[test]
fn each_library_is_named_in_its_place_alone() {
    for (path, text) in sources().iter().filter(|(path, _)| *path != "tests/architecture.rs") {
        for (name, places) in NAMED_IN {
            if places.iter().any(|place| path.starts_with(place)) {
                continue;
            }
            for (number, line) in text.lines().enumerate() {
                let code = line.split("//").next().unwrap_or_default();
                let named = code.contains(&format!("{name}::")) || code.contains(&format!("use {name}"));
                assert!(!named, "{path}:{} names {name}, which belongs to {places:?}", number + 1);
            }
        }
    }
}

#[test]
fn no_source_file_is_longer_than_it_may_be() {
    for (path, text) in sources() {
        let lines = text.lines().count();
        assert!(lines <= MOST_LINES, "{path} has {lines} lines; {MOST_LINES} are allowed");
    }
}

#[test]
fn every_path_that_the_architecture_names_is_there() {
    let text = fs::read_to_string(workspace().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    // A path is what stands in backquotes and has a slash or an ending; a command has spaces.
    let named: BTreeSet<&str> = text
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|word| !word.contains([' ', '\n', ':', '(', '<', '*', '{', '=']))
        .filter(|word| {
            let ends =
                [".rs", ".md", ".toml", ".yaml", ".sql", ".py", ".yml"].iter().any(|end| word.ends_with(end));
            word.ends_with('/') || ends
        })
        .collect();
    assert!(named.len() >= 5, "ARCHITECTURE.md names hardly a path: {named:?}");
    for path in named {
        assert!(workspace().join(path).exists(), "ARCHITECTURE.md names {path}, which is not there");
    }
}
