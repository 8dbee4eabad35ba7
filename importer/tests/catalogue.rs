//! The catalogue keeps what it is given: bit for bit, through reopening, beside others, and refuses what it
//! must not touch.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use importer::catalogue::{
    Catalogue, CatalogueError, Dependency, Failure, FailureRow, ModelRecord, ModelRow, StageRow, Stamp,
};
use importer::collider::{Candidate, ColliderError, Rung, Shape};
use importer::{
    Asset, AssetKey, Axis, BodyRole, BodyVolume, FileFrame, Format, Geometry, MassProperties, Measures, Note,
    Part, Stated, StatedValue, VolumeMethod,
};
use proptest::prelude::*;
use rusqlite::Connection;
use tempfile::{TempDir, tempdir};

fn folder_and_path() -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("catalogue.sqlite");
    (folder, path)
}

fn measures(n: [f64; 3]) -> Measures {
    let mass = MassProperties { measure: n[0], centroid: n, inertia: [n[0], n[1], n[2], n[2], n[1], n[0]] };
    Measures {
        triangles: 12,
        vertices: 24,
        vertices_welded: 8,
        min: [0.0; 3],
        max: n,
        closed: true,
        wound_consistently: false,
        bodies: 1,
        inside_out_bodies: 0,
        boundary_edges: 0,
        nonmanifold_edges: 0,
        degenerate_triangles: 1,
        signed_volume: Some(n[1]),
        solid: Some(mass),
        solid_method: Some(VolumeMethod::Oriented),
        solid_error: Some(n[2]),
        solid_confidence: None,
        body_volumes: vec![BodyVolume {
            role: BodyRole::Cavity,
            triangles: 12,
            volume: n[0],
            method: Some(VolumeMethod::Capped),
            error: n[1],
            confidence: n[2],
        }],
        shell: mass,
        hull_volume: None,
    }
}

fn candidate(rung: Rung, shapes: Vec<Shape>, number: f64) -> Candidate {
    Candidate {
        rung,
        shapes,
        error: ColliderError { surface_max: number, volume_ratio: Some(number), ..ColliderError::default() },
        vertices: 8,
        cost: number,
        fallback: Some("quote \" and \\ and ü".to_owned()),
    }
}

/// Every kind of shape, on the whole and on a part.
fn asset(key: u8, n: [f64; 3]) -> Asset {
    let rotation = [n[0], n[1], n[2], 1.0];
    let short = vec![
        Shape::Sphere { center: n, radius: n[0] },
        Shape::Box { center: n, rotation, half_extents: n },
        Shape::Capsule { center: n, rotation, half_height: n[1], radius: n[2] },
        Shape::Cylinder { center: n, rotation, half_height: n[1], radius: n[2] },
    ];
    let long = vec![
        Shape::Hull { points: vec![n, [n[2], n[1], n[0]], n] },
        Shape::Sphere { center: n, radius: 1.0 },
        Shape::TriangleMesh { positions: vec![n, n], triangles: vec![[0, 1, u32::MAX]] },
        Shape::Hull { points: Vec::new() },
    ];
    let part = |name: &str, ladder| Part {
        name: name.to_owned(),
        materials: vec!["oak".to_owned()],
        measures: measures(n),
        ladder,
    };
    Asset {
        key: AssetKey([key; 32]),
        format: Format::Glb,
        geometry: Geometry::Voxels,
        frame: FileFrame { metres_per_unit: n[0], unit_stated: false, up: Axis::Z, up_stated: true },
        measures: measures(n),
        ladder: vec![
            candidate(Rung::Box, short, n[0]),
            candidate(Rung::Hull, long.clone(), n[2]),
            candidate(Rung::Decomposition, long.clone(), n[1]),
        ],
        parts: vec![
            part("seat", Vec::new()),
            part("leg", vec![candidate(Rung::Sphere, Vec::new(), n[2]), candidate(Rung::Hull, long, n[2])]),
        ],
        names: vec!["Stuhl".to_owned(), String::new()],
        stated: vec![Stated { value: StatedValue::MassKg(n[0]), place: "nodes[1]".to_owned() }],
        notes: vec![Note { code: "welded".to_owned(), place: "line 3".to_owned(), message: "m".to_owned() }],
    }
}

