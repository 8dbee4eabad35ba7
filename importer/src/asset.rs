//! What the importer says of one model file.
//!
//! Everything here is in *file units* and in the file's own axes: what a unit is worth in metres, and which
//! axis is up, is recorded in [`FileFrame`] as stated or assumed, and decided by the mapper, which knows what
//! the thing is.

use serde::{Deserialize, Serialize};

use crate::collider::Candidate;
use crate::measure::Measures;
use crate::primitive::Primitive;

/// blake3 of a file's bytes and of every file it refers to (buffers, not images), in order of reference.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct AssetKey(pub [u8; 32]);

/// File formats that are read, told apart by their bytes rather than by their extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    Glb,
    Gltf,
    Obj,
    Stl,
    Ply,
    Off,
    Xyz,
    Pcd,
    Vox,
    Binvox,
    /// Analytical shapes in YAML: `*.shapes.yaml`.
    Shapes,
}

/// What the file describes its form by. Whatever it is, a [`Source`] has it as triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Geometry {
    #[default]
    Mesh,
    /// Points on a surface, which is laid through them.
    Points,
    /// Filled cells, whose outer faces are the surface.
    Voxels,
    /// Boxes, spheres, cylinders and capsules, whose mass properties are exact whatever their triangles.
    Shapes,
}

/// An axis of the file's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// What the file says of its units and axes; `*_stated` is false where it was assumed.
///
/// glTF states metres and Y up. The others state nothing: one unit is taken for a metre, and for up Y (OBJ, PLY, OFF,
/// binvox) or Z (STL, the habit of CAD and printing; vox; xyz and pcd, the habit of surveying and robots).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FileFrame {
    pub metres_per_unit: f64,
    pub unit_stated: bool,
    pub up: Axis,
    pub up_stated: bool,
}

/// A triangle mesh in file units, node transforms applied, as read: not yet welded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<[f64; 3]>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A physical value that the file itself states, by an extension made for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stated {
    pub value: StatedValue,
    /// Where: `nodes[3].extensions.KHR_physics_rigid_bodies.motion.mass`.
    pub place: String,
}

/// SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StatedValue {
    MassKg(f64),
    FrictionStatic(f64),
    FrictionDynamic(f64),
    Restitution(f64),
    /// A body that never moves.
    Anchored(bool),
}

/// One mesh piece as it stands in the file: a glTF node's mesh, an OBJ object, or a whole STL or PLY.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcePart {
    /// The node's or object's name, else the mesh's, else `part N`.
    pub name: String,
    /// Names of the materials on it, in order of first use.
    pub materials: Vec<String>,
    pub mesh: Mesh,
    /// What the triangles stand for, where the file gives an analytical shape.
    pub primitive: Option<Primitive>,
    /// How far the triangles may lie from the surface they stand for, in file units: 0 but for points.
    pub deviation: f64,
    /// Faces of the file that are left out of the mesh, in triangles: a corner is not there or not finite.
    pub dropped: u64,
}

/// One model file, read: geometry and names, nothing measured. Not stored; read again where it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    pub key: AssetKey,
    pub format: Format,
    pub geometry: Geometry,
    pub frame: FileFrame,
    pub parts: Vec<SourcePart>,
    /// Node, mesh and material names of the whole file, each once, for the mapper.
    pub names: Vec<String>,
    pub stated: Vec<Stated>,
    pub notes: Vec<Note>,
}

/// Something worth knowing that did not stop the import.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// Stable, kebab-case: `unit-assumed`, `skin-ignored`, `extension-ignored`, `welded`, …
    pub code: String,
    /// The place inside the file: `nodes[3].mesh`, `line 12`, or empty for the whole.
    pub place: String,
    pub message: String,
}

/// A part as the catalogue keeps it: measured, with the colliders that could stand for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    pub name: String,
    pub materials: Vec<String>,
    pub measures: Measures,
    /// Cheap to dear. Empty where the asset has one part (its own ladder is the part's) or more than
    /// [`crate::Options::part_ladders`] of them.
    pub ladder: Vec<Candidate>,
}

/// One model file's content: what the catalogue stores and every later stage works on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asset {
    pub key: AssetKey,
    pub format: Format,
    #[serde(default)]
    pub geometry: Geometry,
    pub frame: FileFrame,
    /// Of all parts welded together.
    pub measures: Measures,
    /// Colliders for the whole, cheap to dear.
    pub ladder: Vec<Candidate>,
    pub parts: Vec<Part>,
    pub names: Vec<String>,
    /// Physics that the file carries.
    #[serde(default)]
    pub stated: Vec<Stated>,
    /// Of reading and of measuring: what was assumed, left out, repaired.
    pub notes: Vec<Note>,
}

impl SourcePart {
    /// A piece of triangles and nothing else.
    #[must_use]
    pub fn new(name: impl Into<String>, mesh: Mesh) -> Self {
        Self { name: name.into(), materials: Vec::new(), mesh, primitive: None, deviation: 0.0, dropped: 0 }
    }
}

impl Source {
    /// All parts as one mesh, vertices and triangles in part order.
    #[must_use]
    pub fn merged(&self) -> Mesh {
        let mut whole = Mesh::default();
        for part in &self.parts {
            whole.append(&part.mesh);
        }
        whole
    }
}

impl Mesh {
    /// Adds the other mesh's vertices and triangles after this one's.
    pub fn append(&mut self, other: &Mesh) {
        // Readers hold the sum of vertices below `u32::MAX`.
        #[allow(clippy::cast_possible_truncation)]
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| corner + base)));
    }
}

impl std::fmt::Display for AssetKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl std::fmt::Debug for AssetKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "AssetKey({self})")
    }
}

impl From<AssetKey> for String {
    fn from(key: AssetKey) -> Self {
        key.to_string()
    }
}

impl TryFrom<String> for AssetKey {
    type Error = String;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        let wrong = || format!("expected 64 hexadecimal digits, found {text:?}");
        if text.len() != 64 || !text.is_ascii() {
            return Err(wrong());
        }
        let mut key = [0; 32];
        for (byte, digits) in key.iter_mut().zip(text.as_bytes().chunks(2)) {
            let digits = std::str::from_utf8(digits).map_err(|_| wrong())?;
            *byte = u8::from_str_radix(digits, 16).map_err(|_| wrong())?;
        }
        Ok(Self(key))
    }
}
