//! glTF 2.0: the node graph walked, every node's mesh put in its place.
//!
//! Parsed by the `gltf` crate's JSON layer without its validation, which refuses files for what does not
//! concern geometry; what does is checked where it is used.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use gltf::json::{Root, Value, deserialize};

use crate::asset::{Format, Geometry, Mesh, SourcePart};
use crate::{ImportError, Options};

use super::accessor::Accessors;
use super::buffers::Buffers;
use super::notes::Notes;
use super::physics::{MeshCollider, Physics};
use super::primitive::{self, Piece};
use super::reading::{Reading, check_counts};
use super::transform::{self, Transform};
use super::{extension, glb, instancing, meshopt, skin};

/// A graph may come to a node along many paths; more arrivals than this are taken for a bomb.
const MOST_VISITS: u64 = 1_000_000;

pub(super) fn read(
    bytes: &[u8],
    format: Format,
    folder: &Path,
    options: &Options,
    reading: &mut Reading,
) -> Result<(), ImportError> {
    let (json, chunk) = match format {
        Format::Glb => glb::split(bytes, &mut reading.notes)?,
        _ => (bytes, None),
    };
    let root = parse(json)?;
    let locals = transform::of_nodes(json);
    let globals = skin::globals(&root, &locals);
    extension::check(&root.extensions_required, &mut reading.notes)?;
    add_names(&root, reading);
    note_broken_references(&root, &mut reading.notes);
    let buffers = Buffers::load(&root, chunk, folder, options)?;
    let unpacked = meshopt::unpack(&root, &buffers, options, &mut reading.notes);
    let accessors = Accessors { root: &root, buffers: &buffers, unpacked: &unpacked, options };
    let mut walk = Walk {
        root: &root,
        locals: &locals,
        globals: &globals,
        accessors: &accessors,
        options,
        reading,
        physics: Physics::default(),
        vertices: 0,
        triangles: 0,
    };
    walk.scene()?;
    walk.physics()?;
    if reading.parts.is_empty() && reading.clouds.is_empty() {
        let (nodes, meshes) = (root.nodes.len(), root.meshes.len());
        let message = format!("{nodes} nodes and {meshes} meshes, and no node of the scene has a surface");
        reading.notes.add("empty", "", message);
    }
    reading.referred = buffers.files;
    Ok(())
}

fn parse(json: &[u8]) -> Result<Root, ImportError> {
    let json = json.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(json);
    let old = |version: &str| {
        ImportError::unsupported(
            "asset.version",
            format!("glTF {version}, expected 2.0"),
            "Convert it to glTF 2.0, with gltf-pipeline or Blender",
        )
    };
    let root: Root = deserialize::from_slice(json).or_else(|fault| {
        let value: Option<Value> = serde_json::from_slice(json).ok();
        if let Some(root) = value.clone().and_then(with_empty_scenes) {
            return Ok(root);
        }
        // glTF 1 writes its version as a number, or its collections as objects.
        let version =
            value.as_ref().and_then(|value| value.get("asset")).and_then(|asset| asset.get("version"));
        Err(match version.map(|version| version.to_string().replace('"', "")) {
            Some(version) if version.starts_with('1') => old(&version),
            _ => {
                let place = format!("JSON line {} column {}", fault.line(), fault.column());
                let text = fault.to_string();
                let reason = text.split(" at line ").next().unwrap_or(&text);
                ImportError::malformed(place, reason)
            }
        })
    })?;
    if !root.asset.version.starts_with("2.") && root.asset.version != "2" {
        return Err(old(&root.asset.version));
    }
    Ok(root)
}

