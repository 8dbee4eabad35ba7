//! A clean catalogue and database of models, made from a seed, in which nothing is to be found.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use physique::demo::{Material, Mesh, Part, write_glb};

/// SplitMix64: the same worlds on every machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rng(pub u64);

impl Rng {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly between the two, to three digits.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "53 of 64 bits")]
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let value = low + (high - low) * share;
        (value * 1000.0).round() / 1000.0
    }
}

/// Everything that is written to disk.
#[derive(Clone, Debug)]
pub(crate) struct World {
    pub files: BTreeMap<String, Vec<u8>>,
    /// Half extents of the models that are boxes.
    pub boxes: BTreeMap<String, [f64; 3]>,
}

const PLAIN: Material =
    Material { name: "plain", color: [0.5, 0.5, 0.5, 1.0], metallic: 0.0, roughness: 1.0 };

/// A box on the floor, eight corners, twelve triangles.
pub(crate) fn cuboid([x, y, z]: [f64; 3]) -> Mesh {
    let positions = (0..8)
        .map(|corner: u32| {
            let sign = |bit: u32, half: f64| if corner >> bit & 1 == 1 { half } else { -half };
            [sign(0, x), sign(1, y) + y, sign(2, z)]
        })
        .collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Mesh { positions, triangles }
}

pub(crate) fn glb(mesh: Mesh) -> Vec<u8> {
    write_glb("thing", &[Part { name: "body", material: PLAIN, mesh }])
}

impl World {
    pub(crate) fn clean(seed: u64) -> Self {
        let mut rng = Rng(seed);
        let mut world = Self { files: BTreeMap::new(), boxes: BTreeMap::new() };
        let around = |rng: &mut Rng, half: [f64; 3]| half.map(|side| side * rng.between(0.85, 1.15));
        for (model, half) in [
            ("storage/crate_a.glb", [0.2, 0.15, 0.2]),
            ("storage/crate_b.glb", [0.25, 0.2, 0.2]),
            ("storage/brick_a.glb", [0.11, 0.035, 0.055]),
            ("tools/anvil.glb", [0.2, 0.12, 0.08]),
            ("soft/cushion.glb", [0.2, 0.06, 0.2]),
            ("liquids/puddle.glb", [0.15, 0.02, 0.15]),
            ("garden/pillar.glb", [0.2, 0.9, 0.2]),
        ] {
            world.put_box(model, around(&mut rng, half));
        }
        world.put("catalog.yaml", &catalogue(&mut rng));
        let friction = rng.between(0.45, 0.5);
        world.put(
            "models/overrides.yaml",
            &format!("version: 1\noverrides:\n  - match: 'tools/*.glb'\n    set: {{ friction_dynamic: {friction} }}\n"),
        );
        let mass = rng.between(8.0, 12.0);
        world.put("models/storage/crate_b.physics.yaml", &format!("# weighed\nmass: {mass} kg\n"));
        world.put("physique.yaml", "version: 1\nstack: [brick]\n");
        world
    }

    pub(crate) fn put(&mut self, file: &str, text: &str) {
        self.files.insert(file.to_owned(), text.as_bytes().to_vec());
    }

    pub(crate) fn put_model(&mut self, model: &str, bytes: Vec<u8>) {
        self.files.insert(format!("models/{model}"), bytes);
    }

    pub(crate) fn put_box(&mut self, model: &str, half: [f64; 3]) {
        self.put_model(model, glb(cuboid(half)));
        self.boxes.insert(model.to_owned(), half);
    }

    /// Changes the mesh of a model that is a box.
    pub(crate) fn reshape(&mut self, model: &str, change: impl FnOnce(&mut Mesh)) {
        let mut mesh = cuboid(self.boxes[model]);
        change(&mut mesh);
        self.put_model(model, glb(mesh));
    }

    pub(crate) fn text(&self, file: &str) -> String {
        String::from_utf8(self.files[file].clone()).expect("text")
    }