fn record(model: &str, root: &str, key: Option<AssetKey>, failure: Option<Failure>) -> ModelRecord {
    ModelRecord {
        row: ModelRow { model: model.to_owned(), root: PathBuf::from(root), key, failure },
        stamp: Stamp { bytes: 17, modified_ns: Some(-1_234_567_890_123) },
        dependencies: Vec::new(),
        content: key,
        options: "v1".to_owned(),
    }
}

fn failure(code: &str) -> Failure {
    Failure {
        code: code.to_owned(),
        place: "line 4".to_owned(),
        reason: "expected three numbers".to_owned(),
        way_out: "Export it again".to_owned(),
    }
}

fn stage(model: &str, stage: &str, result: &str) -> StageRow {
    StageRow {
        model: model.to_owned(),
        stage: stage.to_owned(),
        input_key: "k".to_owned(),
        status: "done".to_owned(),
        result: result.to_owned(),
    }
}

/// Debug text tells -0 from 0 and gives every finite number its own digits.
fn bits(asset: &Asset) -> String {
    format!("{asset:?}")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn an_asset_comes_back_bit_for_bit(
        n in prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO)
    ) {
        let catalogue = Catalogue::open_in_memory().unwrap();
        let given = asset(1, n);
        catalogue.put_model(record("m", "/r", Some(given.key), None), Some(given.clone())).unwrap();
        catalogue.flush().unwrap();
        let back = catalogue.asset(&given.key).unwrap().unwrap();
        prop_assert_eq!(bits(&back), bits(&given));

        let lean = catalogue.asset_with_hull(&given.key).unwrap().unwrap();
        let mut without = given;
        without.ladder.retain(|candidate| candidate.rung == Rung::Hull);
        for part in &mut without.parts {
            part.ladder.clear();
        }
        prop_assert_eq!(bits(&lean), bits(&without));
    }
}

#[test]
fn a_number_that_is_not_finite_is_refused_and_the_writer_goes_on() {
    let catalogue = Catalogue::open_in_memory().unwrap();
    for wrong in [f64::NAN, f64::INFINITY] {
        let bad = asset(1, [1.0, wrong, 2.0]);
        let refusal = catalogue.put_model(record("m", "/r", Some(bad.key), None), Some(bad));
        assert!(matches!(refusal, Err(CatalogueError::Unstorable { .. })), "{refusal:?}");
    }
    catalogue.put_stage(stage("m", "map", "{}")).unwrap();
    catalogue.flush().unwrap();
    assert_eq!(catalogue.summary().unwrap().models, 0);
    assert_eq!(catalogue.stages("map").unwrap().len(), 1);
}

#[test]
fn an_asset_made_anew_replaces_the_old_one_whole() {
    let catalogue = Catalogue::open_in_memory().unwrap();
    let old = asset(1, [1.0, 2.0, 3.0]);
    let mut new = asset(1, [4.0, 5.0, 6.0]);
    new.parts.pop();
    new.ladder.pop();
    catalogue.put_model(record("m", "/r", Some(old.key), None), Some(old.clone())).unwrap();
    let renewed = ModelRecord { options: "v2".to_owned(), ..record("m", "/r", Some(new.key), None) };
    catalogue.put_model(renewed, Some(new.clone())).unwrap();
    catalogue.flush().unwrap();
    assert_eq!(catalogue.asset(&old.key).unwrap(), Some(new));
    assert!(catalogue.has_asset(&old.key, "v2").unwrap());
    assert!(!catalogue.has_asset(&old.key, "v1").unwrap());
}

