//! The fifteen axes of two boxes in closed form (Gottschalk, Lin and Manocha 1996, "OBBTree", section 5).

use crate::collide::polytope::Polytope;
use crate::collide::relative::Relative;
use crate::collide::sat::Axis;
use crate::math::Vec3;

/// Square of the sine below which two edges count as parallel: their faces then say it all.
const PARALLEL: f64 = 1e-8;

/// Signed distances of the faces of box A from box B, and then of B's from A, in the order of
/// [`Polytope::cuboid`].
pub(crate) fn face_distances(half_a: &Vec3, half_b: &Vec3, relative: &Relative, out: &mut Vec<f32>) {
    let reach = relative.rotation.abs();
    let seen_from_b = relative.rotation.tr_mul(&relative.translation);
    let sides = |center: f64, extent: f64| [center - extent, -center - extent];
    #[expect(clippy::cast_possible_truncation, reason = "it decides between axes, no more")]
    let mut push = |[low, high]: [f64; 2]| out.extend([low as f32, high as f32]);
    let (extent_a, extent_b) = (half_a + reach * half_b, half_b + reach.tr_mul(half_a));
    for axis in 0..3 {
        push(sides(relative.translation[axis], extent_a[axis]));
    }
    for axis in 0..3 {
        push(sides(-seen_from_b[axis], extent_b[axis]));
    }
}

/// The pair of edges whose common normal parts the boxes most, with that normal from A to B and the distance along it.
pub(crate) fn best_edges(
    (a, half_a): (&Polytope, &Vec3),
    (b, half_b): (&Polytope, &Vec3),
    relative: &Relative,
) -> Option<(Axis, Vec3, f64)> {
    let (r, t) = (&relative.rotation, &relative.translation);
    let mut best: Option<(usize, usize, f64)> = None;
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            let square = r[(i1, j)] * r[(i1, j)] + r[(i2, j)] * r[(i2, j)];
            if square <= PARALLEL {
                continue;
            }
            let between = t[i2] * r[(i1, j)] - t[i1] * r[(i2, j)];
            let extent_a = half_a[i1] * r[(i2, j)].abs() + half_a[i2] * r[(i1, j)].abs();
            let extent_b = half_b[j1] * r[(i, j2)].abs() + half_b[j2] * r[(i, j1)].abs();
            let distance = (between.abs() - extent_a - extent_b) / square.sqrt();
            if best.is_none_or(|(.., most)| distance > most) {
                best = Some((i, j, distance));
            }
        }
    }
    let (i, j, distance) = best?;
    let axis_b = r.column(j);
    let cross = Vec3::ith(i, 1.0).cross(&axis_b);
    let normal = cross.normalize() * cross.dot(t).signum();
    let edge_a = edge(a, i, &normal)?;
    let edge_b = edge(b, j, &-r.tr_mul(&normal))?;
    Some((Axis::Edges(edge_a, edge_b), normal, distance))
}

/// The edge along `axis` that lies farthest in `direction`.
fn edge(cuboid: &Polytope, axis: usize, direction: &Vec3) -> Option<u32> {
    let side = |k: usize| u32::from(k != axis && direction[k] > 0.0) << k;
    let tail = side(0) | side(1) | side(2);
    let head = tail | 1 << axis;
    (0..).zip(&cuboid.edges).find(|(_, edge)| (edge.tail, edge.head) == (tail, head)).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::collide::sat::SatBuffers;
    use crate::math::Quat;

    proptest! {
        #[test]
        fn boxes_in_closed_form_are_as_far_apart_as_any_polytopes(
            turn in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64], at in [-1.5..1.5_f64, -1.5..1.5_f64, -1.5..1.5_f64]
        ) {
            let relative = Relative {
                rotation: *Quat::from_scaled_axis(turn.into()).to_rotation_matrix().matrix(),
                translation: at.into(),
            };
            let (a, b) = (Polytope::cuboid(&Vec3::new(0.5, 0.3, 0.8)), Polytope::cuboid(&Vec3::new(0.4, 0.6, 0.2)));
            let forget = |mut polytope: Polytope| {
                polytope.half_extents = None;
                polytope
            };
            let mut sat = SatBuffers::default();
            let ours = sat.separation((&a, &b), &relative, (10.0, f64::INFINITY), 0.0, None);
            let any = sat.separation((&forget(a), &forget(b)), &relative, (10.0, f64::INFINITY), 0.0, None);
            prop_assert!((ours.distance - any.distance).abs() < 1e-6, "{ours:?} {any:?}");
            if ours.axis != any.axis {
                prop_assert!(ours.lead.min(any.lead) < 1e-5, "{ours:?} {any:?}");
            }
        }
    }
}
