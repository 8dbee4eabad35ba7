//! From names and measures to physics: heads of names, layers, provenance, mass, parts, kinds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod common;

use common::{SMALL, facts, mapper_of, rules, solid};
use mapper::ModelFacts;
use mapper::{Kind, Layer, PartFacts, SetValue, ShapeFacts, Sidecar, SpreadFacts, explain};
use proptest::prelude::*;

#[test]
fn the_head_noun_names_the_thing() {
    let mapper = mapper_of("");
    for (model, expected) in [
        ("dog_bowl.glb", Some("bowl")),
        ("DogBowl_03.glb", Some("bowl")),
        ("bowl_for_dogs.glb", Some("bowl")),
        ("Dog.glb", Some("dog")),
        ("dogs.glb", Some("dog")),
        ("coffeemug.stl", Some("coffee-mug")),
        ("coffee mug v2.obj", Some("coffee-mug")),
        ("toy_dog.glb", Some("toy")),
        ("Lamp_Table.glb", Some("table-lamp")),
        ("BarStool_red.glb", Some("stool")),
        ("chair_orange.glb", Some("chair")),
        ("chair_oak.glb", Some("chair")),
        ("fishknife.glb", Some("knife")),
        ("bowls/0042.glb", Some("bowl")),
        ("plate07.glb", None),
        ("plate.glb", Some("plate")),
        // Keys of databases are no words; dashes and quotes part a name.
        ("chair_V04KKgGBn2A.glb", Some("chair")),
        ("bowls/f1d93c76a0b24e5d.glb", Some("bowl")),
        ("chair - dog.glb", Some("chair")),
        ("chair___dog.glb", Some("chair")),
        ("stool \"dog\".glb", Some("stool")),
        ("bowl w dog.glb", Some("bowl")),
        // How many, whose, which class, part of a series.
        ("table 4 chairs.glb", Some("table")),
        ("4 chairs.glb", Some("chair")),
        ("stool kids.glb", Some("stool")),
        ("kid.glb", Some("child")),
        ("stool acme.glb", Some("stool")),
        ("knife fish animal.glb", Some("knife-fish")),
        ("steel animal.glb", Some("animal")),
        ("dog volume 4.glb", Some("dog")),
        ("volume.glb", Some("volume")),
        ("qwertz.glb", None),
        ("", None),
    ] {
        let mapped = mapper.map(&facts(model, 0.3), &[]);
        assert_eq!(mapped.subcategory.as_deref(), expected, "{model}: {:?}", mapped.trace);
        assert_eq!(mapped.category.is_none(), expected.is_none(), "{model}");
    }
}

#[test]
fn a_folder_does_not_overrule_the_finer_word_of_the_name() {
    // Too large for a dog, right for an animal.
    let mapped = mapper_of("").map(&facts("animals/animals/dog.glb", 2.5), &[]);
    assert_eq!(mapped.subcategory.as_deref(), Some("dog"), "{:?}", mapped.trace);
}

#[test]
fn precedence_is_total() {
    let rules = rules();
    let sidecar = Sidecar::parse("chair.physics.yaml", "friction_dynamic: 0.7\n", &rules).unwrap();
    let cli = SetValue::parse("friction_dynamic=0.8", &rules).unwrap();
    let mapper = mapper_of("overrides:\n  - match: '**/chair*'\n    set: { friction_dynamic: 0.6 }\n");
    let model = facts("a/steel_chair.glb", 0.9);
    let named = facts("a/chair_steel.glb", 0.9);
    let of = |mapped: &mapper::Mapped| {
        let attribute = mapped.attribute("friction_dynamic").unwrap();
        (attribute.value.number().unwrap(), attribute.provenance.layer)
    };
    let plain = mapper_of("");
    assert_eq!(of(&plain.map(&facts("x.glb", 0.9), &[])), (0.4, Layer::Kind));
    assert_eq!(of(&plain.map(&facts("chair.glb", 0.9), &[])), (0.35, Layer::Category));
    assert_eq!(of(&plain.map(&facts("stool.glb", 0.6), &[])), (0.36, Layer::Subcategory));
    assert_eq!(of(&mapper.map(&named, &[])), (0.6, Layer::Project));
    assert_eq!(of(&mapper.map_with_sidecar(&named, Some(&sidecar), &[])), (0.7, Layer::Sidecar));
    let all = mapper.map_with_sidecar(&named, Some(&sidecar), std::slice::from_ref(&cli));
    assert_eq!(of(&all), (0.8, Layer::CommandLine));
    let layers: Vec<Layer> =
        all.attribute("friction_dynamic").unwrap().overrode.iter().map(|(_, by)| by.layer).collect();
    assert_eq!(layers, [Layer::Sidecar, Layer::Project, Layer::Category, Layer::Preset, Layer::Kind]);
    assert!(layers.windows(2).all(|pair| pair[0] > pair[1]));
    // A material word is a rule: its preset beats the category's and what the category sets by hand.
    let steel = plain.map(&model, &[]);
    assert_eq!((steel.preset.as_deref(), steel.number("density")), (Some("steel"), Some(7850.0)));
    assert_eq!(&*steel.preset_by.unwrap().by, "rule:material-word");
    // A later entry of a project file beats an earlier one, a rule beats the catalogue.
    let twice = mapper_of(
        "overrides:\n  - { match: '*', set: { density: 1 kg/m3 } }\n  - { match: '*', set: { density: 2 kg/m3 } }\n",
    );
    assert_eq!(twice.map(&facts("chair.glb", 0.9), &[]).number("density"), Some(2.0));
    assert_eq!(
        plain.map(&facts("toy.glb", 0.1), &[]).attribute("restitution").unwrap().provenance.layer,
        Layer::Rule
    );
}