/// A scene may be empty by the specification; the `gltf` crate wants its `nodes` all the same.
fn with_empty_scenes(mut root: Value) -> Option<Root> {
    for scene in root.get_mut("scenes")?.as_array_mut()? {
        scene.as_object_mut()?.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    deserialize::from_value(root).ok()
}

fn add_names(root: &Root, reading: &mut Reading) {
    let nodes = root.nodes.iter().filter_map(|node| node.name.as_deref());
    let meshes = root.meshes.iter().filter_map(|mesh| mesh.name.as_deref());
    let materials = root.materials.iter().filter_map(|material| material.name.as_deref());
    let mut said = Vec::new();
    let extras = [&root.asset.extras].into_iter().chain(root.nodes.iter().map(|node| &node.extras));
    for extras in extras.flatten() {
        if let Ok(value) = serde_json::from_str(extras.get()) {
            words(&value, &mut said);
        }
    }
    let said = said.iter().map(String::as_str);
    said.chain(nodes).chain(meshes).chain(materials).for_each(|name| reading.names.add(name));
}

/// Keys of `extras` under which exporters and databases say what a thing is; others hold authors, licences and
/// addresses.
const TELLING: [&str; 11] = [
    "title",
    "name",
    "tag",
    "tags",
    "keywords",
    "category",
    "categories",
    "label",
    "labels",
    "class",
    "type",
];

/// The strings of an `extras` value that say what the thing is.
fn words(value: &Value, said: &mut Vec<String>) {
    const LONGEST: usize = 80;
    match value {
        Value::String(text) if text.len() <= LONGEST && !text.contains("://") => said.push(text.clone()),
        Value::Array(items) => {
            items.iter().filter(|item| !item.is_object()).for_each(|item| words(item, said))
        }
        Value::Object(map) => {
            let telling = map.iter().filter(|(key, _)| TELLING.contains(&key.to_ascii_lowercase().as_str()));
            telling.for_each(|(_, value)| words(value, said));
        }
        _ => {}
    }
}

/// References out of range, also of what no scene uses: they explain a file that comes to nothing.
fn note_broken_references(root: &Root, notes: &mut Notes) {
    let mut check = |place: String, what: &str, index: usize, count: usize| {
        if index >= count {
            notes.add("broken-reference", place, format!("refers to {what}[{index}], there are {count}"));
        }
    };
    for (at, view) in root.buffer_views.iter().enumerate() {
        check(format!("bufferViews[{at}].buffer"), "buffers", view.buffer.value(), root.buffers.len());
    }
    for (at, accessor) in root.accessors.iter().enumerate() {
        let views = root.buffer_views.len();
        if let Some(view) = accessor.buffer_view {
            check(format!("accessors[{at}].bufferView"), "bufferViews", view.value(), views);
        }
    }
    for (mesh, primitive, place) in primitives(root) {
        let primitive = &root.meshes[mesh].primitives[primitive];
        let accessors = root.accessors.len();
        if let Some(indices) = primitive.indices {
            check(format!("{place}.indices"), "accessors", indices.value(), accessors);
        }
        for accessor in primitive.attributes.values() {
            check(format!("{place}.attributes"), "accessors", accessor.value(), accessors);
        }
    }
}

fn primitives(root: &Root) -> impl Iterator<Item = (usize, usize, String)> + '_ {
    root.meshes.iter().enumerate().flat_map(|(mesh, of)| {
        (0..of.primitives.len()).map(move |at| (mesh, at, format!("meshes[{mesh}].primitives[{at}]")))
    })
}

struct Walk<'a> {
    root: &'a Root,
    /// Of every node.
    locals: &'a [Transform],
    globals: &'a [Transform],
    accessors: &'a Accessors<'a>,
    options: &'a Options,
    reading: &'a mut Reading,
    physics: Physics,
    vertices: u64,
    triangles: u64,
}

enum Visit {
    Enter { node: usize, outer: Transform },
    Leave { node: usize },
}

