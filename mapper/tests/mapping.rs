//! From names and measures to physics: heads of names, layers, provenance, faults.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::fmt::Write;

use mapper::{
    Kind, Layer, MapError, Mapper, ModelFacts, Overrides, PartFacts, Ruleset, SetValue, ShapeFacts, Sidecar,
    SpreadFacts, explain,
};
use proptest::prelude::*;

const SMALL: &str = "version: 1
sources: { book: 'A book', assumed: Assumed }
words: { noise: [red, large], colours: [orange], vague: [plate] }
defaults:
  density: { value: 1000 kg/m3, source: assumed }
  restitution: { value: 0.3, source: assumed }
kinds:
  rigid: { preset: generic-solid, attributes: [density, mass, friction_static, friction_dynamic, restitution, youngs_modulus] }
  soft: { preset: foam, attributes: [density, mass, youngs_modulus] }
  fluid: { preset: water, attributes: [density, mass, dynamic_viscosity] }
presets:
  generic-solid: { kind: rigid, density: 900 kg/m3, friction_static: 0.5, friction_dynamic: 0.4, youngs_modulus: 1 GPa }
  oak: { kind: rigid, aliases: [oak], density: { value: 700 kg/m3, source: book }, friction_dynamic: 0.3, restitution: 0.4 }
  steel: { kind: rigid, aliases: [steel, metal], density: 7850 kg/m3, restitution: 0.6 }
  foam: { kind: soft, aliases: [foam], density: 30 kg/m3, youngs_modulus: 100 kPa }
  water: { kind: fluid, aliases: [water], density: 998 kg/m3, dynamic_viscosity: 1 mPa.s }
categories:
  seating:
    kind: rigid
    preset: oak
    friction_dynamic: 0.35
    mass_model: { fill: 0.1 }
    subcategories:
      chair: { synset: chair.n.01, size: [70 cm, 1.1 m], mass: [3 kg, 12 kg] }
      stool: { aliases: [bar stool], size: [40 cm, 80 cm], mass: [2 kg, 8 kg], friction_dynamic: 0.36 }
  dish:
    kind: rigid
    preset: steel
    mass_model: { shell: 2 mm }
    subcategories:
      bowl: { size: [10 cm, 30 cm], mass: [100 g, 1 kg] }
      plate: { size: [15 cm, 30 cm], mass: [200 g, 900 g] }
      coffee-mug: { aliases: [mug], size: [7 cm, 13 cm], mass: [200 g, 500 g] }
  animal:
    kind: soft
    preset: foam
    subcategories:
      dog: { size: [40 cm, 1.2 m], mass: [5 kg, 45 kg] }
      knife-fish: { aliases: [fish], size: [10 cm, 1 m], mass: [100 g, 5 kg] }
  thing:
    kind: rigid
    preset: steel
    subcategories:
      knife: { size: [10 cm, 40 cm], mass: [20 g, 400 g] }
      table-lamp: { aliases: [lamp], size: [30 cm, 70 cm], mass: [1 kg, 4 kg] }
      table: { size: [60 cm, 2 m], mass: [10 kg, 60 kg] }
      toy: { size: [5 cm, 50 cm], mass: [20 g, 2 kg] }
rules:
  - { name: toys, when: { word: toy }, set: { subcategory: toy, restitution: 0.45 }, confidence: 0.97 }
  - { name: flat-plates, when: { alias: plate, aspect: [4, 100] }, set: { friction_static: 0.55 } }
";

fn rules() -> Ruleset {
    Ruleset::parse("small.yaml", SMALL).unwrap_or_else(|error| panic!("{error}"))
}

fn mapper_of(overrides: &str) -> Mapper {
    let rules = rules();
    let overrides =
        Overrides::parse("over.yaml", overrides, &rules).unwrap_or_else(|error| panic!("{error}"));
    Mapper::new(rules, overrides)
}

fn facts(model: &str, longest: f64) -> ModelFacts {
    ModelFacts {
        model: model.to_owned(),
        title: None,
        tags: Vec::new(),
        names: Vec::new(),
        materials: Vec::new(),
        extents: [Some(longest), Some(longest * 0.9), Some(longest * 0.8)],
        metres_per_unit: 1.0,
        unit_stated: true,
        shape: None,
        parts: Vec::new(),
        stated: Vec::new(),
    }
}

fn solid(facts: ModelFacts, volume: f64) -> ModelFacts {
    let shape = ShapeFacts {
        volume: Some(volume),
        volume_is_hull: false,
        area: Some(1.0),
        hull_volume: Some(volume),
        closed: true,
        bodies: 1,
        spread: None,
    };
    ModelFacts { shape: Some(shape), ..facts }
}

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
        ("qwertz.glb", None),
        ("", None),
    ] {
        let mapped = mapper.map(&facts(model, 0.3), &[]);
        assert_eq!(mapped.subcategory.as_deref(), expected, "{model}: {:?}", mapped.trace);
        assert_eq!(mapped.category.is_none(), expected.is_none(), "{model}");
    }
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

fn first(error: &MapError) -> (&'static str, u32, u32) {
    let diagnostic = &error.diagnostics()[0];
    (diagnostic.code, diagnostic.line, diagnostic.column)
}

