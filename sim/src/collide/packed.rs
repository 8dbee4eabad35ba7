//! A polytope as the wide kernels read it: in single precision, eight of a kind side by side.

use crate::collide::polytope::{Edge, Polytope};
use crate::collide::relative::Relative;
use crate::math::Vec3;
use crate::solve::wide::lanes::{Eight, Lanes, V3, WIDTH};

/// Eight vectors.
pub(crate) type Eight3 = [Eight<f32>; 3];

/// Vertices and faces, each list filled up with its first entry to whole groups, and the edges one by one, since few of
/// them are near another shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Packed {
    pub(crate) vertices: Vec<Eight3>,
    pub(crate) normals: Vec<Eight3>,
    pub(crate) offsets: Vec<Eight<f32>>,
    pub(crate) edges: Vec<PackedEdge>,
}

/// An edge: its tail, the way to its head, the normals of its faces and a direction between those, one after the other.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PackedEdge([Eight<f32>; 2]);

/// Eight edges; a lane that is not filled has no length.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Edges([Eight3; 5]);

impl Packed {
    /// Of `polytope`, in the memory that it has.
    pub(crate) fn fill(&mut self, polytope: &Polytope) {
        let Polytope { vertices, faces, edges, .. } = polytope;
        pack(vertices.len(), |i| vertices[i], &mut self.vertices);
        pack(faces.len(), |i| faces[i].normal, &mut self.normals);
        self.offsets.clear();
        self.offsets.extend((0..faces.len().div_ceil(WIDTH)).map(|group| {
            Eight(std::array::from_fn(|i| single(faces.get(WIDTH * group + i).unwrap_or(&faces[0]).offset)))
        }));
        self.edges.clear();
        self.edges.extend(edges.iter().map(|edge| PackedEdge::new(edge, polytope)));
    }
}

impl PackedEdge {
    fn new(edge: &Edge, of: &Polytope) -> Self {
        let (tail, head) = (of.vertices[edge.tail as usize], of.vertices[edge.head as usize]);
        let normal = |face: u32| of.faces[face as usize].normal;
        let all = [tail, head - tail, normal(edge.left), normal(edge.right), edge.outward(of)];
        let number = |i: usize| all.get(i / 3).map_or(0.0, |v| single(v[i % 3]));
        Self([0, WIDTH].map(|first| Eight(std::array::from_fn(|i| number(first + i)))))
    }
}

impl Edges {
    /// Those of `all` that `chosen` names, eight at most.
    #[inline(always)]
    pub(crate) fn gather<L: Lanes<Scalar = f32>>(all: &[PackedEdge], chosen: &[u32]) -> Self {
        let mut rows = [[L::zero(); WIDTH]; 2];
        for (lane, &edge) in chosen.iter().enumerate() {
            let PackedEdge([low, high]) = &all[edge as usize];
            rows[0][lane] = L::load(low);
            rows[1][lane] = L::load(high);
        }
        let [low, high] = [L::transpose(rows[0]), L::transpose(rows[1])];
        let mut edges = Self::default();
        for (to, from) in edges.0.iter_mut().flatten().zip(low.into_iter().chain(high)) {
            from.store(to);
        }
        edges
    }

    /// Puts them where their shape lies.
    #[inline(always)]
    pub(crate) fn place<L: Lanes<Scalar = f32>>(&mut self, at: &Placed<L>) {
        let [tail, rest @ ..] = &mut self.0;
        store(at.point(V3::load(tail)), tail);
        for direction in rest {
            store(at.turned(V3::load(direction)), direction);
        }
    }

    #[inline(always)]
    pub(crate) fn load<L: Lanes<Scalar = f32>>(&self) -> [V3<L>; 5] {
        let [tail, along, left, right, outward] = &self.0;
        [V3::load(tail), V3::load(along), V3::load(left), V3::load(right), V3::load(outward)]
    }

    /// One of them in every lane.
    #[inline(always)]
    pub(crate) fn splat<L: Lanes<Scalar = f32>>(&self, lane: usize) -> [V3<L>; 5] {
        let [tail, along, left, right, outward] = &self.0;
        [splat(tail, lane), splat(along, lane), splat(left, lane), splat(right, lane), splat(outward, lane)]
    }
}

/// A pose in every lane.
pub(crate) struct Placed<L> {
    columns: [V3<L>; 3],
    translation: V3<L>,
}

impl<L: Lanes<Scalar = f32>> Placed<L> {
    #[inline(always)]
    pub(crate) fn new(relative: &Relative) -> Self {
        let Relative { rotation: r, translation: t } = relative;
        let column = |k: usize| wide(&r.column(k).into_owned());
        Self { columns: [column(0), column(1), column(2)], translation: wide(t) }
    }

    #[inline(always)]
    fn turned(&self, v: V3<L>) -> V3<L> {
        let [x, y, z] = self.columns;
        x.scaled(v.0) + y.scaled(v.1) + z.scaled(v.2)
    }

    #[inline(always)]
    pub(crate) fn point(&self, v: V3<L>) -> V3<L> {
        self.turned(v) + self.translation
    }
}

#[inline(always)]
pub(crate) fn wide<L: Lanes<Scalar = f32>>(v: &Vec3) -> V3<L> {
    V3(L::number(v.x), L::number(v.y), L::number(v.z))
}

#[inline(always)]
pub(crate) fn splat<L: Lanes<Scalar = f32>>(of: &Eight3, lane: usize) -> V3<L> {
    V3(L::splat(of[0].0[lane]), L::splat(of[1].0[lane]), L::splat(of[2].0[lane]))
}

#[inline(always)]
pub(crate) fn store<L: Lanes<Scalar = f32>>(v: V3<L>, to: &mut Eight3) {
    v.0.store(&mut to[0]);
    v.1.store(&mut to[1]);
    v.2.store(&mut to[2]);
}

#[expect(clippy::cast_possible_truncation, reason = "eight lanes of f32 decide between axes, no more")]
pub(crate) fn single(x: f64) -> f32 {
    x as f32
}

fn pack(count: usize, at: impl Fn(usize) -> Vec3, out: &mut Vec<Eight3>) {
    let lane = |group: usize, axis: usize| {
        Eight(std::array::from_fn(|i| {
            let index = WIDTH * group + i;
            single(at(if index < count { index } else { 0 })[axis])
        }))
    };
    out.clear();
    out.extend((0..count.div_ceil(WIDTH)).map(|group| std::array::from_fn(|axis| lane(group, axis))));
}
