//! Pieces of a decomposition: sets of atoms (parts between cuts) whose common hull is right.
//!
//! Hulls may overlap, so pieces need not partition the atoms' space: a cross is two bars, not three blocks.

use std::collections::HashSet;

use super::atoms::Piece;
use super::concavity::concavity;
use super::decompose::{Context, FINE};
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::Plane;
use super::prepared::{Vec3, bounds};

/// By how much the limit is raised at a time where there are too many pieces.
const RAISE: f64 = 1.25;
/// Widest gap between the bounds of two groups that may be joined, in limits.
const GAP: f64 = 1.5;
/// Rounds of taking pieces apart to give their atoms to others.
const ROUNDS: usize = 3;

/// Atoms that share one hull.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub atoms: Vec<usize>,
    pub hull: Hull,
    pub concavity: f64,
    /// Concavity it may have.
    pub limit: f64,
    /// Set where moving its walls inwards was found to leave too much outside.
    pub exact: bool,
}

impl Group {
    pub fn of_atom(index: usize, atom: &Piece, limit: f64) -> Self {
        Self { atoms: vec![index], hull: atom.hull.clone(), concavity: atom.concavity, limit, exact: false }
    }
}

/// What is known of joining two groups.
#[derive(Clone, Copy, PartialEq)]
enum Pair {
    /// One of them is no more.
    Gone,
    /// The common hull's concavity.
    Known(f64),
    /// It is above this.
    Above(f64),
}

/// Joins the pair with the least concavity as long as it keeps to the limit, takes apart what others can hold,
/// and past the limit joins only as far as needed to come down to `most` groups.
pub(super) fn join_all(
    context: &Context,
    atoms: &[Piece],
    groups: Vec<Group>,
    most: usize,
    notes: &mut Vec<String>,
) -> Vec<Group> {
    let mut table = Table::new(context, atoms, groups);
    while let Some((value, i, j)) = table.best() {
        if !table.join(i, j, value) {
            break;
        }
    }
    let mut groups: Vec<Group> = table.groups.into_iter().flatten().collect();
    let mut refused = Refused::default();
    for _ in 0..ROUNDS {
        if !take_apart(context, atoms, &mut groups, &mut refused) {
            break;
        }
    }
    if groups.len() > most { force(context, atoms, groups, most, notes) } else { groups }
}

/// Joins on beyond the limit, least concavity first.
fn force(
    context: &Context,
    atoms: &[Piece],
    mut groups: Vec<Group>,
    most: usize,
    notes: &mut Vec<String>,
) -> Vec<Group> {
    let mut beyond: f64 = 0.0;
    let mut raised = 1.0;
    while groups.len() > most && raised < 100.0 {
        raised *= RAISE;
        for group in &mut groups {
            group.limit *= RAISE;
        }
        let mut table = Table::new(context, atoms, groups);
        while table.groups.iter().flatten().count() > most {
            let Some((value, i, j)) = table.best() else { break };
            beyond = beyond.max(value);
            if !table.join(i, j, value) {
                break;
            }
        }
        groups = table.groups.into_iter().flatten().collect();
    }
    notes.push(format!("joined beyond the tolerance, to concavity {beyond:.4}, to keep to {most} pieces"));
    groups
}

/// All pairs of groups.
struct Table<'a> {
    context: &'a Context,
    atoms: &'a [Piece],
    groups: Vec<Option<Group>>,
    /// `pairs[j][i]` for i < j.
    pairs: Vec<Vec<Pair>>,
}

impl<'a> Table<'a> {
    fn new(context: &'a Context, atoms: &'a [Piece], groups: Vec<Group>) -> Self {
        let mut table =
            Self { context, atoms, groups: groups.into_iter().map(Some).collect(), pairs: Vec::new() };
        for j in 0..table.groups.len() {
            table.pairs.push((0..j).map(|i| table.judge(i, j)).collect());
        }
        table
    }

    fn best(&self) -> Option<(f64, usize, usize)> {
        let mut best: Option<(f64, usize, usize)> = None;
        for (j, row) in self.pairs.iter().enumerate() {
            for (i, pair) in row.iter().enumerate() {
                if let Pair::Known(value) = pair
                    && best.is_none_or(|(least, ..)| *value < least)
                {
                    best = Some((*value, i, j));
                }
            }
        }
        best
    }

    fn judge(&self, i: usize, j: usize) -> Pair {
        let (Some(a), Some(b)) = (&self.groups[i], &self.groups[j]) else { return Pair::Gone };
        let limit = a.limit.min(b.limit);
        let cuts: Vec<Plane> = cuts_of(self.atoms, a.atoms.iter().chain(&b.atoms));
        match common(self.context, &a.hull, &b.hull, &cuts, limit) {
            Some((_, value)) => Pair::Known(value),
            None => Pair::Above(limit),
        }
    }

    fn join(&mut self, i: usize, j: usize, value: f64) -> bool {
        let (Some(mut a), Some(b)) = (self.groups[i].take(), self.groups[j].take()) else { return false };
        let Some(hull) = common_hull(self.context, &a.hull, &b.hull) else { return false };
        a.atoms.extend(b.atoms);
        self.groups[i] = Some(Group {
            hull,
            concavity: value,
            limit: a.limit.min(b.limit),
            exact: a.exact || b.exact,
            ..a
        });
        for k in 0..self.groups.len() {
            if k != j {
                self.pairs[k.max(j)][k.min(j)] = Pair::Gone;
            }
            if k != i && k != j {
                let (low, high) = (k.min(i), k.max(i));
                self.pairs[high][low] = self.judge(low, high);
            }
        }
        true
    }
}