impl Walk<'_> {
    /// The default scene, else the first, else every node that is nobody's child.
    fn scene(&mut self) -> Result<(), ImportError> {
        let mut cache = BTreeMap::new();
        let mut on_path = vec![false; self.root.nodes.len()];
        let mut stack: Vec<Visit> = self
            .roots()?
            .into_iter()
            .rev()
            .map(|node| Visit::Enter { node, outer: Transform::IDENTITY })
            .collect();
        let mut visits = 0;
        while let Some(visit) = stack.pop() {
            let (index, outer) = match visit {
                Visit::Enter { node, outer } => (node, outer),
                Visit::Leave { node } => {
                    on_path[node] = false;
                    continue;
                }
            };
            visits += 1;
            if visits > MOST_VISITS {
                let reason = format!("the node graph comes to more than {MOST_VISITS} nodes once followed");
                return Err(ImportError::too_large("nodes", reason));
            }
            let Some(node) = self.root.nodes.get(index) else {
                let reason = format!("refers to nodes[{index}], there are {}", self.root.nodes.len());
                return Err(ImportError::malformed("nodes", reason));
            };
            if std::mem::replace(&mut on_path[index], true) {
                let reason = "the node is its own descendant: the graph has a cycle";
                return Err(ImportError::malformed(format!("nodes[{index}]"), reason));
            }
            stack.push(Visit::Leave { node: index });
            let world = self.locals.get(index).map_or(outer, |local| outer.after(local));
            self.physics.visit(self.root, index, &world, self.reading);
            if let Some(mesh) = node.mesh {
                let instances = instancing::frames(node, index, self.accessors)?;
                let frames = instances.map(|frames| frames.iter().map(|frame| world.after(frame)).collect());
                self.place_mesh(index, mesh.value(), &frames.unwrap_or_else(|| vec![world]), &mut cache)?;
            }
            let children = node.children.iter().flatten().rev();
            stack.extend(children.map(|child| Visit::Enter { node: child.value(), outer: world }));
        }
        Ok(())
    }

    fn roots(&mut self) -> Result<Vec<usize>, ImportError> {
        let root = self.root;
        let scene = match root.scene {
            Some(scene) => Some(root.scenes.get(scene.value()).ok_or_else(|| {
                let reason = format!("refers to scenes[{}], there are {}", scene.value(), root.scenes.len());
                ImportError::malformed("scene", reason)
            })?),
            None => root.scenes.first(),
        };
        if root.scenes.len() > 1 {
            let index = root.scene.map_or(0, |scene| scene.value());
            let message = format!("{} scenes: the default one, scenes[{index}], is read", root.scenes.len());
            self.reading.notes.add("scenes-ignored", "scenes", message);
        }
        if let Some(scene) = scene {
            return Ok(scene.nodes.iter().map(|node| node.value()).collect());
        }
        let mut is_child = vec![false; root.nodes.len()];
        for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
            if let Some(slot) = is_child.get_mut(child.value()) {
                *slot = true;
            }
        }
        let roots: Vec<usize> = (0..root.nodes.len()).filter(|&node| !is_child[node]).collect();
        let message = if roots.is_empty() {
            format!("no scene and no node to use the {} meshes", root.meshes.len())
        } else {
            "no scene: every node that is nobody's child is read".to_owned()
        };
        self.reading.notes.add("no-scene", "scenes", message);
        Ok(roots)
    }

    /// What the file states of physics; its colliders' shapes where it has no surface.
    fn physics(&mut self) -> Result<(), ImportError> {
        self.physics.state(self.root, self.reading);
        if !self.reading.parts.is_empty() || !self.reading.clouds.is_empty() {
            return Ok(());
        }
        let mut cache = BTreeMap::new();
        for (collider, world) in self.physics.stand_in(self.reading, self.options)? {
            let (node, mesh) = match collider {
                MeshCollider::Mesh(mesh) => (None, Some(mesh)),
                MeshCollider::Node(node) => {
                    let mesh = self.root.nodes.get(node).and_then(|node| node.mesh);
                    (Some(node), mesh.map(|mesh| mesh.value()))
                }
            };
            if let Some(mesh) = mesh {
                self.place_mesh(node.unwrap_or(usize::MAX), mesh, &[world], &mut cache)?;
                self.reading.geometry = Geometry::Shapes;
            }
        }
        Ok(())
    }

    /// One part of a mesh, once for every frame it stands in.
    fn place_mesh(
        &mut self,
        node: usize,
        index: usize,
        worlds: &[Transform],
        cache: &mut BTreeMap<usize, Vec<(Piece, Option<String>)>>,
    ) -> Result<(), ImportError> {
        let Some(mesh) = self.root.meshes.get(index) else {
            let reason = format!("refers to meshes[{index}], there are {}", self.root.meshes.len());
            return Err(ImportError::malformed(format!("nodes[{node}].mesh"), reason));
        };
        if let Entry::Vacant(slot) = cache.entry(index) {
            slot.insert(self.pieces(index)?);
        }
        let pieces = cache.get(&index).map(Vec::as_slice).unwrap_or_default();
        let joints = self.joints(node);
        let weights = weights_of(self.root, node, index);
        let mut seams = skin::Seams::default();
        let mut merged = Mesh::default();
        let mut materials: Vec<String> = Vec::new();
        for (piece, material) in pieces {
            let morphed = piece.morphed(weights);
            let piece = morphed.as_ref().unwrap_or(piece);
            let times = worlds.len() as u64;
            self.vertices = self.vertices.saturating_add(times.saturating_mul(piece.positions.len() as u64));
            self.triangles =
                self.triangles.saturating_add(times.saturating_mul(piece.triangles.len() as u64));
            check_counts(self.vertices, self.triangles, &format!("nodes[{node}].mesh"), self.options)?;
            let posed =
                joints.as_ref().map(|joints| skin::posed(piece, joints.as_ref().map_err(Clone::clone)?));
            match posed {
                Some(Ok((mut positions, mirrored))) => {
                    skin::close_seams(&piece.positions, &mut positions, &mut seams);
                    append(&mut merged, &positions, &piece.triangles, &Transform::IDENTITY, mirrored);
                }
                posed => {
                    if let Some(Err(fault)) = posed {
                        let message =
                            format!("{fault}: the mesh is read where its node stands, without its skin");
                        self.reading.notes.add("skin-ignored", format!("nodes[{node}].skin"), message);
                    }
                    for world in worlds {
                        let mirrored = world.determinant() < 0.0;
                        append(&mut merged, &piece.positions, &piece.triangles, world, mirrored);
                    }
                }
            }
            if let Some(material) = material
                && !materials.contains(material)
            {
                materials.push(material.clone());
            }
        }
        if merged.triangles.is_empty() {
            return Ok(());
        }
        let named = self.root.nodes.get(node).and_then(|node| node.name.as_ref()).or(mesh.name.as_ref());
        let name = named.filter(|name| !name.trim().is_empty()).cloned();
        let name = name.unwrap_or_else(|| format!("part {}", self.reading.parts.len()));
        self.reading.parts.push(SourcePart { materials, ..SourcePart::new(name, merged) });
        Ok(())
    }

    /// Where a node's skin puts its joints; `None` for a node without one.
    fn joints(&self, node: usize) -> Option<Result<Vec<Transform>, String>> {
        let skin = self.root.nodes.get(node)?.skin?;
        let joints = skin::joints(skin.value(), self.accessors, self.globals);
        Some(joints.map_err(|error| format!("{}: {}", error.place(), error.reason())))
    }

    /// Whether the mesh, or a node that uses it, weighs a target at all.
    fn is_morphed(&self, index: usize) -> bool {
        let any = |weights: Option<&Vec<f32>>| {
            weights.is_some_and(|weights| weights.iter().any(|&weight| weight != 0.0))
        };
        let uses = self.root.nodes.iter().filter(|node| node.mesh.is_some_and(|mesh| mesh.value() == index));
        any(self.root.meshes[index].weights.as_ref())
            || uses.into_iter().any(|node| any(node.weights.as_ref()))
    }

    fn pieces(&mut self, index: usize) -> Result<Vec<(Piece, Option<String>)>, ImportError> {
        let mut pieces = Vec::new();
        let with_targets = self.is_morphed(index);
        for (at, primitive) in self.root.meshes[index].primitives.iter().enumerate() {
            let place = format!("meshes[{index}].primitives[{at}]");
            let read = primitive::read(primitive, self.accessors, &place, with_targets, self.reading)?;
            if let Some(piece) = read {
                let material =
                    primitive.material.and_then(|material| self.root.materials.get(material.value()));
                pieces.push((piece, material.and_then(|material| material.name.clone())));
            }
        }
        Ok(pieces)
    }
}

