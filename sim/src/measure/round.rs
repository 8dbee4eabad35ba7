//! Overlaps with cylinders and cones, whose curved side has infinitely many normals.
//!
//! The overlap along a unit direction d is o(d) = h_A(d) + h_B(-d) - d · (x_B - x_A), with h the support functions;
//! the depth is its least value over all d. The search starts from the directions at which it can have a least
//! value and refines the best of them.

use super::posed::Posed;
use crate::math::{Vec3, tangents};

/// Candidates that are refined.
const REFINED: usize = 4;

/// rad: where the refinement starts and ends.
const WIDEST: f64 = 0.3;
const FINEST: f64 = 1e-6;

/// How deep `a` and `b` overlap, m, where that is above `floor`; within 1e-6 of their size, from above.
pub(super) fn overlap(a: &Posed<'_>, b: &Posed<'_>, floor: f64) -> Option<f64> {
    let apart = b.position - a.position;
    let along = |d: &Vec3| a.support(d) + b.support(&-d) - d.dot(&apart);
    let mut tried = Vec::new();
    for direction in candidates(a, b, &apart) {
        for direction in [direction, -direction] {
            let value = along(&direction);
            if value <= floor {
                return None;
            }
            tried.push((value, direction));
        }
    }
    tried.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut least = f64::INFINITY;
    for (value, direction) in tried.into_iter().take(REFINED) {
        least = least.min(refine(&along, value, direction));
        if least <= floor {
            return None;
        }
    }
    (least > floor && least.is_finite()).then_some(least)
}

fn candidates(a: &Posed<'_>, b: &Posed<'_>, apart: &Vec3) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = a.normals.iter().chain(&b.normals).copied().collect();
    found.push(*apart);
    for (one, other) in [(a, b), (b, a)] {
        let Some([lower, upper]) = one.rims() else { continue };
        let axis = one.edges[0];
        // Normal of the side towards `arm`.
        let length = (one.vertices[1] - one.vertices[0]).norm();
        let side = |arm: &Vec3| {
            let outward = arm - axis * axis.dot(arm);
            outward.try_normalize(1e-9).map_or(outward, |unit| unit * length + axis * (lower - upper))
        };
        found.push(axis);
        found.push(side(&if std::ptr::eq(one, a) { *apart } else { -apart }));
        // From the axis to each corner of the other: rim or side against a corner.
        for vertex in &other.vertices {
            let arm = vertex + if std::ptr::eq(one, a) { *apart } else { -apart };
            found.push(side(&arm));
            for end in &one.vertices {
                found.push(arm - end);
            }
        }
        for edge in &other.edges {
            found.push(axis.cross(edge));
        }
    }
    found.iter().filter_map(|direction| direction.try_normalize(1e-9)).collect()
}

/// A pattern search over the sphere.
fn refine(along: &dyn Fn(&Vec3) -> f64, mut value: f64, mut direction: Vec3) -> f64 {
    let mut turn = WIDEST;
    while turn > FINEST {
        let [u, v] = tangents(&direction);
        let steps = [u, -u, v, -v, u + v, u - v, v - u, -u - v];
        let better = steps
            .iter()
            .map(|step| (direction + step * turn).normalize())
            .map(|near| (along(&near), near))
            .min_by(|(a, _), (b, _)| a.total_cmp(b));
        match better {
            Some((lower, near)) if lower < value => (value, direction) = (lower, near),
            _ => turn *= 0.4,
        }
    }
    value
}
