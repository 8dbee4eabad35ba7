//! Physics that a glTF carries: shapes and bodies of `KHR_implicit_shapes` with `KHR_physics_rigid_bodies`, and of
//! `OMI_physics_shape` with `OMI_physics_body`.
//!
//! Only what the file says is taken: the extensions' own defaults (a friction of 0.6, a mass of 1 kg) are an engine's,
//! not the author's. A collider's shape stands for the model where the file has no surface of its own.

use gltf::json::{Root, Value, scene};

use crate::asset::{Stated, StatedValue};
use crate::{ImportError, Options, Primitive, PrimitiveForm};

use super::reading::Reading;
use super::shapes;
use super::transform::Transform;

const KHR: &str = "KHR_physics_rigid_bodies";
const OMI: &str = "OMI_physics_body";
const KHR_SHAPES: &str = "KHR_implicit_shapes";
const OMI_SHAPES: &str = "OMI_physics_shape";

/// What was met on the way through the scene.
#[derive(Default)]
pub(super) struct Physics {
    shapes: Vec<(Primitive, String)>,
    meshes: Vec<(MeshCollider, Transform)>,
    bodies: Vec<Body>,
    /// Places and values of the physics materials that colliders use.
    materials: Vec<(usize, &'static str)>,
}

/// A mesh that stands for a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeshCollider {
    Mesh(usize),
    /// The mesh of a node.
    Node(usize),
}

struct Body {
    place: String,
    /// As the file says; 0 stands for infinity.
    mass: Option<f64>,
    is_static: bool,
}

fn of_node<'a>(node: &'a scene::Node, name: &str) -> Option<&'a Value> {
    node.extensions.as_ref()?.others.get(name)
}

fn of_root<'a>(root: &'a Root, name: &str, list: &str) -> Option<&'a Vec<Value>> {
    root.extensions.as_ref()?.others.get(name)?.get(list)?.as_array()
}

fn index(value: Option<&Value>) -> Option<usize> {
    value?.as_u64().and_then(|index| usize::try_from(index).ok())
}

impl Physics {
    /// Takes a node of the scene in.
    pub fn visit(&mut self, root: &Root, at: usize, world: &Transform, reading: &mut Reading) {
        let Some(node) = root.nodes.get(at) else { return };
        for (name, shapes) in [(KHR, KHR_SHAPES), (OMI, OMI_SHAPES)] {
            let Some(physics) = of_node(node, name) else { continue };
            let place = format!("nodes[{at}].extensions.{name}");
            if let Some(motion) = physics.get("motion") {
                self.bodies.push(body(motion, &place));
            }
            let Some(collider) = physics.get("collider") else { continue };
            if let Some(material) = index(collider.get("physicsMaterial"))
                && !self.materials.contains(&(material, name))
            {
                self.materials.push((material, name));
            }
            // KHR nests what OMI writes flat.
            let geometry = collider.get("geometry").unwrap_or(collider);
            if let Some(mesh) = index(geometry.get("mesh")) {
                self.meshes.push((MeshCollider::Mesh(mesh), *world));
            } else if let Some(node) = index(geometry.get("node")) {
                self.meshes.push((MeshCollider::Node(node), *world));
            } else if let Some(shape) = index(geometry.get("shape")) {
                let named = node.name.clone().unwrap_or_else(|| format!("shape {shape}"));
                let found = of_root(root, shapes, "shapes").and_then(|list| list.get(shape));
                match found.map(|found| form(found, name)) {
                    Some(Ok(Form::Primitive(form))) => {
                        self.shapes.push((Primitive { form, transform: world.0 }, named));
                    }
                    Some(Ok(Form::Mesh(mesh))) => self.meshes.push((MeshCollider::Mesh(mesh), *world)),
                    Some(Err(reason)) => reading.notes.add("shape-ignored", place, reason),
                    None => {
                        let reason = format!("refers to {shapes}.shapes[{shape}], which is not there");
                        reading.notes.add("shape-ignored", place, reason);
                    }
                }
            }
        }
    }

    /// Parts of the colliders' shapes, for a file without a surface; the meshes among them are the caller's to place.
    ///
    /// # Errors
    /// Too large over [`Options::max_triangles`].
    pub fn stand_in(
        &mut self,
        reading: &mut Reading,
        options: &Options,
    ) -> Result<Vec<(MeshCollider, Transform)>, ImportError> {
        for (primitive, name) in std::mem::take(&mut self.shapes) {
            reading.names.add(&name);
            shapes::add(primitive, name, None, reading, options)?;
        }
        Ok(std::mem::take(&mut self.meshes))
    }

    /// What the file states of the model as a whole.
    pub fn state(&self, root: &Root, reading: &mut Reading) {
        self.state_mass(reading);
        self.state_materials(root, reading);
    }

