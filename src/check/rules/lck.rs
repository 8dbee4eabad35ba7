//! LCK: drift against the lock file, and a baseline that has aged.

use super::fact;
use crate::check::rule::{
    Layer::{Data, Static},
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "LCK001",
        "lock-missing",
        Static,
        Error,
        [
            "`--locked` was asked for and there is no lock file.",
            "Nothing holds the mapping where it was.",
            "Write one with `physique lock` and commit it.",
        ],
        &[],
    ),
    fact(
        "LCK002",
        "lock-malformed",
        Static,
        Error,
        [
            "The lock file cannot be understood: a line is short, out of order, twice there, or left by a merge.",
            "Nothing holds the mapping where it was.",
            "Write it again with `physique lock` and look at the difference.",
        ],
        &[],
    ),
    fact(
        "LCK003",
        "model-not-locked",
        Data,
        Error,
        [
            "A model that is not in the lock file.",
            "It came in without anyone having looked at its physics.",
            "Look at it with `physique explain`, then `physique lock`.",
        ],
        &[],
    ),
    fact(
        "LCK004",
        "model-gone",
        Data,
        Error,
        [
            "A model of the lock file that is not in the database any more.",
            "Scenes that name it will not find it.",
            "Bring it back, or `physique lock`.",
        ],
        &[],
    ),
    fact(
        "LCK005",
        "input-changed",
        Data,
        Error,
        [
            "The bytes of the model, or of a file that it refers to, are others than when it was locked.",
            "Mass, inertia and colliders may have moved with them.",
            "Look at `physique diff physique.lock .`, then `physique lock`.",
        ],
        &[],
    ),
    fact(
        "LCK006",
        "category-changed",
        Data,
        Error,
        [
            "The model has become another kind of thing than when it was locked.",
            "Everything that follows from the category has changed with it.",
            "If that was the aim, `physique lock`; else see `physique explain MODEL`.",
        ],
        &[],
    ),
    fact(
        "LCK007",
        "preset-changed",
        Data,
        Error,
        [
            "The model is of another material than when it was locked.",
            "Density, friction and restitution have changed with it.",
            "If that was the aim, `physique lock`; else see `physique explain MODEL`.",
        ],
        &[],
    ),
    fact(
        "LCK008",
        "attributes-changed",
        Data,
        Error,
        [
            "Attributes of the model have other values than when it was locked.",
            "It falls, slides and bounces otherwise.",
            "If that was the aim, `physique lock`; else see `physique diff physique.lock .`.",
        ],
        &[],
    ),
    fact(
        "LCK009",
        "rule-changed",
        Data,
        Warning,
        [
            "Another rule decides, with the same result.",
            "The next change of either will surprise someone.",
            "`physique lock` takes note of it.",
        ],
        &[],
    ),
    fact(
        "LCK010",
        "other-version",
        Static,
        Info,
        [
            "The lock file was written by another version of the tool or of the catalogue.",
            "Differences may come from there.",
            "`physique lock` takes note of it.",
        ],
        &[],
    ),
    fact(
        "LCK011",
        "baseline-aged",
        Static,
        Warning,
        [
            "The baseline accepts findings that are not found any more.",
            "Left standing they would let the same fault back in.",
            "Write the baseline again with `--update-baseline`.",
        ],
        &[],
    ),
    fact(
        "LCK012",
        "baseline-malformed",
        Static,
        Error,
        [
            "The baseline is not there, or cannot be understood.",
            "Nothing is accepted, or everything is: neither is meant.",
            "Write it with `--update-baseline`.",
        ],
        &[],
    ),
];
