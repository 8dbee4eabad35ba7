//! Which islands are solved directly.
//!
//! Those that stand on something, are small, and whose loads sweeps cannot follow: a heavy body on a light one at any
//! speed; a stack; any other tall or wedged heap while it is quiet. The rule counts, it never times, so that it repeats.

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::island::Sets;
use crate::math::Vec3;
use crate::plan::Plan;
use crate::shape::Geometry;
use crate::solve::rolling::RollingConstraint;

/// Bodies of one island, and of all of a step, at most.
const MAX_BODIES: usize = 96;
const MAX_BODIES_A_STEP: usize = 144;
/// Mass ratio across a contact from which sweeps are too slow.
const HEAVY_ON_LIGHT: f64 = 5.0;
/// Bodies that a tall island has at least.
const TALL: usize = 4;
/// A normal between these shares of gravity wedges.
const WEDGE: std::ops::Range<f64> = 0.15..0.98;
/// Speed of a quiet body as a share of √(g r).
const QUIET: f64 = 0.1;

/// m/s from which a body is a fault rather than a motion.
const WILD: f64 = 1e6;

/// The islands of a step that are solved directly.
#[derive(Clone, Default)]
pub(crate) struct Islands {
    sets: Sets,
    traits: Vec<Traits>,
    /// Island of each body that is taken, its place in `members` and `contacts`.
    taken: Vec<u32>,
    pub(crate) members: Vec<Vec<u32>>,
    pub(crate) contacts: Vec<Vec<(u32, u32)>>,
    pub(crate) count: usize,
    /// Whether an island is one body that touches nothing which moves.
    pub(crate) lone: Vec<bool>,
}

const NONE: u32 = u32::MAX;

#[derive(Clone, Copy)]
struct Traits {
    bodies: usize,
    grounded: bool,
    quiet: bool,
    /// Nothing of it has a speed that is no number, or as good as none.
    sane: bool,
    /// Something of it resists rolling.
    resists: bool,
    heavy: bool,
    wedged: bool,
    contacts: usize,
}

impl Islands {
    /// Whether body `i` is solved directly in this step.
    pub(crate) fn has(&self, i: usize) -> bool {
        self.taken.get(i).is_some_and(|island| *island != NONE)
    }

    /// How many bodies are solved alone, and how many in islands.
    pub(crate) fn bodies(&self) -> [u64; 2] {
        let mut count = [0, 0];
        for (members, lone) in self.members.iter().zip(&self.lone) {
            count[usize::from(!lone)] += members.len() as u64;
        }
        count
    }

    /// Finds them.
    pub(crate) fn find(
        &mut self,
        bodies: &[Body],
        pairs: &[Pair],
        rolling: &[RollingConstraint],
        gravity: &Vec3,
        plan: &Plan,
    ) {
        self.count = 0;
        self.lone.clear();
        self.taken.clear();
        self.taken.resize(bodies.len(), NONE);
        let strength = gravity.norm();
        if strength == 0.0 {
            return;
        }
        let awake = |i: u32| bodies[i as usize].is_awake();
        self.sets.reset(bodies.len());
        let live =
            || pairs.iter().filter(|pair| !pair.manifolds.is_empty() && (awake(pair.a) || awake(pair.b)));
        for pair in live().filter(|pair| awake(pair.a) && awake(pair.b)) {
            self.sets.join(pair.a, pair.b);
        }
        let none = Traits {
            bodies: 0,
            grounded: false,
            quiet: true,
            sane: true,
            resists: false,
            heavy: false,
            wedged: false,
            contacts: 0,
        };
        self.traits.clear();
        self.traits.resize(bodies.len(), none);
        for (i, body) in (0..).zip(bodies).filter(|(_, body)| body.is_awake()) {
            let island = &mut self.traits[self.sets.root(i) as usize];
            island.bodies += 1;
            let speed = body.velocity.norm_squared() + (body.spin * body.reach).norm_squared();
            island.sane &= speed < WILD * WILD;
            island.quiet &= speed < QUIET * QUIET * strength * body.reach;
        }
        for pair in live() {
            let (a, b) = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
            let root = self.sets.root(if a.is_awake() { pair.a } else { pair.b });
            let island = &mut self.traits[root as usize];
            let between = a.is_awake() && b.is_awake();
            island.grounded |= !between;
            let ratio = if between { (a.mass / b.mass).max(b.mass / a.mass) } else { 1.0 };
            for manifold in &pair.manifolds {
                let up = manifold.normal.dot(gravity).abs() / strength;
                island.contacts += 1;
                island.heavy |= ratio > HEAVY_ON_LIGHT && up > WEDGE.start;
                island.wedged |= WEDGE.contains(&up);
            }
        }
        // The direct solve knows no moments, so what resists rolling is left to the sweeps unless it is alone.
        for constraint in rolling.iter().filter(|constraint| constraint.resists()) {
            for body in constraint.bodies().into_iter().filter(|body| awake(*body)) {
                let root = self.sets.root(body);
                self.traits[root as usize].resists = true;
            }
        }
        let every = plan.solves_every_island();
        let mut budget = MAX_BODIES_A_STEP;
        for (i, _) in (0..).zip(bodies).filter(|(_, body)| body.is_awake()) {
            let root = self.sets.root(i);
            if root == i {
                let island = self.traits[root as usize];
                let tall = island.bodies >= TALL;
                let lone = island.bodies == 1 && (every || !rolls_only(&bodies[i as usize]));
                let hard = island.heavy || if island.wedged { island.quiet } else { tall };
                if (lone || (every || hard) && island.bodies > 1 && !island.resists)
                    && island.sane
                    && island.grounded
                    && island.bodies <= MAX_BODIES.min(budget)
                {
                    budget -= island.bodies;
                    self.taken[i as usize] = self.open();
                    self.lone.push(lone);
                }
            }
            // Roots come first: they are the lowest of their island.
            let island = self.taken[root as usize];
            self.taken[i as usize] = island;
            if island != NONE {
                self.members[island as usize].push(i);
            }
        }
        for (p, pair) in (0..).zip(pairs) {
            let body = if awake(pair.a) { pair.a } else { pair.b };
            let island = self.taken[body as usize];
            if island != NONE {
                let manifolds = (0..pair.manifolds.len() as u32).map(|m| (p, m));
                self.contacts[island as usize].extend(manifolds);
            }
        }
    }

    /// A new island's number; its lists keep their storage from earlier steps.
    fn open(&mut self) -> u32 {
        if self.members.len() == self.count {
            self.members.push(Vec::new());
            self.contacts.push(Vec::new());
        }
        self.members[self.count].clear();
        self.contacts[self.count].clear();
        self.count += 1;
        self.count as u32 - 1
    }
}

/// Whether it is made of balls: the arm of their contacts does not turn, so that sweeps are as right.
fn rolls_only(body: &Body) -> bool {
    body.colliders.iter().all(|child| matches!(child.geometry, Geometry::Sphere { .. }))
}