    fn state_mass(&self, reading: &mut Reading) {
        let Some(first) = self.bodies.first() else { return };
        let place = format!("{}.motion", first.place);
        if self.bodies.iter().all(|body| body.is_static || body.mass == Some(0.0)) {
            reading.stated.push(Stated { value: StatedValue::Anchored(true), place });
            return;
        }
        let moving: Vec<&Body> = self.bodies.iter().filter(|body| !body.is_static).collect();
        let masses: Option<Vec<f64>> =
            moving.iter().map(|body| body.mass.filter(|mass| *mass > 0.0)).collect();
        match masses {
            Some(masses) => {
                let value = StatedValue::MassKg(masses.iter().sum());
                reading.stated.push(Stated { value, place: format!("{}.motion.mass", moving[0].place) });
            }
            None if moving.iter().any(|body| body.mass.is_some()) => {
                let message =
                    format!("of {} bodies some state a mass and some do not: none is taken", moving.len());
                reading.notes.add("physics-mixed", place, message);
            }
            None => {}
        }
    }

    fn state_materials(&self, root: &Root, reading: &mut Reading) {
        let [(material, name)] = self.materials.as_slice() else {
            if self.materials.len() > 1 {
                let message = format!(
                    "{} physics materials: the model has one surface, none is taken",
                    self.materials.len()
                );
                reading.notes.add("physics-mixed", "extensions", message);
            }
            return;
        };
        let found = of_root(root, name, "physicsMaterials").and_then(|list| list.get(*material));
        let place = format!("extensions.{name}.physicsMaterials[{material}]");
        for key in ["staticFriction", "dynamicFriction", "restitution"] {
            let value = |number| match key {
                "staticFriction" => StatedValue::FrictionStatic(number),
                "dynamicFriction" => StatedValue::FrictionDynamic(number),
                _ => StatedValue::Restitution(number),
            };
            let number = found.and_then(|found| found.get(key)).and_then(Value::as_f64);
            if let Some(number) = number.filter(|number| (0.0..=1e3).contains(number)) {
                reading.stated.push(Stated { value: value(number), place: format!("{place}.{key}") });
            }
        }
    }
}

fn body(motion: &Value, place: &str) -> Body {
    let mass = motion.get("mass").and_then(Value::as_f64).filter(|mass| (0.0..1e15).contains(mass));
    let is_static = motion.get("type").and_then(Value::as_str) == Some("static");
    Body { place: place.to_owned(), mass, is_static }
}

enum Form {
    Primitive(PrimitiveForm),
    Mesh(usize),
}

/// A shape of either extension; their defaults differ.
fn form(shape: &Value, extension: &str) -> Result<Form, String> {
    let kind = shape.get("type").and_then(Value::as_str).unwrap_or_default();
    // The first drafts of OMI wrote the numbers beside the type.
    let inner = shape.get(kind).unwrap_or(shape);
    let number = |key: &str| inner.get(key).and_then(Value::as_f64);
    let is_khr = extension == KHR;
    let (radius, capsule, cylinder) = if is_khr { (0.25, 0.5, 0.5) } else { (0.5, 1.0, 2.0) };
    let radii = || {
        let both = number("radius");
        [number("radiusBottom"), number("radiusTop")].map(|one| one.or(both).unwrap_or(radius))
    };
    Ok(Form::Primitive(match kind {
        "box" => {
            let sides: Option<Vec<f64>> = match inner.get("size") {
                Some(size) => size.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()),
                None => Some(vec![1.0; 3]),
            };
            let size = sides
                .and_then(|sides| sides.try_into().ok())
                .ok_or("a box whose size is not three numbers")?;
            PrimitiveForm::Box { size }
        }
        "sphere" => PrimitiveForm::Sphere { radius: number("radius").unwrap_or(0.5) },
        "cylinder" => {
            let [bottom, top] = radii();
            PrimitiveForm::Cylinder { height: number("height").unwrap_or(cylinder), bottom, top }
        }
        "capsule" => {
            let [bottom, top] = radii();
            let height = number("height").unwrap_or(capsule);
            // With one radius the height was that of the whole.
            let height = number("radius").map_or(height, |radius| (height - 2.0 * radius).max(0.0));
            PrimitiveForm::Capsule { height, bottom, top }
        }
        "convex" | "trimesh" => {
            return index(inner.get("mesh"))
                .map(Form::Mesh)
                .ok_or_else(|| format!("a {kind} without a mesh"));
        }
        _ => return Err(format!("a shape of type {kind:?}, which encloses nothing")),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form_of(text: &str, extension: &str) -> Option<PrimitiveForm> {
        match form(&serde_json::from_str(text).unwrap(), extension) {
            Ok(Form::Primitive(form)) => Some(form),
            _ => None,
        }
    }

    #[test]
    fn each_extension_has_its_own_defaults() {
        let capsule = r#"{"type":"capsule","capsule":{}}"#;
        assert_eq!(
            form_of(capsule, KHR),
            Some(PrimitiveForm::Capsule { height: 0.5, bottom: 0.25, top: 0.25 })
        );
        assert_eq!(
            form_of(capsule, OMI),
            Some(PrimitiveForm::Capsule { height: 1.0, bottom: 0.5, top: 0.5 })
        );
        let old = r#"{"type":"capsule","radius":0.2,"height":1.0}"#;
        assert_eq!(form_of(old, OMI), Some(PrimitiveForm::Capsule { height: 0.6, bottom: 0.2, top: 0.2 }));
        assert_eq!(form_of(r#"{"type":"plane","plane":{}}"#, KHR), None);
        assert_eq!(form_of(r#"{"type":"box","box":{"size":[1,2]}}"#, KHR), None);
    }
}
