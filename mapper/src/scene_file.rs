//! `SCENE.yaml`: a whole scene in text.
//!
//! ```yaml
//! name: ball-on-slope
//! gravity: [0, -9.81, 0]              # m/s2; vectors are bare SI numbers
//! dt: 16.6667 ms                      # optional, of a step
//! duration: 10 s                      # optional
//! floor: concrete                     # optional: a half-space at height 0 of this preset, or false
//! entities:
//!   - name: slope
//!     shape: box
//!     size: [4 m, 0.2 m, 2 m]         # full extents
//!     material: oak                   # a preset, or { friction: 0.5, restitution: 0.1, density: 700 kg/m3 }
//!     position: [0, 1, 0]             # m
//!     rotation: { axis: [0, 0, 1], angle: 20 deg }   # or a quaternion [x, y, z, w]
//!     static: true
//!   - name: ball
//!     shape: sphere
//!     radius: 5 cm
//!     material: rubber
//!     mass: 0.2 kg                    # beats the density of the material
//!     position: [0, 3, 0]
//!     velocity: [1, 0, 0]             # m/s
//!     angular_velocity: [0, 0, 3]     # rad/s
//!   - name: mug
//!     model: models/mug.glb           # relative to this file, mapped as any model
//!     position: [0.5, 1, 0]
//!   - name: hammer
//!     children:                       # one body of several shapes, each of its own material
//!       - { shape: cylinder, radius: 15 mm, height: 30 cm, material: oak }
//!       - { shape: box, size: [12 cm, 3 cm, 3 cm], material: steel, position: [0, 0.165, 0] }
//! actions:
//!   - { at: 2 s, entity: ball, set_velocity: { linear: [0, 5, 0], angular: [0, 0, 0] } }
//!   - { at: 3 s, entity: ball, set_pose: { position: [0, 3, 0], rotation: [0, 0, 0, 1] } }
//! ```
//!
//! Between two presets whose contact the catalogue knows (`pairs:`), its values hold; a material with a friction or
//! restitution of its own has no such partner.
//!
//! Shapes: `sphere` (radius), `box` (size), `capsule`, `cylinder` and `cone` (radius, height of the whole, along Y),
//! `hull` (points), `mesh` (positions, triangles; static), `height-field` (heights in m, a list for every row along X,
//! rows along Z; spacing between columns and rows in m; static), `half-space` (below its plane, normal +Y; static). Positions
//! are those of a body's own origin, which for a model or a compound need not be its centre of mass; a model's
//! origin is its file's.

use std::path::{Path, PathBuf};

use importer::Asset;
use sim::{Action, Change, ChildShape, Entity, Motion, Pose, Scene, Velocity};

use crate::mapped::Mapped;
use crate::rigid::{Piece, about_center};
use crate::rules::ruleset::Ruleset;
use crate::scene::{Placement, drop_entity, floor_entity, placement, rotate};
use crate::scene_shape::{material, optional_vector, pose, shape, vector};
use crate::text::error::MapError;
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::{self, Node};

/// Gives the asset and the mapping of a model file, or says why not.
pub type Resolver<'r> = dyn FnMut(&Path) -> Result<(Asset, Mapped), String> + 'r;

/// A scene and what a viewer needs to draw its models.
#[derive(Clone, Debug)]
pub struct SceneFile {
    pub scene: Scene,
    /// s, where the file asks for a step of its own.
    pub dt_s: Option<f64>,
    /// s, where the file says how long.
    pub duration_s: Option<f64>,
    pub models: Vec<SceneModel>,
    /// By entity: its own origin in the body's frame.
    origins: Vec<[f64; 3]>,
}

/// An entity that stands for a model file.
#[derive(Clone, Debug)]
pub struct SceneModel {
    /// Index into the scene's entities.
    pub entity: usize,
    pub path: PathBuf,
    pub placement: Placement,
}

const TOP: [&str; 7] = ["name", "gravity", "dt", "duration", "floor", "entities", "actions"];
const ENTITY: [&str; 9] =
    ["name", "model", "children", "position", "rotation", "velocity", "angular_velocity", "static", "mass"];
const SHAPE: [&str; 10] = [
    "shape",
    "size",
    "radius",
    "height",
    "points",
    "positions",
    "triangles",
    "heights",
    "spacing",
    "material",
];

/// Reads a scene file. `resolver` gets each model's path as resolved against the file's folder.
///
/// # Errors
/// The file cannot be read or holds a fault; every fault has its place, that of a model's included.
pub fn load(path: &Path, rules: &Ruleset, resolver: &mut Resolver<'_>) -> Result<SceneFile, MapError> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| MapError::Read { path: path.to_owned(), reason: error.to_string() })?;
    parse(&path.display().to_string(), &text, rules, resolver)
}

