//! The mesh as the collider code works on it: welded, finite, scaled to a diagonal of one.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::asset::Mesh;

/// A point or direction in the prepared frame.
pub(super) type Vec3 = Vector3<f64>;

/// A welded mesh in its own frame: lower corner of its bounds at the origin, diagonal of one.
///
/// Every length in this module's private code is a share of the diagonal, so that one set of tolerances
/// serves a screw in millimetres and a mountain in metres.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub origin: Vec3,
    pub diagonal: f64,
    /// Extents along the file's axes.
    pub size: Vec3,
}

impl Prepared {
    /// `None` where no triangle with finite corners spans a length.
    pub fn from_mesh(mesh: &Mesh) -> Option<Self> {
        let corner = |index: u32| {
            let p = Vec3::from(*mesh.positions.get(index as usize)?);
            p.iter().all(|x| x.is_finite()).then_some(p)
        };
        let mut low = Vec3::repeat(f64::INFINITY);
        let mut high = Vec3::repeat(f64::NEG_INFINITY);
        let mut kept = Vec::with_capacity(mesh.triangles.len());
        for triangle in &mesh.triangles {
            let [Some(a), Some(b), Some(c)] = triangle.map(corner) else { continue };
            for p in [a, b, c] {
                low = low.inf(&p);
                high = high.sup(&p);
            }
            kept.push(*triangle);
        }
        let diagonal = (high - low).norm();
        // Squares of lengths must stay in range in both directions.
        if kept.is_empty() || !diagonal.is_finite() || diagonal < 1e-140 {
            return None;
        }

        // Lookup only: ids are given in order of first use, so the map's order never shows.
        let mut ids: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
        let mut positions: Vec<Vec3> = Vec::new();
        let mut triangles = Vec::with_capacity(kept.len());
        for triangle in kept {
            let welded = triangle.map(|index| {
                let p = (Vec3::from(mesh.positions[index as usize]) - low) / diagonal;
                // Adding zero turns -0 into 0.
                *ids.entry([p.x + 0.0, p.y + 0.0, p.z + 0.0].map(f64::to_bits)).or_insert_with(|| {
                    positions.push(p);
                    (positions.len() - 1) as u32
                })
            });
            triangles.push(welded);
        }
        let size = (high - low) / diagonal;
        Some(Self { positions, triangles, origin: low, diagonal, size })
    }

    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|index| self.positions[index as usize])
    }

    /// Back to the file's units.
    pub fn to_file(&self, p: Vec3) -> [f64; 3] {
        (p * self.diagonal + self.origin).into()
    }
}

/// Lower and upper corner of the points' bounds; equal corners at zero where there are none.
pub(super) fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let mut points = points.iter();
    let first = points.next().copied().unwrap_or_else(Vec3::zeros);
    points.fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Two unit vectors that complete `axis` (a unit vector) to a right-handed frame.
pub(super) fn tangents(axis: Vec3) -> (Vec3, Vec3) {
    let helper = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let u = axis.cross(&helper).normalize();
    (u, axis.cross(&u))
}
