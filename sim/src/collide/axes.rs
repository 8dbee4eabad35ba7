//! The wide half of the separating-axis test: every face, and every pair of edges that can matter, eight at a time.
//!
//! Written once for all lanes; what comes out only decides between axes, whose figures are then found in f64.

use crate::collide::packed::{Edges, Eight3, Packed, PackedEdge, Placed, single, splat, store, wide};
use crate::collide::polytope::{Edge, Polytope};
use crate::collide::relative::Relative;
use crate::math::Vec3;
use crate::solve::wide::lanes::{Eight, Lanes, Portable, V3, WIDTH};

/// Square of the sine below which two edges count as parallel: their faces then say it all.
const PARALLEL: f64 = 1e-7;

/// Buffers of the kernels.
#[derive(Clone, Debug, Default)]
pub(crate) struct AxisBuffers {
    /// Whether the kernels of this processor may be used.
    pub(crate) simd: bool,
    /// Vertices of one shape in the frame of the other.
    placed: Vec<Eight3>,
    /// Signed distance of every face of A from B, then of those of B from A.
    pub(crate) distances: Vec<f32>,
    /// Sides of the common part beyond which each vertex lies.
    beyond: Vec<[u8; WIDTH]>,
    near: [Vec<u32>; 2],
    edges: [Vec<Edges>; 2],
}

/// What is known before edges are looked at.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    /// Unit, from A to B, frame of A, with the distance along it, m.
    pub(crate) normal: &'a Vec3,
    pub(crate) distance: f64,
    /// m: shapes farther apart are of no interest.
    pub(crate) reach: f64,
}

impl AxisBuffers {
    /// Adds the distances of the faces of `a` from `b`, which lies at `relative`.
    pub(crate) fn weigh_faces(&mut self, a: &Polytope, b: &Polytope, relative: &Relative) {
        let count = self.distances.len() + a.faces.len();
        #[cfg(target_arch = "x86_64")]
        if self.simd {
            #[allow(unsafe_code, reason = "the door to the SIMD kernels")]
            // SAFETY: `simd` is true only where `simd_available` has found AVX2.
            unsafe {
                weigh_faces_avx2(self, (&a.packed, &b.packed), b.vertices.len(), relative);
            }
            self.distances.truncate(count);
            return;
        }
        weigh_faces::<Portable<f32>>(self, (&a.packed, &b.packed), b.vertices.len(), relative);
        self.distances.truncate(count);
    }