#[test]
fn every_value_says_where_it_was_written() {
    let mapped = mapper_of("").map(&facts("stool.glb", 0.6), &[]);
    for (name, text) in [("density", "density: { value: 700"), ("friction_dynamic", "friction_dynamic: 0.36")]
    {
        let by = &mapped.attribute(name).unwrap().provenance;
        let line = SMALL.lines().nth(by.line as usize - 1).unwrap();
        assert!(line.contains(text), "{name}: {}:{}: {line}", by.file, by.line);
        assert!(by.column > 1);
    }
    let density = mapped.attribute("density").unwrap();
    assert_eq!(density.provenance.cites.as_deref(), Some("book"));
    assert_eq!(density.overrode.last().unwrap().1.layer, Layer::BuiltIn);
    assert_eq!(mapped.attribute("youngs_modulus").unwrap().provenance.layer, Layer::Kind);
    assert!(mapped.defaults_used() >= 1);
}

#[test]
fn explain_names_file_and_line_of_every_attribute() {
    let facts = facts("steel_stool.glb", 0.6);
    let mapped = mapper_of("").map(&facts, &[]);
    let text = explain("steel_stool.glb", &mapped, &facts);
    for attribute in &mapped.attributes {
        let table = text.split("\nattributes\n").nth(1).unwrap();
        let line = table.lines().find(|line| line.trim_start().starts_with(&*attribute.name)).unwrap();
        assert!(line.contains(&attribute.provenance.place()), "{line}");
        for (_, by) in &attribute.overrode {
            assert!(text.contains(&format!("from {}", by.place())), "{}", by.place());
        }
    }
    assert!(text.contains("won") && text.contains("material-word"), "{text}");
}

#[test]
fn mass_follows_the_model_inside_the_range_and_the_range_outside_it() {
    let mapper = mapper_of("");
    // 0.1 m3 of oak filled to a tenth.
    let chair = mapper.map(&solid(facts("chair.glb", 0.9), 0.1), &[]);
    assert!((chair.number("mass").unwrap() - 7.0).abs() < 1e-9);
    assert!(chair.findings.iter().all(|finding| &*finding.code != "MAP003"));
    // Ten times that is no chair: the range steps in, says so, and keeps what it beat.
    let heavy = mapper.map(&solid(facts("chair.glb", 0.9), 1.0), &[]);
    let mass = heavy.attribute("mass").unwrap();
    assert!((3.0..=12.0).contains(&mass.value.number().unwrap()));
    assert!(mass.provenance.by.starts_with("mass-range"));
    assert!((mass.overrode[0].0.number().unwrap() - 70.0).abs() < 1e-9);
    assert!(heavy.findings.iter().any(|finding| &*finding.code == "MAP003"));
    // Who sets the density is taken at his word.
    let rules = rules();
    let set = [SetValue::parse("density=7000 kg/m3", &rules).unwrap()];
    let set = mapper.map(&solid(facts("chair.glb", 0.9), 0.1), &set);
    assert!((set.number("mass").unwrap() - 70.0).abs() < 1e-9);
    assert!(set.findings.iter().any(|finding| &*finding.code == "MAP003"));
    // Who sets the mass, too; that it is more than solid is a finding.
    let set = [SetValue::parse("mass=100 kg", &rules).unwrap()];
    let set = mapper.map(&solid(facts("chair.glb", 0.9), 0.1), &set);
    assert_eq!(set.number("mass"), Some(100.0));
    assert!(set.findings.iter().any(|finding| &*finding.code == "MAP004"));
}

