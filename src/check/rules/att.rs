//! ATT: the values of attributes, before any geometry.

use super::{fact, measured};
use crate::check::rule::{
    Bound::{Least, Most},
    Layer::{Data, Static},
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "ATT001",
        "value-out-of-range",
        Static,
        Error,
        [
            "A value outside what physics allows: a negative density, a restitution above 1, a Poisson's ratio of 0.6.",
            "An engine refuses it, or takes it and gains energy.",
            "Write a value inside the range that the message gives; check the unit.",
        ],
        &["RB.008", "PMT.001"],
    ),
    fact(
        "ATT002",
        "unit-missing",
        Static,
        Error,
        [
            "A quantity without its unit, or with a unit of another dimension.",
            "7.85 may be g/cm3 or kg/m3: a factor of a thousand in every mass.",
            "Write the unit: `7850 kg/m3`, `2 mm`.",
        ],
        &["UN.002", "UN.003"],
    ),
    fact(
        "ATT003",
        "static-below-dynamic",
        Static,
        Warning,
        [
            "Static friction below dynamic friction.",
            "No dry pair behaves so: a body would be easier to start than to keep moving.",
            "Exchange the two, or set both to the same value.",
        ],
        &["PMT.001"],
    ),
    fact(
        "ATT004",
        "preset-incomplete",
        Static,
        Warning,
        [
            "A preset without an attribute that its kind has.",
            "The built-in default is used in its place, which is nobody's material.",
            "Add the value with its source.",
        ],
        &["PMT.001"],
    ),
    fact(
        "ATT005",
        "no-density",
        Static,
        Error,
        [
            "A subcategory whose preset gives no density.",
            "Its models have no mass.",
            "Give the preset a `density`, or the subcategory a `mass_model: { fixed: … }`.",
        ],
        &["RB.007"],
    ),
    fact(
        "ATT006",
        "attribute-of-another-kind",
        Data,
        Warning,
        [
            "A value was set that things of this kind do not have.",
            "It is stored and never used.",
            "Take it out, or set `kind` to the one that has it.",
        ],
        &[],
    ),
    fact(
        "ATT007",
        "default-used",
        Data,
        Info,
        [
            "Density, friction or restitution come from a built-in default and not from anything known of the model.",
            "A default is a placeholder: right for no material in particular.",
            "Give its preset the value, or the model a preset.",
        ],
        &["PMT.001", "RB.007"],
    ),
    fact(
        "ATT008",
        "pair-static-below-dynamic",
        Static,
        Warning,
        [
            "A pair of presets with static friction below dynamic friction.",
            "No dry pair behaves so.",
            "Exchange the two values; check the source that is cited.",
        ],
        &["PMT.001"],
    ),
    measured(
        "ATT009",
        "bounces-for-ever",
        (Static, Warning),
        (Most(0.95), "restitution"),
        [
            "A restitution so near to 1 that the thing hardly stops bouncing.",
            "At 0.95 a tenth of the speed is gone after two bounces only; simulations do not come to rest in time.",
            "The best superballs reach 0.9: look the value up again.",
        ],
        &["PMT.001"],
    ),
    measured(
        "ATT010",
        "grips-like-glue",
        (Static, Warning),
        (Most(1.5), "friction"),
        [
            "A friction coefficient beyond that of rubber on dry concrete.",
            "Things stick to walls, and stacks that should slide stand.",
            "Look the value up again; adhesives are no friction.",
        ],
        &["PMT.001"],
    ),
    measured(
        "ATT011",
        "slides-off-a-table",
        (Static, Warning),
        (Least(0.03), "friction"),
        [
            "A dynamic friction below that of ice on ice.",
            "Nothing made of it stays where it is put: a table tilted by a degree loses it.",
            "Look the value up again; check for a percentage or a comma.",
        ],
        &["PMT.001"],
    ),
    fact(
        "ATT012",
        "figure-without-source",
        Static,
        Info,
        [
            "A value of a preset that cites no source.",
            "Nobody can check it, and nobody will dare to change it.",
            "Write `{ value: …, source: … }` and list the source under `sources`.",
        ],
        &[],
    ),
];
