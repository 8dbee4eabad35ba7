//! Which closed shells lie inside others?

use std::f64::consts::PI;

use crate::asset::Mesh;

use super::moments::{Point, cross, dot, minus, norm};
use super::shells::Shell;

/// Per shell: it is inside out and lies within another closed shell, as a cavity does.
pub(super) fn cavities(mesh: &Mesh, shells: &[Shell]) -> Vec<bool> {
    let boxes: Vec<(Point, Point)> = shells
        .iter()
        .map(|shell| {
            let corners: Vec<Point> = shell
                .triangles
                .as_flattened()
                .iter()
                .map(|&corner| mesh.positions[corner as usize])
                .collect();
            super::bounds(&corners)
        })
        .collect();
    let inside_out = |shell: &Shell| shell.volume.is_some_and(|volume| volume.total() < 0.0) && !shell.turned;
    let holds = |outer: usize, inner: usize| {
        let ((low, high), (inner_low, inner_high)) = (boxes[outer], boxes[inner]);
        (0..3).all(|axis| low[axis] < inner_low[axis] && inner_high[axis] < high[axis])
    };
    shells
        .iter()
        .enumerate()
        .map(|(inner, shell)| {
            inside_out(shell)
                && shells.iter().enumerate().any(|(outer, other)| {
                    outer != inner
                        && other.volume.is_some()
                        && holds(outer, inner)
                        && winding(mesh, other, mesh.positions[shell.triangles[0][0] as usize]).abs() > 0.5
                })
        })
        .collect()
}

/// How often the shell winds around the point: the sum of its triangles' solid angles over 4 π.
///
/// A. van Oosterom, J. Strackee, The Solid Angle of a Plane Triangle, 1983.
fn winding(mesh: &Mesh, shell: &Shell, point: Point) -> f64 {
    let angle: f64 = shell
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|corner| minus(mesh.positions[corner as usize], point));
            let (la, lb, lc) = (norm(a), norm(b), norm(c));
            let across = dot(a, cross(b, c));
            let along = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            2.0 * across.atan2(along)
        })
        .sum();
    angle / (4.0 * PI)
}
