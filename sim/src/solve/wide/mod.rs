//! The contact solver: soft contacts in small steps, eight manifolds at a time.
//!
//! `lanes` and `avx2` are the numbers, `block` the records, `kernel` and `solving` the sweeps over them, `graph` says which
//! manifolds may be solved at once, `bodies` what happens to bodies between sweeps, `team` who does it.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
mod block;
mod bodies;
mod graph;
mod kernel;
pub(crate) mod lanes;
mod rims;
mod share;
mod solving;
mod statics;
pub(crate) mod team;

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::math::{Mat3, Vec2, Vec3};
use crate::plan::Plan;
use crate::settings::Settings;
use crate::solve::rolling::RollingConstraint;
use crate::solve::softness::Softness;

use block::{Block, GROUND, PointRow, Side};
use bodies::{RowState, steady_noise};
use graph::{Edge, Graph};
use kernel::{BodyRows, Pass, Substep};
use lanes::{Eight, WIDTH};
use rims::Rim;
use share::Shared;
use statics::Statics;
use team::{Team, Worker};

pub(crate) use kernel::{Precision, simd_available};

/// The contacts of one step and the state of the bodies that they hold; its storage serves all steps.
#[derive(Clone, Default)]
pub(crate) struct Contacts<S> {
    /// Row of each body, 0 for what has none.
    row_of: Vec<u32>,
    sides: Vec<Side>,
    states: Vec<RowState<S>>,
    velocity: Vec<Eight<S>>,
    moved: Vec<Eight<S>>,
    edges: Vec<Edge>,
    graph: Graph,
    blocks: Vec<Block<S>>,
    points: Vec<PointRow<S>>,
    /// Ends of the colours among the blocks.
    colors: Vec<usize>,
    /// Block and lane of each edge in the graph's order.
    places: Vec<(u32, u32)>,
    rolling: Vec<RollingPlace>,
    rims: Vec<Rim>,
    statics: Statics,
    /// Place of each edge in the graph's order; kept up only while something resists rolling.
    slots: Vec<u32>,
}

/// Where a contact point that resists rolling is among the rows.
#[derive(Clone)]
struct RollingPlace {
    constraint: usize,
    rows: [u32; 2],
    point: usize,
    lane: usize,
}

/// What is the same for a whole step.
#[derive(Clone, Copy)]
pub(crate) struct StepContext<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) settings: &'a Settings,
    /// s, of a substep.
    pub(crate) h: f64,
    pub(crate) gravity: Vec3,
    pub(crate) max_push_speed: f64,
    pub(crate) simd: bool,
    pub(crate) threads: u32,
}

impl<S: Precision> Contacts<S> {
    /// Sets up the contacts of all pairs with something awake.
    ///
    /// Bodies of which `elsewhere` says so are left out, with their contacts: the ground is all they can share.
    ///
    /// `left` is how much of the substep a body has still to go, s.
    pub(crate) fn begin(
        &mut self,
        bodies: &[Body],
        pairs: &[Pair],
        rolling: &[RollingConstraint],
        left: impl Fn(usize) -> f64,
        elsewhere: impl Fn(u32) -> bool,
        context: &StepContext<'_>,
    ) {
        self.find_edges(bodies, pairs, elsewhere);
        self.find_rows(bodies, left);
        for edge in &mut self.edges {
            let pair = &pairs[edge.pair as usize];
            edge.rows = [pair.a, pair.b].map(|body| self.row_of[body as usize]);
        }
        self.graph.color(&self.edges, self.sides.len());
        self.lay_out();
        self.fill(bodies, pairs, context);
        self.guess_loads(bodies, pairs, context);
        self.place_rolling(rolling);
    }

