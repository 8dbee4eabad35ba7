//! Parts of the mesh between cuts: from its bodies down to what needs no further cut.

use super::concavity::{Closely, concavity};
use super::decompose::{Context, FINE};
use super::error::Reference;
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::{Plane, Surface};
use super::prepared::{Prepared, Vec3, bounds};
use super::seen::Seen;
use super::{cut, simplify};

/// Triangles on which cuts are searched; the pieces' hulls are of the full mesh.
const SEARCH_TRIANGLES: usize = 6_000;
/// Bodies that start as pieces of their own.
const BODIES: usize = 64;
/// Points, triangles and samples looked at before the cutting ends where it is.
pub(super) const WORK: u64 = 150_000_000;

/// A part of the mesh between cuts.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// No two pieces of a decomposition share it.
    pub name: u32,
    /// On which cuts are searched.
    pub surface: Surface,
    /// The same part of the full mesh, where that is another.
    pub full: Option<Surface>,
    pub seen: Seen,
    /// Its cell: it lies below every one of them.
    pub cuts: Vec<Plane>,
    /// Points within the solid where cuts meet, of which the surface knows nothing.
    pub inner: Vec<Vec3>,
    pub hull: Hull,
    /// Most that each face of the hull reaches beyond the solid.
    pub reaches: Vec<f64>,
    pub concavity: f64,
    /// Where the hull is farthest from the mesh.
    pub deepest: Vec3,
    /// Concavity at which it is cut no further.
    pub aim: f64,
}

/// The mesh as one piece, or its bodies as one each.
pub(super) fn start(context: &Context, reference: &Reference<'_>, aim: f64) -> Vec<Piece> {
    let full = surface_of(reference.mesh);
    let search = simplify::to_triangles(&full, SEARCH_TRIANGLES, context.limit / 2.0);
    let (surface, full) = match search {
        Some(coarse) => (coarse, Some(full)),
        None => (full, None),
    };
    let bodies = surface.components();
    let parts = if bodies.len() <= BODIES { bodies } else { vec![surface] };
    pieces_of(context, parts, full, Cell { seen: &context.seen, cuts: &[], inner: &[], aim })
}

fn surface_of(mesh: &Prepared) -> Surface {
    let solid = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    Surface {
        positions: mesh.positions.clone(),
        triangles: mesh.triangles.iter().filter(solid).copied().collect(),
    }
}

/// What the parts on one side of a cut have in common.
struct Cell<'a> {
    seen: &'a Seen,
    cuts: &'a [Plane],
    inner: &'a [Vec3],
    aim: f64,
}

/// Pieces of connected parts.
fn pieces_of(context: &Context, parts: Vec<Surface>, full: Option<Surface>, cell: Cell<'_>) -> Vec<Piece> {
    let Cell { seen, cuts, inner, aim } = cell;
    let hull_of = |points: &[Vec3]| {
        Hull::of_any(points, context.corners, context.limit * 0.05, THIN).map(|(hull, _)| hull)
    };
    let mut hulls: Vec<Option<Hull>> = parts.iter().map(|part| hull_of(&part.positions)).collect();
    let inners = share_inner(context, inner, &hulls);
    for (hull, inner) in hulls.iter_mut().zip(&inners) {
        if let Some(known) = hull.as_ref().filter(|_| !inner.is_empty()) {
            let points: Vec<Vec3> = known.vertices.iter().chain(inner).copied().collect();
            *hull = hull_of(&points);
        }
    }
    let shares = match full {
        None => vec![None; parts.len()],
        Some(full) => share_out(&full, &hulls, context.limit * 0.5).into_iter().map(Some).collect(),
    };
    let mut pieces = Vec::with_capacity(parts.len());
    for (((surface, hull), full), inner) in parts.into_iter().zip(hulls).zip(shares).zip(inners) {
        // Cuts are searched on a coarse surface, but what they leave is judged on the full one.
        let all = full.as_ref().filter(|full: &&Surface| !full.positions.is_empty());
        let hull = all.map_or(hull, |full| {
            let points: Vec<Vec3> = full.positions.iter().chain(&inner).copied().collect();
            hull_of(&points)
        });
        let Some(hull) = hull else { continue };
        let (low, high) = bounds(&hull.vertices);
        let seen = seen.with(seen.within(low, high));
        let closely = Closely {
            fineness: context.limit * FINE,
            negligible: context.limit * FINE,
            enough: f64::INFINITY,
        };
        let worst = concavity(&hull, &context.field, &seen, cuts, closely, &[]);
        pieces.push(Piece {
            name: context.next_name(),
            surface,
            full,
            seen,
            cuts: cuts.to_vec(),
            inner,
            hull,
            concavity: worst.depth,
            deepest: worst.at,
            reaches: worst.reaches,
            aim,
        });
    }
    pieces
}

/// Gives each inner point to the part it is nearest to, if the way there lies within the solid.
fn share_inner(context: &Context, inner: &[Vec3], hulls: &[Option<Hull>]) -> Vec<Vec<Vec3>> {
    let mut shares: Vec<Vec<Vec3>> = vec![Vec::new(); hulls.len()];
    for p in inner {
        let gap = |hull: &Option<Hull>| hull.as_ref().map_or(f64::INFINITY, |hull| hull.plane_distance(*p));
        let nearest = hulls.iter().map(gap).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((owner, gap)) = nearest.filter(|(_, gap)| gap.is_finite()) else { continue };
        let Some(hull) = &hulls[owner] else { continue };
        let corners = hull.vertices.iter().map(|v| ((v - p).norm_squared(), *v));
        let Some((_, corner)) = corners.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let within = |t: &f64| context.field.distance(p + (corner - p) * *t) <= context.tolerance * 0.5;
        if gap <= 0.0 || [0.25, 0.5, 0.75].iter().all(within) {
            shares[owner].push(*p);
        }
    }
    shares
}

