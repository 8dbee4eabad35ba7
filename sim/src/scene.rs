//! The input of a simulation: what is there, where it starts, what it is made of, what happens to it when.
//!
//! Plain data in SI units, right-handed, Y up. Quaternions are `x, y, z, w`. Nothing here is checked:
//! [`crate::World::new`] is the one place that refuses.

use crate::height_field::HeightField;
use crate::material::MaterialPair;

/// Position and orientation: `world = rotation * body + position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// m
    pub position: [f64; 3],
    /// Unit quaternion `x, y, z, w`.
    pub rotation: [f64; 4],
}

/// Linear (m/s, of the centre of mass) and angular (rad/s) velocity in the world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    pub linear: [f64; 3],
    pub angular: [f64; 3],
}

/// Mass properties of a body about its centre of mass, in the body's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    pub mass_kg: f64,
    /// kg m², entries of the inertia tensor `[xx, yy, zz, xy, xz, yz]`.
    pub inertia_kg_m2: [f64; 6],
}

/// What a contact needs to know of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coulomb coefficient; a pair takes the geometric mean.
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1; a pair takes the larger.
    pub restitution: f64,
    /// What rolls on it is held by at most this, times its rolling radius, times the normal force. No unit; a pair
    /// takes the larger.
    pub rolling_resistance: f64,
    /// What it is made of, where [`Scene::pairs`] may know more of it: any number, one a material.
    pub material: Option<u32>,
}

/// A collision shape about its own origin, in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Sphere {
        radius: f64,
    },
    Box {
        half_extents: [f64; 3],
    },
    /// Along Y; `half_height` is that of the straight part.
    Capsule {
        half_height: f64,
        radius: f64,
    },
    /// Along Y.
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    /// Along Y: the base at `-half_height`, the tip at `+half_height`.
    Cone {
        half_height: f64,
        radius: f64,
    },
    /// Convex hull of the points.
    Hull {
        points: Vec<[f64; 3]>,
    },
    /// Everything below the plane through the origin with normal +Y. Static only.
    HalfSpace,
    /// Surface of triangles, counter-clockwise seen from outside. Static only.
    TriangleMesh {
        positions: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
    },
    /// Ground given by its heights. Static only.
    HeightField(HeightField),
}

/// One shape of a body, with its own material and the id of the part it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct ChildShape {
    pub shape: Shape,
    /// Of the shape in the body's frame (origin at the centre of mass).
    pub body_from_shape: Pose,
    pub surface: Surface,
    /// Index of the model's part, for reports.
    pub part: u32,
}

/// Whether and how a body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Never moves.
    Static,
    Dynamic(Mass),
}

/// One thing in the scene: a frame at its centre of mass and any number of shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Entity {
    pub name: String,
    pub motion: Motion,
    pub pose: Pose,
    pub velocity: Velocity,
    pub shapes: Vec<ChildShape>,
}

/// The change an action makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    SetPose(Pose),
    SetVelocity(Velocity),
}

/// A change at a time: it takes effect at the start of the first step that ends after `time_s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Action {
    pub time_s: f64,
    /// Index into [`Scene::entities`].
    pub entity: usize,
    pub change: Change,
}

/// A whole scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub name: String,
    /// m/s²
    pub gravity: [f64; 3],
    pub entities: Vec<Entity>,
    /// In any order.
    pub actions: Vec<Action>,
    /// Materials whose contact is known; they beat the rules of combination.
    pub pairs: Vec<MaterialPair>,
}

impl Pose {
    /// No translation, no rotation.
    pub const IDENTITY: Self = Self { position: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0] };

    /// A translation alone.
    #[must_use]
    pub const fn at(position: [f64; 3]) -> Self {
        Self { position, rotation: [0.0, 0.0, 0.0, 1.0] }
    }
}

impl Surface {
    /// A surface of no known material, on which things roll without loss.
    #[must_use]
    pub const fn new(friction: f64, restitution: f64) -> Self {
        Self { friction, restitution, rolling_resistance: 0.0, material: None }
    }
}

impl Scene {
    /// Standard gravity as the project uses it, along -Y, m/s².
    pub const GRAVITY: [f64; 3] = [0.0, -9.81, 0.0];

    /// Under standard gravity, without actions, every pair by the rules of combination.
    #[must_use]
    pub fn new(name: &str, entities: Vec<Entity>) -> Self {
        let (actions, pairs) = (Vec::new(), Vec::new());
        Self { name: name.to_owned(), gravity: Self::GRAVITY, entities, actions, pairs }
    }
}
