//! Convex polyhedra with all faces and edge directions, in double precision.

use crate::math::{Mat3, Vec3};

/// A convex solid by what a separating-axis test needs.
#[derive(Clone, Debug, Default)]
pub(super) struct Polyhedron {
    pub(super) vertices: Vec<Vec3>,
    /// Outward unit normals.
    pub(super) normals: Vec<Vec3>,
    /// Unit directions of the edges, each once, whatever its sign.
    pub(super) edges: Vec<Vec3>,
    /// The surface, for distances.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Share of the size within which a point counts as on a plane: points come from files in single precision.
const FLATNESS: f64 = 1e-7;

impl Polyhedron {
    pub(super) fn cuboid(half: &Vec3) -> Self {
        let corner =
            |i: u32| Vec3::from_fn(|axis, _| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] });
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        Self {
            vertices: (0..8).map(corner).collect(),
            normals: axes.iter().flat_map(|axis| [*axis, -axis]).collect(),
            edges: axes.to_vec(),
            triangles: [
                [0, 4, 6],
                [0, 6, 2],
                [1, 3, 7],
                [1, 7, 5],
                [0, 1, 5],
                [0, 5, 4],
                [2, 6, 7],
                [2, 7, 3],
                [0, 2, 3],
                [0, 3, 1],
                [4, 5, 7],
                [4, 7, 6],
            ]
            .to_vec(),
        }
    }

    /// Hull of points: every triple of them whose plane has all others on one side spans a face. O(n³) at worst
    /// and exact about coplanar points; done once a shape.
    pub(super) fn hull(points: &[Vec3]) -> Self {
        let vertices = points.to_vec();
        let size = vertices.iter().map(|a| (a - vertices[0]).norm()).fold(0.0, f64::max);
        let flat = FLATNESS * size;
        let mut hull = Self { vertices, ..Self::default() };
        let mut faces: Vec<(Vec3, f64)> = Vec::new();
        let n = hull.vertices.len();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let (a, b, c) = (hull.vertices[i], hull.vertices[j], hull.vertices[k]);
                    let across = (b - a).cross(&(c - a));
                    // Slivers have no reliable normal; the face they lie in has wider triples.
                    if across.norm() <= 1e-6 * size * size {
                        continue;
                    }
                    let normal = across.normalize();
                    let offset = normal.dot(&a);
                    let (mut above, mut below) = (false, false);
                    for point in &hull.vertices {
                        let height = normal.dot(point) - offset;
                        above |= height > flat;
                        below |= height < -flat;
                        if above && below {
                            break;
                        }
                    }
                    let outward = match (above, below) {
                        (true, true) | (false, false) => continue,
                        (true, false) => -normal,
                        (false, true) => normal,
                    };
                    if faces.iter().all(|(known, _)| known.dot(&outward) < 1.0 - 1e-9) {
                        faces.push((outward, outward.dot(&a)));
                    }
                }
            }
        }
        for (normal, offset) in &faces {
            hull.normals.push(*normal);
            hull.add_face(normal, *offset, flat);
        }
        hull
    }

    /// Adds edges and triangles of the face that holds all vertices of a supporting plane.
    fn add_face(&mut self, normal: &Vec3, offset: f64, flat: f64) {
        let on: Vec<usize> = (0..self.vertices.len())
            .filter(|&i| normal.dot(&self.vertices[i]) - offset > -2.0 * flat)
            .collect();
        let rim = rim(&self.vertices, &on, normal);
        for (i, &from) in rim.iter().enumerate() {
            let along = (self.vertices[rim[(i + 1) % rim.len()]] - self.vertices[from]).normalize();
            if self.edges.iter().all(|known| known.dot(&along).abs() < 1.0 - 1e-9) {
                self.edges.push(along);
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "a hull has fewer than 2^32 corners")]
        let index = |i: usize| i as u32;
        for pair in rim.get(1..).unwrap_or_default().windows(2) {
            self.triangles.push([index(rim[0]), index(pair[0]), index(pair[1])]);
        }
    }
}

/// Volume, centre of mass and second moments ∫ x xᵀ dV (about the origin) of the hull of points: the sums over
/// the tetrahedra from the origin to each face's triangles.
pub(crate) fn hull_moments(points: &[Vec3]) -> (f64, Vec3, Mat3) {
    let hull = Polyhedron::hull(points);
    let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
    for triangle in &hull.triangles {
        let [a, b, c] = triangle.map(|i| hull.vertices[i as usize]);
        let six = a.dot(&b.cross(&c));
        let sum = a + b + c;
        volume += six / 6.0;
        first += sum * (six / 24.0);
        let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
        second += (squares + sum * sum.transpose()) * (six / 120.0);
    }
    (volume, first / volume, second)
}

/// Corners of the convex polygon of coplanar points, counter-clockwise about `normal` (Andrew's monotone chain).
fn rim(points: &[Vec3], on: &[usize], normal: &Vec3) -> Vec<usize> {
    let [u, v] = crate::math::tangents(normal);
    let flat = |i: usize| [points[i].dot(&u), points[i].dot(&v)];
    let mut order = on.to_vec();
    order.sort_by(|&i, &j| {
        let (a, b) = (flat(i), flat(j));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let turn = |i: usize, j: usize, k: usize| {
        let (a, b, c) = (flat(i), flat(j), flat(k));
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let chain = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for next in order {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], next) <= 0.0 {
                chain.pop();
            }
            chain.push(next);
        }
        chain.pop();
        chain
    };
    let mut rim = chain(&mut order.iter().copied());
    rim.extend(chain(&mut order.iter().rev().copied()));
    rim
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_of_a_cube_with_points_on_its_faces_is_that_cube() {
        let mut points: Vec<Vec3> = Polyhedron::cuboid(&Vec3::repeat(0.5)).vertices;
        points.extend([
            Vec3::new(0.5, 0.1, 0.2),
            Vec3::new(0.0, -0.5, 0.0),
            Vec3::new(0.5, 0.5, 0.0),
            Vec3::zeros(),
        ]);
        let hull = Polyhedron::hull(&points);
        assert_eq!((hull.normals.len(), hull.edges.len()), (6, 3));
        let area: f64 = hull
            .triangles
            .iter()
            .map(|t| t.map(|i| hull.vertices[i as usize]))
            .map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm())
            .sum();
        assert!((area - 6.0).abs() < 1e-12, "{area}");
    }

    #[test]
    fn a_box_s_moments_are_the_textbook_s_wherever_it_lies() {
        let away = Vec3::new(3.0, -1.0, 2.0);
        let points: Vec<Vec3> =
            Polyhedron::cuboid(&Vec3::new(0.5, 1.0, 1.5)).vertices.iter().map(|v| v + away).collect();
        let (volume, center, second) = hull_moments(&points);
        assert!((volume - 6.0).abs() < 1e-12 && (center - away).norm() < 1e-12);
        let about = second - center * center.transpose() * volume;
        for (axis, half) in [0.5, 1.0, 1.5].into_iter().enumerate() {
            assert!((about[(axis, axis)] - volume * half * half / 3.0).abs() < 1e-12);
        }
        assert!(about[(0, 1)].abs() < 1e-12);
    }

    #[test]
    fn the_box_s_triangles_look_outward() {
        let cube = Polyhedron::cuboid(&Vec3::new(1.0, 2.0, 3.0));
        for triangle in &cube.triangles {
            let [a, b, c] = triangle.map(|i| cube.vertices[i as usize]);
            assert!((b - a).cross(&(c - a)).dot(&(a + b + c)) > 0.0, "{triangle:?}");
        }
    }
}
