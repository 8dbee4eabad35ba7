//! Pieces of a decomposition: sets of atoms (parts between cuts) whose common hull is right.
//!
//! Hulls may overlap, so pieces need not partition the atoms' space: a cross is two bars, not three blocks.

use std::collections::HashMap;

use super::atoms::Piece;
use super::concavity::{Closely, concavity};
use super::decompose::{Context, FINE};
use super::hull::Hull;
use super::ladder::THIN;
use super::piece::Plane;
use super::prepared::{Vec3, bounds};

/// By how much the limit is raised at a time where there are too many pieces.
const RAISE: f64 = 1.25;
/// Widest gap between the bounds of two groups that may be joined, in limits.
const GAP: f64 = 1.5;
/// Share of the limit below which concavities are not told apart.
const NEGLIGIBLE: f64 = 0.6;
/// Rounds of taking pieces apart to give their atoms to others.
const ROUNDS: usize = 3;

/// Atoms that share one hull.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub atoms: Vec<usize>,
    pub hull: Hull,
    /// Of the hull.
    pub bounds: (Vec3, Vec3),
    /// Most that each face of the hull reaches beyond the solid.
    pub reaches: Vec<f64>,
    pub concavity: f64,
    /// Concavity it may have.
    pub limit: f64,
    /// Set where moving its walls inwards was found to leave too much outside.
    pub exact: bool,
}

impl Group {
    pub fn of_atom(index: usize, atom: &Piece, limit: f64) -> Self {
        Self {
            atoms: vec![index],
            hull: atom.hull.clone(),
            bounds: bounds(&atom.hull.vertices),
            reaches: atom.reaches.clone(),
            concavity: atom.concavity,
            limit,
            exact: false,
        }
    }

    /// Both as one; `None` where there is no common hull whose concavity is at most `limit`.
    fn joined(&self, context: &Context, atoms: &[Piece], other: &Self, limit: f64) -> Option<Self> {
        context.work.set(context.work.get() + 4000);
        let hull = common_hull(context, &self.hull, &other.hull)?;
        let cuts: Vec<Plane> = cuts_of(atoms, self.atoms.iter().chain(&other.atoms));
        let closely = Closely { fineness: limit * FINE, negligible: limit * NEGLIGIBLE, enough: limit };
        let known = self.known_reaches(other, &hull);
        let worst = concavity(&hull, &context.field, &context.seen, &cuts, closely, &known);
        (worst.depth <= limit).then(|| Self {
            atoms: self.atoms.iter().chain(&other.atoms).copied().collect(),
            bounds: bounds(&hull.vertices),
            hull,
            reaches: worst.reaches,
            concavity: worst.depth,
            limit: self.limit.min(other.limit),
            exact: self.exact || other.exact,
        })
    }

    /// The reaches of those faces of the common hull that are faces of either already.
    fn known_reaches(&self, other: &Self, hull: &Hull) -> Vec<Option<f64>> {
        if hull.of.is_empty() {
            return Vec::new();
        }
        let first = self.hull.vertices.len() as u32;
        let turned = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
            least if least == a => [a, b, c],
            least if least == b => [b, c, a],
            _ => [c, a, b],
        };
        let mine = self.hull.faces.iter().copied().zip(&self.reaches);
        let theirs = other.hull.faces.iter().map(|face| face.map(|i| i + first)).zip(&other.reaches);
        let mut faces: Vec<([u32; 3], f64)> =
            mine.chain(theirs).map(|(face, reach)| (turned(face), *reach)).collect();
        faces.sort_unstable_by_key(|(face, _)| *face);
        let of = |face: &[u32; 3]| turned(face.map(|i| hull.of[i as usize]));
        let known =
            hull.faces.iter().map(|face| faces.binary_search_by_key(&of(face), |(face, _)| *face).ok());
        known.map(|place| place.map(|place| faces[place].1)).collect()
    }
}

