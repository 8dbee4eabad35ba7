//! Approximate convex decomposition by recursive plane cuts.
//!
//! The piece whose hull is farthest from the mesh is cut by the plane that leaves least to do, its connected
//! parts become pieces, until every hull keeps to the tolerance; neighbours whose common hull keeps to it
//! too are then merged. Cuts are exact, so hulls hug the mesh and nothing is left outside. The idea of
//! cutting by collision-aware concavity is CoACD's (Wei et al., SIGGRAPH 2022); measuring it on a distance
//! grid, cutting where concave edges and walls lie, and splitting loose parts at once are what make it fast.

use super::error::Reference;
use super::field::Field;
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::{Plane, Surface, concavity};
use super::prepared::{Prepared, Vec3, bounds};
use super::{merge, planes, simplify};
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
/// Cuts that are judged closely.
const CLOSELY: usize = 6;
/// A cut that leaves more than this share of the volume on one side,
const SHAVED: f64 = 0.85;
/// and a part with more than this share of the concavity, gets nowhere.
const STUCK: f64 = 0.9;

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
        corners: options.hull_vertices.min(PIECE_CORNERS).max(8),
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

/// Pieces of connected parts; each full component goes to the part it lies in or nearest to.
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
    let mut shares: Vec<Option<Surface>> = vec![None; parts.len()];
    if let Some(full) = full {
        if let [only] = shares.as_mut_slice() {
            *only = Some(full);
        } else {
            for component in full.components() {
                let step = component.positions.len().div_ceil(64).max(1);
                let gap = |hull: &Option<Hull>| {
                    hull.as_ref().map_or(f64::INFINITY, |hull| {
                        let points = component.positions.iter().step_by(step);
                        points.map(|p| hull.plane_distance(*p)).fold(f64::NEG_INFINITY, f64::max)
                    })
                };
                let nearest = (0..hulls.len()).min_by(|&a, &b| gap(&hulls[a]).total_cmp(&gap(&hulls[b])));
                if let Some(share) = nearest.map(|i| shares[i].get_or_insert_with(Surface::default)) {
                    let offset = share.positions.len() as u32;
                    share.positions.extend(component.positions);
                    share.triangles.extend(component.triangles.iter().map(|t| t.map(|i| i + offset)));
                }
            }
        }
    }
    let mut pieces = Vec::with_capacity(parts.len());
    for ((surface, hull), full) in parts.into_iter().zip(hulls).zip(shares) {
        let Some(hull) = hull else { continue };
        let (low, high) = bounds(&hull.vertices);
        let near = |p: &&Vec3| (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]);
        let seen: Vec<Vec3> = seen.iter().filter(near).copied().collect();
        let worst = concavity(&hull, &context.field, &seen, cuts, context.aim * 0.7, f64::INFINITY);
        pieces.push(Piece { surface, full, seen, cuts: cuts.to_vec(), hull, concavity: worst });
    }
    pieces
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
        let parts = best_cut(context, &piece).map(|plane| divide(context, &piece, plane)).unwrap_or_default();
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

/// The plane that leaves least to do: all candidates are judged roughly, the best few of them closely.
///
/// On a round shell no single cut helps, and what leaves least to do is to shave off a sliver, again and
/// again. A cut that leaves a part as large and as concave as the whole is therefore replaced by one that
/// halves.
fn best_cut(context: &Context, piece: &Piece) -> Option<Plane> {
    let planes = planes::candidates(&piece.surface);
    let best = search(context, piece, &planes, Goal::LeastLeft)?;
    if best.largest < SHAVED || best.worst < STUCK * piece.concavity {
        return Some(best.plane);
    }
    search(context, piece, &planes, Goal::Halves).map(|cut| cut.plane)
}

