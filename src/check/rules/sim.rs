//! SIM: what the model does when it is simulated, in the project's own engine and in rapier.

use super::{fact, measured};
use crate::check::rule::{
    Bound::{Least, Most},
    Layer::Runtime,
    Rule,
};
use crate::check::severity::Severity::{Error, Info, Warning};

pub(super) const RULES: &[Rule] = &[
    fact(
        "SIM001",
        "refused",
        Runtime,
        Error,
        [
            "The solver refuses the model, or no body could be made of it.",
            "It cannot be simulated anywhere.",
            "Correct the value that the message names in an override.",
        ],
        &["RB.001", "RB.013"],
    ),
    measured(
        "SIM002",
        "no-rest",
        (Runtime, Error),
        (Most(1.0), "x its time"),
        [
            "Dropped from twice its height, it does not come to rest in time: within 60 times the fall, at least 30 s, and \
             where it still rolls then, for as long as its rolling resistance lets it, `2 v / (c g)`.",
            "It jitters, rocks or bounces on, or nothing resists its rolling: a scene with it never sleeps.",
            "Look at restitution and rolling resistance first, then at the collider's error.",
        ],
        &["FET003.ground_drop"],
    ),
    measured(
        "SIM003",
        "energy-gained",
        (Runtime, Error),
        (Most(0.1), "% of the fall"),
        [
            "Its energy rises while it falls and comes to rest.",
            "Energy from nowhere makes stacks explode and things fly.",
            "Overlapping shapes and thin colliders push: look at the collider.",
        ],
        &["FET003.ground_drop"],
    ),
    measured(
        "SIM004",
        "rests-too-deep",
        (Runtime, Error),
        (Most(1.0), "x the limit"),
        [
            "At rest it is deeper in the floor than 0.5 mm or 1 % of its smallest side, whichever is more.",
            "It looks sunk in, and what is stacked on it sinks too.",
            "A mass or size far out of proportion is the usual cause: see MAS and GEO findings of the same model.",
        ],
        &["FET003.ground_drop"],
    ),
    measured(
        "SIM005",
        "sinks-on-impact",
        (Runtime, Warning),
        (Most(5.0), "x the limit"),
        [
            "On its way to rest it is several times deeper in the floor than a resting body may be.",
            "At higher speeds it will go through.",
            "Thicken the collider, or look for corners that stick out of it.",
        ],
        &["FET003.ground_drop"],
    ),
    fact(
        "SIM006",
        "tunnels",
        Runtime,
        Error,
        [
            "It went through the floor.",
            "It is lost to every scene.",
            "The collider is too thin, or there is a mistake in its scale.",
        ],
        &["FET003.ground_drop"],
    ),
    measured(
        "SIM007",
        "launched",
        (Runtime, Error),
        (Most(1.0), "% of the drop"),
        [
            "After contact it rises above where it was dropped from.",
            "Energy from nowhere: it was thrown.",
            "Overlapping shapes push each other apart: look at the collider.",
        ],
        &["FET003.ground_drop", "FET003.slope_drop"],
    ),
    fact(
        "SIM008",
        "not-a-number",
        Runtime,
        Error,
        [
            "Its state became infinite or not a number, and it was taken out of the simulation.",
            "In another engine it would take the whole scene with it.",
            "Look at mass and inertia: the MAS findings of the same model.",
        ],
        &["FET003.ground_drop"],
    ),
    measured(
        "SIM009",
        "slides-though-it-should-hold",
        (Runtime, Error),
        (Most(1.0), "% of its size"),
        [
            "On a slope of 0.8 times its friction, where Coulomb's law says that it holds, it slides.",
            "Things creep off tables that tremble.",
            "What would roll or tip over is not tried; look at the collider's contact face.",
        ],
        &["FET003.slope_drop"],
    ),
    measured(
        "SIM010",
        "holds-though-it-should-slide",
        (Runtime, Error),
        (Least(50.0), "% of the closed form"),
        [
            "On a slope of 1.25 times its friction, where Coulomb's law says that it slides, it holds or lags behind.",
            "Chutes and ramps clog.",
            "Look for corners of the collider that catch.",
        ],
        &["FET003.slope_drop"],
    ),
    measured(
        "SIM011",
        "creeps",
        (Runtime, Error),
        (Most(1.0), "x the limit"),
        [
            "Put down where it came to rest, it does not stay there: it creeps or trembles, awake, for two seconds.",
            "Without sleeping, nothing keeps it in place.",
            "Look at the contact face of the collider, and at the mass.",
        ],
        &[],
    ),
    measured(
        "SIM012",
        "does-not-stand",
        (Runtime, Info),
        (Most(15.0), "deg"),
        [
            "Put down as it was modelled, it falls over, as the statics of its base say.",
            "Whoever places it upright in a scene finds it lying.",
            "If such things stand, look at up axis, base and mass; if they do not (a sword, a fish), allow it for the category.",
        ],
        &[],
    ),
    measured(
        "SIM013",
        "falls-though-it-should-stand",
        (Runtime, Warning),
        (Most(15.0), "deg"),
        [
            "Put down as it was modelled, it falls over although its centre of mass is well inside its base.",
            "Something pushes it: a contact that trembles, a collider that is not where its base is.",
            "Look at the collider's contact face.",
        ],
        &[],
    ),
    measured(
        "SIM014",
        "stack-falls",
        (Runtime, Warning),
        (Most(25.0), "% of its height"),
        [
            "Three of them, of a category that stacks, do not stand on each other.",
            "Shelves, pallets and piles of it fall.",
            "Look at the collider's top and base; or take the category out of `stack`.",
        ],
        &[],
    ),
    measured(
        "SIM015",
        "slippery",
        (Runtime, Warning),
        (Least(5.0), "deg"),
        [
            "It starts to slide on a slope that hardly anyone would notice.",
            "Nothing of it stays on a table.",
            "Look up the friction of its preset, and of the pair that it makes with the floor.",
        ],
        &["FET003.slope_drop"],
    ),
    fact(
        "SIM016",
        "rapier-rests-elsewhere",
        Runtime,
        Info,
        [
            "Dropped in rapier, it comes to rest on another side or at another height, or not at all.",
            "Which way it falls hangs on the engine: scenes will look different.",
            "Where a difference goes away without bouncing it is chance; else look at the collider.",
        ],
        &["FET003.ground_drop"],
    ),
    fact(
        "SIM017",
        "rapier-slides-otherwise",
        Runtime,
        Info,
        [
            "On a slope one engine holds it and the other lets it slide.",
            "One of the two breaks Coulomb's law for this shape.",
            "See SIM009 and SIM010 of the same model for which.",
        ],
        &["FET003.slope_drop"],
    ),
    fact(
        "SIM018",
        "rapier-does-not-hold-it",
        Runtime,
        Info,
        [
            "Put down at rest it stays in one engine and not in the other.",
            "One of the two does not hold its contact face whole.",
            "rapier keeps four corners of a face: round bases tip over there.",
        ],
        &[],
    ),
    fact(
        "SIM019",
        "rapier-stacks-otherwise",
        Runtime,
        Info,
        [
            "The stack stands in one engine and falls in the other.",
            "Scenes with such stacks will look different.",
            "See SIM014 of the same model.",
        ],
        &[],
    ),
];
