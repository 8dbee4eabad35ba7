//! Large databases: a run that is killed or whose disk is full leaves what is whole, and the next one makes the rest;
//! a run divided over machines comes to what an undivided one comes to.

#![cfg(unix)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use importer::catalogue::{FailureRow, StageRow};
use importer::{Asset, Catalogue, ModelRow};
use util::{physique, run_to};

/// Whether a drop keeps the laws is not asked here.
const RAN: [i32; 2] = [0, 1];

/// Everything a catalogue says that does not tell one run from another.
#[derive(Debug, PartialEq)]
struct Said {
    models: Vec<ModelRow>,
    assets: Vec<Option<Asset>>,
    failures: Vec<FailureRow>,
    stages: Vec<StageRow>,
}

fn said(db: &Path) -> Said {
    let catalogue = Catalogue::open(db).expect("a catalogue");
    assert_eq!(catalogue.check().expect("a check"), Vec::<String>::new());
    let models = catalogue.models().expect("models");
    let asset = |row: &ModelRow| row.key.map(|key| catalogue.asset(&key).expect("an asset"));
    Said {
        assets: models.iter().filter_map(asset).collect(),
        failures: catalogue.failures().expect("failures"),
        stages: ["map", "drop"].map(|stage| catalogue.stages(stage).expect("stages")).concat(),
        models,
    }
}

/// Whether a recording was written to its end: the footer comes last.
fn is_whole(recording: &Path) -> bool {
    let bytes = fs::read(recording).expect("a recording");
    bytes.len() > 100_000 && bytes[bytes.len() - 64..].windows(8).any(|word| word == b"RRF2FOOT")
}

/// Models of every geometry, and two that are refused.
fn models(folder: &Path) {
    let root = folder.join("models");
    fs::create_dir(&root).expect("a folder");
    for (index, side) in (0..24).map(|index| (index, 0.05 + 0.01 * f64::from(index))) {
        let corners: Vec<String> = (0..8_u32)
            .map(|bits| {
                let at = |axis: u32| if bits >> axis & 1 == 1 { side * (1.0 + f64::from(axis)) } else { 0.0 };
                format!("v {} {} {}\n", at(0), at(1), at(2))
            })
            .collect();
        let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        fs::write(root.join(format!("crate_{index}.obj")), corners.concat() + faces).expect("a model");
    }
    let shapes = "shapes:\n  - { shape: sphere, radius: 10 cm, material: steel }\n";
    fs::write(root.join("ball.shapes.yaml"), shapes).expect("a model");
    fs::write(root.join("cup.binvox"), b"#binvox 1\ndim 2 2 2\ndata\n\x01\x05\x00\x03").expect("a model");
    fs::write(root.join("cut.glb"), b"glTF\x02\0\0\0\x60\0\0\0").expect("a model");
    fs::write(root.join("empty.obj"), b"").expect("a model");
}

#[test]
fn killed_at_ten_moments_and_resumed_it_is_as_if_it_never_was() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    models(folder.path());
    let args = ["run", "models", "--out", "out", "--quiet"];
    let out = folder.path().join("out");
    let db = out.join("catalogue.db");

    let begun = Instant::now();
    run_to(folder.path(), &RAN, &args);
    let whole = begun.elapsed();
    let calm = said(&db);
    let recording = out.join("recording.rrd");
    assert!(is_whole(&recording));
    fs::remove_dir_all(&out).expect("outputs");

    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut killed = 0;
    for attempt in 0..10 {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let share = (state >> 11) as f64 / (1_u64 << 53) as f64;
        let mut child = physique(folder.path(), &args)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        std::thread::sleep(Duration::from_secs_f64(0.9 * share * whole.as_secs_f64()));
        child.kill().expect("a signal");
        killed += u32::from(child.wait().expect("an end").code().is_none());
        if db.is_file() {
            let left = Catalogue::open(&db).expect("a catalogue");
            assert_eq!(left.check().expect("a check"), Vec::<String>::new(), "attempt {attempt}");
        }
        // Either there is none yet, or it is whole.
        assert!(!recording.exists() || is_whole(&recording), "attempt {attempt}");
        if attempt == 4 {
            fs::remove_dir_all(&out).expect("outputs");
        }
    }
    println!("{killed} of 10 runs were killed before their end; a whole one takes {whole:.1?}");
    assert!(killed >= 3, "only {killed} runs were killed");

    run_to(folder.path(), &RAN, &args);
    assert_eq!(said(&db), calm);
    assert!(is_whole(&recording));
    assert!(!out.join("recording.part.rrd").exists());
}

#[test]
fn a_file_that_cannot_grow_is_told_and_leaves_the_catalogue_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    models(folder.path());
    let db = folder.path().join("out/catalogue.db");
    // Blocks of 512 bytes: room for the empty catalogue and a few rows. Ignored, the signal becomes an error.
    let limited = |blocks: u32| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let program = env!("CARGO_BIN_EXE_physique");
        let args = ["-c", &script, "sh", program, "import", "models", "--out", "out", "--quiet"];
        Command::new("sh").args(args).current_dir(folder.path()).output().expect("it starts")
    };
    for blocks in [8, 150, 250, 400] {
        let output = limited(blocks);
        let told = String::from_utf8_lossy(&output.stderr);
        println!("{blocks} blocks: {:?} {told}", output.status);
        if !output.status.success() && output.status.code() != Some(1) {
            assert!(output.status.code().is_some(), "it was killed: {:?}", output.status);
            assert!(told.contains("room"), "{told}");
        }
        if db.is_file() {
            let left = Catalogue::open(&db).expect("a catalogue");
            assert_eq!(left.check().expect("a check"), Vec::<String>::new());
        }
    }
    let first = limited(150);
    assert_eq!(first.status.code(), Some(2), "a catalogue fits into 75 kB");
    run_to(folder.path(), &RAN, &["import", "models", "--out", "out", "--quiet"]);
    let resumed = said(&db);
    fs::remove_dir_all(folder.path().join("out")).expect("outputs");
    run_to(folder.path(), &RAN, &["import", "models", "--out", "out", "--quiet"]);
    assert_eq!(resumed, said(&db));
}

#[test]
fn shards_merged_are_what_one_run_makes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    models(folder.path());
    let run = |args: &[&str]| run_to(folder.path(), &RAN, args);
    let flow = ["--quiet", "--no-record", "--time", "2s"];
    run(&[&["run", "models", "--out", "whole"], &flow[..]].concat());
    for share in ["1/3", "2/3", "3/3"] {
        let out = format!("share{}", &share[..1]);
        run(&[&["run", "models", "--out", &out, "--shard", share], &flow[..]].concat());
    }
    let merged =
        run(&["merge", "share1", "share2", "share3/catalogue.db", "--out", "merged", "--format", "json"]);
    assert_eq!(merged.json()["models"], 28);
    let [whole, merged] = ["whole", "merged"].map(|out| said(&folder.path().join(out).join("catalogue.db")));
    assert_eq!(whole, merged);
    let wrong = run_to(folder.path(), &[2], &["merge", "share1", "nowhere", "--out", "elsewhere"]);
    assert!(
        wrong.stderr.contains("nowhere/catalogue.db") || wrong.stderr.contains("nowhere"),
        "{}",
        wrong.stderr
    );
    assert!(!folder.path().join("elsewhere").exists());
    run_to(folder.path(), &[2], &["import", "models", "--shard", "4/3"]);
}
