//! What fuzzing began with and what it found, as an ordinary test.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may stop and say so")]

#[path = "../fuzz/lib.rs"]
mod fuzz;

use std::fs;
use std::path::Path;

#[test]
fn every_seed_is_refused_or_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    for target in fuzz::TARGETS {
        let seeds = fs::read_dir(root.join(target)).expect(target);
        let count = seeds.map(|seed| fuzz::run(target, &fs::read(seed.unwrap().path()).unwrap())).count();
        assert!(count > 0, "{target} has no seed");
    }
    for folder in fs::read_dir(root).unwrap() {
        let name = folder.unwrap().file_name().into_string().unwrap();
        assert!(fuzz::TARGETS.contains(&name.as_str()), "{name} is no target");
    }
}