/// Joins the pair with the least concavity as long as it keeps to the limit, takes apart what others can hold,
/// and past the limit joins only as far as needed to come down to `most` groups.
pub(super) fn join_all(
    context: &Context,
    atoms: &[Piece],
    verdicts: &mut Verdicts,
    groups: Vec<Group>,
    most: usize,
    notes: &mut Vec<String>,
) -> Vec<Group> {
    let mut table = Table::new(context, atoms, verdicts, groups);
    while let Some((_, i, j)) = table.best() {
        table.join(i, j);
    }
    let mut groups: Vec<Group> = table.groups.into_iter().flatten().collect();
    for _ in 0..ROUNDS {
        if !take_apart(context, atoms, verdicts, &mut groups) {
            break;
        }
    }
    if groups.len() > most { force(context, atoms, verdicts, groups, most, notes) } else { groups }
}

/// Joins on beyond the limit, least concavity first.
fn force(
    context: &Context,
    atoms: &[Piece],
    verdicts: &mut Verdicts,
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
        let mut table = Table::new(context, atoms, verdicts, groups);
        while table.groups.iter().flatten().count() > most {
            let Some((value, i, j)) = table.best() else { break };
            beyond = beyond.max(value);
            table.join(i, j);
        }
        groups = table.groups.into_iter().flatten().collect();
    }
    notes.push(format!("joined beyond the tolerance, to concavity {beyond:.4}, to keep to {most} pieces"));
    groups
}

/// What is known of joining two groups.
#[derive(Clone, Copy, PartialEq)]
enum Pair {
    /// One of them is no more.
    Gone,
    /// The common hull is too concave.
    Refused,
    /// Its concavity.
    Known(f64),
}

/// All pairs of groups.
struct Table<'a> {
    context: &'a Context,
    atoms: &'a [Piece],
    verdicts: &'a mut Verdicts,
    groups: Vec<Option<Group>>,
    /// `pairs[j][i]` for i < j.
    pairs: Vec<Vec<Pair>>,
}

