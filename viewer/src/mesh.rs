//! Triangles made ready to draw: vertices split where the surface has an edge, a normal each.

use std::collections::HashMap;

use rerun::Mesh3D;

use crate::bounds::Bounds;
use crate::palette;
use crate::visual::VisualMesh;

/// Faces that meet at less than 40 degrees are shaded as one surface.
const CREASE_COS: f32 = 0.766;
/// A vertex with more faces than this (the tip of a fine cone) is shaded face by face, which keeps the work linear.
const MAX_FACES_A_VERTEX: usize = 128;

/// A surface with normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// One a vertex; empty where [`Self::color`] is that of all.
    pub(crate) colors: Vec<[u8; 4]>,
    pub(crate) color: [u8; 4],
}

impl Mesh {
    /// Joins pieces into one surface. Triangles that name no vertex or have no area are left out.
    pub(crate) fn of(pieces: &[VisualMesh]) -> Self {
        let mut mesh =
            Self { color: pieces.first().map_or([255; 4], |piece| piece.color), ..Self::default() };
        let one_color = pieces.iter().all(|piece| piece.color == mesh.color);
        for piece in pieces {
            mesh.push(piece);
            if !one_color {
                mesh.colors.resize(mesh.positions.len(), piece.color);
            }
        }
        if !one_color {
            mesh.color = [255; 4];
        }
        mesh
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds::of(&self.positions)
    }

    fn push(&mut self, piece: &VisualMesh) {
        let welded = Welded::of(piece);
        let mut split: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        for (face, corners) in welded.faces.iter().enumerate() {
            let triangle = corners.map(|vertex| {
                let normal = welded.normal(face, vertex);
                *split.entry((vertex, normal.map(f32::to_bits))).or_insert_with(|| {
                    self.positions.push(welded.positions[vertex as usize]);
                    self.normals.push(normal);
                    u32::try_from(self.positions.len() - 1).unwrap_or(u32::MAX)
                })
            });
            self.triangles.push(triangle);
        }
    }

    /// Everything but the colour, which changes where it shows the state.
    pub(crate) fn geometry(&self) -> Mesh3D {
        let mesh = Mesh3D::update_fields()
            .with_vertex_positions(&self.positions)
            .with_vertex_normals(&self.normals)
            .with_triangle_indices(&self.triangles);
        if self.colors.is_empty() {
            mesh
        } else {
            mesh.with_vertex_colors(self.colors.iter().map(|color| palette::color(*color)))
        }
    }

    /// With its colour.
    pub(crate) fn archetype(&self) -> Mesh3D {
        self.geometry().with_albedo_factor(palette::albedo(self.color))
    }
}

/// Vertices at one place made one, with the faces around each.
struct Welded {
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    /// Unit normal and area of each face.
    planes: Vec<([f32; 3], f32)>,
    /// Faces of vertex `i` are `around[first[i]..first[i + 1]]`.
    first: Vec<u32>,
    around: Vec<u32>,
}

impl Welded {
    fn of(piece: &VisualMesh) -> Self {
        let mut places: HashMap<[u32; 3], u32> = HashMap::with_capacity(piece.positions.len());
        let mut positions: Vec<[f32; 3]> = Vec::new();
        let ids: Vec<u32> = piece
            .positions
            .iter()
            .map(|point| {
                // Adding zero turns -0 into 0.
                *places.entry(point.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                    positions.push(*point);
                    u32::try_from(positions.len() - 1).unwrap_or(u32::MAX)
                })
            })
            .collect();
        let mut faces = Vec::with_capacity(piece.triangles.len());
        let mut planes = Vec::with_capacity(piece.triangles.len());
        for triangle in &piece.triangles {
            let Some([a, b, c]) = resolve(&ids, *triangle) else { continue };
            let corners = [a, b, c].map(|i| positions[i as usize]);
            if let Some(plane) = plane(corners) {
                faces.push([a, b, c]);
                planes.push(plane);
            }
        }
        let mut first = vec![0u32; positions.len() + 1];
        faces.iter().flatten().for_each(|vertex| first[*vertex as usize + 1] += 1);
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut around = vec![0u32; 3 * faces.len()];
        for (face, corners) in (0u32..).zip(&faces) {
            for vertex in corners {
                let slot = &mut next[*vertex as usize];
                around[*slot as usize] = face;
                *slot += 1;
            }
        }
        Self { positions, faces, planes, first, around }
    }

    /// Mean by area of the normals around `vertex` that are within the crease of `face`'s own.
    fn normal(&self, face: usize, vertex: u32) -> [f32; 3] {
        let own = self.planes[face].0;
        let range = self.first[vertex as usize] as usize..self.first[vertex as usize + 1] as usize;
        if range.len() > MAX_FACES_A_VERTEX {
            return own;
        }
        let mut sum = [0.0; 3];
        for other in &self.around[range] {
            let (normal, area) = self.planes[*other as usize];
            if dot(own, normal) >= CREASE_COS {
                (0..3).for_each(|i| sum[i] += normal[i] * area);
            }
        }
        let length = dot(sum, sum).sqrt();
        if length > 0.0 { sum.map(|x| x / length) } else { own }
    }
}

fn resolve(ids: &[u32], triangle: [u32; 3]) -> Option<[u32; 3]> {
    let [a, b, c] = triangle.map(|i| ids.get(i as usize).copied());
    Some([a?, b?, c?])
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Unit normal and area; `None` for a triangle without area or with a coordinate that is no number.
fn plane([a, b, c]: [[f32; 3]; 3]) -> Option<([f32; 3], f32)> {
    let u: [f64; 3] = std::array::from_fn(|i| f64::from(b[i]) - f64::from(a[i]));
    let v: [f64; 3] = std::array::from_fn(|i| f64::from(c[i]) - f64::from(a[i]));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    #[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
    let plane = (n.map(|x| (x / length) as f32), (0.5 * length) as f32);
    (length > 0.0 && length.is_finite()).then_some(plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::{cuboid, sphere};

    #[test]
    fn a_box_keeps_its_edges_and_a_sphere_is_smooth() {
        let cube = Mesh::of(&[cuboid([1.0; 3])]);
        assert_eq!((cube.positions.len(), cube.triangles.len()), (24, 12));
        let ball = Mesh::of(&[sphere(2.0)]);
        for (point, normal) in ball.positions.iter().zip(&ball.normals) {
            let radial = point.map(|x| x / 2.0);
            assert!(dot(radial, *normal) > 0.99, "{point:?} {normal:?}");
        }
    }

    #[test]
    fn bad_triangles_are_left_out() {
        let piece = VisualMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN; 3]],
            triangles: vec![[0, 1, 2], [0, 0, 1], [0, 1, 9], [0, 1, 3]],
            color: [1, 2, 3, 255],
        };
        let mesh = Mesh::of(&[piece]);
        assert_eq!(mesh.triangles.len(), 1);
        assert_eq!(mesh.normals, vec![[0.0, 0.0, 1.0]; 3]);
    }

    #[test]
    fn two_colours_become_vertex_colours() {
        let mut other = cuboid([0.5; 3]);
        other.color = [9, 9, 9, 255];
        let mesh = Mesh::of(&[cuboid([1.0; 3]), other]);
        assert_eq!(mesh.colors.len(), mesh.positions.len());
        assert_eq!(mesh.color, [255; 4]);
    }
}
