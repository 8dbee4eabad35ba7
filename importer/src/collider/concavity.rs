//! How far a hull is from what it stands for.

use super::field::Field;
use super::hull::Hull;
use super::piece::Plane;
use super::prepared::{Vec3, bounds};

/// The largest gap between a hull and the solid, and where it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Concavity {
    pub depth: f64,
    pub at: Vec3,
}

/// How far the hull of a piece is from the piece: the larger of how far the hull's surface reaches beyond
/// the solid, and how deep a seen point of the mesh lies under the hull's surface. `planes` are cuts, where
/// the hull's surface is no outer one. Left off early above `enough`.
pub(super) fn concavity(
    hull: &Hull,
    field: &Field,
    seen: &[Vec3],
    planes: &[Plane],
    fineness: f64,
    enough: f64,
) -> Concavity {
    let mut worst = growth(hull, field, fineness, enough);
    if worst.depth > enough {
        return worst;
    }
    let outer: Vec<(Vec3, f64)> =
        hull.planes.iter().filter(|face| !planes.iter().any(|cut| cut.holds(face))).copied().collect();
    let (low, high) = bounds(&hull.vertices);
    for p in seen {
        if (0..3).any(|k| p[k] < low[k] || p[k] > high[k]) {
            continue;
        }
        let mut depth = f64::INFINITY;
        for (n, d) in &outer {
            depth = depth.min(d - n.dot(p));
            if depth <= worst.depth {
                break;
            }
        }
        if depth > worst.depth && depth.is_finite() && hull.plane_distance(*p) <= 0.0 {
            worst = Concavity { depth, at: *p };
        }
    }
    worst
}

/// Largest distance from the hull's surface to the solid, by bisecting faces: the distance changes no faster
/// than the place does, so a face whose middle is near and that is small cannot hold a farther point. Faces
/// smaller than `fineness` are not looked into, nor are those that cannot hold more than `fineness`.
fn growth(hull: &Hull, field: &Field, fineness: f64, enough: f64) -> Concavity {
    let mut best = Concavity { depth: 0.0, at: Vec3::zeros() };
    // The square of the reach, and the distance at the middle.
    let look = |[a, b, c]: &[Vec3; 3]| {
        let middle = (a + b + c) / 3.0;
        let reach =
            (a - middle).norm_squared().max((b - middle).norm_squared()).max((c - middle).norm_squared());
        (field.distance(middle), reach)
    };
    let mut open: Vec<([Vec3; 3], f64, f64)> = hull
        .face_points()
        .map(|face| {
            let (here, reach) = look(&face);
            (face, here, reach)
        })
        .collect();
    // The farthest is popped first: it saves looking into the others.
    open.sort_by(|a, b| a.1.total_cmp(&b.1));
    while let Some(([a, b, c], here, reach)) = open.pop() {
        if here > best.depth {
            best = Concavity { depth: here, at: (a + b + c) / 3.0 };
        }
        if best.depth > enough {
            return best;
        }
        if reach < fineness * fineness || here + reach.sqrt() <= best.depth.max(fineness) {
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
            let (here, reach) = look(&half);
            open.push((half, here, reach));
        }
    }
    best
}
