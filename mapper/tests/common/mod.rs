//! A small catalogue and models for the tests.

#![allow(dead_code, reason = "each test file takes what it needs")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may stop and say so")]

use mapper::{Mapper, ModelFacts, Overrides, Ruleset, ShapeFacts};

pub const SMALL: &str = "version: 1
sources: { book: 'A book', assumed: Assumed }
words: { noise: [red, large], brands: [acme], colours: [orange], qualities: [kids], vague: [plate], general: [animal] }
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
    group: animal
    subcategories:
      animal: { aliases: [acme], size: [20 cm, 2 m], mass: [1 kg, 200 kg] }
      child: { aliases: [kid], size: [60 cm, 1.5 m], mass: [8 kg, 45 kg] }
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
      volume: { size: [10 cm, 40 cm], mass: [200 g, 2 kg] }
rules:
  - { name: toys, when: { word: toy }, set: { subcategory: toy, restitution: 0.45 }, confidence: 0.97 }
  - { name: flat-plates, when: { alias: plate, aspect: [4, 100] }, set: { friction_static: 0.55 } }
";

pub fn rules() -> Ruleset {
    Ruleset::parse("small.yaml", SMALL).unwrap_or_else(|error| panic!("{error}"))
}

pub fn mapper_of(overrides: &str) -> Mapper {
    let rules = rules();
    let overrides =
        Overrides::parse("over.yaml", overrides, &rules).unwrap_or_else(|error| panic!("{error}"));
    Mapper::new(rules, overrides)
}

pub fn facts(model: &str, longest: f64) -> ModelFacts {
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

pub fn solid(facts: ModelFacts, volume: f64) -> ModelFacts {
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