    /// Replaces words of a text file, which must be there.
    pub(crate) fn edit(&mut self, file: &str, from: &str, to: &str) {
        let text = self.text(file);
        assert!(text.contains(from), "{file} has no {from:?}:\n{text}");
        self.put(file, &text.replacen(from, to, 1));
    }

    /// Line of the first place where these words stand; 0 where they do not.
    pub(crate) fn line(&self, file: &str, words: &str) -> u64 {
        let text = self.text(file);
        text.lines().position(|line| line.contains(words)).map_or(0, |line| line as u64 + 1)
    }

    /// Makes the folder what this world is.
    pub(crate) fn write(&self, folder: &Path) {
        for (file, bytes) in &self.files {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, bytes).expect("written");
        }
    }
}

fn catalogue(rng: &mut Rng) -> String {
    let mut number = |low: f64, high: f64| rng.between(low, high);
    let mut rigid = |name: &str, density: (f64, f64)| {
        let held = number(0.55, 0.65);
        format!(
            "  {name}:
    kind: rigid
    density: {{ value: {} kg/m3, source: handbook }}
    friction_static: {{ value: {held}, source: tables }}
    friction_dynamic: {{ value: {}, source: tables }}
    restitution: {{ value: {}, source: tables }}
    rolling_resistance: {{ value: 0.01, source: tables }}
",
            number(density.0, density.1),
            number(0.4, held - 0.05),
            number(0.1, 0.3),
        )
    };
    let presets = [
        ("oak", (650.0, 750.0)),
        ("steel", (7800.0, 7900.0)),
        ("ceramic", (1800.0, 2000.0)),
        ("concrete", (2200.0, 2400.0)),
    ]
    .map(|(name, density)| rigid(name, density))
    .concat();
    format!(
        "version: 1
sources:
  handbook: A handbook of densities
  tables: Tables of friction and bounce
defaults:
  restitution: {{ value: 0.3, source: tables }}
  rolling_resistance: {{ value: 0.01, source: tables }}
kinds:
  rigid: {{ preset: oak, attributes: [density, mass, friction_static, friction_dynamic, restitution, rolling_resistance] }}
  soft: {{ preset: foam, attributes: [density, mass, youngs_modulus, poisson_ratio] }}
  fluid: {{ preset: water, attributes: [density, mass, dynamic_viscosity] }}
presets:
{presets}  foam:
    kind: soft
    density: {{ value: {} kg/m3, source: handbook }}
    youngs_modulus: {{ value: 50 kPa, source: handbook }}
    poisson_ratio: {{ value: 0.2, source: handbook }}
  water:
    kind: fluid
    density: {{ value: 998 kg/m3, source: handbook }}
    dynamic_viscosity: {{ value: 1 mPa.s, source: handbook }}
pairs:
  - {{ between: [oak, concrete], friction_static: 0.62, friction_dynamic: {}, source: tables }}
  - {{ between: [steel, oak], friction_static: 0.6, friction_dynamic: 0.45, source: tables }}
categories:
  storage:
    subcategories:
      crate:
        aliases: [crate, packing case]
        size: [30 cm, 80 cm]
        mass: [2 kg, 25 kg]
        preset: oak
        mass_model: {{ fill: 0.2 }}
      brick:
        size: [15 cm, 40 cm]
        mass: [1 kg, 9 kg]
        preset: ceramic
        mass_model: solid
  tools:
    subcategories:
      anvil:
        size: [20 cm, 70 cm]
        mass: [20 kg, 600 kg]
        preset: steel
        mass_model: solid
  soft:
    subcategories:
      cushion:
        size: [25 cm, 70 cm]
        mass: [50 g, 5 kg]
        preset: foam
  liquids:
    subcategories:
      puddle:
        size: [20 cm, 60 cm]
        mass: [0.5 kg, 10 kg]
        preset: water
  garden:
    subcategories:
      pillar:
        size: [1 m, 3 m]
        mass: [100 kg, 2 t]
        preset: concrete
        anchored: true
rules:
  - name: metal-crate
    when: {{ path: '**/metal/**', word: crate }}
    set: {{ preset: steel }}
",
        number(30.0, 50.0),
        number(0.4, 0.5),
    )
}
