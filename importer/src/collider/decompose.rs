//! Approximate convex decomposition by recursive plane cuts.
//!
//! The piece whose hull is farthest from the mesh is cut by the plane that leaves least to do, its connected
//! parts become pieces, until every hull keeps to the tolerance; neighbours whose common hull keeps to it
//! too are then merged. Cuts are exact, so hulls hug the mesh and nothing is left outside. The idea of
//! cutting by collision-aware concavity is CoACD's (Wei et al., SIGGRAPH 2022); measuring it on a distance
//! grid, cutting where concave edges and walls lie, and splitting loose parts at once are what make it fast.

use super::ColliderError;
use super::atoms::{Piece, WORK, cut_all, start};
use super::error::{PieceError, REACH, Reference};
use super::field::Field;
use super::finish::{SHARE, finish, without_covered};
use super::group::{self, Group, Verdicts};
use super::hull::Hull;
use super::needless::without_needless;
use super::prepared::Vec3;
use super::seen::Seen;
use super::solid::Solid;
use crate::Options;

/// Concavity a piece may have, in tolerances: its walls are moved inwards afterwards, to err to both sides.
const LIMIT: f64 = 2.0;
/// Share of the limit at which parts are cut no further: finer parts leave more ways to join them.
const AIM: f64 = 0.9;
/// Share of the error allowed at which a smaller limit aims.
const FINER: f64 = 0.97;
/// Most parts between cuts: joining them takes time with the square of their number.
const ATOMS: usize = 224;
/// Mending that leaves more than this of the farthest error gets nowhere.
const STUCK: f64 = 0.9;
/// What a piece may hold more than the others do and yet be none too few, in tolerances.
const SPARE: f64 = 0.1;
/// How finely hulls are looked at, in limits.
pub(super) const FINE: f64 = 0.3;
/// A closed mesh whose collider has more than this times its volume is a shell that was filled.
const FILLED: f64 = 1.5;
/// Thickness of a shell in tolerances, at most.
const SHELL: f64 = 2.0;
/// Rounds of measuring the pieces and mending those that err too much.
const MENDING: usize = 4;
/// Most corners of a piece's hull, whatever the budget of a single hull.
const PIECE_CORNERS: usize = 32;

/// A decomposition, and what went wrong on the way.
pub(super) struct Decomposition {
    pub pieces: Vec<Hull>,
    /// Of the pieces together.
    pub error: ColliderError,
    /// Distances to the solid.
    pub field: Field,
    pub fallback: Option<String>,
}

/// What every step needs to know.
pub(super) struct Context {
    pub field: Field,
    /// Of the mesh's bounds.
    pub middle: Vec3,
    /// Largest error wanted, either way.
    pub tolerance: f64,
    /// Largest concavity a piece may have.
    pub limit: f64,
    pub corners: usize,
    /// It encloses a shell about as thin as the tolerance: cuts along it shave it off slice by slice.
    pub is_shell: bool,
    /// All points of the mesh that can be seen from outside, of those at which errors are measured.
    pub seen: Seen,
    pub work: std::cell::Cell<u64>,
    names: std::cell::Cell<u32>,
}

impl Context {
    /// A name for a piece that no other has.
    pub fn next_name(&self) -> u32 {
        self.names.replace(self.names.get() + 1)
    }
}

pub(super) fn decompose(reference: &Reference<'_>, options: &Options) -> Decomposition {
    let mesh = reference.mesh;
    let mut notes: Vec<String> = Vec::new();
    let tolerance = options.collider_tolerance.clamp(1e-3, 0.2);
    // Two cells within the tolerance tell a gap of that size from none.
    let wanted = (1.2 * mesh.size.max() / tolerance).ceil() as u32;
    let limit = tolerance * LIMIT;
    let context = Context {
        field: Field::new(mesh, wanted.clamp(16, options.decomposition_resolution.max(16))),
        middle: mesh.size / 2.0,
        tolerance,
        limit,
        corners: options.hull_vertices.clamp(8, PIECE_CORNERS),
        is_shell: reference.thickness().is_some_and(|thickness| thickness < SHELL * tolerance),
        seen: Seen::new(reference.samples.seen_points().collect()),
        work: std::cell::Cell::new(0),
        names: std::cell::Cell::new(0),
    };
    let most = options.decomposition_pieces.max(1);
    let aim = limit * AIM;
    let mut atoms = cut_all(&context, start(&context, reference, aim), ATOMS, &mut notes);
    let single = |(i, atom): (usize, &Piece)| Group::of_atom(i, atom, limit);
    let mut groups: Vec<Group> = atoms.iter().enumerate().map(single).collect();
    let mut best: Option<(f64, Measured)> = None;
    let mut troubles: Vec<String> = Vec::new();
    let mut before = f64::INFINITY;
    let mut limit_now = limit;
    let mut verdicts = Verdicts::default();
    for _ in 0..=MENDING {
        let mut these: Vec<String> = Vec::new();
        groups = group::join_all(&context, &atoms, &mut verdicts, groups, most, &mut these);
        let hulls = finish(&context, &atoms, &groups, &mut these);
        let solids: Vec<Solid> = hulls.iter().cloned().map(Solid::Hull).collect();
        let (errors, whole) = reference.measure_each(&solids);
        let (common, farthest) = whole.excesses(tolerance);
        let filled = whole.volume_ratio.map_or(0.0, |ratio| ratio / FILLED);
        let score = filled.max(1.0) - 1.0 + common.max(1.0) + farthest.max(1.0);
        if best.as_ref().is_none_or(|(least, ..)| score < *least) {
            best = Some((score, Measured { hulls, error: whole }));
            troubles = these;
        }
        // Points in holes too narrow to cut open stay where they are, however fine the pieces.
        let stuck = common <= 1.0 && filled <= 1.0 && farthest > STUCK * before;
        before = farthest;
        if score <= 2.0 || stuck || context.work.get() > WORK {
            break;
        }
        let beyond = common.max(filled);
        (atoms, groups) = if beyond > 1.0 {
            // Walls move in by up to their share: what errs is the rest.
            let moved = SHARE * tolerance;
            let wanted = moved + (limit_now - moved) * FINER / beyond;
            limit_now = wanted.clamp(limit_now * 0.6, limit_now * 0.95);
            finer(&context, atoms, &groups, limit_now, &mut notes)
        } else {
            mend(&context, atoms, groups, &errors, &mut notes)
        };
    }
    notes.extend(troubles);
    let made = best.map(|(_, made)| fewest(&context, reference, made)).unwrap_or_default();
    Decomposition {
        pieces: made.hulls,
        error: made.error,
        field: context.field,
        fallback: (!notes.is_empty()).then(|| notes.join("; ")),
    }
}

