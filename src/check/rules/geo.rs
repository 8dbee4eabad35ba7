//! GEO: the mesh, its size, its unit and its axes.

use super::{fact, measured};
use crate::check::rule::{
    Bound::{Least, Most},
    Layer::Data,
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "GEO001",
        "not-closed",
        Data,
        Info,
        [
            "The surface has holes: it encloses no volume by itself.",
            "Mass and inertia follow from the hull or the mass range instead of the model.",
            "Close the mesh, or use a `shell` mass model, which needs the area alone.",
        ],
        &["VG.007"],
    ),
    fact(
        "GEO002",
        "inside-out",
        Data,
        Warning,
        [
            "Closed bodies of the mesh are wound inside out.",
            "Their volume counts as negative: masses cancel, and engines see the wall from behind.",
            "Flip the normals of these bodies and export again.",
        ],
        &["VG.029"],
    ),
    fact(
        "GEO003",
        "winding-inconsistent",
        Data,
        Info,
        [
            "The mesh is closed, but neighbouring triangles are wound against each other.",
            "Volume and inertia are those of a repaired mesh.",
            "Recalculate the normals and export again.",
        ],
        &["VG.029"],
    ),
    measured(
        "GEO004",
        "degenerate-triangles",
        (Data, Info),
        (Most(5.0), "%"),
        [
            "A share of the triangles has no area.",
            "They cost time, and decompositions and normals go wrong on them.",
            "Merge by distance and dissolve degenerate faces before exporting.",
        ],
        &["VG.019"],
    ),
    measured(
        "GEO005",
        "nonmanifold-edges",
        (Data, Info),
        (Most(0.1), "% of triangles"),
        [
            "Edges that more than two triangles share.",
            "What is inside and what is outside is undefined there.",
            "Separate the bodies that touch, or remove inner faces.",
        ],
        &["VG.007"],
    ),
    measured(
        "GEO006",
        "flat",
        (Data, Warning),
        (Least(0.05), "% of the longest side"),
        [
            "The shortest side is next to nothing.",
            "A sheet without thickness has no volume, tunnels through floors, and rests on an edge of nothing.",
            "Give it a thickness, or set a `shell` mass model and a collider of its own.",
        ],
        &["VG.030"],
    ),
    measured(
        "GEO007",
        "size-implausible",
        (Data, Warning),
        (Most(2.0), "x outside"),
        [
            "The longest side is far outside the size that such things have, in the unit that was taken.",
            "Mass goes with the third power of size: ten times too long is a thousand times too heavy.",
            "Set `unit` in an override, or correct the file; if the thing is right, widen the subcategory's `size`.",
        ],
        &["UN.002", "VG.005"],
    ),
    fact(
        "GEO008",
        "unit-suspect",
        Data,
        Warning,
        [
            "The size fits the category in no plain unit.",
            "The model was scaled to the nearest end of its category's sizes: a guess.",
            "Set `unit` in an override, with the length that one file unit stands for.",
        ],
        &["UN.002"],
    ),
    fact(
        "GEO009",
        "unit-assumed",
        Data,
        Info,
        [
            "The format states no unit; the one that fits the category was taken.",
            "Another program may read the same file in another unit.",
            "Export as glTF, which is in metres, or set `unit` in an override.",
        ],
        &["UN.002"],
    ),
    fact(
        "GEO010",
        "up-axis-assumed",
        Data,
        Info,
        [
            "The format states no up axis; that of its habit was taken.",
            "A model that lies on its side rests, tips and rolls otherwise.",
            "Export as glTF, which has Y up.",
        ],
        &["UN.001"],
    ),
    measured(
        "GEO011",
        "far-from-origin",
        (Data, Warning),
        (Most(10.0), "diagonals"),
        [
            "The model lies many times its own size away from its file's origin.",
            "Whoever places it by its origin finds nothing there, and f32 loses digits.",
            "Move it to the origin and apply the transform.",
        ],
        &["VG.020", "VG.025"],
    ),
    measured(
        "GEO012",
        "many-triangles",
        (Data, Info),
        (Most(500_000.0), "triangles"),
        [
            "More triangles than a single thing needs.",
            "Importing and decomposing it takes long, and it is drawn slowly.",
            "Reduce the mesh; colliders do not need it.",
        ],
        &["VG.013", "VG.021"],
    ),
    measured(
        "GEO013",
        "many-bodies",
        (Data, Info),
        (Most(500.0), "bodies"),
        [
            "The mesh falls into very many pieces that do not touch.",
            "It is a scene, a soup of triangles or an unwelded export rather than one thing.",
            "Weld the vertices, or split the file into models.",
        ],
        &["VG.012"],
    ),
    measured(
        "GEO014",
        "tiny",
        (Data, Warning),
        (Least(1.0), "mm"),
        [
            "The longest side is below a millimetre.",
            "Engines have tolerances of that size: it will sink, stick or fly.",
            "Check the unit; simulate such things at a larger scale.",
        ],
        &["VG.005"],
    ),
    measured(
        "GEO015",
        "huge",
        (Data, Warning),
        (Most(500.0), "m"),
        [
            "The longest side is beyond half a kilometre.",
            "It is terrain, a city, or a file in other units than it says.",
            "Check the unit; for terrain set `anchored: true`.",
        ],
        &["VG.005"],
    ),
    fact(
        "GEO016",
        "faces-left-out",
        Data,
        Warning,
        [
            "Faces of the file refer to corners that are not there or are not finite, and were left out.",
            "What is measured is not what the file's author sees.",
            "Export the model again; a mesh viewer shows the holes.",
        ],
        &["VG.014"],
    ),
    fact(
        "GEO017",
        "no-extent",
        Data,
        Error,
        [
            "The mesh has no extent, or one that is not finite.",
            "Nothing can be placed, weighed or simulated.",
            "Check the file's vertices and the scales of its nodes.",
        ],
        &["VG.002", "VG.030"],
    ),
];
