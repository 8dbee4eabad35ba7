//! Joining pieces whose common hull is still right.

use super::concavity::concavity;
use super::decompose::{Context, Piece};
use super::hull::Hull;
use super::ladder::THIN;
use super::prepared::{Vec3, bounds};

/// By how much the tolerance is raised at a time where there are too many pieces.
const RAISE: f64 = 1.25;

/// What is known of joining two pieces.
#[derive(Clone, Copy, PartialEq)]
enum Pair {
    /// One of them is no more.
    Gone,
    /// The common hull's concavity.
    Known(f64),
    /// It is above this.
    Above(f64),
}

/// Merges the pair with the least concavity as long as it keeps to the aim; past that, only as far as needed
/// to come down to `most` pieces.
pub(super) fn merge(
    context: &Context,
    pieces: Vec<Piece>,
    most: usize,
    notes: &mut Vec<String>,
) -> Vec<Piece> {
    let mut pieces: Vec<Option<Piece>> = pieces.into_iter().map(Some).collect();
    let mut limit = context.aim;
    // `pairs[j][i]` for i < j.
    let mut pairs: Vec<Vec<Pair>> = Vec::new();
    for j in 0..pieces.len() {
        pairs.push((0..j).map(|i| judge(context, &pieces, i, j, limit)).collect());
    }
    let mut beyond: f64 = 0.0;
    loop {
        let mut best: Option<(f64, usize, usize)> = None;
        for (j, row) in pairs.iter().enumerate() {
            for (i, pair) in row.iter().enumerate() {
                if let Pair::Known(value) = pair
                    && best.is_none_or(|(least, ..)| *value < least)
                {
                    best = Some((*value, i, j));
                }
            }
        }
        let forced = pieces.iter().flatten().count() > most;
        let Some((value, i, j)) = best.filter(|(value, ..)| forced || *value <= context.aim) else {
            if !forced || limit > 2.0 {
                break;
            }
            limit *= RAISE;
            for (j, row) in pairs.iter_mut().enumerate() {
                for (i, pair) in row.iter_mut().enumerate() {
                    if matches!(pair, Pair::Above(known) if *known < limit) {
                        *pair = judge(context, &pieces, i, j, limit);
                    }
                }
            }
            continue;
        };
        let (Some(a), Some(b)) = (pieces[i].take(), pieces[j].take()) else { break };
        if value > context.aim {
            beyond = beyond.max(value);
        }
        let Some(joined) = join(context, a, b, value) else { break };
        pieces[i] = Some(joined);
        for k in 0..pieces.len() {
            if k != j {
                pairs[k.max(j)][k.min(j)] = Pair::Gone;
            }
            if k != i && k != j {
                let (low, high) = (k.min(i), k.max(i));
                pairs[high][low] = judge(context, &pieces, low, high, limit);
            }
        }
    }
    if beyond > 0.0 {
        notes
            .push(format!("merged beyond the tolerance, to concavity {beyond:.4}, to keep to {most} pieces"));
    }
    pieces.into_iter().flatten().collect()
}

fn judge(context: &Context, pieces: &[Option<Piece>], i: usize, j: usize, limit: f64) -> Pair {
    let (Some(a), Some(b)) = (&pieces[i], &pieces[j]) else { return Pair::Gone };
    let (low_a, high_a) = bounds(&a.hull.vertices);
    let (low_b, high_b) = bounds(&b.hull.vertices);
    // Across a wide gap the common hull is far from either, unless other pieces lie between.
    let gap = (low_a - high_b).sup(&(low_b - high_a)).max();
    if gap > limit * 5.0 {
        return Pair::Above(limit);
    }
    let Some(hull) = common_hull(context, a, b) else { return Pair::Gone };
    let cuts: Vec<_> = a.cuts.iter().chain(&b.cuts).copied().collect();
    context.work.set(context.work.get() + 4000);
    let value = concavity(&hull, &context.field, &context.seen, &cuts, context.aim * 0.7, limit).depth;
    if value <= limit { Pair::Known(value) } else { Pair::Above(limit) }
}

fn common_hull(context: &Context, a: &Piece, b: &Piece) -> Option<Hull> {
    let points: Vec<Vec3> = a.hull.vertices.iter().chain(&b.hull.vertices).copied().collect();
    Hull::of_any(&points, context.corners, context.aim * 0.05, THIN).map(|(hull, _)| hull)
}

fn join(context: &Context, mut a: Piece, b: Piece, value: f64) -> Option<Piece> {
    a.hull = common_hull(context, &a, &b)?;
    a.concavity = value;
    a.surface.append(&b.surface);
    match (&mut a.full, b.full) {
        (Some(mine), Some(other)) => mine.append(&other),
        (mine @ None, Some(other)) => *mine = Some(other),
        _ => {}
    }
    a.cuts.extend(b.cuts);
    Some(a)
}
