//! What fuzzing began with and what it found, as an ordinary test.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::cast_possible_truncation,
    reason = "a test may stop and say so"
)]

#[path = "../../fuzz/lib.rs"]
mod fuzz;

use std::fs;
use std::path::Path;

#[test]
fn every_seed_is_refused_or_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/seeds");
    let mut count = 0;
    for folder in fs::read_dir(root).unwrap() {
        let folder = folder.unwrap();
        let target = folder.file_name().into_string().unwrap();
        for seed in fs::read_dir(folder.path()).unwrap() {
            fuzz::run(&target, &fs::read(seed.unwrap().path()).unwrap());
            count += 1;
        }
    }
    assert!(count > 20, "{count} seeds");
}
