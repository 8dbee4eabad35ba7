//! A convex polyhedron with its topology: vertices, faces as loops, and edges that know the two faces they part.

use std::collections::BTreeMap;

use crate::collide::packed::Packed;
use crate::collide::parry;
use crate::collide::relative::Relative;
use crate::math::Vec3;
use crate::shape::Aabb;

/// A flat side: outward unit normal, `normal · x <= offset` inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub(crate) normal: Vec3,
    pub(crate) offset: f64,
    first: u32,
    count: u32,
}

/// From vertex `tail` to vertex `head`, counter-clockwise in face `left`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) tail: u32,
    pub(crate) head: u32,
    pub(crate) left: u32,
    pub(crate) right: u32,
}

impl Edge {
    /// A direction between the normals of its faces; of a sheet's edge, which lies between opposite ones, out of the
    /// triangle.
    pub(crate) fn outward(&self, of: &Polytope) -> Vec3 {
        let left = of.faces[self.left as usize].normal;
        let sum = left + of.faces[self.right as usize].normal;
        if sum.norm_squared() > 1e-12 {
            return sum;
        }
        (of.vertices[self.head as usize] - of.vertices[self.tail as usize]).cross(&left)
    }
}

/// A convex polyhedron in its shape's frame, m.
#[derive(Clone, Debug)]
pub(crate) struct Polytope {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) faces: Vec<Face>,
    pub(crate) edges: Vec<Edge>,
    /// Vertices of the faces, one face after the other, counter-clockwise from outside.
    loops: Vec<u32>,
    pub(crate) packed: Packed,
    /// Of a box about the origin.
    pub(crate) half_extents: Option<Vec3>,
    /// Bounds of the vertices.
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

/// Shares of its size by which a vertex may lie off the plane of a face and still be taken into it: the least that makes
/// a closed surface.
const COPLANAR: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