    fn find_edges(&mut self, bodies: &[Body], pairs: &[Pair], elsewhere: impl Fn(u32) -> bool) {
        self.edges.clear();
        self.row_of.clear();
        self.row_of.resize(bodies.len(), GROUND);
        for (at, pair) in (0..).zip(pairs) {
            let awake = [pair.a, pair.b].map(|i| bodies[i as usize].is_awake());
            let left_out = elsewhere(pair.a) || elsewhere(pair.b);
            if awake == [false, false] || pair.manifolds.is_empty() || pair.apart || left_out {
                continue;
            }
            for (body, awake) in [pair.a, pair.b].into_iter().zip(awake) {
                // Marked here, numbered in the order of the bodies later.
                self.row_of[body as usize] = u32::from(awake);
            }
            for (manifold, points) in
                (0..).zip(&pair.manifolds).map(|(m, manifold)| (m, manifold.points.len()))
            {
                if points > 0 {
                    self.edges.push(Edge { pair: at, manifold, rows: [GROUND; 2], points: points as u32 });
                }
            }
        }
    }

    /// Numbers the bodies that take part; a sleeping one stands as still as the ground until it is woken.
    fn find_rows(&mut self, bodies: &[Body], left: impl Fn(usize) -> f64) {
        self.sides.clear();
        self.sides.push(Side::GROUND);
        self.states.clear();
        self.velocity.clear();
        self.moved.clear();
        self.velocity.push(Eight::default());
        self.moved.push(bodies::unmoved());
        for (i, (body, row)) in (0..).zip(bodies.iter().zip(&mut self.row_of)) {
            if *row == GROUND {
                continue;
            }
            *row = self.sides.len() as u32;
            self.sides.push(Side {
                row: *row,
                inv_mass: body.inv_mass,
                inv_inertia: body.world_inv_inertia(),
            });
            let (state, velocity) = RowState::new(i, body, left(i as usize));
            self.states.push(state);
            self.velocity.push(velocity);
            self.moved.push(bodies::unmoved());
        }
    }

    /// Cuts the coloured edges into blocks of eight.
    fn lay_out(&mut self) {
        self.blocks.clear();
        self.colors.clear();
        self.places.clear();
        let (mut start, mut points, mut last) = (0, 0, None);
        for &(end, color) in &self.graph.runs {
            if last.is_some_and(|last| last != color) {
                self.colors.push(self.blocks.len());
            }
            last = Some(color);
            for chunk in self.graph.order[start as usize..end as usize].chunks(WIDTH) {
                let count = self.edges[chunk[0] as usize].points as usize;
                self.places.extend((0..).take(chunk.len()).map(|lane| (self.blocks.len() as u32, lane)));
                self.blocks.push(Block { first: points, count, ..Block::default() });
                points += count;
            }
            start = end;
        }
        self.colors.push(self.blocks.len());
        self.points.clear();
        self.points.resize(points, PointRow::default());
    }

    fn fill(&mut self, bodies: &[Body], pairs: &[Pair], context: &StepContext<'_>) {
        let StepContext { plan, settings, h, .. } = *context;
        let hertz = settings.contact_hertz.min(0.25 / h);
        let zeta = settings.contact_damping_ratio;
        // Against what does not move a contact may be twice as stiff: only one body has to follow.
        let soft = [Softness::new(hertz, zeta, h), Softness::new(2.0 * hertz, zeta, h)];
        self.rims.clear();
        for (i, (&(block, lane), edge)) in self.places.iter().zip(&self.graph.order).enumerate() {
            self.call_ahead(i, pairs);
            let edge = &self.edges[*edge as usize];
            let pair = &pairs[edge.pair as usize];
            let block = &mut self.blocks[block as usize];
            let points = &mut self.points[block.first..block.first + block.count];
            let manifold = &pair.manifolds[edge.manifold as usize];
            block.fill(
                points,
                lane as usize,
                manifold,
                if plan.friction(manifold.friction) { manifold.friction } else { 0.0 },
                [(pair.a, edge.rows[0]), (pair.b, edge.rows[1])]
                    .map(|(body, row)| (&bodies[body as usize], &self.sides[row as usize])),
                &soft[usize::from(edge.rows.contains(&GROUND))],
            );
            for (side, body) in [pair.a, pair.b].into_iter().enumerate() {
                let side = (side, edge.rows[side], &bodies[body as usize]);
                let rims = (0..manifold.points.len())
                    .filter_map(|i| Rim::of(manifold, i, side, (block.first + i, lane as usize)));
                self.rims.extend(rims.filter(|rim| rim.row != GROUND));
            }
        }
    }

