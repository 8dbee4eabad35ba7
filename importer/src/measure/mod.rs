//! What is this shape: is it closed, how big, how heavy per density?

mod cap;
mod filled;
mod hull;
mod moments;
mod nesting;
mod open;
mod repair;
mod resample;
mod rims;
mod shells;
mod solid;
mod topology;
mod weld;
mod winding;

use serde::{Deserialize, Serialize};

pub use weld::{Welded, weld};
pub(crate) use winding::{Element, WindingTree};

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

/// How a volume was come by, the surest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeMethod {
    /// Exact integrals over a closed, consistently wound surface.
    Closed,
    /// Exact integrals after safe repair: inside-out bodies turned, winding made consistent.
    Oriented,
    /// Closed form of an analytical shape.
    Exact,
    /// Exact integrals once the holes are filled; what their filling may be off by is sampled on the same surface.
    Capped,
    /// Points counted where the generalised winding number is over a half, for surfaces of pieces that do not join.
    Winding,
    /// Convex hull: an upper bound, for surfaces that enclose nothing by themselves.
    Hull,
}

/// What a connected piece of the surface is to the solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BodyRole {
    /// Encloses material.
    Outer,
    /// Closed, inside out and within another: encloses a hollow.
    Cavity,
    /// Closed and within another.
    Inner,
    /// Has holes, and encloses material once they are filled.
    Open,
    /// Encloses nothing.
    Sheet,
}

/// One connected piece of the surface, as far as volume goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyVolume {
    pub role: BodyRole,
    pub triangles: u64,
    /// Never negative; a cavity's is what it takes away.
    pub volume: f64,
    /// Absent for what encloses nothing.
    pub method: Option<VolumeMethod>,
    /// Half the width of the bound, as a share of `volume`.
    pub error: f64,
    /// How likely the truth lies within the bound.
    pub confidence: f64,
}

/// More bodies than this are not listed one by one.
pub const MOST_BODIES: usize = 64;

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
    /// Share of the solid's volume by which it may be off, either way; 0 is exact up to rounding.
    #[serde(default)]
    pub solid_error: Option<f64>,
    /// How likely the truth lies within `solid_error`.
    #[serde(default)]
    pub solid_confidence: Option<f64>,
    /// The solid piece by piece, the [`MOST_BODIES`] largest.
    #[serde(default)]
    pub body_volumes: Vec<BodyVolume>,
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
    let estimate = solid::estimate(mesh, &topology, hull.as_ref());
    let solid = estimate.solid;
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
        solid: solid.as_ref().map(|solid| solid.properties),
        solid_method: solid.as_ref().map(|solid| solid.method),
        solid_error: solid.as_ref().map(|solid| solid.error),
        solid_confidence: solid.as_ref().map(|solid| solid.confidence),
        body_volumes: estimate.bodies,
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

/// Of several bodies together, each about its own centroid, by the parallel axis theorem.
#[must_use]
pub fn sum(parts: &[MassProperties]) -> MassProperties {
    let measure: f64 = parts.iter().map(|part| part.measure).sum();
    let mut total = MassProperties { measure, centroid: [0.0; 3], inertia: [0.0; 6] };
    if measure <= 0.0 {
        return total;
    }
    for part in parts {
        for axis in 0..3 {
            total.centroid[axis] += part.measure / measure * part.centroid[axis];
        }
    }
    for part in parts {
        let [x, y, z] = moments::minus(part.centroid, total.centroid);
        let offset = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
        for (entry, (own, offset)) in total.inertia.iter_mut().zip(part.inertia.iter().zip(offset)) {
            *entry += own + part.measure * offset;
        }
    }
    total
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