/// The same from text.
///
/// # Errors
/// As [`load`].
pub fn parse(
    file: &str,
    text: &str,
    rules: &Ruleset,
    resolver: &mut Resolver<'_>,
) -> Result<SceneFile, MapError> {
    let doc = yaml::parse(file, text)?;
    let mut reader = Reader::new(&doc);
    let folder = Path::new(file).parent().unwrap_or(Path::new("")).to_owned();
    let mut scene = SceneFile {
        scene: Scene::new("", Vec::new()),
        dt_s: None,
        duration_s: None,
        models: Vec::new(),
        origins: Vec::new(),
    };
    if let Some(top) = reader.fields(&doc.root, &TOP) {
        let fallback =
            Path::new(file).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        scene.scene.name = top.get("name").and_then(|node| reader.text(node)).map_or(fallback, str::to_owned);
        if let Some(gravity) = top.get("gravity").and_then(|node| vector(&mut reader, node)) {
            scene.scene.gravity = gravity;
        }
        scene.dt_s = top.get("dt").and_then(|node| reader.bounded(node, Dimension::Time, 1e-6, 1.0));
        scene.duration_s =
            top.get("duration").and_then(|node| reader.bounded(node, Dimension::Time, 0.0, 1e6));
        if let Some(node) = top.get("floor") {
            floor(&mut reader, node, rules, &mut scene.scene);
            scene.origins.resize(scene.scene.entities.len(), [0.0; 3]);
        }
        let mut builder = Builder { rules, folder: &folder, resolver, scene: &mut scene };
        for item in top.get("entities").and_then(|node| reader.list(node)).unwrap_or_default() {
            builder.entity(&mut reader, item);
        }
        for item in top.get("actions").and_then(|node| reader.list(node)).unwrap_or_default() {
            let made = action(&mut reader, item, &scene);
            scene.scene.actions.extend(made);
        }
        rules.lay_pairs(&mut scene.scene);
    }
    reader.finish(scene)
}

fn floor<'d>(reader: &mut Reader<'d>, node: &'d Node, rules: &Ruleset, scene: &mut Scene) {
    if node.text() == "false" {
        return;
    }
    if let Some(material) = material(reader, node, rules) {
        scene.entities.push(floor_entity(material.surface));
    }
}

struct Builder<'a, 'r> {
    rules: &'a Ruleset,
    folder: &'a Path,
    resolver: &'a mut Resolver<'r>,
    scene: &'a mut SceneFile,
}

