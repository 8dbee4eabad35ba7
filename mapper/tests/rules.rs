//! What a rule may ask for: each predicate holds for one model and not for another.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::{SMALL, facts, solid};
use mapper::{Mapper, ModelFacts, Overrides, Ruleset};

/// A rule that makes soft what it holds for, over the small catalogue.
fn holds(when: &str, model: &ModelFacts) -> bool {
    let text = format!("{SMALL}  - {{ name: asked, when: {when}, set: {{ density: 123 kg/m3 }} }}\n");
    let rules = Ruleset::parse("small.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
    Mapper::new(rules, Overrides::none()).map(model, &[]).number("density") == Some(123.0)
}

#[test]
fn every_predicate_holds_for_one_model_and_not_for_another() {
    let plain = || facts("a/b/chair.glb", 0.9);
    let shaped = |closed, bodies, hull| {
        let mut model = solid(plain(), 0.1);
        let shape = model.shape.as_mut().unwrap();
        (shape.closed, shape.bodies, shape.hull_volume) = (closed, bodies, Some(hull));
        model
    };
    let of_steel = ModelFacts { materials: vec!["Steel_01".to_owned()], ..plain() };
    let tagged = ModelFacts { tags: vec!["toy".to_owned()], ..plain() };
    for (when, yes, no) in [
        ("{ path: 'a/**' }", plain(), facts("b/chair.glb", 0.9)),
        ("{ path: ['x/**', '**/CHAIR.*'] }", plain(), facts("a/b/chairs.glb", 0.9)),
        ("{ word: toy }", tagged.clone(), plain()),
        ("{ word: [knife fish, zebra] }", facts("knife_fish_2.glb", 0.5), facts("fish_knife.glb", 0.2)),
        ("{ alias: chair }", facts("chair_07.glb", 0.9), facts("stool.glb", 0.6)),
        ("{ alias: seating }", facts("stool.glb", 0.6), facts("dog.glb", 0.9)),
        ("{ material: steel }", of_steel, plain()),
        ("{ size: [50 cm, 2 m] }", plain(), facts("a/b/chair.glb", 90.0)),
        (
            "{ aspect: [1.2, 1.3] }",
            facts("x.glb", 0.9),
            ModelFacts { extents: [Some(0.9), Some(0.9), Some(0.9)], ..plain() },
        ),
        ("{ closed: true }", shaped(true, 1, 0.1), shaped(false, 1, 0.1)),
        ("{ closed: false }", shaped(false, 1, 0.1), plain()),
        ("{ bodies: [2, 5] }", shaped(true, 3, 0.1), shaped(true, 1, 0.1)),
        ("{ hull_ratio: [2, 10] }", shaped(true, 1, 0.5), shaped(true, 1, 0.11)),
        ("{ extension: [obj, .STL] }", facts("chair.stl", 0.9), plain()),
        ("{ all: [{ word: toy }, { alias: chair }] }", tagged.clone(), plain()),
        ("{ any: [{ word: toy }, { alias: stool }] }", tagged.clone(), plain()),
        ("{ not: { word: toy } }", plain(), tagged),
    ] {
        assert!(holds(when, &yes), "{when} should hold for {}", yes.model);
        assert!(!holds(when, &no), "{when} should not hold for {}", no.model);
    }
}

#[test]
fn a_fact_that_is_not_known_fulfils_nothing() {
    let unknown = ModelFacts { extents: [None; 3], ..facts("chair.glb", 0.9) };
    for when in [
        "{ size: [0.1 mm, 1 km] }",
        "{ aspect: [1, 1000] }",
        "{ closed: true }",
        "{ bodies: [1, 9] }",
        "{ hull_ratio: [1, 9] }",
    ] {
        assert!(!holds(when, &unknown), "{when}");
    }
}
