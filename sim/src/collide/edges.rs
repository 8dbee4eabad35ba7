//! The axis that an edge of each of two polytopes defines.

use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint, nearest_on_lines};
use crate::collide::relative::Relative;
use crate::collide::sat::Axis;
use crate::math::Vec3;

/// The common normal of edge `i` of A and edge `j` of B, from A to B in the frame of A, and how far it parts them.
pub(crate) fn normal(
    (a, b): (&Polytope, &Polytope),
    relative: &Relative,
    (i, j): (u32, u32),
) -> Option<(Axis, Vec3, f64)> {
    let (edge_a, edge_b) = (&a.edges[i as usize], &b.edges[j as usize]);
    let tail_a = a.vertices[edge_a.tail as usize];
    let along_a = a.vertices[edge_a.head as usize] - tail_a;
    let tail_b = b.vertices[edge_b.tail as usize];
    let along_b = relative.rotation * (b.vertices[edge_b.head as usize] - tail_b);
    let cross = along_a.cross(&along_b).try_normalize(0.0)?;
    // Outward of A is inward of B; one of the two has no say where it is a sheet.
    let sense = cross.dot(&(edge_a.outward(a) - relative.rotation * edge_b.outward(b)));
    let normal = cross * sense.signum();
    Some((Axis::Edges(i, j), normal, normal.dot(&(relative.point(&tail_b) - tail_a))))
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