impl Polytope {
    /// A box about the origin; faces in the order +x, -x, +y, -y, +z, -z.
    pub(crate) fn cuboid(half: &Vec3) -> Self {
        let vertices = (0..8)
            .map(|i| Vec3::from_fn(|axis, _| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] }))
            .collect();
        let loops = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
        Self::from_loops(vertices, loops.iter().map(|l| l.to_vec()).collect())
            .map_or_else(|| Self::point(*half), |cuboid| Self { half_extents: Some(*half), ..cuboid })
    }

    /// A triangle of no size, to be filled by [`Self::set_sheet`].
    pub(crate) fn sheet() -> Self {
        let face = |first| Face { normal: Vec3::y(), offset: 0.0, first, count: 3 };
        let edge = |tail| Edge { tail, head: (tail + 1) % 3, left: 0, right: 1 };
        Self {
            vertices: vec![Vec3::zeros(); 3],
            faces: vec![face(0), face(3)],
            edges: (0..3).map(edge).collect(),
            loops: vec![0, 1, 2, 0, 2, 1],
            packed: Packed::default(),
            half_extents: None,
            low: Vec3::zeros(),
            high: Vec3::zeros(),
        }
    }

    /// Makes this sheet the triangle of `corners`, as a polytope without volume: face 0 looks along `normal`, face 1
    /// the other way.
    pub(crate) fn set_sheet(&mut self, corners: &[Vec3; 3], normal: &Vec3) {
        self.vertices.copy_from_slice(corners);
        (self.low, self.high) = bounds(corners);
        let offset = corners[0].dot(normal);
        for (face, sign) in self.faces.iter_mut().zip([1.0, -1.0]) {
            (face.normal, face.offset) = (normal * sign, offset * sign);
        }
        self.pack();
    }

    /// What a box of no size would be; never met, since construction refuses such shapes.
    fn point(at: Vec3) -> Self {
        Self {
            vertices: vec![at],
            faces: Vec::new(),
            edges: Vec::new(),
            loops: Vec::new(),
            packed: Packed::default(),
            half_extents: None,
            low: at,
            high: at,
        }
    }

    /// The convex hull of `points`.
    ///
    /// # Errors
    /// What is wrong with them, in words.
    pub(crate) fn hull(points: &[Vec3]) -> Result<Self, String> {
        let mut points = points.to_vec();
        for share in COPLANAR {
            let (vertices, triangles) = parry::convex_hull(&points)?;
            let (low, high) = bounds(&vertices);
            let tolerance = share * (high - low).norm();
            let hull = merge_coplanar(&vertices, &triangles, tolerance)
                .and_then(|loops| Self::from_loops(vertices.clone(), loops))
                .filter(|hull| hull.is_convex(4.0 * tolerance))
                .or_else(|| {
                    // Merging went round a corner: keep the triangles.
                    let loops = triangles.iter().map(|t| t.to_vec()).collect();
                    Self::from_loops(vertices.clone(), loops).filter(|hull| hull.is_convex(4.0 * tolerance))
                });
            if let Some(hull) = hull {
                return Ok(hull);
            }
            // Corners that crowd together make faces of no area: once more with one of each crowd.
            points = thinned(vertices, 10.0 * tolerance);
        }
        Err("the points of the hull span no closed surface; give it a thickness".to_owned())
    }

    /// `None` where a face has no area or an edge does not part two faces.
    fn from_loops(vertices: Vec<Vec3>, face_loops: Vec<Vec<u32>>) -> Option<Self> {
        let mut faces = Vec::with_capacity(face_loops.len());
        let mut loops = Vec::new();
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (index, face) in (0_u32..).zip(&face_loops) {
            let at = |i: usize| vertices[face[i % face.len()] as usize];
            // Newell: right for any planar loop, and the mean for one that is not quite planar.
            let area = (1..face.len()).map(|i| (at(i) - at(0)).cross(&(at(i + 1) - at(0)))).sum::<Vec3>();
            let normal = area.try_normalize(f64::MIN_POSITIVE)?;
            let offset = face.iter().map(|v| vertices[*v as usize].dot(&normal)).fold(f64::MIN, f64::max);
            let (first, count) = (u32::try_from(loops.len()).ok()?, u32::try_from(face.len()).ok()?);
            faces.push(Face { normal, offset, first, count });
            loops.extend(face);
            for (i, &from) in face.iter().enumerate() {
                if sides.insert((from, face[(i + 1) % face.len()]), index).is_some() {
                    return None;
                }
            }
        }
        let mut edges = Vec::with_capacity(sides.len() / 2);
        for (&(tail, head), &left) in &sides {
            let &right = sides.get(&(head, tail))?;
            if tail < head {
                edges.push(Edge { tail, head, left, right });
            }
        }
        let (low, high) = bounds(&vertices);
        let packed = Packed::default();
        let mut polytope = Self { vertices, faces, edges, loops, packed, half_extents: None, low, high };
        polytope.pack();
        Some(polytope)
    }

    fn pack(&mut self) {
        let mut packed = std::mem::take(&mut self.packed);
        packed.fill(self);
        self.packed = packed;
    }

    /// Vertices of a face, counter-clockwise from outside.
    pub(crate) fn face_loop(&self, face: usize) -> &[u32] {
        let Face { first, count, .. } = self.faces[face];
        &self.loops[first as usize..(first + count) as usize]
    }

    /// The vertex farthest along `direction`; the first of equals.
    pub(crate) fn support(&self, direction: &Vec3) -> usize {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, vertex) in self.vertices.iter().enumerate() {
            let along = vertex.dot(direction);
            if along > best.1 {
                best = (i, along);
            }
        }
        best.0
    }

    /// The face whose outward normal is nearest to `direction`; the first of equals.
    pub(crate) fn face_along(&self, direction: &Vec3) -> usize {
        let mut best = (0, f64::NEG_INFINITY);
        for (i, face) in self.faces.iter().enumerate() {
            let along = face.normal.dot(direction);
            if along > best.1 {
                best = (i, along);
            }
        }
        best.0
    }

    /// Signed distance of `point` from the side that it is farthest beyond or least below: inside, its depth negated.
    pub(crate) fn height(&self, point: &Vec3) -> f64 {
        let height = |face: &Face| face.normal.dot(point) - face.offset;
        self.faces.iter().map(height).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A ball inside of it: its centre and radius, m.
    pub(crate) fn ball_inside(&self) -> (Vec3, f64) {
        #[expect(clippy::cast_precision_loss, reason = "a count of vertices")]
        let center = self.vertices.iter().sum::<Vec3>() / self.vertices.len() as f64;
        let depth = |face: &Face| face.offset - face.normal.dot(&center);
        (center, self.faces.iter().map(depth).fold(f64::INFINITY, f64::min).max(0.0))
    }

    /// Bounds of the vertices where it lies at `relative`.
    pub(crate) fn bounds_at(&self, relative: &Relative) -> Aabb {
        let at = &relative.translation;
        let empty = Aabb { min: Vec3::repeat(f64::INFINITY), max: Vec3::repeat(f64::NEG_INFINITY) };
        let bounds = self.vertices.iter().fold(empty, |Aabb { min, max }, vertex| {
            let point = relative.rotation * vertex;
            Aabb { min: min.inf(&point), max: max.sup(&point) }
        });
        bounds.shifted(at)
    }

    fn is_convex(&self, tolerance: f64) -> bool {
        let below =
            |face: &Face| self.vertices.iter().all(|v| v.dot(&face.normal) <= face.offset + tolerance);
        self.vertices.len() + self.faces.len() == self.edges.len() + 2 && self.faces.iter().all(below)
    }
}

