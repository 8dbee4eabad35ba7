//! Scene files, and models turned into bodies.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::path::Path;

use importer::collider::{Candidate, ColliderError, Rung, Shape as FileShape};
use importer::{Asset, AssetKey, Axis, FileFrame, Format, Geometry, MassProperties, Measures, VolumeMethod};
use mapper::scene::{collider, drop_scene, placement};
use mapper::{Kind, Layer, MapError, Mapped, Mapper, ModelFacts, Overrides, Ruleset, SetValue, scene_file};
use sim::{Change, Meeting, Motion, Shape, pair_friction};

/// A box of 20 x 10 x 40 file units, its lower corner at the origin, up along Z, one unit a centimetre.
fn asset() -> Asset {
    let sides = [20.0, 10.0, 40.0];
    let [x, y, z] = sides;
    let center = sides.map(|side| side / 2.0);
    let volume = x * y * z;
    let about = |a: f64, b: f64| volume * (a * a + b * b) / 12.0;
    let solid = MassProperties {
        measure: volume,
        centroid: center,
        inertia: [about(y, z), about(x, z), about(x, y), 0.0, 0.0, 0.0],
    };
    let measures = Measures {
        triangles: 12,
        vertices: 8,
        vertices_welded: 8,
        min: [0.0; 3],
        max: sides,
        closed: true,
        wound_consistently: true,
        bodies: 1,
        inside_out_bodies: 0,
        boundary_edges: 0,
        nonmanifold_edges: 0,
        degenerate_triangles: 0,
        signed_volume: Some(volume),
        solid: Some(solid),
        solid_method: Some(VolumeMethod::Closed),
        solid_error: Some(0.0),
        solid_confidence: Some(1.0),
        body_volumes: Vec::new(),
        shell: MassProperties { measure: 2.0 * (x * y + y * z + z * x), ..solid },
        hull_volume: Some(volume),
    };
    let shape = FileShape::Box { center, rotation: [0.0, 0.0, 0.0, 1.0], half_extents: center };
    let candidate = Candidate {
        rung: Rung::Box,
        shapes: vec![shape],
        error: ColliderError::default(),
        vertices: 8,
        cost: 2.0,
        fallback: None,
    };
    Asset {
        key: AssetKey([0; 32]),
        format: Format::Stl,
        geometry: Geometry::Mesh,
        frame: FileFrame { metres_per_unit: 1.0, unit_stated: false, up: Axis::Z, up_stated: false },
        measures,
        ladder: vec![candidate],
        parts: Vec::new(),
        names: Vec::new(),
        stated: Vec::new(),
        notes: Vec::new(),
    }
}

fn rules() -> Ruleset {
    Ruleset::embedded().unwrap_or_else(|error| panic!("{error}"))
}

fn mapped(asset: &Asset, sets: &[&str]) -> Mapped {
    let rules = rules();
    let sets: Vec<SetValue> = sets.iter().map(|set| SetValue::parse(set, &rules).unwrap()).collect();
    Mapper::new(rules, Overrides::none()).map(&ModelFacts::new("block.stl", asset), &sets)
}

#[test]
fn a_model_becomes_a_body_about_its_centre_of_mass() {
    let asset = asset();
    let mapped = mapped(&asset, &["unit=cm", "mass_model=solid", "density=500 kg/m3", "kind=rigid"]);
    let floor = rules().surface("concrete").unwrap();
    let scene = drop_scene("block.stl", &asset, &mapped, floor, &rules()).unwrap();
    let body = &scene.entities[1];
    let Motion::Dynamic(mass) = body.motion else { panic!("static") };
    assert!((mass.mass_kg - 500.0 * 0.2 * 0.1 * 0.4).abs() < 1e-9, "{}", mass.mass_kg);
    // Z up turns to Y up: the tall side is along Y now.
    let moment = |a: f64, b: f64| mass.mass_kg * (a * a + b * b) / 12.0;
    let expected = [moment(0.4, 0.1), moment(0.2, 0.1), moment(0.2, 0.4)];
    for (moment, expected) in mass.inertia_kg_m2.iter().zip(expected) {
        assert!((moment - expected).abs() < 1e-9, "{:?} {expected}", mass.inertia_kg_m2);
    }
    let [low, high] = mapper::scene::bounds(&body.shapes).unwrap();
    for (bound, expected) in low.iter().chain(&high).zip([-0.1, -0.2, -0.05, 0.1, 0.2, 0.05]) {
        assert!((bound - expected).abs() < 1e-9, "{low:?} {high:?}");
    }
    // A tenth of its height above the floor.
    assert!((body.pose.position[1] - (0.2 + 0.04)).abs() < 1e-9, "{:?}", body.pose);
    let place = placement("block.stl", &asset, &mapped).unwrap();
    let corner = place.apply([0.0, 0.0, 0.0]);
    assert!(
        (corner[0] + 0.1).abs() < 1e-9 && (corner[1] + 0.2).abs() < 1e-9 && (corner[2] - 0.05).abs() < 1e-9
    );
}

