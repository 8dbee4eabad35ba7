//! Every sample model against what an independent reader measured in it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod support;

use std::collections::BTreeMap;
use std::path::Path;

use importer::{Geometry, ImportError, Measures, Options, Source, measure, read, weld};

type Row = BTreeMap<String, String>;

/// Where the table and these measures differ, and why that is right.
const EXPLAINED: [(&str, &[&str]); 5] = [
    // 125 instances of a cube: the table counts it once.
    ("hard/transforms/SimpleInstancing.glb", &["triangles", "vertices", "bodies", "size", "area", "volume"]),
    // Both bodies are wound both ways, so their signed volume depends on where it is taken about.
    ("hard/topology/multibody.stl", &["inside_out_bodies"]),
    // A flat square, rotated: its thickness is rounding.
    ("hard/topology/Cube_Dirt_Center_Tall.glb", &["size_y"]),
    // 84 skins over one mesh: without them, as in the table, the copies lie in one place.
    ("hard/transforms/RecursiveSkeletons.glb", &["vertices_merged", "bodies", "nonmanifold_edges"]),
    // Needles on rotated nodes: whether their area comes to exactly nothing is rounding.
    ("hard/compressed/helicopter.gltf", &["zero_area_triangles"]),
];

fn is_explained(model: &str, misfit: &str) -> bool {
    let columns = EXPLAINED.iter().find(|(explained, _)| *explained == model);
    columns.is_some_and(|(_, columns)| columns.iter().any(|column| misfit.starts_with(column)))
}

struct Outcome {
    row: Row,
    read: Result<(Source, Measures), ImportError>,
}

fn measured(root: &Path, row: &Row) -> Result<(Source, Measures), ImportError> {
    let source = read(&root.join(&row["path"]), &Options::default())?;
    let mut measures = measure(&weld(&source.merged()));
    measures.triangles += source.parts.iter().map(|part| part.dropped).sum::<u64>();
    Ok((source, measures))
}

fn outcomes(root: &Path) -> Vec<Outcome> {
    let rows = support::table(&root.join("FACTS.csv"));
    rows.into_iter().map(|row| Outcome { read: measured(root, &row), row }).collect()
}

fn number(row: &Row, column: &str) -> Option<f64> {
    row[column].parse().ok()
}

fn differs(found: f64, expected: f64, tolerance: f64) -> bool {
    (found - expected).abs() > tolerance * expected.abs().max(1e-300)
}

/// Columns in which a model's measures differ from the table's.
fn misfits(row: &Row, measures: &Measures) -> Vec<String> {
    let mut misfits = Vec::new();
    let mut compare = |column: &str, found: f64, tolerance: f64| {
        if let Some(expected) = number(row, column)
            && differs(found, expected, tolerance)
        {
            misfits.push(format!("{column} {found} for {expected}"));
        }
    };
    compare("triangles", measures.triangles as f64, 0.0);
    // Not the vertices as read: readers differ in what they take for one where seams split them.
    compare("vertices_merged", measures.vertices_welded as f64, 0.0);
    compare("bodies", measures.bodies as f64, 0.0);
    compare("inside_out_bodies", measures.inside_out_bodies as f64, 0.0);
    compare("boundary_edges", measures.boundary_edges as f64, 0.0);
    compare("nonmanifold_edges", measures.nonmanifold_edges as f64, 0.0);
    compare("zero_area_triangles", measures.degenerate_triangles as f64, 0.0);
    // The table measures sizes with and without the skin, the rest without.
    let skinned = !row["skinned_size_x"].is_empty();
    let sizes = if skinned {
        ["skinned_size_x", "skinned_size_y", "skinned_size_z"]
    } else {
        ["size_x", "size_y", "size_z"]
    };
    for (axis, column) in sizes.into_iter().enumerate() {
        compare(column, measures.size()[axis], 1e-5);
    }
    if skinned {
        return misfits;
    }
    let mut compare = |column: &str, found: f64, tolerance: f64| {
        if let Some(expected) = number(row, column)
            && differs(found, expected, tolerance)
        {
            misfits.push(format!("{column} {found} for {expected}"));
        }
    };
    compare("area", measures.shell.measure, 1e-5);
    if let Some(volume) = measures.signed_volume {
        compare("volume", volume, 1e-5);
    }
    for (column, found) in
        [("watertight", measures.closed), ("winding_consistent", measures.wound_consistently)]
    {
        let expected = &row[column];
        if !expected.is_empty() && (expected == "yes") != found {
            misfits.push(format!("{column} {found} for {expected}"));
        }
    }
    misfits
}

