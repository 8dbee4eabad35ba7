//! What of a scene is drawn: a look for every entity, and how far it all reaches.

use sim::{Entity, Motion, Scene, Shape};

use crate::bounds::Bounds;
use crate::palette;
use crate::path::Names;
use crate::place::Drawn;
use crate::tessellate;
use crate::visual::{ColliderMesh, Visual, VisualMesh};

/// The collider overlay is drawn this much larger, so that it does not flicker on a surface it equals.
const OVERLAY_SCALE: f32 = 1.004;
/// Radius of a drawn half space, and its thickness, in radii of the scene.
const GROUND_REACH: f32 = 24.0;
const GROUND_DEPTH: f32 = 0.02;

/// One entity as drawn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Look {
    /// Unique in the scene.
    pub(crate) name: String,
    pub(crate) fixed: bool,
    /// Whether someone gave it a visual; else `body` is made of its shapes.
    pub(crate) visual: bool,
    /// In the body's frame.
    pub(crate) body: Vec<VisualMesh>,
    /// The collider where it is not what is drawn already.
    pub(crate) overlay: Vec<VisualMesh>,
}

/// All of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Scenery {
    pub(crate) looks: Vec<Look>,
    /// Of the dynamic bodies at their start.
    pub(crate) bodies: Bounds,
    /// The same down to the floor.
    pub(crate) bounds: Bounds,
    /// m, height of the level ground under them.
    pub(crate) floor: Option<f32>,
    /// N, of all dynamic bodies.
    pub(crate) weight_n: f64,
}

/// A scene copied for the worker.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    pub(crate) entities: Vec<Entity>,
    pub(crate) gravity: [f64; 3],
    pub(crate) dt_s: f64,
    pub(crate) visuals: Vec<Visual>,
    pub(crate) colliders: Vec<ColliderMesh>,
}

impl Script {
    pub(crate) fn new(scene: &Scene, dt_s: f64, visuals: Vec<Visual>, colliders: Vec<ColliderMesh>) -> Self {
        Self { entities: scene.entities.clone(), gravity: scene.gravity, dt_s, visuals, colliders }
    }
}

impl Scenery {
    pub(crate) fn of(script: &Script) -> Self {
        let mut names = Names::default();
        let mut looks: Vec<Look> = Vec::with_capacity(script.entities.len());
        for (index, entity) in script.entities.iter().enumerate() {
            let fixed = entity.motion == Motion::Static;
            let color = if fixed { palette::STATIC } else { palette::body(index) };
            let mut body = tessellate::entity(entity);
            body.iter_mut().for_each(|mesh| mesh.color = color);
            let name = names.unique(&entity.name);
            looks.push(Look { name, fixed, visual: false, body, overlay: Vec::new() });
        }
        for visual in script.visuals.iter().filter(|v| v.meshes.iter().any(|m| !m.triangles.is_empty())) {
            if let Some(look) = looks.get_mut(visual.entity) {
                let shapes = std::mem::replace(&mut look.body, visual.meshes.clone());
                look.visual = true;
                if !look.fixed {
                    look.overlay = grown(&shapes);
                }
            }
        }
        for collider in script.colliders.iter().filter(|c| !c.triangles.is_empty()) {
            if let Some(look) = looks.get_mut(collider.entity) {
                let mesh = VisualMesh {
                    positions: collider.positions.clone(),
                    triangles: collider.triangles.clone(),
                    color: [255; 4],
                };
                look.overlay = grown(&[mesh]);
            }
        }
        let bodies = reach(&script.entities, &looks);
        let mut bounds = bodies;
        let floor = floor(&script.entities);
        if let Some(height) = floor.filter(|y| bounds.min[1] - y < 4.0 * bounds.radius()) {
            bounds.min[1] = bounds.min[1].min(height);
        }
        ground(&script.entities, &mut looks, &bounds);
        Self { looks, bodies, bounds, floor, weight_n: weight(script) }
    }

    /// How many entities move.
    pub(crate) fn dynamic(&self) -> usize {
        self.looks.iter().filter(|look| !look.fixed).count()
    }
}

fn grown(meshes: &[VisualMesh]) -> Vec<VisualMesh> {
    let mut meshes = meshes.to_vec();
    for mesh in &mut meshes {
        mesh.color = [255; 4];
        mesh.positions.iter_mut().flatten().for_each(|x| *x *= OVERLAY_SCALE);
    }
    meshes
}

/// Bounds of the moving bodies where they start; of all bodies where none moves.
fn reach(entities: &[Entity], looks: &[Look]) -> Bounds {
    let of = |fixed: bool| {
        let mut bounds = Bounds::EMPTY;
        for (entity, look) in entities.iter().zip(looks).filter(|(_, look)| look.fixed == fixed) {
            let pose = Drawn::of(&entity.pose);
            let points = look.body.iter().flat_map(|mesh| &mesh.positions);
            points.for_each(|point| bounds.add(pose.apply(*point)));
        }
        bounds
    };
    let moving = of(false);
    if moving.is_empty() { of(true) } else { moving }
}

/// Height of the highest half space that is level.
fn floor(entities: &[Entity]) -> Option<f32> {
    let shapes = entities.iter().flat_map(|entity| entity.shapes.iter().map(move |child| (entity, child)));
    let poses = shapes
        .filter(|(_, child)| child.shape == Shape::HalfSpace)
        .map(|(entity, child)| Drawn::of(&entity.pose).after(&Drawn::of(&child.body_from_shape)));
    let level = poses.filter(|pose| crate::place::rotate(pose.rotation, [0.0, 1.0, 0.0])[1] > 0.9999);
    level.map(|pose| pose.position[1]).max_by(f32::total_cmp)
}

/// Gives half spaces a plate large enough for the scene, centred under it.
fn ground(entities: &[Entity], looks: &mut [Look], bounds: &Bounds) {
    let radius = bounds.radius().max(1e-3);
    let [reach, depth] = [GROUND_REACH * radius, GROUND_DEPTH * radius];
    for (entity, look) in entities.iter().zip(looks).filter(|(_, look)| !look.visual) {
        for child in entity.shapes.iter().filter(|child| child.shape == Shape::HalfSpace) {
            let pose = Drawn::of(&entity.pose).after(&Drawn::of(&child.body_from_shape));
            let back = |point: [f32; 3]| {
                let [x, y, z, w] = pose.rotation;
                let rel = std::array::from_fn(|i| point[i] - pose.position[i]);
                crate::place::rotate([-x, -y, -z, w], rel)
            };
            let [cx, _, cz] = back(bounds.center());
            let mut plate = tessellate::cylinder(f64::from(depth), f64::from(reach));
            let child_pose = Drawn::of(&child.body_from_shape);
            for point in &mut plate.positions {
                *point = child_pose.apply([point[0] + cx, point[1] - depth, point[2] + cz]);
            }
            plate.color = palette::GROUND;
            look.body.push(plate);
        }
    }
}

fn weight(script: &Script) -> f64 {
    let [x, y, z] = script.gravity;
    let mass = |entity: &Entity| match entity.motion {
        Motion::Dynamic(mass) => mass.mass_kg,
        Motion::Static => 0.0,
    };
    script.entities.iter().map(mass).sum::<f64>() * (x * x + y * y + z * z).sqrt()
}