#[test]
fn a_solid_of_another_material_weighs_by_its_density() {
    let mapper = mapper_of("");
    let mass = |name: &str| mapper.map(&facts(name, 0.2), &[]).number("mass").unwrap();
    assert!((mass("oak_knife.glb") / mass("knife.glb") - 700.0 / 7850.0).abs() < 1e-9);
    // Walls follow the material: the range of what is hollow stays.
    assert_eq!(mass("oak_bowl.glb"), mass("bowl.glb"));
}

#[test]
fn a_mass_that_the_name_states_is_taken_where_such_things_may_have_it() {
    let mapper = mapper_of("");
    let mass = |name: &str| {
        let mapped = mapper.map(&facts(name, 0.2), &[]);
        let mass = mapped.attribute("mass").unwrap();
        (mass.value.number().unwrap(), mass.provenance.by.to_string())
    };
    let (stated, by) = mass("dog_bowl_450_g.glb");
    assert!((stated - 0.45).abs() < 1e-12 && by == "mass-stated: \"450 g\" in its names", "{by}");
    assert_eq!(mass("dog_bowl_50kg.glb").0, mass("dog_bowl.glb").0);
    let set = [SetValue::parse("mass=1 kg", &rules()).unwrap()];
    assert_eq!(mapper.map(&facts("dog_bowl_450_g.glb", 0.2), &set).number("mass"), Some(1.0));
}

#[test]
fn parts_have_values_and_masses_of_their_own() {
    let part = |name: &str, volume: f64| PartFacts {
        name: name.to_owned(),
        materials: Vec::new(),
        shape: ShapeFacts {
            volume: Some(volume),
            volume_is_hull: false,
            area: Some(1.0),
            hull_volume: Some(volume),
            closed: true,
            bodies: 1,
            spread: None,
        },
    };
    let mut model = solid(facts("chair.glb", 0.9), 0.1);
    model.parts = vec![part("Seat", 0.02), part("Leg_1", 0.01)];
    let mapper = mapper_of(
        "overrides:\n  - match: chair.glb\n    parts:\n      'leg*': { preset: steel, mass_model: solid }\n      0: { density: 500 kg/m3 }\n",
    );
    let mapped = mapper.map(&model, &[]);
    // Globs on part names are case-blind, as those on paths are.
    assert_eq!(mapped.part_number(1, "density"), Some(7850.0));
    assert_eq!(mapped.part_number(0, "density"), Some(500.0));
    assert_eq!(mapped.part_number(1, "friction_dynamic"), Some(0.35));
    assert!((mapped.number("mass").unwrap() - (500.0 * 0.02 * 0.1 + 7850.0 * 0.01)).abs() < 1e-9);
    let own = mapped.attributes.iter().find(|attribute| attribute.part == Some(1)).unwrap();
    assert_eq!(own.provenance.layer, Layer::Project);
}

#[test]
fn kinds_follow_the_preset_that_somebody_chose() {
    let mapper = mapper_of("");
    let rules = rules();
    let set = |text: &str| vec![SetValue::parse(text, &rules).unwrap()];
    assert_eq!(mapper.map(&facts("dog.glb", 0.9), &[]).kind, Kind::Soft);
    assert_eq!(mapper.map(&facts("chair.glb", 0.9), &set("preset=water")).kind, Kind::Fluid);
    assert_eq!(mapper.map(&facts("chair.glb", 0.9), &set("kind=soft")).kind, Kind::Soft);
    let bowl = mapper.map(&facts("water_bowl.glb", 0.2), &[]);
    assert_eq!((bowl.kind, bowl.preset.as_deref()), (Kind::Rigid, Some("steel")));
    let unit = mapper.map(&facts("chair.glb", 0.9), &set("unit=cm")).scale;
    assert_eq!((&*unit.unit, unit.metres_per_unit), ("cm", 0.01));
    assert_eq!(
        mapper.map(&facts("x.glb", 0.9), &set("category=seating")).category.as_deref(),
        Some("seating")
    );
}

