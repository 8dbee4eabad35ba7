//! The axes that two edges define: those pairs that make a face of the Minkowski difference (Gregorius 2013, "The
//! Separating Axis Test between Convex Polyhedra"), among the edges that can matter.

use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint, nearest_on_lines};
use crate::collide::relative::Relative;
use crate::collide::sat::Axis;
use crate::math::Vec3;

/// Square of the sine below which two edges count as parallel: their faces then say it all.
const PARALLEL: f64 = 1e-8;

/// Buffers of the search.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeBuffers {
    /// Sides of the common part beyond which each vertex lies.
    beyond: Vec<u8>,
    near_a: Vec<u32>,
}

impl EdgeBuffers {
    /// The pair of edges whose common normal parts the shapes most, with that normal from A to B and the distance along
    /// it; `vertices_b` are B's in the frame of A, `known` is a normal with the distance along it, and shapes farther
    /// apart than `reach` are of no interest.
    ///
    /// Two edges that part the shapes more than `known` does are nearer to each other than `near`, the larger of the
    /// reach and the overlap along `known`. So both pass through the common part of the bounds grown by that; and since
    /// all of B lies beyond A by the known distance, both pass through the outermost slices of A and of B along the
    /// known normal that are as thick as `near` less that distance. An edge with both ends beyond one side of this does
    /// not (the outcodes of Cohen and Sutherland).
    pub(crate) fn best(
        &mut self,
        (a, b): (&Polytope, &Polytope),
        vertices_b: &[Vec3],
        relative: &Relative,
        known: (&Vec3, f64),
        reach: f64,
    ) -> Option<(Axis, Vec3, f64)> {
        let (along, distance) = known;
        let near = reach.max(-distance);
        let empty = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
        let (low_b, high_b) = vertices_b.iter().fold(empty, |(low, high), p| (low.inf(p), high.sup(p)));
        let low = a.low.sup(&low_b).add_scalar(-near);
        let high = a.high.inf(&high_b).add_scalar(near);
        let Self { beyond, near_a } = self;
        let beyond_sides = |vertices: &[Vec3], sign: f64, beyond: &mut Vec<u8>| {
            let height = |p: &Vec3| sign * p.dot(along);
            // A hair more, as the known distance may be rounded.
            let slice = 1.001 * (near - distance);
            let top = vertices.iter().map(height).fold(f64::MIN, f64::max) - slice;
            beyond.clear();
            beyond.extend(vertices.iter().map(|p| {
                (0..3).fold(u8::from(height(p) < top) << 6, |sides, k| {
                    sides | u8::from(p[k] < low[k]) << k | u8::from(p[k] > high[k]) << (k + 3)
                })
            }));
        };
        beyond_sides(&a.vertices, 1.0, beyond);
        near_a.clear();
        let crosses =
            |beyond: &[u8], tail: u32, head: u32| beyond[tail as usize] & beyond[head as usize] == 0;
        near_a.extend((0..).zip(&a.edges).filter(|(_, e)| crosses(beyond, e.tail, e.head)).map(|(i, _)| i));
        if near_a.is_empty() {
            return None;
        }
        beyond_sides(vertices_b, -1.0, beyond);
        let mut found: Option<(Axis, Vec3, f64)> = None;
        for (j, edge) in (0_u32..).zip(&b.edges).filter(|(_, e)| crosses(beyond, e.tail, e.head)) {
            let tail_b = vertices_b[edge.tail as usize];
            let along_b = vertices_b[edge.head as usize] - tail_b;
            let left_b = relative.rotation * b.faces[edge.left as usize].normal;
            let right_b = relative.rotation * b.faces[edge.right as usize].normal;
            let inward_b = left_b + right_b;
            for &i in near_a.iter() {
                let edge = &a.edges[i as usize];
                let (left_a, right_a) =
                    (&a.faces[edge.left as usize].normal, &a.faces[edge.right as usize].normal);
                // The arcs of the two edges cross on the Gauss map where each parts the other's ends.
                if left_a.dot(&along_b) * right_a.dot(&along_b) >= 0.0 {
                    continue;
                }
                let tail_a = a.vertices[edge.tail as usize];
                let along_a = a.vertices[edge.head as usize] - tail_a;
                if left_b.dot(&along_a) * right_b.dot(&along_a) >= 0.0 {
                    continue;
                }
                let cross = along_a.cross(&along_b);
                let square = cross.norm_squared();
                if square <= PARALLEL * along_a.norm_squared() * along_b.norm_squared() {
                    continue;
                }
                // Outward of A is inward of B; of a sheet's edges B alone knows.
                let normal = cross * (-cross.dot(&inward_b).signum() / square.sqrt());
                if normal.dot(&edge.outward(a)) <= 0.0 {
                    continue;
                }
                let distance = normal.dot(&(tail_b - tail_a));
                if found.is_none_or(|(.., best)| distance > best) {
                    found = Some((Axis::Edges(i, j), normal, distance));
                }
            }
        }
        found
    }
}

/// The point of the region that edge `i` of A and edge `j` of B define.
pub(crate) fn point(
    (a, b): (&Polytope, &Polytope),
    relative: &Relative,
    (i, j): (u32, u32),
    reach: f64,
    region: &mut Region,
) {
    let (edge_a, edge_b) = (&a.edges[i as usize], &b.edges[j as usize]);
    let tail_a = a.vertices[edge_a.tail as usize];
    let along_a = a.vertices[edge_a.head as usize] - tail_a;
    let tail_b = relative.point(&b.vertices[edge_b.tail as usize]);
    let along_b = relative.point(&b.vertices[edge_b.head as usize]) - tail_b;
    let cross = along_a.cross(&along_b);
    let Some((s, t)) = nearest_on_lines(&tail_a, &along_a, &tail_b, &along_b) else { return };
    let outward = edge_a.outward(a);
    region.normal = cross * (cross.dot(&outward).signum() / cross.norm());
    let on_a = tail_a + along_a * s.clamp(0.0, 1.0);
    let on_b = tail_b + along_b * t.clamp(0.0, 1.0);
    let separation = (on_b - on_a).dot(&region.normal);
    if separation < reach {
        let feature = 1 << 63 | u64::from(i) << 32 | u64::from(j);
        region.points.push(RegionPoint { on_a, separation, feature });
    }
}