#[test]
fn everything_is_there_after_reopening_without_a_flush() {
    let (_folder, path) = folder_and_path();
    let catalogue = Catalogue::open(&path).unwrap();
    let given = asset(7, [0.1, 0.2, 0.3]);
    let mut good = record("a/chair.gltf", "/r", Some(given.key), None);
    good.dependencies = vec![Dependency {
        path: "chair 1.bin".to_owned(),
        stamp: Stamp { bytes: u64::from(u32::MAX) * 9, modified_ns: None },
    }];
    let bad = record("b/broken.stl", "/r", None, Some(failure("malformed")));
    catalogue.put_model(good.clone(), Some(given.clone())).unwrap();
    catalogue.put_model(bad.clone(), None).unwrap();
    catalogue.put_stage(stage("a/chair.gltf", "map", r#"{"kind":"rigid"}"#)).unwrap();
    let fell = FailureRow {
        model: "a/chair.gltf".to_owned(),
        stage: "simulate".to_owned(),
        failure: failure("exploded"),
    };
    catalogue.put_failure(fell.clone()).unwrap();
    drop(catalogue);

    assert!(!path.with_extension("sqlite-wal").exists(), "a closed catalogue is one file");
    let catalogue = Catalogue::open(&path).unwrap();
    assert_eq!(catalogue.models().unwrap(), [good.row.clone(), bad.row.clone()]);
    assert_eq!(catalogue.model("b/broken.stl").unwrap(), Some(bad.row.clone()));
    assert_eq!(catalogue.model("b").unwrap(), None);
    assert_eq!(catalogue.record("a/chair.gltf").unwrap(), Some(good));
    assert_eq!(catalogue.asset(&given.key).unwrap(), Some(given));
    assert_eq!(catalogue.asset(&AssetKey([8; 32])).unwrap(), None);
    assert_eq!(
        catalogue.stage("a/chair.gltf", "map").unwrap().map(|row| row.result),
        Some(r#"{"kind":"rigid"}"#.to_owned())
    );
    assert_eq!(catalogue.stage("a/chair.gltf", "simulate").unwrap(), None);
    let refused = FailureRow {
        model: "b/broken.stl".to_owned(),
        stage: "import".to_owned(),
        failure: failure("malformed"),
    };
    assert_eq!(catalogue.failures().unwrap(), [fell, refused]);
    catalogue.clear_failure("a/chair.gltf", "simulate").unwrap();
    catalogue.flush().unwrap();
    assert_eq!(catalogue.failures().unwrap().len(), 1);
    let summary = catalogue.summary().unwrap();
    assert_eq!((summary.models, summary.imported, summary.assets), (2, 1, 1));
    assert_eq!(summary.failures["import"]["malformed"], 1);
    assert_eq!(summary.stages["map"]["done"], 1);
}

#[test]
fn a_model_that_is_gone_takes_its_rows_along_and_shared_assets_stay() {
    let catalogue = Catalogue::open_in_memory().unwrap();
    let shared = asset(1, [1.0; 3]);
    let own = asset(2, [2.0; 3]);
    for (model, root, asset) in
        [("a", "/r", &shared), ("b", "/r", &shared), ("c", "/r", &own), ("d", "/other", &shared)]
    {
        let record = record(model, root, Some(asset.key), None);
        catalogue.put_model(record, Some(asset.clone())).unwrap();
        catalogue.put_stage(stage(model, "map", "1")).unwrap();
    }
    catalogue
        .put_failure(FailureRow { model: "c".to_owned(), stage: "check".to_owned(), failure: failure("x") })
        .unwrap();
    let present = BTreeSet::from(["b".to_owned()]);
    assert_eq!(catalogue.forget_missing(Path::new("/r"), present).unwrap(), 2);
    assert_eq!(catalogue.prune().unwrap(), 1);
    let names: Vec<String> = catalogue.models().unwrap().into_iter().map(|row| row.model).collect();
    assert_eq!(names, ["b", "d"]);
    assert_eq!(catalogue.stages("map").unwrap().len(), 2);
    assert_eq!(catalogue.failures().unwrap(), []);
    assert!(catalogue.asset(&shared.key).unwrap().is_some());
    assert!(catalogue.asset(&own.key).unwrap().is_none());
    assert_eq!(catalogue.check().unwrap(), Vec::<String>::new());
}

#[test]
fn a_model_whose_asset_was_dropped_by_another_run_is_to_do() {
    let catalogue = Catalogue::open_in_memory().unwrap();
    catalogue.put_model(record("a", "/r", Some(AssetKey([5; 32])), None), None).unwrap();
    catalogue.flush().unwrap();
    let row = catalogue.model("a").unwrap().unwrap();
    assert_eq!((row.key, row.failure), (None, None));
}

#[test]
fn what_is_no_catalogue_is_refused_and_not_touched() {
    let (folder, path) = folder_and_path();
    fs::write(&path, "solid cube\n".repeat(200)).unwrap();
    let before = fs::read(&path).unwrap();
    let refusal = Catalogue::open(&path).err().unwrap();
    assert_eq!(refusal, CatalogueError::NotADatabase { path: path.clone() });
    assert!(refusal.to_string().contains("not an SQLite database"));
    assert_eq!(fs::read(&path).unwrap(), before);

    let foreign = folder.path().join("foreign.sqlite");
    Connection::open(&foreign).unwrap().execute_batch("CREATE TABLE t (n)").unwrap();
    let before = fs::read(&foreign).unwrap();
    assert!(matches!(Catalogue::open(&foreign), Err(CatalogueError::Foreign { .. })));
    assert_eq!(fs::read(&foreign).unwrap(), before);

    let absent = folder.path().join("no/such/folder/c.sqlite");
    assert!(matches!(Catalogue::open(&absent), Err(CatalogueError::Open { .. })));
}

#[test]
fn a_newer_catalogue_is_refused_with_both_versions() {
    let (_folder, path) = folder_and_path();
    drop(Catalogue::open(&path).unwrap());
    Connection::open(&path).unwrap().pragma_update(None, "user_version", 99).unwrap();
    let refusal = Catalogue::open(&path).err().unwrap();
    assert!(matches!(refusal, CatalogueError::Newer { found: 99, .. }), "{refusal:?}");
    assert!(refusal.to_string().contains("version 99"), "{refusal}");
}

#[test]
fn a_row_that_makes_no_sense_is_named() {
    let (_folder, path) = folder_and_path();
    let catalogue = Catalogue::open(&path).unwrap();
    let given = asset(3, [1.0, 2.0, 3.0]);
    catalogue.put_model(record("m", "/r", Some(given.key), None), Some(given.clone())).unwrap();
    catalogue.flush().unwrap();
    let spoil = |sql: &str| Connection::open(&path).unwrap().execute_batch(sql).unwrap();
    for sql in [
        "UPDATE collider SET geometry = x'00' WHERE length(geometry) > 0",
        "UPDATE collider SET geometry = CAST(geometry || x'0000' AS BLOB)",
        "UPDATE collider SET part = 9 WHERE part = 1 AND step = 0",
        "UPDATE part SET facts = '{}'",
        "UPDATE asset SET facts = 'nonsense'",
    ] {
        catalogue.put_model(record("m", "/r", Some(given.key), None), Some(given.clone())).unwrap();
        catalogue.flush().unwrap();
        assert!(catalogue.asset(&given.key).unwrap().is_some());
        spoil(sql);
        let refusal = catalogue.asset(&given.key).unwrap_err();
        assert!(matches!(refusal, CatalogueError::Corrupt { .. }), "{sql}: {refusal:?}");
        assert!(refusal.to_string().contains(&given.key.to_string()), "{refusal}");
    }
}

#[test]
fn sql_can_ask_what_it_wants_to_know() {
    let (_folder, path) = folder_and_path();
    let catalogue = Catalogue::open(&path).unwrap();
    let given = asset(3, [1.5, 2.5, 3.5]);
    catalogue.put_model(record("m", "/r", Some(given.key), None), Some(given)).unwrap();
    catalogue.flush().unwrap();
    let connection = Connection::open(&path).unwrap();
    let row: (String, i64, bool, f64, String, String) = connection
        .query_row(
            "SELECT format, triangles, closed, size_z, volume_method, up FROM model JOIN asset ON key = asset
             WHERE model = 'm'",
            [],
            |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?, row.get(5)?)),
        )
        .unwrap();
    assert_eq!(row, ("glb".to_owned(), 12, true, 3.5, "oriented".to_owned(), "z".to_owned()));
    let radius: f64 = connection
        .query_row("SELECT shapes ->> '$[0].sphere.radius' FROM collider WHERE rung = 'box'", [], |row| {
            row.get(0)
        })
        .unwrap();
    assert_eq!(radius.to_bits(), 1.5_f64.to_bits());
    let corners: i64 = connection
        .query_row(
            "SELECT shapes ->> '$[0].hull.points' FROM collider WHERE part = -1 AND rung = 'decomposition'",
            [],
            |row| row.get(0),
        )
        .unwrap();
    assert_eq!(corners, 3);
}

#[test]
fn many_handles_and_threads_on_one_file_lose_nothing() {
    let (_folder, path) = folder_and_path();
    thread::scope(|scope| {
        for writer in 0..4 {
            let path = &path;
            scope.spawn(move || {
                // Opened at once by all, each with a writer of its own, as by four processes.
                let catalogue = Catalogue::open(path).unwrap();
                for index in 0..400 {
                    let own = stage(&format!("{writer}/{index}"), "map", "1");
                    catalogue.put_stage(own).unwrap();
                    catalogue.put_stage(stage(&format!("shared/{index}"), "map", "2")).unwrap();
                    if index % 100 == 7 {
                        catalogue.flush().unwrap();
                        assert!(catalogue.stage(&format!("{writer}/{index}"), "map").unwrap().is_some());
                    }
                }
            });
        }
    });
    let catalogue = Catalogue::open(&path).unwrap();
    assert_eq!(catalogue.stages("map").unwrap().len(), 4 * 400 + 400);
    assert_eq!(catalogue.check().unwrap(), Vec::<String>::new());
}

#[test]
fn clones_share_a_writer_and_readers_run_beside_it() {
    let (_folder, path) = folder_and_path();
    let catalogue = Catalogue::open(&path).unwrap();
    thread::scope(|scope| {
        for writer in 0..3 {
            let catalogue = catalogue.clone();
            scope.spawn(move || {
                for index in 0..700 {
                    catalogue.put_stage(stage(&format!("{writer}/{index}"), "map", "1")).unwrap();
                    if index % 50 == 0 {
                        catalogue.models().unwrap();
                    }
                }
            });
        }
    });
    catalogue.flush().unwrap();
    assert_eq!(catalogue.stages("map").unwrap().len(), 2_100);
}

#[test]
fn a_merge_takes_everything_over_and_the_other_wins() {
    let (folder, path) = folder_and_path();
    let other_path = folder.path().join("it's other.sqlite");
    let one = Catalogue::open(&path).unwrap();
    let other = Catalogue::open(&other_path).unwrap();
    let (old, new) = (asset(1, [1.0; 3]), asset(1, [2.0; 3]));
    let more = asset(2, [3.0; 3]);
    one.put_model(record("a", "/r", Some(old.key), None), Some(old.clone())).unwrap();
    one.put_model(record("b", "/r", None, Some(failure("io"))), None).unwrap();
    one.put_stage(stage("a", "map", "1")).unwrap();
    other.put_model(record("b", "/r", Some(new.key), None), Some(new.clone())).unwrap();
    other.put_model(record("c", "/r", Some(more.key), None), Some(more.clone())).unwrap();
    other.put_model(record("d", "/r", None, Some(failure("malformed"))), None).unwrap();
    other.put_stage(stage("c", "map", "2")).unwrap();
    other.flush().unwrap();

    // Rows given before the merge are in before it.
    one.merge_from(&other_path).unwrap();
    let rows: Vec<_> = one.models().unwrap().into_iter().map(|row| (row.model, row.key)).collect();
    let row = |name: &str, asset: Option<&Asset>| (name.to_owned(), asset.map(|asset| asset.key));
    assert_eq!(rows, [row("a", Some(&new)), row("b", Some(&new)), row("c", Some(&more)), row("d", None)]);
    assert_eq!(one.asset(&new.key).unwrap(), Some(new));
    assert_eq!(one.asset(&more.key).unwrap(), Some(more));
    let failures: Vec<String> = one.failures().unwrap().into_iter().map(|row| row.model).collect();
    assert_eq!(failures, ["d"]);
    assert_eq!(one.stages("map").unwrap(), [stage("a", "map", "1"), stage("c", "map", "2")]);
    assert_eq!(one.check().unwrap(), Vec::<String>::new());

    assert!(matches!(one.merge_from(&path), Err(CatalogueError::MergeItself { .. })));
    let absent = folder.path().join("absent.sqlite");
    assert!(matches!(one.merge_from(&absent), Err(CatalogueError::Open { .. })));
    assert!(!absent.exists());
    // A merge that failed has lost nothing, so the catalogue goes on.
    one.put_stage(stage("e", "map", "3")).unwrap();
    one.flush().unwrap();
}
