//! Real files, where they are at hand: read, mapped, and put into a scene.

#![allow(clippy::expect_used, clippy::panic, clippy::print_stderr, clippy::unwrap_used)] // helpers of tests count as production code

use std::path::{Path, PathBuf};

use mapper::{Mapper, ModelFacts, Overrides, Ruleset, explain, scene::drop_scene};
use sim::Motion;

/// The sample of real models, `None` with a printed reason where it is absent.
fn models() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/models");
    let root = std::env::var_os("PHYSIQUE_MODELS").map_or(beside, PathBuf::from);
    if root.is_dir() {
        return Some(root);
    }
    eprintln!("skipped: no folder {} (set PHYSIQUE_MODELS)", root.display());
    None
}

#[test]
fn real_models_get_their_category_size_and_mass() {
    let Some(root) = models() else { return };
    let mapper = Mapper::new(Ruleset::embedded().unwrap(), Overrides::none());
    // Model, subcategory, longest extent in m, mass in kg.
    for (model, subcategory, size, mass) in [
        ("containers/coffeemug.stl", "coffee-mug", 0.08..0.15, 0.15..0.6),
        ("household/eyeglasses.stl", "eyeglasses", 0.1..0.2, 0.01..0.1),
        ("electronics/mouse.stl", "computer-mouse", 0.08..0.15, 0.05..0.2),
        ("furniture/chair_A.gltf", "chair", 0.6..1.5, 2.0..15.0),
        ("furniture/lamp_table.gltf", "table-lamp", 0.2..1.2, 0.5..6.0),
        ("animals/Cow.glb", "cow", 1.5..3.0, 300.0..900.0),
        ("food/apple.stl", "apple", 0.05..0.12, 0.08..0.35),
        ("tools/flashlight.stl", "flashlight", 0.08..0.3, 0.05..0.6),
        ("mechanical/wingnut.obj", "nut", 0.003..0.05, 0.0001..0.2),
    ] {
        let path = root.join(model);
        if !path.is_file() {
            eprintln!("skipped: no {model}");
            continue;
        }
        let asset =
            importer::import(&path, &importer::Options::default()).unwrap_or_else(|error| panic!("{error}"));
        let facts = ModelFacts::new(model, &asset);
        let mapped = mapper.map(&facts, &[]);
        let text = explain(model, &mapped, &facts);
        assert_eq!(mapped.subcategory.as_deref(), Some(subcategory), "{text}");
        let longest = facts.longest().unwrap() * mapped.scale.metres_per_unit;
        assert!(size.contains(&longest), "{longest} m\n{text}");
        assert!(mass.contains(&mapped.number("mass").unwrap()), "{text}");
        let floor = mapper.rules().surface("concrete").unwrap();
        let scene = drop_scene(model, &asset, &mapped, floor, mapper.rules())
            .unwrap_or_else(|error| panic!("{error}\n{text}"));
        let Motion::Dynamic(body) = scene.entities[1].motion else { panic!("static\n{text}") };
        assert!(body.mass_kg > 0.0 && body.inertia_kg_m2[..3].iter().all(|moment| *moment > 0.0));
    }
}
