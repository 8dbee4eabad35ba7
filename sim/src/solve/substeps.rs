//! The small steps of a step: impacts at their time, then contacts.

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::frame::Event;
use crate::phase::{Observer, Phase};
use crate::plan::Plan;
use crate::settings::{Precision, Settings};
use crate::solve::direct::{Direct, Islands};
use crate::solve::impact::{ImpactBuffers, Impacts};
use crate::solve::lone::Lone;
use crate::solve::rolling::{self, RollingConstraint};
use crate::solve::wide::{self, Contacts, StepContext};
use crate::step::StepReport;
use crate::work::Work;
use crate::world::World;

/// The solvers with their storage, which serves all steps.
#[derive(Clone)]
pub(crate) struct Solver {
    contacts: Wide,
    islands: Islands,
    direct: Direct,
    lone: Lone,
    /// s into the substep at which each body is.
    elapsed: Vec<f64>,
    impacts: ImpactBuffers,
    /// Those of the step before, while the next are found.
    rolling: Vec<RollingConstraint>,
}

/// The sweeping solver in the precision of the settings.
#[derive(Clone)]
enum Wide {
    Single(Contacts<f32>),
    Double(Contacts<f64>),
}

impl Solver {
    pub(crate) fn new(settings: &Settings) -> Self {
        let contacts = match settings.precision {
            Precision::Single => Wide::Single(Contacts::default()),
            Precision::Double => Wide::Double(Contacts::default()),
        };
        Self {
            contacts,
            islands: Islands::default(),
            direct: Direct::default(),
            lone: Lone::default(),
            elapsed: Vec::new(),
            impacts: ImpactBuffers::default(),
            rolling: Vec::new(),
        }
    }
}

impl World {
    /// Moves all bodies that something is near over the step, contacts and impacts included.
    pub(crate) fn solve(&mut self, report: &mut StepReport, observer: &mut dyn Observer) {
        let settings = &self.settings;
        let context = StepContext {
            plan: &self.plan,
            settings,
            h: settings.dt_s / f64::from(settings.substeps),
            gravity: self.gravity,
            max_push_speed: settings.max_push_speed_m_s,
            simd: settings.simd && wide::simd_available(),
            threads: settings.threads,
        };
        if self.plan.rolling() {
            observer.enters(Phase::Rolling);
            let found = &mut self.solver.rolling;
            rolling::prepare(&self.plan, &self.pairs, &self.bodies, &self.rolling, found);
            std::mem::swap(&mut self.rolling, found);
            report.work.rolling_points += self.rolling.len() as u64;
        }
        report.work.friction_points += friction_points(&self.plan, &self.bodies, &self.pairs);
        let Solver { contacts, islands, direct, lone, elapsed, impacts, .. } = &mut self.solver;
        islands.find(&self.bodies, &self.pairs, &self.rolling, &self.gravity, &self.plan);
        let solved = islands.bodies();
        report.work.lone_bodies += solved[0];
        report.work.direct_bodies += solved[1];
        let step = Step {
            islands,
            direct,
            lone,
            elapsed,
            impact_buffers: impacts,
            rolling: &mut self.rolling,
            bodies: &mut self.bodies,
            pairs: &mut self.pairs,
            events: &mut self.output.events,
            work: &mut report.work,
            observer,
            context,
        };
        report.impacts += match contacts {
            Wide::Single(contacts) => step.solve(contacts),
            Wide::Double(contacts) => step.solve(contacts),
        };
    }
}

fn friction_points(plan: &Plan, bodies: &[Body], pairs: &[Pair]) -> u64 {
    let awake = |i: u32| bodies[i as usize].is_awake();
    let live = pairs.iter().filter(|pair| awake(pair.a) || awake(pair.b));
    let rough = live.flat_map(|pair| &pair.manifolds).filter(|manifold| plan.friction(manifold.friction));
    rough.map(|manifold| manifold.points.len() as u64).sum()
}

struct Step<'a> {
    islands: &'a Islands,
    direct: &'a mut Direct,
    lone: &'a mut Lone,
    elapsed: &'a mut Vec<f64>,
    impact_buffers: &'a mut ImpactBuffers,
    rolling: &'a mut [RollingConstraint],
    bodies: &'a mut [Body],
    pairs: &'a mut [Pair],
    events: &'a mut Vec<Event>,
    work: &'a mut Work,
    observer: &'a mut dyn Observer,
    context: StepContext<'a>,
}

impl Step<'_> {
    /// Returns how many impacts there were.
    fn solve<S: wide::Precision>(mut self, contacts: &mut Contacts<S>) -> u32 {
        let substeps = self.context.settings.substeps;
        if !self.context.plan.impacts() {
            // Nothing looks at the bodies between the small steps, so they run in one go.
            self.observer.enters(Phase::Contacts);
            self.begin(contacts);
            self.contacts(contacts, substeps);
            contacts.end(self.pairs, false);
            return 0;
        }
        let mut impacts = 0;
        self.elapsed.clear();
        self.elapsed.resize(self.bodies.len(), 0.0);
        for _ in 0..substeps {
            self.elapsed.fill(0.0);
            self.observer.enters(Phase::Impacts);
            impacts += self.impacts();
            self.observer.enters(Phase::Contacts);
            self.begin(contacts);
            self.contacts(contacts, 1);
            contacts.end(self.pairs, true);
        }
        impacts
    }

    fn begin<S: wide::Precision>(&self, contacts: &mut Contacts<S>) {
        let h = self.context.h;
        contacts.begin(
            self.bodies,
            self.pairs,
            self.rolling,
            |i| h - self.gone(i),
            |i| self.islands.has(i as usize),
            &self.context,
        );
    }

    /// s of the first substep by which an impact has already moved a body.
    fn gone(&self, body: usize) -> f64 {
        self.elapsed.get(body).copied().unwrap_or(0.0)
    }

    /// Runs `substeps` of contacts.
    fn contacts<S: wide::Precision>(&mut self, contacts: &mut Contacts<S>, substeps: u32) {
        let StepContext { h, gravity, .. } = self.context;
        let islands = self.islands;
        let elapsed = &*self.elapsed;
        let span = h * f64::from(substeps);
        let gone = |i: usize| elapsed.get(i).copied().unwrap_or(0.0);
        contacts.substeps(substeps, self.bodies, self.rolling, &self.context);
        contacts.store(self.bodies, &gravity, |i| span - gone(i), |i| islands.has(i as usize));
        for island in 0..islands.count {
            let (members, edges) = (&islands.members[island], &islands.contacts[island]);
            if !self.context.plan.impacts() {
                edges.iter().for_each(|&(p, m)| self.pairs[p as usize].manifolds[m as usize].begin_step());
            }
            let left = |i: usize| h - gone(i);
            if islands.lone[island] {
                let i = members[0] as usize;
                let state = (&mut *self.bodies, &mut *self.pairs, &mut *self.rolling);
                self.lone.step((i, edges), state, left(i), substeps, &self.context);
            } else {
                self.direct.step((members, edges), self.bodies, self.pairs, left, substeps, &self.context);
            }
        }
    }

    fn impacts(&mut self) -> u32 {
        let StepContext { h, gravity, .. } = self.context;
        Impacts {
            plan: self.context.plan,
            work: self.work,
            threshold: 2.0 * gravity.norm() * h,
            bodies: self.bodies,
            pairs: self.pairs,
            gravity,
            h,
            elapsed: self.elapsed,
            buffers: self.impact_buffers,
            events: self.events,
        }
        .resolve()
    }
}