#[derive(Default)]
struct Measured {
    hulls: Vec<Hull>,
    error: ColliderError,
}

/// Without pieces that the others stand for, as long as the whole stays as right as it is.
fn fewest(context: &Context, reference: &Reference<'_>, made: Measured) -> Measured {
    let all = made.hulls.len();
    let uncovered = without_covered(made.hulls);
    let most = made.error.excess(context.tolerance).max(1.0);
    let mut last = usize::MAX;
    for margin in [SPARE * context.tolerance, 0.0] {
        let hulls = without_needless(context, &uncovered, margin);
        // None went, or the same as with more to spare.
        if hulls.len() == uncovered.len() || hulls.len() == last {
            continue;
        }
        last = hulls.len();
        let solids: Vec<Solid> = hulls.iter().cloned().map(Solid::Hull).collect();
        let error = reference.measure(&solids);
        if error.excess(context.tolerance) <= most {
            return Measured { hulls, error };
        }
    }
    // Those that lie inside of another change nothing that is measured but the place of the samples.
    if uncovered.len() == all {
        return Measured { hulls: uncovered, error: made.error };
    }
    let solids: Vec<Solid> = uncovered.iter().cloned().map(Solid::Hull).collect();
    Measured { error: reference.measure(&solids), hulls: uncovered }
}

/// Atoms cut on to a smaller limit, each a group of its own again: where too much of the whole is a little off, as on
/// shells that curve everywhere, all pieces have to be smaller, and joined anew they are fewest.
fn finer(
    context: &Context,
    atoms: Vec<Piece>,
    groups: &[Group],
    limit: f64,
    notes: &mut Vec<String>,
) -> (Vec<Piece>, Vec<Group>) {
    let mut exact = vec![false; atoms.len()];
    for group in groups.iter().filter(|group| group.exact) {
        for &atom in &group.atoms {
            exact[atom] = true;
        }
    }
    let (exact_atoms, atoms): (Vec<_>, Vec<_>) = atoms.into_iter().zip(exact).partition(|(_, exact)| *exact);
    let mut cut: Vec<Piece> = Vec::new();
    let mut fresh: Vec<Group> = Vec::new();
    for (members, exact) in [(atoms, false), (exact_atoms, true)] {
        let open = members.into_iter().map(|(atom, _)| Piece { aim: limit * AIM, ..atom }).collect();
        for part in cut_all(context, open, ATOMS, notes) {
            fresh.push(Group { exact, ..Group::of_atom(cut.len(), &part, limit) });
            cut.push(part);
        }
    }
    (cut, fresh)
}

/// Takes apart the groups that err too far, and cuts their atoms finer where they have to be.
fn mend(
    context: &Context,
    atoms: Vec<Piece>,
    groups: Vec<Group>,
    errors: &[PieceError],
    notes: &mut Vec<String>,
) -> (Vec<Piece>, Vec<Group>) {
    let most = REACH * context.tolerance;
    let mut kept: Vec<Piece> = Vec::new();
    let mut mended: Vec<Group> = Vec::new();
    for (group, error) in groups.into_iter().zip(errors) {
        let members: Vec<Piece> = group.atoms.iter().map(|&i| atoms[i].clone()).collect();
        let add = |piece: Piece, kept: &mut Vec<Piece>| {
            kept.push(piece);
            kept.len() - 1
        };
        let exact = group.exact || error.outside > most;
        if error.grown <= most {
            let ids = members.into_iter().map(|piece| add(piece, &mut kept)).collect();
            mended.push(Group { atoms: ids, exact, ..group });
            continue;
        }
        let finer = (0.9 * most / error.grown).clamp(0.5, 0.85);
        let limit = group.limit.min(group.concavity.max(error.grown)) * finer;
        for mut piece in members {
            piece.aim = limit;
            for part in cut_all(context, vec![piece], 8, notes) {
                let id = add(part, &mut kept);
                mended.push(Group { exact, ..Group::of_atom(id, &kept[id], limit) });
            }
        }
    }
    (kept, mended)
}
