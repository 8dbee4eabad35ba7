//! The choice of the plane by which a piece is cut.

use super::atoms::Piece;
use super::concavity::{Closely, concavity};
use super::decompose::Context;
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::Plane;
use super::planes;
use super::prepared::Vec3;
use super::seen::Seen;

/// How much worse a cut is that slices along the wall over a void, in what of the void it leaves.
const SLICED: f64 = 1.5;
/// Cuts that are judged closely.
const CLOSELY: usize = 6;
/// A cut that leaves a part with more than this share of the concavity gets nowhere.
const STUCK: f64 = 0.9;

/// The plane that leaves least to do: all candidates are judged roughly, the best few of them closely.
///
/// On a round shell no single cut helps, and what leaves least to do is to shave off a sliver, again and
/// again, or to slice it into rings. A cut that leaves a part about as concave as the whole is therefore
/// replaced by one through the place where the hull is farthest from the mesh.
pub(super) fn best(context: &Context, piece: &Piece) -> Option<Plane> {
    let mut planes = planes::candidates(&piece.surface, context.middle);
    let found = search(context, piece, &planes, Goal::LeastLeft)?;
    if found.worst < STUCK * piece.concavity {
        return Some(found.plane);
    }
    planes.extend((0..3).map(|axis| Plane { normal: Vec3::ith(axis, 1.0), offset: piece.deepest[axis] }));
    search(context, piece, &planes, Goal::Open).map(|cut| cut.plane)
}

fn search(context: &Context, piece: &Piece, planes: &[Plane], goal: Goal) -> Option<Cut> {
    let seen = piece.seen.thinned(100);
    let rough = Judge { context, piece, goal, seen, corners: context.corners.min(16), spacing: 0.04 };
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

    let seen = piece.seen.thinned(400);
    let close = Judge { context, piece, goal, seen, corners: context.corners, spacing: 0.02 };
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
    /// Little concavity left in the worst part, sides of like size, and a cut through the widest void.
    Open,
}

/// A cut that was judged.
#[derive(Clone, Copy)]
struct Cut {
    plane: Plane,
    /// Less is better; depends on the goal.
    score: f64,
    /// Concavity of the worst part.
    worst: f64,
}

/// How closely a cut is looked at.
struct Judge<'a> {
    context: &'a Context,
    piece: &'a Piece,
    goal: Goal,
    seen: Seen,
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
                let (hull, _) = Hull::of_any(points, self.corners, context.limit * 0.1, THIN)?;
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
        let mut score = 0.1 * piece.aim * hulls.len() as f64 + 0.05 * piece.concavity * both / whole;
        if self.goal == Goal::Open {
            let gap = plane.above(&piece.deepest).abs();
            score += gap + 0.3 * piece.concavity * (largest - 0.5);
            // Along the wall that spans the void a cut shaves off a slice and leaves the void as wide as it was.
            if context.is_shell && piece.hull.plane_distance(piece.deepest) > -1e-6 {
                let along = plane.normal.dot(&piece.hull.wall_at(&piece.deepest)).powi(8);
                score += SLICED * along * (piece.concavity - gap).max(0.0);
            }
        }
        let mut worst: f64 = 0.0;
        for hull in &hulls {
            // What this part may have before the cut is no longer among the best.
            let enough = match self.goal {
                Goal::LeastLeft => limit - score,
                Goal::Open => limit - score + worst,
            };
            let closely = Closely { fineness: self.spacing, negligible: self.spacing, enough };
            let left = concavity(hull, &context.field, &self.seen, &cuts, closely, &[]).depth;
            score += match self.goal {
                Goal::LeastLeft if left <= piece.aim => 0.15 * left,
                Goal::LeastLeft => left,
                Goal::Open => left.max(worst) - worst,
            };
            worst = worst.max(left);
            if score >= limit {
                return None;
            }
        }
        Some(Cut { plane: *plane, score, worst })
    }
}
