//! Which closed shells lie inside others, and as what?

use std::cell::OnceCell;

use crate::asset::Mesh;

use super::BodyRole;
use super::moments::Point;
use super::shells::Shell;
use super::winding::{Element, WindingTree};

/// Among more shells than this only the inside-out ones are looked for: the others stand for themselves anyway.
const MOST_SHELLS: usize = 2_000;

/// A shell of which a larger share than this was turned has no winding of its own to say that it is a cavity.
const DOUBTFUL: f64 = 0.4;

/// Per shell: whether it encloses material, is a cavity within another, a piece within another, or has a rim.
pub(super) fn roles(mesh: &Mesh, shells: &[Shell]) -> Vec<BodyRole> {
    let boxes: Vec<(Point, Point)> = shells.iter().map(|shell| bounds_of(mesh, shell)).collect();
    let trees: Vec<OnceCell<WindingTree>> = shells.iter().map(|_| OnceCell::new()).collect();
    let holds = |outer: usize, inner: usize| {
        let ((low, high), (inner_low, inner_high)) = (boxes[outer], boxes[inner]);
        (0..3).all(|axis| low[axis] < inner_low[axis] && inner_high[axis] < high[axis])
    };
    let winds = |outer: usize, point: Point| {
        let tree = trees[outer].get_or_init(|| tree_of(mesh, &shells[outer]));
        tree.at(point).abs() > 0.5
    };
    let few = shells.len() <= MOST_SHELLS;
    let role = |inner: usize, shell: &Shell| {
        let Some(volume) = shell.volume else { return BodyRole::Open };
        let inside_out = volume.total() < 0.0 && shell.turned <= DOUBTFUL;
        if !inside_out && !few {
            return BodyRole::Outer;
        }
        let point = mesh.positions[shell.triangles[0][0] as usize];
        let within = (0..shells.len()).any(|outer| {
            outer != inner && shells[outer].volume.is_some() && holds(outer, inner) && winds(outer, point)
        });
        match (within, inside_out) {
            (false, _) => BodyRole::Outer,
            (true, true) => BodyRole::Cavity,
            (true, false) => BodyRole::Inner,
        }
    };
    shells.iter().enumerate().map(|(inner, shell)| role(inner, shell)).collect()
}

fn bounds_of(mesh: &Mesh, shell: &Shell) -> (Point, Point) {
    let corners: Vec<Point> =
        shell.triangles.as_flattened().iter().map(|&corner| mesh.positions[corner as usize]).collect();
    super::bounds(&corners)
}

fn tree_of(mesh: &Mesh, shell: &Shell) -> WindingTree {
    let corners = shell.triangles.iter().map(|three| three.map(|corner| mesh.positions[corner as usize]));
    WindingTree::new(corners.map(Element::Triangle).collect())
}