impl Builder<'_, '_> {
    fn entity<'d>(&mut self, reader: &mut Reader<'d>, item: &'d Node) {
        let known: Vec<&str> = ENTITY.iter().chain(&SHAPE).copied().collect();
        let Some(fields) = reader.fields(item, &known) else { return };
        let index = self.scene.scene.entities.len();
        let name = fields
            .get("name")
            .and_then(|node| reader.text(node))
            .map_or_else(|| format!("entity {index}"), str::to_owned);
        if self.scene.scene.entities.iter().any(|entity| entity.name == name) {
            reader.fault(
                item,
                "CAT006",
                format!("a second entity named `{name}`"),
                "here",
                "rename it".to_owned(),
            );
            return;
        }
        let Some(pose) = pose(reader, fields) else { return };
        let velocity = Velocity {
            linear: optional_vector(reader, fields, "velocity"),
            angular: optional_vector(reader, fields, "angular_velocity"),
        };
        let fixed = fields.get("static").is_some_and(|node| reader.boolean(node) == Some(true));
        let mass_kg = match fields.get("mass") {
            Some(node) => match reader.bounded(node, Dimension::Mass, 1e-9, 1e12) {
                Some(mass) => Some(mass),
                None => return,
            },
            None => None,
        };
        let made = if let Some(model) = fields.get("model") {
            self.model(reader, model, &name, mass_kg)
        } else {
            self.shapes(reader, item, fields, &name, fixed, mass_kg)
        };
        let Some((mut entity, origin)) = made else { return };
        if fixed {
            entity.motion = Motion::Static;
        }
        // `position` is that of the body's own origin; the solver wants the centre of mass.
        let offset = rotate(pose.rotation, origin.map(|coordinate| -coordinate));
        entity.pose = Pose {
            position: std::array::from_fn(|axis| pose.position[axis] + offset[axis]),
            rotation: pose.rotation,
        };
        entity.velocity = velocity;
        self.scene.scene.entities.push(entity);
        self.scene.origins.push(origin);
    }

    /// The body of a model file and where its file's origin lies in the body's frame.
    fn model<'d>(
        &mut self,
        reader: &mut Reader<'d>,
        node: &'d Node,
        name: &str,
        mass_kg: Option<f64>,
    ) -> Option<(Entity, [f64; 3])> {
        let path = self.folder.join(reader.text(node)?);
        let (asset, mapped) = match (self.resolver)(&path) {
            Ok(found) => found,
            Err(reason) => {
                reader.fault(node, "CAT010", reason, "this model", "check the path and the file".to_owned());
                return None;
            }
        };
        let place = placement(name, &asset, &mapped)
            .and_then(|place| Ok((place, drop_entity(name, &asset, &mapped, self.rules)?)));
        let (placement, mut entity) = match place {
            Ok(found) => found,
            Err(error) => {
                reader.fault(node, "CAT010", error.reason(), "this model", error.way_out());
                return None;
            }
        };
        if let (Some(mass_kg), Motion::Dynamic(mass)) = (mass_kg, &mut entity.motion) {
            let factor = mass_kg / mass.mass_kg;
            mass.inertia_kg_m2 = mass.inertia_kg_m2.map(|entry| entry * factor);
            mass.mass_kg = mass_kg;
        }
        let entity_index = self.scene.scene.entities.len();
        self.scene.models.push(SceneModel { entity: entity_index, path, placement });
        Some((entity, placement.body_from_file.position))
    }

    /// A body of one shape or several, and where its own origin lies in the body's frame.
    fn shapes<'d>(
        &mut self,
        reader: &mut Reader<'d>,
        item: &'d Node,
        fields: Fields<'d>,
        name: &str,
        fixed: bool,
        mass_kg: Option<f64>,
    ) -> Option<(Entity, [f64; 3])> {
        let mut pieces = Vec::new();
        if let Some(children) = fields.get("children") {
            for child in reader.list(children)? {
                let known: Vec<&str> =
                    SHAPE.iter().copied().chain(["position", "rotation", "mass"]).collect();
                let fields = reader.fields(child, &known)?;
                let pose = pose(reader, fields)?;
                let part = u32::try_from(pieces.len()).unwrap_or(u32::MAX);
                pieces.push(self.piece(reader, child, fields, pose, part)?);
            }
        } else {
            pieces.push(self.piece(reader, item, fields, Pose::IDENTITY, 0)?);
        }
        if fixed {
            let shapes = pieces.into_iter().map(|piece| piece.child).collect();
            let still = Velocity::default();
            let entity = Entity {
                name: name.to_owned(),
                motion: Motion::Static,
                pose: Pose::IDENTITY,
                velocity: still,
                shapes,
            };
            return Some((entity, [0.0; 3]));
        }
        let Some((entity, origin)) = about_center(name, pieces, mass_kg) else {
            let help = "give it a volume, or set `static: true`".to_owned();
            reader.fault(item, "CAT008", format!("`{name}` has no mass and is not static"), "here", help);
            return None;
        };
        Some((entity, origin))
    }

    fn piece<'d>(
        &self,
        reader: &mut Reader<'d>,
        item: &'d Node,
        fields: Fields<'d>,
        pose: Pose,
        part: u32,
    ) -> Option<Piece> {
        let Some(kind) = fields.get("shape") else {
            let help = "add `shape: box`, `model: FILE` or `children: [...]`".to_owned();
            reader.fault(item, "CAT007", "neither shape nor model nor children".to_owned(), "here", help);
            return None;
        };
        let shape = shape(reader, kind, item, fields)?;
        let material = match fields.get("material") {
            Some(node) => material(reader, node, self.rules)?,
            None => {
                let help =
                    "add `material: oak` or `material: { friction: 0.5, restitution: 0.1 }`".to_owned();
                reader.fault(item, "CAT007", "no material".to_owned(), "here", help);
                return None;
            }
        };
        let mass_kg = match fields.get("mass") {
            Some(node) => Some(reader.bounded(node, Dimension::Mass, 1e-9, 1e12)?),
            None => None,
        };
        let child = ChildShape { shape, body_from_shape: pose, surface: material.surface, part };
        Some(Piece { child, density: material.density, mass_kg })
    }
}

fn action<'d>(reader: &mut Reader<'d>, item: &'d Node, scene: &SceneFile) -> Option<Action> {
    let fields = reader.fields(item, &["at", "entity", "set_pose", "set_velocity"])?;
    let (Some(at), Some(entity)) = (fields.get("at"), fields.get("entity")) else {
        reader.fault(item, "CAT007", "an action needs `at` and `entity`".to_owned(), "here", String::new());
        return None;
    };
    let time_s = reader.bounded(at, Dimension::Time, 0.0, 1e9)?;
    let Some(index) = scene.scene.entities.iter().position(|known| known.name == entity.text()) else {
        reader.unknown(entity, "entity", scene.scene.entities.iter().map(|known| known.name.as_str()));
        return None;
    };
    let change = if let Some(node) = fields.get("set_pose") {
        let fields = reader.fields(node, &["position", "rotation"])?;
        let wanted = pose(reader, fields)?;
        // As in `entities`: the position of the body's own origin.
        let origin = scene.origins.get(index).copied().unwrap_or_default();
        let offset = rotate(wanted.rotation, origin.map(|coordinate| -coordinate));
        let position = std::array::from_fn(|axis| wanted.position[axis] + offset[axis]);
        Change::SetPose(Pose { position, rotation: wanted.rotation })
    } else if let Some(node) = fields.get("set_velocity") {
        let fields = reader.fields(node, &["linear", "angular"])?;
        let linear = optional_vector(reader, fields, "linear");
        Change::SetVelocity(Velocity { linear, angular: optional_vector(reader, fields, "angular") })
    } else {
        reader.fault(item, "CAT007", "an action sets a pose or a velocity".to_owned(), "here", String::new());
        return None;
    };
    Some(Action { time_s, entity: index, change })
}