/// Of the morph targets: the node's own, else the mesh's.
fn weights_of(root: &Root, node: usize, mesh: usize) -> &[f32] {
    let own = root.nodes.get(node).and_then(|node| node.weights.as_deref());
    own.or_else(|| root.meshes.get(mesh)?.weights.as_deref()).unwrap_or_default()
}

/// Puts a piece in its place; a mirrored one gets its winding back.
fn append(
    mesh: &mut Mesh,
    positions: &[[f64; 3]],
    triangles: &[[u32; 3]],
    world: &Transform,
    mirrored: bool,
) {
    // Held within `u32` by `check_counts`; a corner that is out of range stays so.
    #[allow(clippy::cast_possible_truncation)]
    let base = mesh.positions.len() as u32;
    let count = positions.len();
    if *world == Transform::IDENTITY {
        mesh.positions.extend_from_slice(positions);
    } else {
        mesh.positions.extend(positions.iter().map(|&position| world.apply(position)));
    }
    mesh.triangles.extend(triangles.iter().map(|&corners| {
        let [a, b, c] =
            corners.map(|corner| if (corner as usize) < count { corner + base } else { u32::MAX });
        if mirrored { [a, c, b] } else { [a, b, c] }
    }));
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn extras_give_the_words_that_say_what_a_thing_is() {
        let mut said = Vec::new();
        let text = r#"{ "title": "Oak Stool", "author": "A. Person", "license": "CC-BY", "tags": ["seat", 3, "wood"],
            "source": "https://example.org", "Category": { "name": "Furniture", "id": 7 } }"#;
        words(&serde_json::from_str(text).unwrap(), &mut said);
        assert_eq!(said, ["Oak Stool", "seat", "wood", "Furniture"]);
    }
}
