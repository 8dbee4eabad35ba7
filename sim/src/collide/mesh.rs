//! A surface of triangles that knows which normals each of its edges may have.
//!
//! A body that slides over a seam must not be kicked by it. At an edge only directions between the normals of its two
//! triangles are those of the surface (the edge's Voronoi region); any other contact normal found there is an artefact of
//! looking at one triangle alone, and the triangle's own normal takes its place.

use std::collections::BTreeMap;

use crate::collide::bvh::Bvh;
use crate::math::Vec3;
use crate::shape::Aabb;

/// A triangle with what its neighbours say of its edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) corners: [Vec3; 3],
    /// Unit, to the side from which the corners run counter-clockwise.
    pub(crate) normal: Vec3,
    /// In the plane, unit, out of the triangle through the edge after each corner.
    outward: [Vec3; 3],
    /// Tangent of the angle from the normal towards `outward` up to which a direction belongs to the edge: 0 or less
    /// where the surface is flat or a valley, infinite where it ends.
    leeway: [f64; 3],
}

/// Sine below which a direction counts as the normal itself.
const STRAIGHT: f64 = 1e-6;
/// Tangent added to every leeway: rounding of a direction is no kick.
const ROUNDING: f64 = 1e-9;

impl Triangle {
    /// Whether the surface has the outward unit direction `normal` somewhere on this triangle, its edges and corners
    /// included.
    pub(crate) fn owns(&self, normal: &Vec3) -> bool {
        let up = normal.dot(&self.normal);
        (0..3).all(|i| {
            let out = normal.dot(&self.outward[i]);
            out <= STRAIGHT
                || self.leeway[i] == f64::INFINITY
                || up > 0.0 && out <= (self.leeway[i] + ROUNDING) * up
        })
    }

    /// Distance of the point from the triangle's plane.
    pub(crate) fn height(&self, point: &Vec3) -> f64 {
        (point - self.corners[0]).dot(&self.normal)
    }
}

/// A mesh, or a height field as one, in its shape's frame.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub(crate) triangles: Vec<Triangle>,
    bvh: Bvh,
    bounds: Vec<Aabb>,
}

impl Mesh {
    /// # Errors
    /// What is wrong with the surface, in words.
    pub(crate) fn new(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<Self, String> {
        if let Some(index) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(format!("vertex {index} of the mesh is not finite"));
        }
        if let Some(index) = faces.iter().flatten().find(|index| **index as usize >= positions.len()) {
            return Err(format!("a triangle names vertex {index} of {}", positions.len()));
        }
        // Vertices at the same place are one, or every edge would be a border.
        let mut at: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        // Adding 0 makes -0 and 0 the same bits.
        let bits = |p: &[f64; 3]| p.map(|x| (x + 0.0).to_bits());
        let welded: Vec<u32> =
            (0..).zip(positions).map(|(i, position)| *at.entry(bits(position)).or_insert(i)).collect();
        let mut triangles = Vec::with_capacity(faces.len());
        let mut sides: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        let mut names = Vec::with_capacity(faces.len());
        for face in faces {
            let ids = face.map(|v| welded[v as usize]);
            let corners = ids.map(|v| Vec3::from(positions[v as usize]));
            let Some(triangle) = triangle(corners) else { continue };
            for i in 0..3 {
                sides.insert((ids[i], ids[(i + 1) % 3]), triangles.len());
            }
            triangles.push(triangle);
            names.push(ids);
        }
        if triangles.is_empty() {
            return Err("no triangle of the mesh has an area".to_owned());
        }
        for index in 0..triangles.len() {
            for i in 0..3 {
                let Some(&other) = sides.get(&(names[index][(i + 1) % 3], names[index][i])) else { continue };
                let neighbour = triangles[other].normal;
                let triangle = &mut triangles[index];
                let (out, up) = (neighbour.dot(&triangle.outward[i]), neighbour.dot(&triangle.normal));
                triangle.leeway[i] = if up > 0.0 {
                    out / up
                } else if out > 0.0 {
                    // Sharper than a right angle: the other triangle takes over from there.
                    f64::MAX
                } else {
                    0.0
                };
            }
        }
        let bounds: Vec<Aabb> = triangles
            .iter()
            .map(|Triangle { corners: [a, b, c], .. }| Aabb { min: a.inf(b).inf(c), max: a.sup(b).sup(c) })
            .collect();
        let mut bvh = Bvh::default();
        bvh.build(&bounds);
        Ok(Self { triangles, bvh, bounds })
    }

    /// Indices of the triangles whose bounds overlap `bounds`, ascending.
    pub(crate) fn near(&self, bounds: &Aabb, found: &mut Vec<u32>) {
        found.clear();
        self.bvh.query(bounds, |index| {
            if self.bounds[index as usize].overlaps(bounds) {
                found.push(index);
            }
        });
        found.sort_unstable();
    }
}

fn triangle(corners: [Vec3; 3]) -> Option<Triangle> {
    let [a, b, c] = corners;
    let area = (b - a).cross(&(c - a));
    let longest = [b - a, c - b, a - c].iter().map(Vec3::norm_squared).fold(0.0, f64::max);
    if area.norm() <= 1e-12 * longest {
        return None;
    }
    let normal = area.try_normalize(f64::MIN_POSITIVE)?;
    let outward = [b - a, c - b, a - c].map(|along| along.cross(&normal).normalize());
    Some(Triangle { corners, normal, outward, leeway: [f64::INFINITY; 3] })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles over the unit square, folded along the diagonal so that the far corner lies at `height`.
    fn fold(height: f64) -> Mesh {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, height, 1.0], [0.0, 0.0, 1.0]];
        Mesh::new(&positions, &[[0, 3, 1], [1, 3, 2]]).unwrap()
    }

    #[test]
    fn an_edge_owns_the_directions_between_its_triangles_normals_alone() {
        let towards = |tangent: f64| (Vec3::y() + Vec3::new(1.0, 0.0, 1.0).normalize() * tangent).normalize();
        // Flat: only the normal. A ridge: up to the neighbour's normal. A valley: only the normal.
        for (height, allowed, forbidden) in [(0.0, 0.0, 0.01), (-0.5, 0.7, 0.72), (0.5, 0.0, 0.01)] {
            let mesh = fold(height);
            let flat = mesh.triangles.iter().find(|t| t.normal.y > 1.0 - 1e-12).unwrap();
            assert!(flat.owns(&towards(allowed)), "height {height}");
            assert!(!flat.owns(&towards(forbidden)), "height {height}");
            // The outer edges are borders: there anything goes.
            assert!(flat.owns(&Vec3::new(-1.0, 0.2, 0.0).normalize()));
        }
    }

    #[test]
    fn vertices_at_one_place_are_one_and_triangles_without_area_are_left_out() {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, -0.0],
            [1.0, 0.0, 1.0],
            [0.0, 0.0, 1.0],
        ];
        let mesh = Mesh::new(&positions, &[[0, 2, 1], [3, 5, 4], [0, 1, 1]]).unwrap();
        assert_eq!(mesh.triangles.len(), 2);
        assert_eq!(mesh.triangles[0].leeway.iter().filter(|leeway| **leeway == 0.0).count(), 1);
        assert!(Mesh::new(&positions, &[[0, 1, 9]]).unwrap_err().contains("vertex 9 of 6"));
    }
}