impl<'a> Table<'a> {
    fn new(context: &'a Context, atoms: &'a [Piece], verdicts: &'a mut Verdicts, groups: Vec<Group>) -> Self {
        let groups = groups.into_iter().map(Some).collect();
        let mut table = Self { context, atoms, verdicts, groups, pairs: Vec::new() };
        for j in 0..table.groups.len() {
            let row = (0..j).map(|i| table.judge(i, j)).collect();
            table.pairs.push(row);
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

    fn judge(&mut self, i: usize, j: usize) -> Pair {
        let (Some(a), Some(b)) = (&self.groups[i], &self.groups[j]) else { return Pair::Gone };
        let limit = a.limit.min(b.limit);
        self.verdicts.of(self.context, self.atoms, a, b, limit).map_or(Pair::Refused, Pair::Known)
    }

    fn join(&mut self, i: usize, j: usize) {
        let (Some(a), Some(b)) = (&self.groups[i], &self.groups[j]) else { return };
        let Some(both) = a.joined(self.context, self.atoms, b, a.limit.min(b.limit)) else {
            // Looked at for another limit it was a hair less concave.
            self.pairs[j][i] = Pair::Refused;
            return;
        };
        self.groups[i] = Some(both);
        self.groups[j] = None;
        for k in 0..self.groups.len() {
            if k != j {
                self.pairs[k.max(j)][k.min(j)] = Pair::Gone;
            }
            if k != i && k != j {
                let (low, high) = (k.min(i), k.max(i));
                self.pairs[high][low] = self.judge(low, high);
            }
        }
    }
}

/// Gives the atoms of a group to others whose hulls stay right with them, smallest group first; whether any
/// group went.
fn take_apart(context: &Context, atoms: &[Piece], verdicts: &mut Verdicts, groups: &mut Vec<Group>) -> bool {
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by(|&a, &b| groups[a].hull.volume().total_cmp(&groups[b].hull.volume()).then(a.cmp(&b)));
    let mut gone = vec![false; groups.len()];
    for g in order {
        if let Some(changed) = spread(context, atoms, verdicts, groups, &gone, g) {
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
    verdicts: &mut Verdicts,
    groups: &[Group],
    gone: &[bool],
    g: usize,
) -> Option<Vec<(usize, Group)>> {
    let mut changed: Vec<(usize, Group)> = Vec::new();
    let mut homeless = groups[g].atoms.clone();
    homeless.sort_by(|&a, &b| atoms[b].hull.volume().total_cmp(&atoms[a].hull.volume()).then(a.cmp(&b)));
    for index in homeless {
        let limit = groups[g].limit;
        let atom = Group { exact: groups[g].exact, ..Group::of_atom(index, &atoms[index], limit) };
        let mut best: Option<(f64, usize)> = None;
        for h in (0..groups.len()).filter(|&h| h != g && !gone[h]) {
            let host = changed.iter().find(|(k, _)| *k == h).map_or(&groups[h], |(_, group)| group);
            let most = host.limit.min(limit).min(best.map_or(f64::INFINITY, |(value, _)| value));
            if let Some(value) = verdicts.of(context, atoms, host, &atom, most) {
                best = Some((value, h));
            }
        }
        let (_, h) = best?;
        match changed.iter_mut().find(|(k, _)| *k == h) {
            Some((_, group)) => *group = group.joined(context, atoms, &atom, group.limit.min(limit))?,
            None => changed.push((h, groups[h].joined(context, atoms, &atom, groups[h].limit.min(limit))?)),
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

fn common_hull(context: &Context, a: &Hull, b: &Hull) -> Option<Hull> {
    let points: Vec<Vec3> = a.vertices.iter().chain(&b.vertices).copied().collect();
    Hull::of_any(&points, context.corners, context.limit * 0.05, THIN).map(|(hull, _)| hull)
}

/// What was found of joining two groups, kept for as long as the same atoms may meet again: joining is most of the
/// time of a decomposition.
#[derive(Default)]
pub(super) struct Verdicts(HashMap<[Vec<u32>; 2], Verdict>);

#[derive(Clone, Copy)]
enum Verdict {
    /// The common hull's concavity.
    Concavity(f64),
    /// It is above this.
    Above(f64),
}

impl Verdicts {
    /// The concavity of the hull around both, where that is at most `limit`.
    fn of(&mut self, context: &Context, atoms: &[Piece], a: &Group, b: &Group, limit: f64) -> Option<f64> {
        let ((low_a, high_a), (low_b, high_b)) = (a.bounds, b.bounds);
        // Across a wide gap the common hull is far from either, unless other pieces lie between.
        let gap = (low_a - high_b).sup(&(low_b - high_a)).max();
        if gap > limit * GAP {
            return None;
        }
        let key = |group: &Group| {
            let mut names: Vec<u32> = group.atoms.iter().map(|&i| atoms[i].name).collect();
            names.sort_unstable();
            names
        };
        let mut keys = [key(a), key(b)];
        keys.sort_unstable();
        let known = self.0.get(&keys).copied();
        let verdict = match known {
            Some(Verdict::Above(least)) if least < limit => judge(context, atoms, a, b, limit),
            Some(verdict) => verdict,
            None => judge(context, atoms, a, b, limit),
        };
        self.0.insert(keys, verdict);
        match verdict {
            Verdict::Concavity(value) => (value <= limit).then_some(value),
            Verdict::Above(_) => None,
        }
    }
}

fn judge(context: &Context, atoms: &[Piece], a: &Group, b: &Group, limit: f64) -> Verdict {
    if apart(context, &a.hull, &b.hull, limit) {
        return Verdict::Above(limit);
    }
    let both = a.joined(context, atoms, b, limit);
    both.map_or(Verdict::Above(limit), |both| Verdict::Concavity(both.concavity))
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