    fn guess_loads(&mut self, bodies: &[Body], pairs: &[Pair], context: &StepContext<'_>) {
        let strength = context.gravity.norm();
        if strength == 0.0 {
            return;
        }
        let (places, blocks) = (&self.places, &self.blocks);
        let place = |slot: usize| {
            let (block, lane) = places[slot];
            let block = &blocks[block as usize];
            (block.first..block.first + block.count, lane as usize)
        };
        self.statics.guess(
            (&self.edges, &self.graph.order),
            (pairs, bodies),
            (-context.gravity / strength, strength * context.h),
            place,
            &mut self.points,
            self.sides.len(),
        );
    }

    /// Finds where the contacts are that resist rolling.
    fn place_rolling(&mut self, rolling: &[RollingConstraint]) {
        self.rolling.clear();
        if rolling.is_empty() {
            return;
        }
        self.slots.clear();
        self.slots.resize(self.edges.len(), 0);
        for (slot, edge) in (0..).zip(&self.graph.order) {
            self.slots[*edge as usize] = slot;
        }
        for (constraint, [pair, manifold, point]) in rolling.iter().map(RollingConstraint::at).enumerate() {
            let key = (pair as u32, manifold as u32);
            if let Ok(edge) = self.edges.binary_search_by_key(&key, |edge| (edge.pair, edge.manifold)) {
                let (block, lane) = self.places[self.slots[edge] as usize];
                let point = self.blocks[block as usize].first + point;
                self.rolling.push(RollingPlace {
                    constraint,
                    rows: self.edges[edge].rows,
                    point,
                    lane: lane as usize,
                });
            }
        }
    }

    /// Runs `count` substeps.
    pub(crate) fn substeps(
        &mut self,
        count: u32,
        bodies: &[Body],
        rolling: &mut [RollingConstraint],
        context: &StepContext<'_>,
    ) {
        let stage = Stage {
            blocks: Shared::new(&mut self.blocks),
            points: Shared::new(&mut self.points),
            rows: BodyRows { velocity: Shared::new(&mut self.velocity), moved: Shared::new(&mut self.moved) },
            states: Shared::new(&mut self.states),
            colors: &self.colors,
            rolling: Shared::new(rolling),
            rolling_places: &self.rolling,
            rims: Shared::new(&mut self.rims),
            bodies,
            context,
        };
        Team::new(context.threads).run(|worker| {
            for index in 0..count {
                stage.substep(worker, index == 0);
            }
        });
    }

    /// Hands the bodies' state back; bodies without contacts fly. `left` and `elsewhere`
    /// as in [`Self::begin`].
    pub(crate) fn store(
        &mut self,
        bodies: &mut [Body],
        gravity: &Vec3,
        left: impl Fn(usize) -> f64,
        elsewhere: impl Fn(u32) -> bool,
    ) {
        let here = |i: usize, body: &Body| body.substeps() && !elsewhere(i as u32);
        for (i, body) in bodies.iter_mut().enumerate().filter(|(i, body)| here(*i, body)) {
            let row = self.row_of[i] as usize;
            if row == GROUND as usize {
                body.flies = true;
                body.acceleration = *gravity;
                body.steady_acceleration = *gravity;
                body.fly(gravity, left(i));
            } else {
                self.states[row - 1].store(body, gravity, left(i), &self.velocity[row], &self.moved[row]);
            }
        }
    }

