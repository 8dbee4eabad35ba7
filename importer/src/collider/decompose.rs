//! Approximate convex decomposition by recursive plane cuts.
//!
//! The piece whose hull is farthest from the mesh is cut by the plane that leaves least to do, its connected
//! parts become pieces, until every hull keeps to the tolerance; neighbours whose common hull keeps to it
//! too are then merged. Cuts are exact, so hulls hug the mesh and nothing is left outside. The idea of
//! cutting by collision-aware concavity is CoACD's (Wei et al., SIGGRAPH 2022); measuring it on a distance
//! grid, cutting where concave edges and walls lie, and splitting loose parts at once are what make it fast.

use super::concavity::concavity;
use super::error::Reference;
use super::field::Field;
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::{Plane, Surface};
use super::prepared::{Prepared, Vec3, bounds};
use super::{cut, merge, simplify};
use crate::Options;

/// Share of the tolerance that pieces aim at: what is left is for the corners a hull is not given.
const AIM: f64 = 0.85;
/// Most corners of a piece's hull, whatever the budget of a single hull.
const PIECE_CORNERS: usize = 32;
/// Triangles on which cuts are searched; the pieces' hulls are of the full mesh.
const SEARCH_TRIANGLES: usize = 6_000;
/// Bodies that start as pieces of their own.
const BODIES: usize = 64;
/// Points, triangles and samples looked at before the cutting ends where it is.
const WORK: u64 = 250_000_000;
/// A decomposition, and what went wrong on the way.
pub(super) struct Decomposition {
    pub pieces: Vec<Hull>,
    pub fallback: Option<String>,
}

/// What every step needs to know.
pub(super) struct Context {
    pub field: Field,
    /// Largest concavity a piece may keep.
    pub aim: f64,
    pub corners: usize,
    /// All points of the mesh that can be seen from outside, of those at which errors are measured.
    pub seen: Vec<Vec3>,
    pub work: std::cell::Cell<u64>,
}

/// A part of the mesh between cuts.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// On which cuts are searched.
    pub surface: Surface,
    /// The same part of the full mesh, where that is another.
    pub full: Option<Surface>,
    pub seen: Vec<Vec3>,
    pub cuts: Vec<Plane>,
    pub hull: Hull,
    pub concavity: f64,
    /// Where the hull is farthest from the mesh.
    pub deepest: Vec3,
}

pub(super) fn decompose(reference: &Reference<'_>, options: &Options) -> Decomposition {
    let mesh = reference.mesh;
    let mut notes: Vec<String> = Vec::new();
    let tolerance = options.collider_tolerance.clamp(1e-3, 0.2);
    // Two cells within the tolerance tell a gap of that size from none.
    let wanted = (1.2 * mesh.size.max() / tolerance).ceil() as u32;
    let context = Context {
        field: Field::new(mesh, wanted.clamp(16, options.decomposition_resolution.max(16))),
        aim: tolerance * AIM,
        corners: options.hull_vertices.clamp(8, PIECE_CORNERS),
        seen: reference.samples.seen_points().collect(),
        work: std::cell::Cell::new(0),
    };
    let most = options.decomposition_pieces.max(1);
    let done = cut_all(&context, start(&context, reference), most * 3, &mut notes);
    let pieces = merge::merge(&context, done, most, &mut notes);
    let pieces = finish(&context, pieces, &mut notes);
    Decomposition { pieces, fallback: (!notes.is_empty()).then(|| notes.join("; ")) }
}

/// The mesh as one piece, or its bodies as one each.
fn start(context: &Context, reference: &Reference<'_>) -> Vec<Piece> {
    let full = surface_of(reference.mesh);
    let search = simplify::to_triangles(&full, SEARCH_TRIANGLES, context.aim / 2.0);
    let (surface, full) = match search {
        Some(coarse) => (coarse, Some(full)),
        None => (full, None),
    };
    let bodies = surface.components();
    let parts = if bodies.len() <= BODIES { bodies } else { vec![surface] };
    pieces_of(context, parts, full, &context.seen, &[])
}

