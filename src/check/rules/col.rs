//! COL: the shapes that stand for the model in a simulation.

use super::{fact, measured};
use crate::check::rule::{
    Bound::{Least, Most},
    Layer::Data,
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "COL001",
        "no-collider",
        Data,
        Error,
        [
            "There is no shape that could stand for the model.",
            "It falls through everything.",
            "Check that the file holds triangles with an extent.",
        ],
        &["RB.COL.001", "RB.013"],
    ),
    measured(
        "COL002",
        "collider-off",
        (Data, Warning),
        (Most(2.5), "% of the diagonal"),
        [
            "The collider's surface is off the mesh by more than its budget, at the 95th percentile of sampled points.",
            "Things float above it or sink into it by as much.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override: a dearer shape is taken. `physique \
             explain MODEL` lists all there are with their errors.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL003",
        "collider-far-off",
        (Data, Warning),
        (Most(8.0), "% of the diagonal"),
        [
            "Somewhere the collider's surface is far off the mesh.",
            "A handle cannot be reached into, a bowl not filled.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override: a convex hull closes what is \
             hollow, more pieces do not. Where the dearest shape is as far off, allow it for the model.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL004",
        "collider-grows",
        (Data, Info),
        (Most(5.0), "% of the diagonal"),
        [
            "The collider reaches beyond the mesh.",
            "Contacts happen in the air beside the model.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override: a dearer shape is taken.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL005",
        "collider-misses",
        (Data, Info),
        (Most(25.0), "% of the surface"),
        [
            "A share of the mesh's surface lies outside the collider.",
            "These parts pass through other things.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override, if these parts matter.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL006",
        "collider-too-big",
        (Data, Info),
        (Most(1.5), "x the volume"),
        [
            "The collider encloses much more than the model does.",
            "Things that fit into each other do not, and float in water.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override: more pieces are taken.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL007",
        "collider-too-small",
        (Data, Info),
        (Least(0.75), "x the volume"),
        [
            "The collider encloses much less than the model does.",
            "The model sinks into others.",
            "Set a smaller `collider_tolerance` (a length) for its category or in an override: a dearer shape is taken.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL008",
        "many-pieces",
        (Data, Warning),
        (Most(64.0), "pieces"),
        [
            "The collider is made of very many pieces.",
            "Every contact is asked of each of them.",
            "Set a larger `collider_tolerance` (a length) for its category or in an override: a cheaper shape is taken.",
        ],
        &["RB.COL.001"],
    ),
    measured(
        "COL009",
        "many-corners",
        (Data, Warning),
        (Most(2_000.0), "corners"),
        [
            "The collider's hulls have very many corners.",
            "Narrow phases slow down, and some engines refuse hulls of more than 64 or 255.",
            "Set a larger `collider_tolerance` (a length) for its category or in an override: a cheaper shape is taken.",
        ],
        &["RB.COL.001"],
    ),
    fact(
        "COL010",
        "made-by-detour",
        Data,
        Info,
        [
            "Something went wrong while the collider was made, and was worked around.",
            "The shape is a fallback: right, but not the best there could be.",
            "See the message; a mesh that is closed and clean needs no detour.",
        ],
        &["RB.COL.001"],
    ),
    fact(
        "COL011",
        "moving-surface",
        Data,
        Error,
        [
            "A body that moves has a bare triangle mesh as its collider.",
            "A surface without an inside lets things through, and most engines refuse it.",
            "Set `anchored: true` if it never moves; else close the mesh, so that a hull or a decomposition can be made of it.",
        ],
        &["COL.001"],
    ),
    measured(
        "COL012",
        "thin",
        (Data, Info),
        (Least(1.0), "mm"),
        [
            "The collider is thinner than a millimetre.",
            "Engines without continuous collision let it fall through the floor.",
            "Check unit and scale; a sheet that is right needs an engine with continuous collision.",
        ],
        &["RB.COL.001"],
    ),
];