    /// Hands the impulses back to the contact cache.
    ///
    /// What the whole step has carried is added to where it was solved `piecewise`.
    pub(crate) fn end(&self, pairs: &mut [Pair], piecewise: bool) {
        for (i, (&(block, lane), edge)) in self.places.iter().zip(&self.graph.order).enumerate() {
            self.call_ahead(i, pairs);
            let edge = &self.edges[*edge as usize];
            let pair = &mut pairs[edge.pair as usize];
            let manifold = &mut pair.manifolds[edge.manifold as usize];
            let block = &self.blocks[block as usize];
            let tangents = manifold.tangents;
            let row_points = &self.points[block.first..block.first + block.count];
            for (row, point) in row_points.iter().zip(&mut manifold.points) {
                if !piecewise {
                    (point.step_impulse, point.step_friction) = (0.0, Vec2::zeros());
                }
                let slid = self.displacement(edge.rows, row, lane as usize);
                row.keep(lane as usize, point, Vec2::new(tangents[0].dot(&slid), tangents[1].dot(&slid)));
                pair.touching |= point.step_impulse > 0.0;
            }
        }
    }

    /// Calls the manifold that comes some turns after edge `i` of the order from memory: those of a heap fit into no cache.
    fn call_ahead(&self, i: usize, pairs: &[Pair]) {
        const TURNS: usize = 6;
        if let Some(next) = self.graph.order.get(i + TURNS) {
            let next = &self.edges[*next as usize];
            lanes::prefetch(&pairs[next.pair as usize].manifolds[next.manifold as usize..]);
        }
    }

    /// How far B's surface point has moved from A's since the step began, to first order as the kernels see it.
    fn displacement(&self, rows: [u32; 2], point: &PointRow<S>, lane: usize) -> Vec3 {
        let [a, b] = [0, 1].map(|side| {
            let d = &self.moved[rows[side] as usize].0;
            let wide = |i: usize| Vec3::new(d[i].wide(), d[i + 1].wide(), d[i + 2].wide());
            let arm = &point.arm[side];
            let arm = Vec3::new(arm[0].0[lane].wide(), arm[1].0[lane].wide(), arm[2].0[lane].wide());
            wide(0) + wide(3).cross(&arm)
        });
        b - a
    }
}

impl Side {
    pub(crate) const GROUND: Self = Self {
        row: GROUND,
        inv_mass: 0.0,
        inv_inertia: Mat3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };
}

/// A step as its workers see it.
struct Stage<'a, S> {
    blocks: Shared<'a, Block<S>>,
    points: Shared<'a, PointRow<S>>,
    rows: BodyRows<'a, S>,
    states: Shared<'a, RowState<S>>,
    colors: &'a [usize],
    rolling: Shared<'a, RollingConstraint>,
    rolling_places: &'a [RollingPlace],
    rims: Shared<'a, Rim>,
    bodies: &'a [Body],
    context: &'a StepContext<'a>,
}