#[test]
fn a_value_that_the_kind_does_not_have_is_a_finding_with_both_places() {
    let mapper = mapper_of("");
    let rules = rules();
    let sidecar = |text: &str| Sidecar::parse("x.physics.yaml", text, &rules).unwrap();
    let found = |name: &str, text: &str| {
        let mapped = mapper.map_with_sidecar(&facts(name, 0.9), Some(&sidecar(text)), &[]);
        let found = mapped.findings.into_iter().filter(|finding| &*finding.code == "MAP007");
        found.map(|finding| finding.message).collect::<Vec<_>>()
    };
    let viscous = "dynamic_viscosity: 1 Pa.s\n";
    let message = found("chair.glb", viscous).pop().expect("a chair that flows");
    assert!(message.contains("x.physics.yaml:1)") && message.contains("small.yaml:"), "{message}");
    let message = found("chair.glb", "preset: water\nfriction_static: 0.5\n").pop().expect("water that rubs");
    assert!(
        message.contains("x.physics.yaml:2)") && message.contains("at x.physics.yaml:1 makes"),
        "{message}"
    );
    assert_eq!(found("chair.glb", "preset: water\ndynamic_viscosity: 1 Pa.s\n"), [""; 0]);
    assert_eq!(found("chair.glb", "density: 500 kg/m3\n"), [""; 0]);
}

#[test]
fn a_mesh_whose_volumes_cancel_is_a_finding_with_its_mass_model() {
    let mapper = mapper_of("");
    let mut model = facts("stool.glb", 0.6);
    let codes = |model: &ModelFacts| {
        let findings = mapper.map(model, &[]).findings;
        findings
            .into_iter()
            .filter(|finding| ["MAP009", "MAP010"].contains(&&*finding.code))
            .collect::<Vec<_>>()
    };
    let good = SpreadFacts {
        center: [0.5; 3],
        inertia: [1.0, 1.0, 2.0, 0.0, 0.0, 0.0],
        low: [0.0; 3],
        high: [1.0; 3],
        outside_hull: false,
    };
    let spread =
        |spread| ShapeFacts { spread: Some(spread), ..solid(facts("x.glb", 0.6), 0.1).shape.unwrap() };
    model.shape = Some(spread(good));
    assert_eq!(codes(&model), []);
    model.shape = Some(spread(SpreadFacts { inertia: [1.0, 1.0, 2.1, 0.0, 0.0, 0.0], ..good }));
    assert_eq!(codes(&model).len(), 1);
    model.shape = Some(spread(SpreadFacts { center: [0.5, 1.1, 0.5], ..good }));
    let found = codes(&model);
    assert_eq!((found.len(), &*found[0].code), (1, "MAP010"));
    model.shape = Some(spread(SpreadFacts { outside_hull: true, ..good }));
    assert_eq!(codes(&model).len(), 1);
    model.shape = Some(spread(SpreadFacts { center: [0.5, 1.1, 0.5], ..good }));
    let mass_model = found[0].place.as_ref().unwrap().place();
    assert!(found[0].message.contains(&mass_model), "{found:?}");
}

#[test]
fn what_a_database_says_beside_the_model_counts_as_its_own_words() {
    let sidecar = |text: &str| Sidecar::parse("x.physics.yaml", text, &rules()).unwrap();
    let mapper = mapper_of("");
    let nameless = facts("0042.glb", 0.9);
    assert_eq!(mapper.map(&nameless, &[]).subcategory, None);
    let tagged = sidecar("tags: [steel, stool]\n");
    let mapped = mapper.map_with_sidecar(&nameless, Some(&tagged), &[]);
    assert_eq!((mapped.subcategory.as_deref(), mapped.preset.as_deref()), (Some("stool"), Some("steel")));
    let titled = sidecar("title: Dog bowl\nmass: 300 g\n");
    let mapped = mapper.map_with_sidecar(&nameless, Some(&titled), &[]);
    assert_eq!((mapped.subcategory.as_deref(), mapped.number("mass")), (Some("bowl"), Some(0.3)));
    assert!(Sidecar::parse("x.physics.yaml", "tags: { a: b }\n", &rules()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn no_name_makes_the_matcher_panic(path in any::<String>(), name in any::<String>(), tag in any::<String>(), size in any::<f64>()) {
        let mut model = facts(&path, size);
        model.title = Some(name.clone());
        model.tags = vec![tag];
        model.names = vec![name];
        let mapper = mapper_of("");
        let mapped = mapper.map(&model, &[]);
        prop_assert!((0.0..=1.0).contains(&mapped.confidence));
        prop_assert_eq!(&mapper.map(&model, &[]), &mapped);
        let _ = explain("x", &mapped, &model);
    }
}
