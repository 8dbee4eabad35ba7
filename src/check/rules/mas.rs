//! MAS: mass, its centre and its spread.

use super::{fact, measured};
use crate::check::rule::{
    Bound::{Least, Most},
    Layer::{Data, Static},
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "MAS001",
        "no-mass",
        Data,
        Error,
        [
            "A rigid model without a mass: no density with a volume, no mass range, no mass of its own.",
            "Engines take 0 for fixed in place, or a default of 1 kg.",
            "Set a `mass` in an override, or give its category a mass range.",
        ],
        &["RB.007", "RB.011"],
    ),
    measured(
        "MAS002",
        "mass-outside-range",
        (Data, Warning),
        (Most(1.001), "x outside"),
        [
            "The mass is outside the range that things of this subcategory weigh.",
            "A mug of 7 kg feels wrong in every hand that lifts it, and topples what it stands on.",
            "Check unit, preset and mass model at the place shown; if the thing is right, widen the subcategory's `mass`.",
        ],
        &["RB.007"],
    ),
    measured(
        "MAS003",
        "mass-model-outside-range",
        (Data, Info),
        (Most(5.0), "x outside"),
        [
            "Density and geometry by the mass model lead far outside what such things weigh; their range is used instead.",
            "The mass is right in order of magnitude, but says nothing of this model.",
            "Take a mass model that fits (`shell`, `fill`), or check the unit.",
        ],
        &["RB.007"],
    ),
    fact(
        "MAS004",
        "mass-contradicts-density",
        Data,
        Warning,
        [
            "A mass that somebody set contradicts density times volume.",
            "An engine that computes mass from density gives another one.",
            "Set one of the two, or a mass model that reconciles them.",
        ],
        &["RB.008"],
    ),
    fact(
        "MAS005",
        "inertia-unreal",
        Data,
        Warning,
        [
            "No body could have the inertia tensor of this mesh: one moment is above the sum of the others.",
            "MuJoCo refuses it, other engines spin it up; the collider's is taken instead.",
            "Make the winding consistent: volumes that cancel lead to this.",
        ],
        &["RB.008"],
    ),
    fact(
        "MAS006",
        "center-outside-mesh",
        Data,
        Warning,
        [
            "The centre of mass lies outside the mesh's own bounds.",
            "The body turns about a point beside itself.",
            "Make the winding consistent: volumes that cancel lead to this.",
        ],
        &["RB.008"],
    ),
    fact(
        "MAS007",
        "volume-of-hull",
        Data,
        Info,
        [
            "The mass rests on the volume of the convex hull, an upper bound.",
            "What is hollow or open is too heavy, by up to several times.",
            "Close the mesh, or use a `shell` mass model or a `fixed` mass.",
        ],
        &["RB.007"],
    ),
    measured(
        "MAS008",
        "denser-than-osmium",
        (Data, Error),
        (Most(22_600.0), "kg/m3"),
        [
            "Mass over the volume of the convex hull is above the density of osmium, the densest metal.",
            "No solid of this size weighs as much.",
            "Check the unit of the model and of the mass.",
        ],
        &["RB.007", "RB.008"],
    ),
    measured(
        "MAS009",
        "lighter-than-foam",
        (Data, Warning),
        (Least(1.5), "kg/m3"),
        [
            "Mass over the volume of the convex hull is near to or below the density of air.",
            "Anything that touches it throws it away.",
            "Check the unit of the model and of the mass; a fence or a net may be right.",
        ],
        &["RB.007"],
    ),
    measured(
        "MAS010",
        "inertia-box",
        (Data, Error),
        (Most(1.75), "x the extents"),
        [
            "The box with the same mass and inertia is larger than the body itself.",
            "All mass in the corners of a box gives 1.732: beyond that the inertia is not that of this body, and it turns too slowly.",
            "Check the inertia's unit and the body's scale.",
        ],
        &["RB.008"],
    ),
    fact(
        "MAS011",
        "mass-by-range",
        Data,
        Info,
        [
            "The mass comes from the range that such things weigh, not from density and geometry.",
            "It is a typical mass for the size, and says nothing of this model's walls.",
            "Close the mesh or choose a mass model that fits, if the model's own mass matters.",
        ],
        &["RB.007"],
    ),
    fact(
        "MAS012",
        "ranges-contradict",
        Static,
        Warning,
        [
            "Size, mass and mass model of a subcategory contradict each other.",
            "Its models are wrong in one of them, whichever way they come out.",
            "Correct the range at the place shown.",
        ],
        &[],
    ),
    measured(
        "MAS013",
        "center-outside-collider",
        (Data, Warning),
        (Most(0.1), "% of the size"),
        [
            "The centre of mass lies outside the convex hull of the collider.",
            "Wherever the body stands it tips over.",
            "Check the collider's error and the winding of the mesh.",
        ],
        &["RB.008"],
    ),
    measured(
        "MAS014",
        "volume-uncertain",
        (Data, Info),
        (Most(25.0), "% of the volume"),
        [
            "The mass rests on the volume of a surface with holes, which is known no better than this.",
            "The mass may be off by as much.",
            "Close the mesh, use a `shell` mass model, or set the mass.",
        ],
        &["RB.007"],
    ),
];