fn surface_of(mesh: &Prepared) -> Surface {
    let solid = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    Surface {
        positions: mesh.positions.clone(),
        triangles: mesh.triangles.iter().filter(solid).copied().collect(),
    }
}

/// Pieces of connected parts.
fn pieces_of(
    context: &Context,
    parts: Vec<Surface>,
    full: Option<Surface>,
    seen: &[Vec3],
    cuts: &[Plane],
) -> Vec<Piece> {
    let hulls: Vec<Option<Hull>> = parts
        .iter()
        .map(|part| {
            Hull::of_any(&part.positions, context.corners, context.aim * 0.05, THIN).map(|(hull, _)| hull)
        })
        .collect();
    let shares = match full {
        None => vec![None; parts.len()],
        Some(full) => share_out(&full, &hulls, context.aim * 0.5).into_iter().map(Some).collect(),
    };
    let mut pieces = Vec::with_capacity(parts.len());
    for ((surface, hull), full) in parts.into_iter().zip(hulls).zip(shares) {
        let Some(hull) = hull else { continue };
        let (low, high) = bounds(&hull.vertices);
        let near = |p: &&Vec3| (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]);
        let seen: Vec<Vec3> = seen.iter().filter(near).copied().collect();
        let worst = concavity(&hull, &context.field, &seen, cuts, context.aim * 0.7, f64::INFINITY);
        pieces.push(Piece {
            surface,
            full,
            seen,
            cuts: cuts.to_vec(),
            hull,
            concavity: worst.depth,
            deepest: worst.at,
        });
    }
    pieces
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
fn cut_all(context: &Context, mut open: Vec<Piece>, most: usize, notes: &mut Vec<String>) -> Vec<Piece> {
    let mut done: Vec<Piece> = Vec::new();
    while let Some(worst) = worst_of(&open) {
        let piece = open.swap_remove(worst);
        if piece.concavity <= context.aim {
            done.push(piece);
            continue;
        }
        if open.len() + done.len() + 1 >= most || context.work.get() > WORK {
            if context.work.get() > WORK {
                notes.push(format!("cutting ended by its work limit at concavity {:.4}", piece.concavity));
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
    let mut cuts = piece.cuts.clone();
    cuts.push(plane);
    let full = piece.full.as_ref().map(|full| full.cut(&plane));
    let [full_below, full_above] = full.map_or([None, None], |[below, above]| [Some(below), Some(above)]);
    let [below, above] = piece.surface.cut(&plane);
    let mut parts = Vec::new();
    for (surface, full, sign) in [(below, full_below, -1.0), (above, full_above, 1.0)] {
        let seen: Vec<Vec3> = piece.seen.iter().filter(|p| plane.above(p) * sign >= -1e-6).copied().collect();
        parts.extend(pieces_of(context, surface.components(), full, &seen, &cuts));
    }
    parts
}

/// Hulls of the full mesh's points within the budget of corners; those inside another are left out.
fn finish(context: &Context, pieces: Vec<Piece>, notes: &mut Vec<String>) -> Vec<Hull> {
    let mut hulls: Vec<Hull> = Vec::new();
    let mut thickened = 0;
    for piece in &pieces {
        let full = piece.full.as_ref().filter(|full| !full.positions.is_empty());
        let points = full.map_or(&piece.surface.positions, |full| &full.positions);
        if let Some((hull, thick)) = Hull::of_any(points, context.corners, 5e-4, THIN) {
            thickened += usize::from(thick);
            hulls.push(hull.balanced());
        }
    }
    if thickened > 0 {
        notes.push(format!("{thickened} flat pieces thickened to {} % of the diagonal", THIN * 100.0));
    }
    let mut kept: Vec<Hull> = Vec::new();
    hulls.sort_by(|a, b| b.volume().total_cmp(&a.volume()));
    for hull in hulls {
        let inside = |other: &Hull| hull.vertices.iter().all(|v| other.plane_distance(*v) < 1e-4);
        if !kept.iter().any(inside) {
            kept.push(hull);
        }
    }
    kept
}