impl<S: Precision> Stage<'_, S> {
    /// Forces, soft contacts, motion, and a relaxation that takes out the speed which pushing overlaps apart put in.
    fn substep(&self, worker: Worker<'_>, first: bool) {
        let StepContext { h, gravity, .. } = *self.context;
        let g = [S::of(gravity.x), S::of(gravity.y), S::of(gravity.z)];
        let (step, noise) = (S::of(h), S::of(steady_noise(&gravity)));
        self.each_body(worker, |state, body, velocity, moved| {
            state.accelerate(body, &g, step, velocity, moved)
        });
        if first {
            self.each_contact(worker, Pass::Weigh, first);
            self.each_contact(worker, Pass::WarmStart, first);
            self.resist_rolling(worker, Pass::WarmStart);
        }
        self.each_contact(worker, Pass::Bias, first);
        self.resist_rolling(worker, Pass::Bias);
        self.each_body(worker, |state, _, velocity, moved| state.advance(&g, velocity, moved));
        self.follow_rims(worker);
        self.each_contact(worker, Pass::Relax, first);
        self.resist_rolling(worker, Pass::Relax);
        self.each_body(worker, |state, _, velocity, _| state.note(noise, step, velocity));
    }

    #[allow(unsafe_code, reason = "see share.rs")]
    fn each_body(
        &self,
        worker: Worker<'_>,
        verb: impl Fn(&mut RowState<S>, &Body, &mut Eight<S>, &mut Eight<S>),
    ) {
        for i in worker.share(self.states.len()) {
            // SAFETY: workers have disjoint shares, and meet before anyone else looks at these rows.
            let (state, velocity, moved) =
                unsafe { (self.states.at(i), self.rows.velocity.at(i + 1), self.rows.moved.at(i + 1)) };
            verb(state, &self.bodies[state.body as usize], velocity, moved);
        }
        worker.meet();
    }

    /// Gives what rolls on a rim the point of it that is lowest now.
    #[allow(unsafe_code, reason = "see share.rs")]
    fn follow_rims(&self, worker: Worker<'_>) {
        if self.rims.len() == 0 {
            return;
        }
        // One worker does it: two rims may share a row of points, and few bodies have any.
        for i in (0..self.rims.len()).filter(|_| worker.is_first()) {
            // SAFETY: the other workers wait at the barrier below.
            let (rim, row, state, moved) = unsafe {
                let rim = self.rims.at(i);
                let (point, body) = (rim.point, rim.row as usize);
                (rim, self.points.at(point), self.states.read(body - 1), self.rows.moved.read(body))
            };
            rim.follow(state.start_rotation(), moved, row);
        }
        worker.meet();
    }

    /// One worker does it: few contacts resist, and each sees the spins that the one before has left.
    #[allow(unsafe_code, reason = "see share.rs")]
    fn resist_rolling(&self, worker: Worker<'_>, pass: Pass) {
        if self.rolling_places.is_empty() {
            return;
        }
        if worker.is_first() {
            for place in self.rolling_places {
                let constraint =
                    // SAFETY: the other workers wait at the barrier below.
                    unsafe { self.rolling.at(place.constraint) };
                let mut spins = place.rows.map(|row| {
                    // SAFETY: as above.
                    let v = unsafe { &self.rows.velocity.read(row as usize).0 };
                    Vec3::new(v[3].wide(), v[4].wide(), v[5].wide())
                });
                if pass == Pass::WarmStart {
                    constraint.warm_start(&mut spins);
                } else {
                    // SAFETY: as above.
                    let point = unsafe { self.points.read(place.point) };
                    constraint.solve(&mut spins, point.normal_impulse.0[place.lane].wide());
                }
                for (row, spin) in place.rows.into_iter().zip(spins).filter(|(row, _)| *row != GROUND) {
                    // SAFETY: as above.
                    let v = unsafe { &mut self.rows.velocity.at(row as usize).0 };
                    v[3..6].copy_from_slice(&[S::of(spin.x), S::of(spin.y), S::of(spin.z)]);
                }
            }
        }
        worker.meet();
    }

    #[allow(unsafe_code, reason = "see share.rs")]
    fn each_contact(&self, worker: Worker<'_>, pass: Pass, first: bool) {
        let substep = Substep {
            h: self.context.h,
            max_push_speed: self.context.max_push_speed,
            gravity: self.context.gravity,
            first,
        };
        let mut start = 0;
        for &end in self.colors {
            let share = worker.share(end - start);
            // SAFETY: workers have disjoint shares of a colour, and meet after it.
            let blocks = unsafe { self.blocks.range(start + share.start..start + share.end) };
            S::sweep(blocks, &self.points, &self.rows, pass, &substep, self.context.simd);
            worker.meet();
            start = end;
        }
    }
}