#[test]
fn every_model_that_is_read_agrees_with_the_table() {
    let Some(root) = support::models() else { return };
    let (mut read, mut exact, mut wrong) = (0, 0, Vec::new());
    for outcome in outcomes(&root) {
        let path = &outcome.row["path"];
        let Ok((source, measures)) = &outcome.read else { continue };
        // The table counts triangles, and a file of shapes has none.
        if source.geometry != Geometry::Mesh {
            continue;
        }
        read += 1;
        let misfits: Vec<_> = misfits(&outcome.row, measures)
            .into_iter()
            .filter(|misfit| !is_explained(path, misfit))
            .collect();
        exact += u32::from(misfits.is_empty());
        wrong.extend((!misfits.is_empty()).then(|| format!("{path}: {}", misfits.join("; "))));
    }
    println!("{exact} of {read} models that are read agree in every column");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_category_model_is_read() {
    let Some(root) = support::models() else { return };
    let refused: Vec<_> = outcomes(&root)
        .into_iter()
        .filter(|outcome| !outcome.row["path"].starts_with("hard/"))
        .filter_map(|outcome| outcome.read.err())
        .map(|error| error.to_string())
        .collect();
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}

#[test]
fn every_packed_model_is_read_and_agrees_with_the_table() {
    let Some(root) = support::models() else { return };
    let mut wrong = Vec::new();
    let mut packed = 0;
    for row in support::table(&root.join("FACTS.csv")) {
        if !row["flags"].split(' ').any(|flag| flag == "draco" || flag == "meshopt") {
            continue;
        }
        packed += 1;
        match measured(&root, &row) {
            Ok((source, measures)) => {
                let path = &row["path"];
                let misfits = misfits(&row, &measures);
                let unexplained = misfits.iter().filter(|misfit| !is_explained(path, misfit));
                wrong.extend(unexplained.map(|misfit| format!("{path}: {misfit}")));
                let plain = source.notes.iter().any(|note| note.code == "compression-fallback");
                wrong.extend(plain.then(|| format!("{}: read from its fallback", row["path"])));
            }
            Err(error) => wrong.push(error.to_string()),
        }
    }
    println!("{packed} packed models, {} misfits", wrong.len());
    assert!(packed >= 10, "the table lists {packed} packed models");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_hard_case_is_read_right_or_refused_with_a_reason() {
    let Some(root) = support::models() else { return };
    let mut wrong = Vec::new();
    let (mut right, mut refused) = (0, 0);
    for row in support::table(&root.join("hard/EXPECTED.csv")) {
        let path = root.join(&row["path"]);
        let expected: Option<u64> = row["triangles"].parse().ok().filter(|&count| count > 0);
        match (measured(&root, &row), expected) {
            (Ok((_, measures)), Some(expected)) if measures.triangles == expected => right += 1,
            // Points and shapes have no triangles of their own, and are read all the same.
            (Ok((source, _)), None) if source.geometry != Geometry::Mesh => right += 1,
            (Ok((_, measures)), Some(expected))
                if is_explained(&row["path"], "triangles") && measures.triangles == 125 * expected =>
            {
                right += 1;
            }
            (Ok((_, measures)), expected) => {
                wrong.push(format!("{}: {} triangles for {expected:?}", row["path"], measures.triangles));
            }
            (Err(error), expected) => {
                let told = error.to_string();
                let unusable = error.code() == "malformed" && row["topic"] == "malformed";
                let says = error.file() == path && !error.reason().is_empty() && !error.way_out().is_empty();
                if error.code() == "panic" || !says || (expected.is_some() && !unusable) {
                    wrong.push(told);
                } else {
                    refused += 1;
                }
            }
        }
    }
    println!("{right} hard cases read right, {refused} refused with a reason");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