/// Those of `points` that are no nearer than `apart` to one before them.
fn thinned(points: Vec<Vec3>, apart: f64) -> Vec<Vec3> {
    let mut kept: Vec<Vec3> = Vec::with_capacity(points.len());
    for point in points {
        if kept.iter().all(|other| (point - other).norm_squared() >= apart * apart) {
            kept.push(point);
        }
    }
    kept
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let empty = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    points.iter().fold(empty, |(low, high), p| (low.inf(p), high.sup(p)))
}

fn sides(&[a, b, c]: &[u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Triangles that lie in one plane within `tolerance`, joined to loops: the largest first takes in its neighbours.
fn merge_coplanar(vertices: &[Vec3], triangles: &[[u32; 3]], tolerance: f64) -> Option<Vec<Vec<u32>>> {
    let at = |v: u32| vertices[v as usize];
    let area = |t: &[u32; 3]| (at(t[1]) - at(t[0])).cross(&(at(t[2]) - at(t[0])));
    let mut of_side: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for (index, t) in triangles.iter().enumerate() {
        of_side.extend(sides(t).map(|side| (side, index)));
    }
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    let size = |i: usize| area(&triangles[i]).norm_squared();
    order.sort_by(|&i, &j| size(j).total_cmp(&size(i)).then(i.cmp(&j)));
    let mut region_of: Vec<Option<usize>> = vec![None; triangles.len()];
    let mut loops = Vec::new();
    for seed in order {
        if region_of[seed].is_some() {
            continue;
        }
        let normal = area(&triangles[seed]).try_normalize(f64::MIN_POSITIVE)?;
        let offset = normal.dot(&at(triangles[seed][0]));
        let flat = |t: &[u32; 3]| t.iter().all(|&v| (normal.dot(&at(v)) - offset).abs() <= tolerance);
        region_of[seed] = Some(seed);
        let mut region = vec![seed];
        let mut next = 0;
        while let Some(&index) = region.get(next) {
            next += 1;
            for (from, to) in sides(&triangles[index]) {
                let &other = of_side.get(&(to, from))?;
                if region_of[other].is_none() && flat(&triangles[other]) {
                    region_of[other] = Some(seed);
                    region.push(other);
                }
            }
        }
        let mut border = BTreeMap::new();
        for (from, to) in region.iter().flat_map(|&index| sides(&triangles[index])) {
            let outside = region_of[*of_side.get(&(to, from))?] != Some(seed);
            if outside && border.insert(from, to).is_some() {
                return None;
            }
        }
        let (&start, _) = border.first_key_value()?;
        let mut face = vec![start];
        while let Some(next) = border.remove(face.last()?).filter(|&next| next != start) {
            face.push(next);
        }
        if !border.is_empty() || face.len() < 3 {
            return None;
        }
        loops.push(face);
    }
    Some(loops)
}