#[test]
fn faults_name_their_place_and_the_way_out() {
    for (from, to, code, help) in [
        ("preset: oak\n", "preset: oka\n", "CAT005", "did you mean `oak`?"),
        ("7850 kg/m3", "7850", "CAT004", "write `7850 kg/m3`"),
        ("7850 kg/m3", "7850 kg", "CAT004", "units of density"),
        (
            "    friction_dynamic: 0.35",
            "    friction_dynamc: 0.35",
            "CAT002",
            "did you mean `friction_dynamic`?",
        ),
        ("kind: soft, aliases", "kind: sotf, aliases", "CAT005", "did you mean `soft`?"),
        ("source: book", "source: bok", "CAT005", "did you mean `book`?"),
        ("fill: 0.1 }", "fill: 1.1 }", "CAT008", ""),
        ("[70 cm, 1.1 m]", "[70 cm, 0.1 m]", "CAT008", "swap them"),
        ("chair.n.01", "chair", "CAT003", "armchair.n.01"),
        ("    preset: oak\n", "    preset: oak\n    preset: oak\n", "CAT006", ""),
        ("subcategory: toy,", "subcategory: toyy,", "CAT005", "did you mean"),
        ("word: toy }", "wrod: toy }", "CAT002", "did you mean `word`?"),
    ] {
        let text = SMALL.replacen(from, to, 1);
        assert_ne!(text, SMALL, "{from}");
        let error = Ruleset::parse("bad.yaml", &text).unwrap_err();
        let (found, line, _) = first(&error);
        let changed = text.lines().zip(SMALL.lines()).position(|(new, old)| new != old).unwrap() + 1;
        assert_eq!(found, code, "{error}");
        assert_eq!(line as usize, changed, "{error}");
        let shown = error.to_string();
        assert!(shown.contains(&format!("bad.yaml:{line}:")) && shown.contains('^'), "{shown}");
        assert!(shown.contains(help), "{shown}");
    }
    assert!(SetValue::parse("mass=2.4", &rules()).is_err());
    assert!(
        SetValue::parse("mas=2.4 kg", &rules()).unwrap_err().to_string().contains("did you mean `mass`?")
    );
    assert!(SetValue::parse("mass", &rules()).is_err());
    let deep = "[".repeat(10_000);
    assert!(Ruleset::parse("deep.yaml", &deep).is_err());
    assert!(Ruleset::parse("alias.yaml", "a: &a [1]\nb: *a\n").is_err());
}

#[test]
fn static_analysis_finds_what_cannot_be_right() {
    let with = |rules: &str| {
        let text = format!("{SMALL}{rules}");
        let rules = Ruleset::parse("small.yaml", &text).unwrap_or_else(|error| panic!("{error}"));
        mapper::check_rules(&rules).iter().map(|finding| finding.code.to_string()).collect::<Vec<_>>()
    };
    let before = with("");
    for (rule, code) in [
        (
            "  - { name: a, when: { aspect: [2, 3], all: [{ aspect: [4, 5] }] }, set: { kind: soft } }\n",
            "RUL002",
        ),
        ("  - { name: a, when: { bodies: [0, 0.5] }, set: { kind: soft } }\n", "RUL002"),
        ("  - { name: a, when: { word: toy }, set: { restitution: 0.1, subcategory: toy } }\n", "RUL003"),
        ("  - { name: a, when: { word: x }, set: { category: dish }, confidence: 0.1 }\n", "RUL004"),
    ] {
        let mut after = with(rule);
        for known in &before {
            let at = after.iter().position(|code| code == known).expect("a finding went away");
            after.remove(at);
        }
        assert_eq!(after, [code], "{rule}");
    }
    let text = SMALL.replace("aliases: [bar stool]", "aliases: [bar stool, chair]");
    let rules = Ruleset::parse("small.yaml", &text).unwrap();
    assert!(mapper::check_rules(&rules).iter().any(|finding| &*finding.code == "RUL001"));
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

    #[test]
    fn mutated_yaml_is_refused_with_a_place_or_read(at in 0..SMALL.len(), cut in 0usize..12, put in "[ -~\n\t#é{}\\[\\]:]{0,6}") {
        let from = (0..=at).rev().find(|byte| SMALL.is_char_boundary(*byte)).unwrap_or(0);
        let to = (from + cut).min(SMALL.len());
        let text = format!("{}{put}{}", &SMALL[..from], &SMALL[to..]);
        if let Err(error) = Ruleset::parse("mutated.yaml", &text) {
            prop_assert!(!error.diagnostics().is_empty());
            let lines = text.lines().count() as u32 + 1;
            for diagnostic in error.diagnostics() {
                prop_assert!(diagnostic.line <= lines, "{}", diagnostic.place());
            }
            let mut shown = String::new();
            write!(shown, "{error}").unwrap();
            prop_assert!(shown.contains("mutated.yaml"));
        }
    }
}

#[test]
fn a_mesh_whose_volumes_cancel_is_a_finding_with_both_places() {
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
    let mass_model = found[0].place.as_ref().unwrap().place();
    assert!(found[0].message.contains("stool.glb") && found[0].message.contains(&mass_model), "{found:?}");
}
