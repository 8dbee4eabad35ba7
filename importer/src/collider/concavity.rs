//! How far a hull is from what it stands for.

use super::field::Field;
use super::hull::Hull;
use super::piece::Plane;
use super::prepared::{Vec3, bounds};
use super::seen::Seen;

/// The largest gap between a hull and the solid, and where it is.
#[derive(Clone, Debug)]
pub(super) struct Concavity {
    pub depth: f64,
    pub at: Vec3,
    /// Most that each face of the hull reaches beyond the solid; only where nothing was left off.
    pub reaches: Vec<f64>,
}

/// How closely a hull is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closely {
    /// Faces smaller than this are not looked into.
    pub fineness: f64,
    /// Reaches below this are not told apart.
    pub negligible: f64,
    /// Left off early above this.
    pub enough: f64,
}

/// How far the hull of a piece is from the piece: the larger of how far the hull's surface reaches beyond
/// the solid, and how deep a seen point of the mesh lies under the hull's surface. `planes` are cuts, where
/// the hull's surface is no outer one; `known` are the reaches of the hull's first faces that are known already,
/// empty where none is.
pub(super) fn concavity(
    hull: &Hull,
    field: &Field,
    seen: &Seen,
    planes: &[Plane],
    closely: Closely,
    known: &[Option<f64>],
) -> Concavity {
    let mut worst = growth(hull, field, closely, known);
    if worst.depth > closely.enough {
        return worst;
    }
    let outer: Vec<(Vec3, f64)> =
        hull.planes.iter().filter(|face| !planes.iter().any(|cut| cut.holds(face))).copied().collect();
    let (low, high) = bounds(&hull.vertices);
    // The face that the point before lay close to is asked first: it mostly settles the next as well.
    let mut near = (Vec3::zeros(), f64::INFINITY);
    for p in seen.within(low, high) {
        if near.1 - near.0.dot(p) <= worst.depth {
            continue;
        }
        let mut depth = f64::INFINITY;
        for face @ (n, d) in &outer {
            depth = depth.min(d - n.dot(p));
            if depth <= worst.depth {
                near = *face;
                break;
            }
        }
        if depth > worst.depth && depth.is_finite() && hull.plane_distance(*p) <= 0.0 {
            worst.depth = depth;
            worst.at = *p;
            if depth > closely.enough {
                break;
            }
        }
    }
    worst
}

/// A part of a face that waits to be looked into.
struct Part {
    corners: [Vec3; 3],
    face: usize,
    /// Distance to the solid at the middle.
    here: f64,
    /// Square of the distance from the middle to the farthest corner.
    radius: f64,
}

impl Part {
    fn new(corners: [Vec3; 3], face: usize, field: &Field) -> Self {
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let [a, b, c] = corners.map(|corner| (corner - middle).norm_squared());
        Self { corners, face, here: field.distance(middle), radius: a.max(b).max(c) }
    }
}

/// Largest distance from the hull's surface to the solid, by bisecting faces: the distance changes no faster
/// than the place does, so a face whose middle is near and that is small cannot hold a farther point.
fn growth(hull: &Hull, field: &Field, closely: Closely, known: &[Option<f64>]) -> Concavity {
    let known_of = |face: usize| known.get(face).copied().flatten();
    let mut best = Concavity { depth: 0.0, at: Vec3::zeros(), reaches: vec![0.0; hull.faces.len()] };
    let mut open: Vec<Part> = Vec::with_capacity(2 * hull.faces.len());
    for (face, corners) in hull.face_points().enumerate() {
        match known_of(face) {
            Some(reach) => {
                best.reaches[face] = reach;
                best.depth = best.depth.max(reach);
            }
            None => open.push(Part::new(corners, face, field)),
        }
    }
    if best.depth > closely.enough {
        return best;
    }
    // The farthest is popped first: it saves looking into the others.
    open.sort_by(|a, b| a.here.total_cmp(&b.here));
    while let Some(Part { corners: [a, b, c], face, here, radius }) = open.pop() {
        if here > best.depth {
            best.depth = here;
            best.at = (a + b + c) / 3.0;
            if here > closely.enough {
                return best;
            }
        }
        let reach = &mut best.reaches[face];
        *reach = reach.max(here);
        let most = here + radius.sqrt();
        let enough = most <= best.depth.max(closely.negligible);
        if enough || radius < closely.fineness * closely.fineness {
            if enough {
                *reach = reach.max(most);
            }
            continue;
        }
        // The longest side is halved, so that slivers turn into round faces.
        let sides = [(b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared()];
        let halves = if sides[0] >= sides[1] && sides[0] >= sides[2] {
            let m = (a + b) / 2.0;
            [[a, m, c], [m, b, c]]
        } else if sides[1] >= sides[2] {
            let m = (b + c) / 2.0;
            [[b, m, a], [m, c, a]]
        } else {
            let m = (c + a) / 2.0;
            [[c, m, b], [m, a, b]]
        };
        for half in halves {
            let part = Part::new(half, face, field);
            let most = part.here + part.radius.sqrt();
            if part.here <= best.depth && most <= best.depth.max(closely.negligible) {
                best.reaches[face] = best.reaches[face].max(most);
            } else {
                open.push(part);
            }
        }
    }
    best
}
