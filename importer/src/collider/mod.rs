//! Which simple shapes could stand for this one, and how wrong is each?

mod atoms;
mod balance;
mod bvh;
mod choice;
mod compound;
mod concavity;
mod cut;
mod decompose;
mod error;
mod field;
mod finish;
mod fit_box;
mod fit_frustum;
mod fit_round;
mod fit_sphere;
mod group;
mod hull;
mod ladder;
mod needless;
mod outline;
mod piece;
mod planes;
mod prepared;
mod quickhull;
mod sampling;
mod seen;
mod sets;
mod sight;
mod simplify;
mod solid;
mod surface;
mod vhacd;
mod winding;

use serde::{Deserialize, Serialize};

pub use choice::{cheapest, verdict};
pub use error::REACH;
pub use ladder::ladder;
pub use solid::frustum_corners;
pub use surface::surface;
pub use vhacd::parry_decomposition;

/// A shape that physics can use, in file units and the file's axes. Rotations are quaternions `x, y, z, w`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    Box {
        center: [f64; 3],
        rotation: [f64; 4],
        half_extents: [f64; 3],
    },
    /// Along the local Y axis; `half_height` is that of the straight part.
    Capsule {
        center: [f64; 3],
        rotation: [f64; 4],
        half_height: f64,
        radius: f64,
    },
    /// Along the local Y axis.
    Cylinder {
        center: [f64; 3],
        rotation: [f64; 4],
        half_height: f64,
        radius: f64,
    },
    /// A cone cut off, along the local Y axis.
    Frustum {
        center: [f64; 3],
        rotation: [f64; 4],
        half_height: f64,
        radius_bottom: f64,
        radius_top: f64,
    },
    /// Convex hull of the points, every one of them a corner.
    Hull {
        points: Vec<[f64; 3]>,
    },
    /// For things that never move.
    TriangleMesh {
        positions: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
    },
}

/// How a candidate was made: the rungs of the ladder, cheap to dear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rung {
    Sphere,
    Box,
    Capsule,
    Cylinder,
    Frustum,
    Hull,
    /// A decomposition with primitives for hulls where they stand for its pieces.
    Primitives,
    Decomposition,
    TriangleMesh,
}

impl Rung {
    /// In a word or two, for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Box => "box",
            Self::Capsule => "capsule",
            Self::Cylinder => "cylinder",
            Self::Frustum => "frustum",
            Self::Hull => "hull",
            Self::Primitives => "primitives",
            Self::Decomposition => "decomposition",
            Self::TriangleMesh => "triangle mesh",
        }
    }
}

/// How far a candidate is from the mesh. Distances are shares of the mesh's diagonal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ColliderError {
    /// Largest distance from a sampled mesh point to the collider's surface (outside it) or, for points the
    /// collider swallows, to its outer surface: what a contact would get wrong.
    pub surface_max: f64,
    /// The same at the 95th percentile.
    pub surface_p95: f64,
    /// Largest distance by which the collider reaches beyond the mesh.
    pub growth_max: f64,
    /// The same at the 95th percentile of the collider's seen surface.
    #[serde(default)]
    pub growth_p95: f64,
    /// Share of sampled mesh points that lie outside the collider by more than 0.1 % of the diagonal.
    pub outside_share: f64,
    /// Collider volume over mesh volume, where both are known.
    pub volume_ratio: Option<f64>,
}

/// One rung of an asset's or a part's ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    pub rung: Rung,
    /// One shape, or the convex pieces of a decomposition.
    pub shapes: Vec<Shape>,
    pub error: ColliderError,
    pub vertices: u64,
    /// Relative cost in a step: 1 for a sphere.
    pub cost: f64,
    /// What went wrong on the way here and was worked around, if anything.
    pub fallback: Option<String>,
}
