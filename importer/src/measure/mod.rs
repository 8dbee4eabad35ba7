//! What is this shape: is it closed, how big, how heavy per density?

use serde::{Deserialize, Serialize};

/// Mass properties at density 1: multiply by a density for kilograms (in file units).
///
/// The inertia tensor is about the centroid, in the file's axes: `[xx, yy, zz, xy, xz, yz]`, where the
/// off-diagonals are the tensor's entries (minus the products of inertia).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MassProperties {
    /// Volume (solid) or area (shell), in file units cubed or squared.
    pub measure: f64,
    pub centroid: [f64; 3],
    pub inertia: [f64; 6],
}

/// How a volume was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// Exact integrals over a closed, consistently wound surface.
    Closed,
    /// Exact integrals after safe repair: inside-out bodies turned, winding made consistent.
    Oriented,
    /// Convex hull: an upper bound, for surfaces that enclose nothing by themselves.
    Hull,
}

/// Facts of a welded mesh, in file units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// As read, before degenerate ones are dropped.
    pub triangles: u64,
    pub vertices: u64,
    /// After merging equal positions.
    pub vertices_welded: u64,
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// Every edge of the non-degenerate triangles is shared by exactly two.
    pub closed: bool,
    /// Closed, and each edge is run once in each direction.
    pub wound_consistently: bool,
    /// Connected components by shared welded vertices.
    pub bodies: u64,
    pub inside_out_bodies: u64,
    pub boundary_edges: u64,
    pub nonmanifold_edges: u64,
    pub degenerate_triangles: u64,
    /// Volume as the surface encloses it, signed bodies summed; only where closed and consistent.
    pub signed_volume: Option<f64>,
    /// Best estimate of the solid, always positive, absent for flat or empty shapes.
    pub solid: Option<MassProperties>,
    pub solid_method: Option<VolumeMethod>,
    /// Of the surface as a thin sheet of unit area density.
    pub shell: MassProperties,
    /// Of the convex hull; absent for flat shapes.
    pub hull_volume: Option<f64>,
}

impl Measures {
    /// Extents along the file's axes.
    #[must_use]
    pub fn size(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Length of the bounding box's diagonal.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.size().iter().map(|side| side * side).sum::<f64>().sqrt()
    }
}
