//! Approximate convex decomposition by recursive plane cuts.
//!
//! The piece whose hull is farthest from the mesh is cut by the plane that leaves least to do, its connected
//! parts become pieces, until every hull keeps to the tolerance; neighbours whose common hull keeps to it
//! too are then merged. Cuts are exact, so hulls hug the mesh and nothing is left outside. The idea of
//! cutting by collision-aware concavity is CoACD's (Wei et al., SIGGRAPH 2022); measuring it on a distance
//! grid, cutting where concave edges and walls lie, and splitting loose parts at once are what make it fast.

use super::balance::balanced;
use super::concavity::concavity;
use super::error::{PieceError, REACH, Reference};
use super::field::Field;
use super::group::{self, Group};
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::{Plane, Surface};
use super::prepared::{Prepared, Vec3, bounds};
use super::solid::Solid;
use super::{cut, simplify};
use crate::Options;

/// Concavity a piece may have, in tolerances: its walls are moved inwards afterwards, to err to both sides.
const LIMIT: f64 = 1.8;
/// Share of the limit at which parts are cut no further: finer parts leave more ways to join them.
const AIM: f64 = 0.9;
/// Most that the mesh is left outside of a piece, in tolerances.
const SHARE: f64 = 0.42;
/// Share of the surface that may be off by more than the tolerance: a little below the 5 % that are allowed.
const BEYOND: f64 = 0.045;
/// Mending that leaves more than this of the farthest error gets nowhere.
const STUCK: f64 = 0.9;
/// How finely hulls are looked at, in limits.
pub(super) const FINE: f64 = 0.3;
/// A closed mesh whose collider has more than this times its volume is a shell that was filled.
const FILLED: f64 = 1.6;
/// Rounds of measuring the pieces and mending those that err too much.
const MENDING: usize = 3;
/// Most corners of a piece's hull, whatever the budget of a single hull.
const PIECE_CORNERS: usize = 32;
/// Triangles on which cuts are searched; the pieces' hulls are of the full mesh.
const SEARCH_TRIANGLES: usize = 6_000;
/// Bodies that start as pieces of their own.
const BODIES: usize = 64;
/// Points, triangles and samples looked at before the cutting ends where it is.
const WORK: u64 = 150_000_000;

/// A decomposition, and what went wrong on the way.
pub(super) struct Decomposition {
    pub pieces: Vec<Hull>,
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
    /// Its cell: it lies below every one of them.
    pub cuts: Vec<Plane>,
    /// Points within the solid where cuts meet, of which the surface knows nothing.
    pub inner: Vec<Vec3>,
    pub hull: Hull,
    pub concavity: f64,
    /// Where the hull is farthest from the mesh.
    pub deepest: Vec3,
    /// Concavity at which it is cut no further.
    pub aim: f64,
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
        seen: reference.samples.seen_points().collect(),
        work: std::cell::Cell::new(0),
    };
    let most = options.decomposition_pieces.max(1);
    let aim = limit * AIM;
    let mut atoms = cut_all(&context, start(&context, reference, aim), most * 3, &mut notes);
    let single = |(i, atom): (usize, &Piece)| Group::of_atom(i, atom, limit);
    let mut groups: Vec<Group> = atoms.iter().enumerate().map(single).collect();
    let mut best: Option<(f64, Vec<Hull>)> = None;
    let mut troubles: Vec<String> = Vec::new();
    let mut before = f64::INFINITY;
    for _ in 0..=MENDING {
        let mut these: Vec<String> = Vec::new();
        groups = group::join_all(&context, &atoms, groups, most, &mut these);
        let hulls = finish(&context, &atoms, &groups, &mut these);
        let solids: Vec<Solid> = hulls.iter().cloned().map(Solid::Hull).collect();
        let (errors, whole) = reference.measure_each(&solids, tolerance);
        let (common, farthest) = whole.excesses(tolerance);
        let filled = whole.volume_ratio.map_or(0.0, |ratio| ratio / FILLED);
        let score = filled.max(1.0) - 1.0 + common.max(1.0) + farthest.max(1.0);
        if best.as_ref().is_none_or(|(least, ..)| score < *least) {
            best = Some((score, hulls));
            troubles = these;
        }
        // Points in holes too narrow to cut open stay where they are, however fine the pieces.
        let stuck = common <= 1.0 && filled <= 1.0 && farthest > STUCK * before;
        before = farthest;
        if score <= 2.0 || stuck || context.work.get() > WORK {
            break;
        }
        (atoms, groups) = mend(&context, atoms, groups, &errors, filled > 1.0, &mut notes);
    }
    notes.extend(troubles);
    let pieces = best.map(|(_, hulls)| without_covered(hulls)).unwrap_or_default();
    Decomposition { pieces, field: context.field, fallback: (!notes.is_empty()).then(|| notes.join("; ")) }
}