/// Atoms, and the members of a host that did not stay right with them. Lookup only.
type Refused = HashSet<(usize, Vec<usize>)>;

/// Gives the atoms of a group to others whose hulls stay right with them, smallest group first; whether any
/// group went.
fn take_apart(context: &Context, atoms: &[Piece], groups: &mut Vec<Group>, refused: &mut Refused) -> bool {
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by(|&a, &b| groups[a].hull.volume().total_cmp(&groups[b].hull.volume()).then(a.cmp(&b)));
    let mut gone = vec![false; groups.len()];
    for g in order {
        if let Some(changed) = spread(context, atoms, groups, &gone, g, refused) {
            for (h, group) in changed {
                groups[h] = group;
            }
            gone[g] = true;
        }
    }
    let any = gone.contains(&true);
    let mut index = 0;
    groups.retain(|_| {
        index += 1;
        !gone[index - 1]
    });
    any
}

/// The groups that change where those of `g`'s atoms go to others; `None` where one finds no place.
fn spread(
    context: &Context,
    atoms: &[Piece],
    groups: &[Group],
    gone: &[bool],
    g: usize,
    refused: &mut Refused,
) -> Option<Vec<(usize, Group)>> {
    let mut changed: Vec<(usize, Group)> = Vec::new();
    let mut homeless = groups[g].atoms.clone();
    homeless.sort_by(|&a, &b| atoms[b].hull.volume().total_cmp(&atoms[a].hull.volume()).then(a.cmp(&b)));
    for index in homeless {
        let atom = &atoms[index];
        let mut best: Option<(f64, usize, Group)> = None;
        for h in (0..groups.len()).filter(|&h| h != g && !gone[h]) {
            let host = changed.iter().find(|(k, _)| *k == h).map_or(&groups[h], |(_, group)| group);
            let key = (index, host.atoms.clone());
            if refused.contains(&key) {
                continue;
            }
            let most = host.limit.min(groups[g].limit);
            let limit = most.min(best.as_ref().map_or(f64::INFINITY, |b| b.0));
            let cuts = cuts_of(atoms, host.atoms.iter().chain(std::iter::once(&index)));
            if let Some((hull, value)) = common(context, &host.hull, &atom.hull, &cuts, limit) {
                let mut joined = host.clone();
                joined.atoms.push(index);
                joined.hull = hull;
                joined.concavity = value;
                joined.limit = host.limit.min(groups[g].limit);
                joined.exact |= groups[g].exact;
                best = Some((value, h, joined));
            } else if limit == most {
                refused.insert(key);
            }
        }
        let (_, h, joined) = best?;
        match changed.iter_mut().find(|(k, _)| *k == h) {
            Some((_, group)) => *group = joined,
            None => changed.push((h, joined)),
        }
    }
    Some(changed)
}

pub(super) fn cuts_of<'a>(atoms: &[Piece], members: impl Iterator<Item = &'a usize>) -> Vec<Plane> {
    let mut cuts: Vec<Plane> = Vec::new();
    for &index in members {
        for cut in &atoms[index].cuts {
            if !cuts.contains(cut) {
                cuts.push(*cut);
            }
        }
    }
    cuts
}

/// The hull of both and its concavity, where that is at most `limit`.
fn common(context: &Context, a: &Hull, b: &Hull, cuts: &[Plane], limit: f64) -> Option<(Hull, f64)> {
    let (low_a, high_a) = bounds(&a.vertices);
    let (low_b, high_b) = bounds(&b.vertices);
    // Across a wide gap the common hull is far from either, unless other pieces lie between.
    let gap = (low_a - high_b).sup(&(low_b - high_a)).max();
    if gap > limit * GAP || apart(context, a, b, limit) {
        return None;
    }
    context.work.set(context.work.get() + 4000);
    let hull = common_hull(context, a, b)?;
    let value = concavity(&hull, &context.field, &context.seen, cuts, limit * FINE, limit).depth;
    (value <= limit).then_some((hull, value))
}

/// Whether some point between the two lies farther from the solid than `limit`: a quick no.
fn apart(context: &Context, a: &Hull, b: &Hull, limit: f64) -> bool {
    let few = |hull: &Hull| -> Vec<Vec3> {
        hull.vertices.iter().step_by(hull.vertices.len().div_ceil(8)).copied().collect()
    };
    let others = few(b);
    few(a).iter().any(|p| {
        others
            .iter()
            .any(|q| [0.5, 0.25, 0.75].iter().any(|t| context.field.distance(p + (q - p) * *t) > limit))
    })
}

fn common_hull(context: &Context, a: &Hull, b: &Hull) -> Option<Hull> {
    let points: Vec<Vec3> = a.vertices.iter().chain(&b.vertices).copied().collect();
    Hull::of_any(&points, context.corners, context.limit * 0.05, THIN).map(|(hull, _)| hull)
}