    /// The pair of edges, one of A and one of B, whose common normal parts the shapes most.
    ///
    /// Two edges that part the shapes more than what is known are nearer to each other than `near`, the larger of the
    /// reach and the overlap. So both pass through the common part of the bounds grown by that; and since all of B lies
    /// beyond A by the known distance, both pass through the outermost slices of A and of B along the known normal that
    /// are as thick as `near` less that distance. An edge with both ends beyond one side of this does not (the outcodes
    /// of Cohen and Sutherland).
    pub(crate) fn best_edges(
        &mut self,
        shapes: (&Polytope, &Polytope),
        relative: &Relative,
        known: Known<'_>,
    ) -> Option<(u32, u32)> {
        #[cfg(target_arch = "x86_64")]
        if self.simd {
            #[allow(unsafe_code, reason = "the door to the SIMD kernels")]
            // SAFETY: as in `weigh_faces`.
            return unsafe { best_edges_avx2(self, shapes, relative, known) };
        }
        best_edges::<Portable<f32>>(self, shapes, relative, known)
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn weigh_faces_avx2(
    buffers: &mut AxisBuffers,
    shapes: (&Packed, &Packed),
    vertices: usize,
    relative: &Relative,
) {
    weigh_faces::<crate::solve::wide::avx2::Avx2>(buffers, shapes, vertices, relative);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn best_edges_avx2(
    buffers: &mut AxisBuffers,
    shapes: (&Polytope, &Polytope),
    relative: &Relative,
    known: Known<'_>,
) -> Option<(u32, u32)> {
    best_edges::<crate::solve::wide::avx2::Avx2>(buffers, shapes, relative, known)
}

/// Puts the vertices where their shape lies.
#[inline(always)]
fn place<L: Lanes<Scalar = f32>>(vertices: &[Eight3], relative: &Relative, placed: &mut Vec<Eight3>) {
    let at = Placed::<L>::new(relative);
    placed.clear();
    placed.resize(vertices.len(), Eight3::default());
    for (from, to) in vertices.iter().zip(placed) {
        store(at.point(V3::load(from)), to);
    }
}

#[inline(always)]
fn weigh_faces<L: Lanes<Scalar = f32>>(
    buffers: &mut AxisBuffers,
    (a, b): (&Packed, &Packed),
    vertices: usize,
    relative: &Relative,
) {
    let AxisBuffers { placed, distances, .. } = buffers;
    place::<L>(&b.vertices, relative, placed);
    for (normal, offset) in a.normals.iter().zip(&a.offsets) {
        let normal = V3::<L>::load(normal);
        let mut nearest = L::splat(f32::INFINITY);
        for i in 0..vertices {
            nearest = normal.dot(splat(&placed[i / WIDTH], i % WIDTH)).min(nearest);
        }
        let mut out = Eight::default();
        (nearest - L::load(offset)).store(&mut out);
        distances.extend_from_slice(&out.0);
    }
}

#[inline(always)]
fn best_edges<L: Lanes<Scalar = f32>>(
    buffers: &mut AxisBuffers,
    (a, b): (&Polytope, &Polytope),
    relative: &Relative,
    Known { normal, distance, reach }: Known<'_>,
) -> Option<(u32, u32)> {
    let AxisBuffers { placed, beyond, near: [near_a, near_b], edges: [edges_a, edges_b], .. } = buffers;
    place::<L>(&b.packed.vertices, relative, placed);
    let near = reach.max(-distance);
    let bounds_b = bounds::<L>(placed);
    let grown = single(near);
    let low = std::array::from_fn(|k| single(a.low[k]).max(bounds_b[0][k]) - grown);
    let high = std::array::from_fn(|k| single(a.high[k]).min(bounds_b[1][k]) + grown);
    // A hair more, as the known distance may be rounded.
    let slice = single(1.001 * (near - distance));
    outcodes::<L>(&a.packed.vertices, normal, slice, (&low, &high), beyond);
    gather::<L>(&a.edges, &a.packed.edges, beyond, near_a, edges_a);
    if near_a.is_empty() {
        return None;
    }
    outcodes::<L>(placed, &-normal, slice, (&low, &high), beyond);
    gather::<L>(&b.edges, &b.packed.edges, beyond, near_b, edges_b);
    let at = Placed::<L>::new(relative);
    for group in edges_b.iter_mut() {
        group.place(&at);
    }
    let mut best = L::splat(f32::NEG_INFINITY);
    let mut best_turn = L::zero();
    let mut turn = 0_u32;
    for j in 0..near_b.len() {
        let edge_b = edges_b[j / WIDTH].splat::<L>(j % WIDTH);
        for group in edges_a.iter() {
            if let Some(distance) = distances(group.load::<L>(), edge_b) {
                best_turn = distance.where_at_most(best, best_turn, L::number(f64::from(turn)));
                best = distance.where_at_most(best, best, distance);
            }
            turn += 1;
        }
    }
    let (mut distances, mut turns) = (Eight::default(), Eight::default());
    best.store(&mut distances);
    best_turn.store(&mut turns);
    let mut found: Option<(usize, f32, f32)> = None;
    for (lane, (&distance, &turn)) in distances.0.iter().zip(&turns.0).enumerate() {
        let better =
            |(_, most, first): (usize, f32, f32)| distance > most || distance == most && turn < first;
        if distance > f32::NEG_INFINITY && found.is_none_or(better) {
            found = Some((lane, distance, turn));
        }
    }
    let (lane, _, turn) = found?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it was a count below 2^24")]
    let turn = turn as usize;
    let (j, group) = (turn / edges_a.len(), turn % edges_a.len());
    Some((near_a[WIDTH * group + lane], near_b[j]))
}

/// How far edges of A and one of B, in the frame of A, part their shapes; minus infinity where they do not make a face
/// of the Minkowski difference. `None` where none of them does.
#[inline(always)]
fn distances<L: Lanes<Scalar = f32>>(
    [tail_a, along_a, left_a, right_a, outward_a]: [V3<L>; 5],
    [tail_b, along_b, left_b, right_b, outward_b]: [V3<L>; 5],
) -> Option<L> {
    let none = L::splat(f32::NEG_INFINITY);
    let below = L::splat(-f32::MIN_POSITIVE);
    // The arcs of the two edges cross on the Gauss map where each parts the other's ends.
    let parts_a = left_a.dot(along_b) * right_a.dot(along_b);
    let parts_b = left_b.dot(along_a) * right_b.dot(along_a);
    let crosses = parts_a.max(parts_b);
    if !crosses.any_at_most(below) {
        return None;
    }
    let cross = along_a.cross(along_b);
    let square = cross.dot(cross);
    let parallel = along_a.dot(along_a) * along_b.dot(along_b) * L::number(PARALLEL);
    // Outward of A is inward of B; one of the two has no say where it is a sheet.
    let (out_a, in_b) = (cross.dot(outward_a), -cross.dot(outward_b));
    let along = cross.dot(tail_b - tail_a);
    let signed = (out_a + in_b).where_at_most(L::zero(), -along, along);
    let distance = signed.divided_by(square.sqrt());
    let faces_b = (out_a * in_b).where_at_most(below, none, distance);
    let skew = square.where_at_most(parallel, none, faces_b);
    Some(crosses.where_at_most(below, skew, none))
}

/// Those edges of which not both ends lie beyond one side.
#[inline(always)]
fn gather<L: Lanes<Scalar = f32>>(
    edges: &[Edge],
    packed: &[PackedEdge],
    beyond: &[[u8; WIDTH]],
    near: &mut Vec<u32>,
    groups: &mut Vec<Edges>,
) {
    let beyond = beyond.as_flattened();
    near.clear();
    near.resize(edges.len(), 0);
    let mut count = 0;
    for (i, edge) in (0..).zip(edges) {
        near[count] = i;
        count += usize::from(beyond[edge.tail as usize] & beyond[edge.head as usize] == 0);
    }
    near.truncate(count);
    groups.clear();
    for chosen in near.chunks(WIDTH) {
        groups.push(Edges::gather::<L>(packed, chosen));
    }
}

/// Lowest and highest coordinates.
#[inline(always)]
fn bounds<L: Lanes<Scalar = f32>>(points: &[Eight3]) -> [[f32; 3]; 2] {
    std::array::from_fn(|end| {
        std::array::from_fn(|axis| {
            let mut all = L::load(&points[0][axis]);
            for point in points {
                let one = L::load(&point[axis]);
                all = if end == 0 { one.min(all) } else { one.max(all) };
            }
            let mut lanes = Eight::default();
            all.store(&mut lanes);
            lanes.0.iter().fold(lanes.0[0], |a, &b| if (b < a) == (end == 0) { b } else { a })
        })
    })
}

/// Of each vertex, the sides of the box beyond which it lies, and whether it lies below the outermost slice of all along
/// the normal.
#[inline(always)]
fn outcodes<L: Lanes<Scalar = f32>>(
    vertices: &[Eight3],
    normal: &Vec3,
    slice: f32,
    (low, high): (&[f32; 3], &[f32; 3]),
    out: &mut Vec<[u8; WIDTH]>,
) {
    let normal = wide::<L>(normal);
    let mut top = L::splat(f32::NEG_INFINITY);
    for vertex in vertices {
        top = normal.dot(V3::load(vertex)).max(top);
    }
    let mut lanes = Eight::default();
    top.store(&mut lanes);
    let bottom = lanes.0.iter().fold(f32::NEG_INFINITY, |a, &b| if b > a { b } else { a }) - slice;
    out.clear();
    for vertex in vertices {
        let mut height = Eight::default();
        normal.dot(V3::load(vertex)).store(&mut height);
        let [x, y, z] = vertex;
        out.push(std::array::from_fn(|i| {
            u8::from(height.0[i] < bottom) << 6
                | u8::from(x.0[i] < low[0])
                | u8::from(x.0[i] > high[0]) << 1
                | u8::from(y.0[i] < low[1]) << 2
                | u8::from(y.0[i] > high[1]) << 3
                | u8::from(z.0[i] < low[2]) << 4
                | u8::from(z.0[i] > high[2]) << 5
        }));
    }
}
