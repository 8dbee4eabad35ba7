//! From a file to an asset.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::fs;

use importer::{Axis, Format, Options, asset_of, import, read};

const TWO: &str = "o Left\nusemtl Oak\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n\
    o Right\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\nf 5 6 99\n";

#[test]
fn a_file_of_two_parts_is_measured_whole_and_in_parts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.obj");
    fs::write(&path, TWO).unwrap();
    let asset = import(&path, &Options::default()).unwrap();
    assert_eq!((asset.format, asset.frame.up, asset.frame.unit_stated), (Format::Obj, Axis::Y, false));
    assert_eq!(asset.names, ["Left", "Oak", "Right"]);
    assert_eq!(asset.parts.iter().map(|part| part.measures.triangles).collect::<Vec<_>>(), [4, 5]);
    assert_eq!((asset.measures.triangles, asset.measures.bodies), (9, 2));
    assert!((asset.measures.signed_volume.unwrap() - 1.0 / 3.0).abs() < 1e-12);
    assert!(!asset.ladder.is_empty() && asset.parts.iter().all(|part| !part.ladder.is_empty()));
    let note = asset.notes.iter().find(|note| note.code == "faces-dropped").unwrap();
    assert!(note.message.starts_with("1 of 5"), "{}", note.message);
}

#[test]
fn one_part_or_too_many_get_no_ladders_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.obj");
    fs::write(&path, TWO).unwrap();
    let source = read(&path, &Options::default()).unwrap();
    let few = Options { part_ladders: 1, ..Options::default() };
    let asset = asset_of(&source, &few).unwrap();
    assert!(asset.parts.iter().all(|part| part.ladder.is_empty()));
    assert_ne!(few.fingerprint(), Options::default().fingerprint());
}

#[test]
fn the_same_file_gives_the_same_asset() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.obj");
    fs::write(&path, TWO).unwrap();
    let options = Options::default();
    assert_eq!(import(&path, &options).unwrap(), import(&path, &options).unwrap());
}