fn search(context: &Context, piece: &Piece, planes: &[Plane], goal: Goal) -> Option<Cut> {
    let thinned = |count: usize| -> Vec<Vec3> {
        piece.seen.iter().step_by(piece.seen.len().div_ceil(count).max(1)).copied().collect()
    };
    let rough =
        Judge { context, piece, goal, seen: thinned(100), corners: context.corners.min(16), spacing: 0.04 };
    let mut candidates: Vec<Cut> = Vec::new();
    for plane in planes {
        // Only what may come among the best few is judged to the end.
        let limit = candidates.get(CLOSELY - 1).map_or(f64::INFINITY, |cut| cut.score);
        if let Some(cut) = rough.judge(plane, limit) {
            let place = candidates.partition_point(|known| known.score <= cut.score);
            candidates.insert(place, cut);
            candidates.truncate(CLOSELY);
        }
    }

    let close = Judge { context, piece, goal, seen: thinned(400), corners: context.corners, spacing: 0.02 };
    let mut best: Option<Cut> = None;
    let consider = |plane: &Plane, best: &mut Option<Cut>| {
        let limit = best.map_or(f64::INFINITY, |cut| cut.score);
        if let Some(cut) = close.judge(plane, limit) {
            *best = Some(cut);
        }
    };
    for cut in &candidates {
        consider(&cut.plane, &mut best);
    }
    if let Some(cut) = best {
        for moved in planes::around(&cut.plane, &piece.surface) {
            consider(&moved, &mut best);
        }
    }
    best
}

/// What a good cut is.
#[derive(Clone, Copy, PartialEq)]
enum Goal {
    /// Little concavity left in all parts together.
    LeastLeft,
    /// Little concavity left in the worst part, and sides of like size.
    Halves,
}

/// A cut that was judged.
#[derive(Clone, Copy)]
struct Cut {
    plane: Plane,
    /// Less is better; depends on the goal.
    score: f64,
    /// Concavity of the worst part.
    worst: f64,
    /// Share of the larger side in the volume of both sides' hulls.
    largest: f64,
}

/// How closely a cut is looked at.
struct Judge<'a> {
    context: &'a Context,
    piece: &'a Piece,
    goal: Goal,
    seen: Vec<Vec3>,
    corners: usize,
    /// At which the hulls' surface is looked at.
    spacing: f64,
}

impl Judge<'_> {
    /// `None` where the cut parts nothing, or scores no less than `limit`.
    fn judge(&self, plane: &Plane, limit: f64) -> Option<Cut> {
        let Self { context, piece, .. } = self;
        let sides = piece.surface.cut_points(plane);
        let looked_at = 2 * piece.surface.triangles.len() + 6 * piece.surface.positions.len() + 2000;
        context.work.set(context.work.get() + looked_at as u64);
        if sides.iter().any(Vec::is_empty) {
            return None;
        }
        let mut hulls: Vec<Hull> = Vec::new();
        let mut volumes = [0.0; 2];
        for (side, volume) in sides.iter().zip(&mut volumes) {
            for points in side {
                let (hull, _) = Hull::of_any(points, self.corners, context.aim * 0.15, THIN)?;
                *volume += hull.volume();
                hulls.push(hull);
            }
        }
        let both = (volumes[0] + volumes[1]).max(1e-12);
        let largest = volumes[0].max(volumes[1]) / both;
        let mut cuts = piece.cuts.clone();
        cuts.push(*plane);

        // A little for every part and for the volume, so that equals are told apart.
        let whole = piece.hull.volume().max(1e-12);
        let mut score = 0.1 * context.aim * hulls.len() as f64 + 0.05 * piece.concavity * both / whole;
        if self.goal == Goal::Halves {
            score += piece.concavity * (largest - 0.5);
        }
        let mut worst: f64 = 0.0;
        for hull in &hulls {
            // What this part may have before the cut is no longer among the best.
            let enough = match self.goal {
                Goal::LeastLeft => limit - score,
                Goal::Halves => limit - score + worst,
            };
            let left = concavity(hull, &context.field, &self.seen, &cuts, self.spacing, enough);
            score += match self.goal {
                Goal::LeastLeft if left <= context.aim => 0.15 * left,
                Goal::LeastLeft => left,
                Goal::Halves => left.max(worst) - worst,
            };
            worst = worst.max(left);
            if score >= limit {
                return None;
            }
        }
        Some(Cut { plane: *plane, score, worst, largest })
    }
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