/// Shares the full surface out among the parts that were found on the coarse one: whole components to the
/// hull they lie in, to within `margin`; what hangs together only on the full surface, triangle by triangle.
fn share_out(full: &Surface, hulls: &[Option<Hull>], margin: f64) -> Vec<Surface> {
    if hulls.len() == 1 {
        return vec![full.clone()];
    }
    let mut shares: Vec<Surface> = vec![Surface::default(); hulls.len()];
    let nearest = |points: &[Vec3]| {
        let gap = |hull: &Option<Hull>| {
            hull.as_ref().map_or(f64::INFINITY, |hull| {
                points.iter().map(|p| hull.plane_distance(*p)).fold(f64::NEG_INFINITY, f64::max)
            })
        };
        let gaps = hulls.iter().map(gap).enumerate();
        gaps.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
    };
    for component in full.components() {
        let step = component.positions.len().div_ceil(64).max(1);
        let few: Vec<Vec3> = component.positions.iter().step_by(step).copied().collect();
        let (owner, gap) = nearest(&few);
        if gap <= margin {
            shares[owner].append(&component);
            continue;
        }
        for triangle in &component.triangles {
            let corners = triangle.map(|i| component.positions[i as usize]);
            let one = Surface { positions: corners.to_vec(), triangles: vec![[0, 1, 2]] };
            let (owner, _) = nearest(&corners);
            shares[owner].append(&one);
        }
    }
    shares
}

/// Cuts the worst piece until all keep to the aim, there are `most`, or the work is used up.
pub(super) fn cut_all(
    context: &Context,
    mut open: Vec<Piece>,
    most: usize,
    notes: &mut Vec<String>,
) -> Vec<Piece> {
    let mut done: Vec<Piece> = Vec::new();
    while let Some(worst) = worst_of(&open) {
        let piece = open.swap_remove(worst);
        if piece.concavity <= piece.aim {
            done.push(piece);
            continue;
        }
        if open.len() + done.len() + 1 >= most || context.work.get() > WORK {
            if context.work.get() > WORK {
                let note = "cutting ended by its work limit";
                if !notes.iter().any(|known| known == note) {
                    notes.push(note.to_owned());
                }
            }
            done.push(piece);
            done.append(&mut open);
            break;
        }
        let parts =
            cut::best(context, &piece).map(|plane| divide(context, &piece, plane)).unwrap_or_default();
        if parts.len() < 2 {
            done.push(piece);
        } else {
            open.extend(parts);
        }
    }
    done
}

fn worst_of(pieces: &[Piece]) -> Option<usize> {
    (0..pieces.len()).max_by(|&a, &b| pieces[a].concavity.total_cmp(&pieces[b].concavity).then(b.cmp(&a)))
}

fn divide(context: &Context, piece: &Piece, plane: Plane) -> Vec<Piece> {
    let full = piece.full.as_ref().map(|full| full.cut(&plane));
    let [full_below, full_above] = full.map_or([None, None], |[below, above]| [Some(below), Some(above)]);
    let [below, above] = piece.surface.cut(&plane);
    let mut inner = where_cuts_meet(context, piece, &plane);
    inner.extend(&piece.inner);
    let mut parts = Vec::new();
    for (surface, full, sign) in [(below, full_below, 1.0), (above, full_above, -1.0)] {
        let mut cuts = piece.cuts.clone();
        cuts.push(Plane { normal: plane.normal * sign, offset: plane.offset * sign });
        let on_side = |p: &&Vec3| plane.above(p) * sign <= 1e-6;
        let seen = piece.seen.with(piece.seen.iter().filter(on_side));
        let inner: Vec<Vec3> = inner.iter().filter(on_side).copied().collect();
        let cell = Cell { seen: &seen, cuts: &cuts, inner: &inner, aim: piece.aim };
        parts.extend(pieces_of(context, surface.components(), full, cell));
    }
    parts
}

/// Points within the solid along the lines where `plane` meets the piece's earlier cuts: a surface cut open has
/// no corners there, and hulls without them would leave hollows in the middle of a solid.
fn where_cuts_meet(context: &Context, piece: &Piece, plane: &Plane) -> Vec<Vec3> {
    let mut points = Vec::new();
    for cut in &piece.cuts {
        let across = plane.normal.cross(&cut.normal);
        let square = across.norm_squared();
        if square < 1e-4 {
            continue;
        }
        let direction = across / square.sqrt();
        let origin =
            (cut.normal.cross(&across) * plane.offset + across.cross(&plane.normal) * cut.offset) / square;
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for (normal, offset) in &piece.hull.planes {
            let (along, room) = (normal.dot(&direction), offset + 1e-6 - normal.dot(&origin));
            if along.abs() < 1e-9 {
                if room < 0.0 {
                    last = f64::NEG_INFINITY;
                }
            } else if along > 0.0 {
                last = last.min(room / along);
            } else {
                first = first.max(room / along);
            }
        }
        if !(last > first && (last - first).is_finite()) {
            continue;
        }
        let steps = ((last - first) / context.tolerance * 2.0).ceil().clamp(1.0, 128.0) as usize;
        let along =
            (0..=steps).map(|i| origin + direction * (first + (last - first) * i as f64 / steps as f64));
        points.extend(along.filter(|p| context.field.distance(*p) < 0.0));
    }
    points
}
