//! Seeded faults: a clean world gives no finding, and each of many kinds of fault is found with its code at its
//! place. `PHYSIQUE_SEED=7` runs another seed.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

#[path = "seeded/modelled.rs"]
mod modelled;
#[path = "seeded/mutation.rs"]
mod mutation;
#[path = "seeded/world.rs"]
mod world;
#[path = "seeded/written.rs"]
mod written;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use importer::Catalogue;
use mutation::{Mutation, Tamper};
use serde_json::Value;
use util::{run, run_to};
use world::{Rng, World};

const DB: &str = "catalogue.db";

fn seeds(default: &[u64]) -> Vec<u64> {
    match std::env::var("PHYSIQUE_SEED").ok().and_then(|seed| seed.parse().ok()) {
        Some(seed) => vec![seed],
        None => default.to_vec(),
    }
}

fn arguments<'a>(flags: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["check", "models", "--db", DB, "--catalog", "catalog.yaml", "--format", "json"];
    arguments.extend(["--quiet", "--threads", "1", "--exit-zero"]);
    arguments.extend(flags);
    arguments
}

fn findings(folder: &Path, flags: &[&str]) -> Vec<Value> {
    let run = run(folder, &arguments(flags));
    assert!(matches!(run.code, Some(0)), "{:?}: {}\n{}", run.code, run.stdout, run.stderr);
    run.json()["findings"].as_array().expect("findings").clone()
}

/// A clean world on disk, looked at once, with its lock.
fn prepared(seed: u64) -> (tempfile::TempDir, World) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut world = World::clean(seed);
    world.write(folder.path());
    run_to(folder.path(), &[0], &["lock", "models", "--db", DB, "--catalog", "catalog.yaml", "--quiet"]);
    let found = findings(folder.path(), &["--locked"]);
    assert!(found.is_empty(), "seed {seed}: the clean world has findings:\n{found:#?}");
    let lock = fs::read_to_string(folder.path().join("physique.lock")).expect("the lock");
    world.put("physique.lock", &lock);
    (folder, world)
}

#[test]
fn a_clean_world_gives_no_finding() {
    for seed in seeds(&[2, 3, 4]) {
        drop(prepared(seed));
    }
}

#[test]
fn every_kind_of_fault_is_found_with_its_code_at_its_place() {
    for seed in seeds(&[1]) {
        let (clean, world) = prepared(seed);
        let mutations: Vec<&Mutation> = written::MUTATIONS.iter().chain(modelled::MUTATIONS).collect();
        let next = AtomicUsize::new(0);
        let missed: Mutex<Vec<String>> = Mutex::default();
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    while let Some(mutation) = mutations.get(next.fetch_add(1, Ordering::Relaxed)) {
                        if let Err(why) = tried(mutation, clean.path(), &world, seed) {
                            missed.lock().expect("a lock").push(why);
                        }
                    }
                });
            }
        });
        let missed = missed.into_inner().expect("a lock");
        assert!(
            missed.is_empty(),
            "seed {seed}: {} of {} missed:\n{}",
            missed.len(),
            mutations.len(),
            missed.join("\n")
        );
    }
}

#[test]
fn the_kinds_of_fault_are_many_and_of_every_family() {
    let all: Vec<&Mutation> = written::MUTATIONS.iter().chain(modelled::MUTATIONS).collect();
    let names: BTreeSet<&str> = all.iter().map(|mutation| mutation.name).collect();
    assert_eq!(names.len(), all.len());
    assert!(all.len() >= 60, "{}", all.len());
    for family in physique::check::Family::ALL {
        assert!(
            all.iter().filter(|mutation| mutation.code.starts_with(family.code())).count() >= 5,
            "{family:?}"
        );
    }
    println!(
        "{} kinds of fault over {} codes",
        all.len(),
        all.iter().map(|m| m.code).collect::<BTreeSet<_>>().len()
    );
}

fn tried(mutation: &Mutation, clean: &Path, world: &World, seed: u64) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut mutated = world.clone();
    (mutation.change)(&mut mutated, &mut Rng(seed));
    mutated.write(folder.path());
    fs::copy(clean.join(DB), folder.path().join(DB)).expect("the catalogue copied");
    if let Some(tamper) = mutation.tamper {
        tamper_with(&folder.path().join(DB), mutation.model, tamper);
    }
    let run = run(folder.path(), &arguments(mutation.flags));
    if run.code != Some(0) {
        return Err(format!("{}: ended with {:?}: {}", mutation.name, run.code, run.stderr));
    }
    let told = run.json();
    let found = told["findings"].as_array().expect("findings");
    let line = mutation.at.map(|(file, words)| (file, mutated.line(file, words)));
    let right = |finding: &&Value| {
        finding["code"] == mutation.code
            && finding["model"].as_str().unwrap_or_default() == mutation.model
            && line.is_none_or(|(file, line)| finding["file"] == file && finding["line"] == line)
    };
    if found.iter().any(|finding| right(&finding)) {
        return Ok(());
    }
    let shown: Vec<String> = found
        .iter()
        .map(|f| format!("{} {} {}:{} {}", f["code"], f["model"], f["file"], f["line"], f["message"]))
        .collect();
    Err(format!(
        "{}: no {} at {:?} {line:?}, found:\n    {}",
        mutation.name,
        mutation.code,
        mutation.model,
        shown.join("\n    ")
    ))
}

fn tamper_with(db: &Path, model: &str, tamper: Tamper) {
    let catalogue = Catalogue::open(db).expect("opened");
    match tamper {
        Tamper::Asset(change) => {
            let record = catalogue.record(model).expect("read").expect("a record");
            let mut asset =
                catalogue.asset(&record.row.key.expect("a key")).expect("read").expect("an asset");
            change(&mut asset);
            catalogue.put_model(record, Some(asset)).expect("put");
            // The stages after it have to look again.
            for stage in ["map", "check", "prove"] {
                let row = catalogue.stage(model, stage).expect("read").expect("a result");
                catalogue.put_stage(importer::StageRow { input_key: String::new(), ..row }).expect("put");
            }
        }
        Tamper::Proof(change) => {
            let row = catalogue.stage(model, "prove").expect("read").expect("a proof");
            let mut proof: Value = serde_json::from_str(&row.result).expect("JSON");
            change(&mut proof);
            catalogue.put_stage(importer::StageRow { result: proof.to_string(), ..row }).expect("put");
        }
    }
    catalogue.flush().expect("flushed");
}
