//! A pile of copies, stepped: what a collider costs where it is used most.

use std::time::Instant;

use importer::Measures;
use importer::collider::Shape;
use mapper::scene::{Placement, child, floor_entity};
use sim::{Entity, Mass, Motion, Pose, Scene, Settings, Surface, Velocity, World};

use super::COPIES;

/// Size that every model is given, m: the step must not depend on file units.
const DIAGONAL_M: f64 = 0.5;
/// Steps that are clocked: two seconds, from the fall to the pile.
const STEPS: usize = 120;
/// Copies side by side in a layer.
const SIDE: usize = 2;

/// Mean milliseconds of a step, asleep or not: sleeping is off. `None` where no world can be made.
pub(super) fn step_ms(shapes: &[Shape], measures: &Measures) -> Option<f64> {
    let diagonal = measures.diagonal();
    let scale = DIAGONAL_M / diagonal;
    let centre: [f64; 3] = std::array::from_fn(|k| -(measures.min[k] + measures.max[k]) / 2.0 * scale);
    let placement = Placement {
        metres_per_unit: scale,
        body_from_file: Pose { position: centre, rotation: [0.0, 0.0, 0.0, 1.0] },
    };
    let surface = Surface::new(0.5, 0.0);
    let children: Vec<_> = shapes.iter().map(|shape| child(shape, &placement, surface)).collect();
    let side: [f64; 3] = std::array::from_fn(|k| (measures.max[k] - measures.min[k]) * scale);
    let about = |a: f64, b: f64| (a * a + b * b) / 12.0;
    let mass = Mass {
        mass_kg: 1.0,
        inertia_kg_m2: [
            about(side[1], side[2]),
            about(side[0], side[2]),
            about(side[0], side[1]),
            0.0,
            0.0,
            0.0,
        ],
    };
    let mut entities = vec![floor_entity(surface)];
    for copy in 0..COPIES {
        let (layer, place) = (copy / (SIDE * SIDE), copy % (SIDE * SIDE));
        let at =
            |index: usize, k: usize| (index as f64 - 0.5) * side[k] * 1.1 + layer as f64 * 0.02 * side[k];
        // Every other layer is turned half around, so that nothing nests.
        let turn = std::f64::consts::FRAC_PI_2 * (layer % 2) as f64;
        let position = [at(place % SIDE, 0), side[1] * (0.6 + 1.15 * layer as f64), at(place / SIDE, 2)];
        entities.push(Entity {
            name: format!("copy {copy}"),
            motion: Motion::Dynamic(mass),
            pose: Pose { position, rotation: [0.0, turn.sin(), 0.0, turn.cos()] },
            velocity: Velocity::default(),
            shapes: children.clone(),
        });
    }
    let scene = Scene {
        name: "pile".to_owned(),
        gravity: Scene::GRAVITY,
        entities,
        actions: Vec::new(),
        pairs: Vec::new(),
    };
    let settings = Settings { sleeping: false, ..Settings::default() };
    let mut world = World::new(&scene, &settings).ok()?;
    let begun = Instant::now();
    for _ in 0..STEPS {
        world.step();
    }
    Some(begun.elapsed().as_secs_f64() * 1e3 / STEPS as f64)
}