#[test]
fn a_tolerance_in_metres_chooses_the_collider() {
    let mut asset = asset();
    let exact = asset.ladder[0].clone();
    let error = ColliderError { surface_p95: 0.03, surface_max: 0.03, ..ColliderError::default() };
    let coarse = Candidate { rung: Rung::Sphere, cost: 1.0, error, ..exact };
    asset.ladder.insert(0, coarse);
    let rung = |sets: &[&str]| collider(&asset, &mapped(&asset, sets)).unwrap().rung;
    // The ball is off by 3 % of a diagonal of 0.458 m: 14 mm.
    assert_eq!(rung(&["unit=cm"]), Rung::Box);
    assert_eq!(rung(&["unit=cm", "collider_tolerance=13 mm"]), Rung::Box);
    assert_eq!(rung(&["unit=cm", "collider_tolerance=15 mm"]), Rung::Sphere);
    assert_eq!(rung(&["unit=mm", "collider_tolerance=13 mm"]), Rung::Sphere);
    let said = mapped(&asset, &["collider_tolerance=15 mm"]).collider_tolerance.unwrap();
    assert!((said.metres - 0.015).abs() < 1e-12 && said.by.layer == Layer::CommandLine, "{said:?}");
}

#[test]
fn a_known_pair_holds_between_model_and_floor() {
    let rules = rules();
    let floor = rules.surface("concrete").unwrap();
    let asset = asset();
    let meeting = |sets: &[&str]| {
        let scene = drop_scene("m", &asset, &mapped(&asset, sets), floor, &rules).unwrap();
        Meeting::of(&scene.pairs, &scene.entities[1].shapes[0].surface, &floor)
    };
    let mut known = 0;
    for preset in rules.presets.iter().filter(|preset| preset.kind == Kind::Rigid) {
        let Some(pair) = rules.known_pair("concrete", &preset.name) else { continue };
        known += 1;
        let met = meeting(&[&format!("preset={}", preset.name)]);
        let combined = pair_friction(&rules.surface(&preset.name).unwrap(), &floor);
        assert_eq!(met.friction, pair.friction.unwrap_or(combined), "{}", preset.name);
        assert!(pair.restitution.is_none_or(|known| met.restitution == known), "{}", preset.name);
    }
    assert!(known >= 5, "{known}");
    // Who writes a friction means it, in every contact.
    let by_hand = meeting(&["preset=steel", "friction_dynamic=0.1"]);
    assert_eq!(by_hand.friction, (0.1 * floor.friction).sqrt());
}

#[test]
fn a_known_pair_holds_between_two_bodies_of_a_scene_file() {
    let text = "entities:
  - { name: rink, shape: half-space, material: ice, static: true }
  - { name: skate, shape: box, size: [1 m, 1 m, 1 m], material: steel, position: [0, 1, 0] }
  - { name: brush, shape: box, size: [1 m, 1 m, 1 m], material: { preset: steel, friction: 0.3 }, position: [3, 1, 0] }
";
    let mut no_models = |_: &Path| Err("no model here".to_owned());
    let file = mapper::scene_file::parse("t.yaml", text, &rules(), &mut no_models).unwrap();
    let surface = |entity: usize| file.scene.entities[entity].shapes[0].surface;
    let known = rules().known_pair("steel", "ice").unwrap();
    assert_eq!(Some(Meeting::of(&file.scene.pairs, &surface(1), &surface(0)).friction), known.friction);
    let brush = Meeting::of(&file.scene.pairs, &surface(2), &surface(0)).friction;
    assert_eq!(brush, pair_friction(&surface(2), &surface(0)));
}

