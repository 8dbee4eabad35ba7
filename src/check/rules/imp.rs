//! IMP: files that could not be read, and what reading left out.

use super::fact;
use crate::check::rule::{Layer::Data, Rule};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "IMP001",
        "unreadable",
        Data,
        Error,
        [
            "The file system refuses the file.",
            "The model is not in the result.",
            "Check that the file exists and may be read; its name must be UTF-8.",
        ],
        &[],
    ),
    fact(
        "IMP002",
        "unknown-format",
        Data,
        Error,
        [
            "Neither its bytes nor its name are of a format that is read.",
            "The model is not in the result.",
            "Export it as glb, gltf, obj, stl or ply.",
        ],
        &["AA.002"],
    ),
    fact(
        "IMP003",
        "malformed",
        Data,
        Error,
        [
            "The bytes break the rules of their format.",
            "The model is not in the result; other programs may show a part of it.",
            "Fetch the file again, or export it again from its source.",
        ],
        &[],
    ),
    fact(
        "IMP004",
        "unsupported",
        Data,
        Error,
        [
            "The file is right by its format, but uses more than is read here.",
            "The model is not in the result.",
            "Follow the way out that the message names, or leave the file out.",
        ],
        &[],
    ),
    fact(
        "IMP005",
        "missing-file",
        Data,
        Error,
        [
            "A file that this one refers to is not there.",
            "The model is not in the result.",
            "Put the file beside it, or export as one glb.",
        ],
        &["AA.001"],
    ),
    fact(
        "IMP006",
        "no-triangles",
        Data,
        Error,
        [
            "The file was read, and there is no surface in it.",
            "Points and lines have no physics.",
            "Leave the file out, or export its faces too.",
        ],
        &["VG.001"],
    ),
    fact(
        "IMP007",
        "too-large",
        Data,
        Error,
        [
            "The file is over a limit of size or of triangles.",
            "The model is not in the result.",
            "Reduce the model, or raise the limit.",
        ],
        &[],
    ),
    fact(
        "IMP008",
        "crashed",
        Data,
        Error,
        [
            "A library crashed on the file, or did not come to an end with it.",
            "The model is not in the result, the others are.",
            "Export the model again; the file is worth a report.",
        ],
        &[],
    ),
    fact(
        "IMP009",
        "not-finite",
        Data,
        Error,
        [
            "A measure of the model is not a finite number.",
            "It cannot be stored, compared or simulated.",
            "Scale the model to sizes that can be squared, or leave it out.",
        ],
        &["VG.002"],
    ),
    fact(
        "IMP010",
        "note-of-the-reader",
        Data,
        Info,
        [
            "The reader left something out or had to assume something.",
            "What is simulated may differ from what the file's author sees.",
            "See the message: an extension that is not read, a skin or a morph target at rest.",
        ],
        &[],
    ),
    fact(
        "IMP011",
        "orphaned-sidecar",
        Data,
        Warning,
        [
            "A sidecar file beside which there is no model.",
            "The model was renamed or deleted, and what was set for it by hand is lost.",
            "Rename the sidecar with its model, or delete it.",
        ],
        &[],
    ),
    fact(
        "IMP012",
        "failed-otherwise",
        Data,
        Error,
        [
            "A stage failed on the model for a reason that has no code of its own.",
            "The model is not in the result.",
            "See the message for the reason and the way out.",
        ],
        &[],
    ),
];
