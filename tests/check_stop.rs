//! Ctrl-C while the gate works: it ends with 130, keeps what was done, and the next run goes on from there.
#![cfg(unix)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

#[allow(dead_code, reason = "the seeded tests use the rest")]
#[path = "seeded/world.rs"]
mod world;

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;
use util::{count, physique, run_to};
use world::World;

const MODELS: usize = 160;

const CHECK: [&str; 9] =
    ["check", "models", "--db", "catalogue.db", "--catalog", "catalog.yaml", "--format", "json", "--verbose"];

fn many() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut world = World::clean(21);
    for index in 0..MODELS {
        // No two have the same bytes: such a one is not imported again.
        world.put_box(&format!("storage/crate_{index:03}.glb"), [0.2, 0.15, 0.2 + 1e-4 * index as f64]);
    }
    world.write(folder.path());
    folder
}

/// Runs the gate on one thread, interrupts it so many times once a line begins so, and gives what it said.
fn interrupted(root: &Path, more: &[&str], line: &str, times: usize) -> (Option<i32>, String, String) {
    let args = [&CHECK[..], &["--threads", "1"], more].concat();
    let mut child = physique(root, &args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut lines = BufReader::new(child.stderr.take().expect("its stderr")).lines();
    let mut said = String::new();
    for told in lines.by_ref() {
        let told = told.expect("a line");
        said.push_str(&told);
        said.push('\n');
        if told.trim_start().starts_with(line) {
            break;
        }
    }
    for _ in 0..times {
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(sent.expect("kill starts").success());
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let mut out = String::new();
    // What is read to its end keeps neither pipe from being written.
    lines.for_each(|told| said.push_str(&(told.expect("a line") + "\n")));
    child.stdout.take().expect("its stdout").read_to_string(&mut out).expect("text");
    (child.wait().expect("it ends").code(), out, said)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn an_import_that_is_interrupted_goes_on_where_it_was() {
    let folder = many();
    let root = folder.path();
    let data = ["--layer", "data"];
    let (code, out, said) = interrupted(root, &data, "imported", 1);
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("stopping after the models in hand"), "{said}");
    let report = json(&out);
    let imported = usize::try_from(count(&report, "models")).expect("small");
    assert_eq!(report["stopped"], true);
    assert!((1..MODELS).contains(&imported), "{imported} models");
    let next = run_to(root, &[0, 1], &[&CHECK[..], &data].concat());
    assert_eq!(
        next.stderr.lines().filter(|line| line.trim_start().starts_with("unchanged ")).count(),
        imported
    );
    assert_eq!(next.json()["stopped"], false);
    assert!(count(&next.json(), "models") > MODELS as u64);
}

#[test]
fn trials_that_are_interrupted_are_not_made_again() {
    let folder = many();
    let root = folder.path();
    let (code, out, said) = interrupted(root, &[], "check ", 1);
    assert_eq!(code, Some(130), "{said}");
    let stopped = json(&out);
    let done = count(&stopped, "simulated");
    assert!(done < MODELS as u64, "{done} simulated");
    let next = run_to(root, &[0, 1], &CHECK).json();
    assert_eq!(count(&next, "unchanged"), done, "{}", next["simulated"]);
    assert!(count(&next, "simulated") + done >= MODELS as u64);
}

#[test]
fn two_interrupts_end_at_once_and_harm_nothing() {
    let folder = many();
    let root = folder.path();
    fs::write(root.join("baseline.txt"), "# physique baseline 1\n").expect("written");
    let update = ["--baseline", "baseline.txt", "--update-baseline"];
    let (code, _, said) = interrupted(root, &update, "check ", 2);
    assert_eq!(code, Some(130), "{said}");
    let baseline = fs::read_to_string(root.join("baseline.txt")).expect("the baseline");
    assert_eq!(baseline, "# physique baseline 1\n", "half a baseline would bring back the other half as new");
    let catalogue = importer::Catalogue::open(&root.join("catalogue.db")).expect("opened");
    assert_eq!(catalogue.check().expect("checked"), Vec::<String>::new());
    drop(catalogue);
    run_to(root, &[0, 1], &[&CHECK[..], &["--layer", "static,data"]].concat());
}