/// Takes apart the groups that err too far, and those most to blame where too much is beyond the tolerance, and cuts their atoms finer where they have to be.
fn mend(
    context: &Context,
    atoms: Vec<Piece>,
    groups: Vec<Group>,
    errors: &[PieceError],
    filled: bool,
    notes: &mut Vec<String>,
) -> (Vec<Piece>, Vec<Group>) {
    let most = REACH * context.tolerance;
    let blamed = if filled { vec![true; errors.len()] } else { blamed(errors) };
    let mut kept: Vec<Piece> = Vec::new();
    let mut mended: Vec<Group> = Vec::new();
    for ((group, error), blamed) in groups.into_iter().zip(errors).zip(blamed) {
        let members: Vec<Piece> = group.atoms.iter().map(|&i| atoms[i].clone()).collect();
        let add = |piece: Piece, kept: &mut Vec<Piece>| {
            kept.push(piece);
            kept.len() - 1
        };
        let exact = group.exact || error.outside > most;
        if error.grown <= most && !blamed {
            let ids = members.into_iter().map(|piece| add(piece, &mut kept)).collect();
            mended.push(Group { atoms: ids, exact, ..group });
            continue;
        }
        let limit =
            group.limit.min(group.concavity.max(error.grown)) * (0.9 * most / error.grown).clamp(0.5, 0.85);
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

/// The pieces with the most beyond the tolerance, as few as bring the shares of all others below [`BEYOND`].
fn blamed(errors: &[PieceError]) -> Vec<bool> {
    let mut blamed = vec![false; errors.len()];
    let mut shares: [f64; 2] = std::array::from_fn(|way| errors.iter().map(|error| error.beyond[way]).sum());
    let mut order: Vec<usize> = (0..errors.len()).collect();
    let most = |i: usize| errors[i].beyond[0].max(errors[i].beyond[1]);
    order.sort_by(|&a, &b| most(b).total_cmp(&most(a)).then(a.cmp(&b)));
    for i in order {
        if shares.iter().all(|share| *share <= BEYOND) {
            break;
        }
        blamed[i] = true;
        shares = std::array::from_fn(|way| shares[way] - errors[i].beyond[way]);
    }
    blamed
}

/// The mesh as one piece, or its bodies as one each.
fn start(context: &Context, reference: &Reference<'_>, aim: f64) -> Vec<Piece> {
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
    seen: &'a [Vec3],
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
        let near = |p: &&Vec3| (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]);
        let seen: Vec<Vec3> = seen.iter().filter(near).copied().collect();
        let worst = concavity(&hull, &context.field, &seen, cuts, context.limit * FINE, f64::INFINITY);
        pieces.push(Piece {
            surface,
            full,
            seen,
            cuts: cuts.to_vec(),
            inner,
            hull,
            concavity: worst.depth,
            deepest: worst.at,
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
fn cut_all(context: &Context, mut open: Vec<Piece>, most: usize, notes: &mut Vec<String>) -> Vec<Piece> {
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
        let on_side = |points: &[Vec3]| -> Vec<Vec3> {
            points.iter().filter(|p| plane.above(p) * sign <= 1e-6).copied().collect()
        };
        let (seen, inner) = (on_side(&piece.seen), on_side(&inner));
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

/// Hulls of the full mesh's points within the budget of corners, one a group.
fn finish(context: &Context, atoms: &[Piece], groups: &[Group], notes: &mut Vec<String>) -> Vec<Hull> {
    let mut hulls: Vec<Hull> = Vec::with_capacity(groups.len());
    let mut residuals: Vec<f64> = Vec::with_capacity(groups.len());
    let mut thickened = 0;
    for group in groups {
        let mut points: Vec<Vec3> = Vec::new();
        for atom in group.atoms.iter().map(|&i| &atoms[i]) {
            let full = atom.full.as_ref().filter(|full| !full.positions.is_empty());
            points.extend(full.map_or(&atom.surface.positions, |full| &full.positions));
            points.extend(&atom.inner);
        }
        let made = Hull::of_any(&points, context.corners, 0.05 * context.tolerance, THIN);
        let (hull, thick) = made.unwrap_or_else(|| (group.hull.clone(), false));
        thickened += usize::from(thick);
        residuals.push(hull.residual);
        hulls.push(hull.balanced());
    }
    if thickened > 0 {
        notes.push(format!("{thickened} flat pieces thickened to {} % of the diagonal", THIN * 100.0));
    }
    (0..hulls.len())
        .map(|i| {
            let cuts = inner_walls(atoms, &groups[i], &hulls[i]);
            let share = if groups[i].exact { 0.0 } else { SHARE };
            balanced(context, &hulls, i, &cuts, (share * context.tolerance - residuals[i]).max(0.0))
        })
        .collect()
}

/// The cuts on which the group has next to no surface of the mesh: walls between pieces, not of the thing.
fn inner_walls(atoms: &[Piece], group: &Group, hull: &Hull) -> Vec<Plane> {
    let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).norm();
    let on_cut = |cut: &Plane, face: &[Vec3; 3]| face.iter().all(|p| cut.above(p).abs() < 1e-4);
    let mut cuts = group::cuts_of(atoms, group.atoms.iter());
    cuts.retain(|cut| {
        let wall: f64 = hull.face_points().filter(|face| on_cut(cut, face)).map(area).sum();
        let surfaces = group.atoms.iter().map(|&i| &atoms[i].surface);
        let faces = surfaces
            .flat_map(|surface| surface.triangles.iter().map(|t| t.map(|i| surface.positions[i as usize])));
        let mesh: f64 = faces.filter(|face| on_cut(cut, face)).map(area).sum();
        mesh < 0.3 * wall
    });
    cuts
}

/// Without those that lie inside another.
fn without_covered(mut hulls: Vec<Hull>) -> Vec<Hull> {
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
