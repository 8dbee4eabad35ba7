//! What is this shape: is it closed, how big, how heavy per density?

mod hull;
mod moments;
mod nesting;
mod repair;
mod shells;
mod solid;
mod topology;
mod weld;

use serde::{Deserialize, Serialize};

pub use weld::{Welded, weld};

use moments::{Area, Volume};
use topology::Topology;

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
    /// As the file has them: with those of no area and those left out for a corner that is absent or not finite.
    pub triangles: u64,
    pub vertices: u64,
    /// After merging equal positions; only those that triangles use.
    pub vertices_welded: u64,
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// Every edge of the non-degenerate triangles is shared by exactly two.
    pub closed: bool,
    /// Closed, and each edge is run once in each direction.
    pub wound_consistently: bool,
    /// Connected components by shared welded vertices.
    pub bodies: u64,
    /// Closed bodies of negative signed volume, taken about the middle of each: where a body is wound both ways,
    /// most of it is inside out.
    pub inside_out_bodies: u64,
    pub boundary_edges: u64,
    pub nonmanifold_edges: u64,
    /// Without area: two corners in one place, or all three on a line.
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

/// Measures a welded mesh. The same mesh gives the same bits.
#[must_use]
pub fn measure(welded: &Welded) -> Measures {
    let mesh = &welded.mesh;
    let topology = Topology::of(mesh);
    let (min, max) = bounds(&mesh.positions);
    let area = Area::of(mesh, &mesh.triangles, center(min, max));
    let wound_consistently = topology.closed && topology.wound_consistently;
    let mut inside_out_bodies = 0;
    let mut signed = Volume::default();
    for body in topology.bodies(mesh) {
        let volume = Volume::of(&mesh.positions, &body.triangles);
        inside_out_bodies += u64::from(body.closed && volume.total() < 0.0);
        signed = signed.plus(&volume);
    }
    let hull = hull::volume(&mesh.positions);
    let solid = solid::estimate(mesh, &topology, hull.as_ref());
    Measures {
        triangles: welded.triangles,
        vertices: welded.vertices,
        vertices_welded: mesh.positions.len() as u64,
        min,
        max,
        closed: topology.closed,
        wound_consistently,
        bodies: topology.body_count,
        inside_out_bodies,
        boundary_edges: topology.boundary_edges,
        nonmanifold_edges: topology.nonmanifold_edges,
        degenerate_triangles: welded.degenerate,
        signed_volume: wound_consistently.then(|| signed.total()),
        solid: solid.map(|(solid, _)| solid),
        solid_method: solid.map(|(_, method)| method),
        shell: area.properties(),
        hull_volume: hull.map(|hull| hull.total()),
    }
}

/// Bounds of the positions; zeros for none.
fn bounds(positions: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let Some(&first) = positions.first() else { return ([0.0; 3], [0.0; 3]) };
    positions.iter().fold((first, first), |(min, max), position| {
        (
            std::array::from_fn(|axis| min[axis].min(position[axis])),
            std::array::from_fn(|axis| max[axis].max(position[axis])),
        )
    })
}

fn norm_of(vector: [f64; 3]) -> f64 {
    moments::norm(vector)
}

fn center(min: [f64; 3], max: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| 0.5 * min[axis] + 0.5 * max[axis])
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