#[test]
fn what_is_anchored_does_not_move_and_a_fluid_has_no_surface() {
    let asset = asset();
    let floor = rules().surface("concrete").unwrap();
    let scene =
        drop_scene("m", &asset, &mapped(&asset, &["anchored=true", "kind=rigid"]), floor, &rules()).unwrap();
    assert_eq!(scene.entities[1].motion, Motion::Static);
    let error = drop_scene("m", &asset, &mapped(&asset, &["preset=water"]), floor, &rules()).unwrap_err();
    assert_eq!((error.code(), error.place().as_str()), ("no-surface", "m"));
}

fn example() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/scene.yaml")).unwrap()
}

fn none(_: &Path) -> Result<(Asset, Mapped), String> {
    Err("no models here".to_owned())
}

#[test]
fn the_example_scene_is_read() {
    let file = scene_file::parse("scene.yaml", &example(), &rules(), &mut none)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((file.dt_s, file.duration_s), (Some(0.01), Some(4.0)));
    let names: Vec<&str> = file.scene.entities.iter().map(|entity| entity.name.as_str()).collect();
    assert_eq!(names, ["floor", "slope", "ball", "hammer", "pin", "wedge", "ramp"]);
    let entity = |name: &str| file.scene.entities.iter().find(|entity| entity.name == name).unwrap();
    assert_eq!(entity("slope").motion, Motion::Static);
    assert_eq!(entity("slope").shapes[0].shape, Shape::Box { half_extents: [2.0, 0.1, 1.0] });
    let Motion::Dynamic(ball) = entity("ball").motion else { panic!("static") };
    assert!((ball.mass_kg - 0.2).abs() < 1e-12);
    assert!((ball.inertia_kg_m2[0] - 0.4 * 0.2 * 0.0025).abs() < 1e-12);
    assert!((entity("ball").shapes[0].surface.restitution - 0.9).abs() < 1e-12);
    // The hammer's head is steel, so that its centre of mass lies near the head and its origin below that.
    let hammer = entity("hammer");
    assert!(hammer.pose.position[1] > 2.1 && hammer.pose.position[1] < 2.165, "{:?}", hammer.pose);
    assert_eq!((hammer.shapes[0].part, hammer.shapes[1].part), (0, 1));
    assert!(hammer.shapes[0].surface != hammer.shapes[1].surface);
    assert_eq!(file.scene.actions.len(), 2);
    let Change::SetPose(pose) = file.scene.actions[1].change else { panic!("no pose") };
    assert_eq!(pose, hammer.pose);
}

#[test]
fn a_model_in_a_scene_stands_where_its_file_origin_is_put() {
    let text = "entities:\n  - { name: block, model: m/block.stl, position: [1, 2, 3], mass: 4 kg }\n";
    let mut asked = Vec::new();
    let mut resolver = |path: &Path| {
        asked.push(path.to_owned());
        let asset = asset();
        let mapped = mapped(&asset, &["unit=cm", "mass_model=solid", "kind=rigid"]);
        Ok((asset, mapped))
    };
    let file = scene_file::parse("dir/scene.yaml", text, &rules(), &mut resolver)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(asked, [Path::new("dir/m/block.stl")]);
    let body = &file.scene.entities[0];
    let Motion::Dynamic(mass) = body.motion else { panic!("static") };
    assert!((mass.mass_kg - 4.0).abs() < 1e-12);
    // The box's centre is at (10, 5, 20) cm of the file, which is (0.1, 0.2, -0.05) m with Y up.
    for (at, expected) in body.pose.position.iter().zip([1.1, 2.2, 2.95]) {
        assert!((at - expected).abs() < 1e-9, "{:?}", body.pose);
    }
    assert_eq!(file.models[0].entity, 0);
}

#[test]
fn faults_of_a_scene_have_their_place() {
    for (from, to, code) in [
        ("entity: ball", "entity: bal", "CAT005"),
        ("radius: 5 cm", "radius: 5", "CAT004"),
        ("material: oak", "material: oka", "CAT005"),
        ("shape: sphere", "shape: spere", "CAT005"),
        ("size: [4 m, 20 cm, 2 m]", "size: [4 m, 20 cm]", "CAT003"),
        ("[0, 2, 1]", "[0, 9, 1]", "CAT003"),
        ("name: pin", "name: ball", "CAT006"),
        ("gravity:", "gravty:", "CAT002"),
    ] {
        let text = example().replacen(from, to, 1);
        assert_ne!(text, example(), "{from}");
        let error: MapError = scene_file::parse("scene.yaml", &text, &rules(), &mut none).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
        assert!(error.place().starts_with("scene.yaml:"), "{error}");
    }
}
