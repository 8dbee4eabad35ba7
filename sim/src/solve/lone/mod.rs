//! A body that touches nothing which moves, solved for itself: an energy-momentum method between its landings.
//!
//! Between landings the contacts that are closed act at the mean of their arms before and after, so that with Cayley's
//! map the displacement of a contact point is exactly the interval times its mean velocity ([`motion`]). A normal impulse
//! on a point that stays on its plane, and friction on a point that stays in its place, then do no work at all, whatever
//! the length of the interval: a body that pivots keeps its energy as one that flies does. What slides is braked
//! against its velocity at the end of the interval, where it stops for good.
//!
//! A point that comes down within the interval ends it at that moment. The landing is a plastic impact by the same two
//! laws on the velocities after it (Moreau 1988); its work is Σ p·(u + u′)/2 ≤ 0. So energy is never created, and an edge
//! of a block that rocks takes what Housner (1963) says.
//!
//! Rejected: sweeps with the arms of the beginning of the step. A pivot then moves along its tangent, is driven
//! into the ground and pushed out again, which at 8 rad/s adds some thousandths of the energy; and a landing that waits for the end of its
//! substep loses up to a tenth of what a rocking block keeps.

mod motion;
mod patch;
mod rim;
mod row;

use crate::body::Body;
use crate::collide::pair::Pair;
use crate::math::{Mat3, Vec2, Vec3};
use crate::solve::rolling::{self, RollingConstraint};
use crate::solve::wide::StepContext;

use motion::{Interval, State, cayley};
use row::Row;

/// rad, most that a body turns in one interval; and intervals a substep at which that is given up.
const MAX_TURN_RAD: f64 = 0.1;
const MAX_INTERVALS: f64 = 8.0;
/// Landings a substep; what else comes down stops at the end of its substep.
const MAX_LANDINGS: u32 = 8;
/// Trials for the moment of a landing.
const MAX_TRIALS: u32 = 24;
/// Sweeps over the points for one interval or landing.
const MAX_SWEEPS: u32 = 64;
/// Share of gravity's speed in a substep to which velocities are found.
const TOLERANCE: f64 = 1e-8;
/// Over the tolerance, by how much the last sweep may still change a velocity.
const RUNS_AWAY: f64 = 1e7;
/// Share of gravity's speed in an interval below which a point sticks.
const STICKS: f64 = 1e-4;
/// Share of the body's size up to which a gap is closed.
const CLOSED: f64 = 1e-6;
/// Approach over the tolerance from which a landing is a blow of its own, not what an interval has left.
const BLOW: f64 = 1e6;
/// Share of an overlap that is taken back a substep.
const CORRECTION: f64 = 0.25;

/// The solver with its storage, which serves all bodies.
#[derive(Clone, Default)]
pub(crate) struct Lone {
    rows: Vec<Row>,
    /// What resists rolling over corners.
    corners: Vec<RollingConstraint>,
    /// s over which the rows' impulses act.
    span: f64,
    pushes: Vec<f64>,
}

/// What is the same for a body during a step.
struct Scope<'a> {
    body: &'a Body,
    gravity: Vec3,
    /// m/s
    tolerance: f64,
    /// m
    closed: f64,
}

impl Lone {
    /// Moves body `i` over a step; `contacts` are its manifolds as pair and place, and among `rolling` is what resists its
    /// rolling. `left` is what it has still to go of the first substep, s.
    pub(crate) fn step(
        &mut self,
        (i, contacts): (usize, &[(u32, u32)]),
        (bodies, pairs, rolling): (&mut [Body], &mut [Pair], &mut [RollingConstraint]),
        left: f64,
        substeps: u32,
        context: &StepContext<'_>,
    ) {
        let StepContext { h, gravity, .. } = *context;
        self.begin(i, contacts, bodies, pairs, context);
        let body = &bodies[i];
        let scope = Scope {
            body,
            gravity,
            tolerance: TOLERANCE * gravity.norm() * h,
            closed: CLOSED * body.reach + 1e-14 * body.position.norm(),
        };
        let mut state = State::of(body);
        if !body.flies {
            // An impact has moved it without its weight, which something carried.
            state.velocity += gravity * (h - left);
        }
        let mut before = state.velocity;
        for substep in 0..substeps {
            let span = if substep == 0 { left } else { h };
            self.push_apart(&scope, &mut state, context.max_push_speed * span);
            before = state.velocity;
            self.advance(&scope, &mut state, span);
            self.resist_rolling(i, rolling, &mut state);
        }
        self.end(pairs, h);
        let body = &mut bodies[i];
        state.store(body);
        let acceleration = (state.velocity - before) / h;
        body.flies = !self.rows.iter().any(|row| row.impulse.x > 0.0);
        // As for every other body, should sweeps take it over.
        let steady = (acceleration - body.acceleration).norm() < 0.02 * gravity.norm();
        body.acceleration = acceleration;
        body.steady_acceleration = if steady { acceleration } else { Vec3::zeros() };
    }

    fn begin(
        &mut self,
        i: usize,
        contacts: &[(u32, u32)],
        bodies: &[Body],
        pairs: &[Pair],
        context: &StepContext<'_>,
    ) {
        self.rows.clear();
        self.span = context.h;
        let axes = State::of(&bodies[i]).axes();
        for &(p, m) in contacts {
            let pair = &pairs[p as usize];
            if pair.apart {
                continue;
            }
            let manifold = &pair.manifolds[m as usize];
            let friction = if context.plan.friction(manifold.friction) { manifold.friction } else { 0.0 };
            let points = 0..manifold.points.len();
            let on_b = pair.b as usize == i;
            let first = self.rows.len();
            self.rows
                .extend(points.map(|k| Row::new((p as usize, m as usize, k), pairs, bodies, on_b, friction)));
            let child = if on_b { manifold.key.1 } else { manifold.key.0 };
            let lowest = self.rows[first..].iter_mut().min_by(|a, b| a.gap.total_cmp(&b.gap));
            if let (Some(row), Some(shape)) = (lowest, bodies[i].colliders.get(child as usize)) {
                row.follow_rim(shape, &axes);
            }
        }
        self.corners.clear();
        if context.plan.rolling() {
            let found = self.rows.iter().filter_map(|row| {
                let [arm, _] = row.arms(&axes);
                rolling::at_corner(context.plan, (pairs, bodies), row.at, arm.norm())
            });
            self.corners.extend(found);
        }
    }

    /// Moves the body out of what it overlaps, `most` metres at a point at most.
    fn push_apart(&mut self, scope: &Scope<'_>, state: &mut State, most: f64) {
        if !self.rows.iter().any(|row| row.gap < -2.0 * scope.closed) {
            return;
        }
        let axes = state.axes();
        let inv_mass = scope.body.inv_mass;
        self.weigh(scope, &axes, &axes, |_| true);
        self.pushes.clear();
        self.pushes.resize(self.rows.len(), 0.0);
        let mut way = [Vec3::zeros(); 2];
        for _ in 0..MAX_LANDINGS {
            for (row, push) in self.rows.iter().zip(&mut self.pushes) {
                let wanted = if row.gap < 0.0 { (-CORRECTION * row.gap).min(most) } else { -row.gap };
                row.push_apart(inv_mass, wanted, push, &mut way);
            }
        }
        state.frame.position += way[0];
        state.frame.rotation = cayley(&state.frame.rotation, &way[1]);
        let after = state.axes();
        self.rows.iter_mut().for_each(|row| row.gap += row.opened(&way[0], &axes, &after));
    }

    /// Moves by `left` seconds, from landing to landing.
    fn advance(&mut self, scope: &Scope<'_>, state: &mut State, mut left: f64) {
        let shortest = left / MAX_INTERVALS;
        let mut landings = 0;
        self.land(scope, state, true);
        while left > 0.0 {
            let turn = state.spin.norm() * left;
            let pieces = (turn / MAX_TURN_RAD).ceil().max(1.0);
            let mut span = (left / pieces).max(shortest).min(left);
            let patient = landings < MAX_LANDINGS;
            self.note_sticking(scope, state, span);
            let mut end = self.trial(scope, state, span, patient);
            if patient && self.lowest_open() < -scope.closed {
                (span, end) = self.find_landing(scope, state, span);
                landings += 1;
            }
            left -= span;
            if left < 1e-9 * shortest {
                left = 0.0;
            }
            self.span = span;
            for row in &mut self.rows {
                row.gap = row.next_gap;
                row.total += row.impulse;
                row.kept = row.impulse;
            }
            *state = end;
            self.land(scope, state, false);
        }
    }

    /// Brakes the spin as far as what each contact has carried since allows; friction tells the velocity.
    fn resist_rolling(&mut self, i: usize, rolling: &mut [RollingConstraint], state: &mut State) {
        let rolling = rolling.iter_mut().filter(|constraint| constraint.bodies().contains(&(i as u32)));
        for constraint in rolling.chain(&mut self.corners) {
            let at = constraint.at();
            if let Some(row) = self.rows.iter_mut().find(|row| [row.at.0, row.at.1, row.at.2] == at) {
                let carried = row.total.x - row.resisted;
                row.resisted = row.total.x;
                constraint.brake(i, &mut state.spin, carried);
            }
        }
    }

    /// Which points are closed where the body is now, and where their friction acts.
    fn mark_closed(&mut self, scope: &Scope<'_>, axes: &Mat3) {
        let mut changed = false;
        for row in &mut self.rows {
            let closed = row.gap <= scope.closed;
            changed |= closed != row.closed;
            row.closed = closed;
        }
        if changed {
            patch::draw_in(&mut self.rows, axes);
        }
    }

    /// Which of the closed points stick as an interval begins.
    fn note_sticking(&mut self, scope: &Scope<'_>, state: &State, span: f64) {
        let slow = STICKS * scope.gravity.norm() * span;
        let axes = state.axes();
        for row in &mut self.rows {
            row.sticks = false;
            if row.closed {
                let slip = row.velocity(&state.velocity, &state.spin, &row.arms(&axes)).yz();
                row.sticks = slip.norm() < slow;
            } else {
                (row.impulse, row.kept) = (Vec3::zeros(), Vec3::zeros());
            }
        }
    }

    /// The smallest gap at the end of the last trial of what was open at its start, m.
    fn lowest_open(&self) -> f64 {
        self.rows.iter().filter(|row| !row.closed).map(|row| row.next_gap).fold(f64::INFINITY, f64::min)
    }

    /// The moment in an interval of `span` seconds, at the end of which something overlaps, at which it lands; and the state
    /// then. By false position (Illinois).
    fn find_landing(&mut self, scope: &Scope<'_>, state: &State, span: f64) -> (f64, State) {
        let open = self.rows.iter().filter(|row| !row.closed);
        let (mut low, mut above) = (0.0, open.map(|row| row.gap).fold(f64::INFINITY, f64::min));
        let (mut high, mut below) = (span, self.lowest_open());
        let mut t = span;
        for trial in 0..MAX_TRIALS {
            t = if trial < MAX_TRIALS / 2 {
                low + (high - low) * above / (above - below)
            } else {
                0.5 * (low + high)
            };
            let end = self.trial(scope, state, t, true);
            let gap = self.lowest_open();
            if gap.abs() <= scope.closed {
                return (t, end);
            }
            if gap > 0.0 {
                (low, above, below) = (t, gap, 0.5 * below);
            } else {
                (high, below, above) = (t, gap, 0.5 * above);
            }
        }
        (t, self.trial(scope, state, t, true))
    }

    /// The state after `span` seconds. Unless `patient`, also what is open stops where it lands, at the end of the interval.
    fn trial(&mut self, scope: &Scope<'_>, start: &State, span: f64, patient: bool) -> State {
        let acts = |row: &Row| row.closed || !patient;
        let end = if self.rows.iter().any(acts) {
            self.driven(scope, start, span, patient).unwrap_or_else(|| {
                // The lowest point of a rim that lies nearly flat runs round it faster than the sweeps can follow.
                let axes = start.axes();
                self.rows.iter_mut().for_each(|row| row.leave_rim(&axes));
                self.driven(scope, start, span, patient).unwrap_or_else(|| {
                    // No impulse is no energy; what sinks in meanwhile is moved out.
                    self.rows.iter_mut().for_each(|row| row.impulse = Vec3::zeros());
                    fly(scope.body, start, &scope.gravity, span)
                })
            })
        } else {
            fly(scope.body, start, &scope.gravity, span)
        };
        let (before, after) = (start.axes(), end.axes());
        let way = end.frame.position - start.frame.position;
        self.rows.iter_mut().for_each(|row| row.next_gap = row.gap + row.opened(&way, &before, &after));
        end
    }

    /// The same where something holds the body; `None` where the sweeps run away.
    fn driven(&mut self, scope: &Scope<'_>, start: &State, span: f64, patient: bool) -> Option<State> {
        let body = scope.body;
        let weight = scope.gravity * (body.mass * span);
        let acts = |row: &Row| row.closed || !patient;
        let mut interval = Interval::new(body, start, span);
        self.weigh(scope, &interval.start_axes, &interval.end_axes, acts);
        let share = span / self.span;
        self.rows.iter_mut().for_each(|row| row.impulse = row.kept * share);
        let mut largest = 0.0;
        for _ in 0..MAX_SWEEPS {
            let turned = self.drive(scope, &mut interval, &weight);
            let mut change = [Vec3::zeros(); 2];
            largest = turned * body.reach;
            for row in self.rows.iter_mut().filter(|row| acts(row)) {
                row.judge(&interval, span, patient);
                largest = row.solve(body.inv_mass, &mut change).max(largest);
            }
            if largest <= scope.tolerance {
                break;
            }
        }
        self.drive(scope, &mut interval, &weight);
        (largest <= RUNS_AWAY * scope.tolerance).then_some(interval.end)
    }

    /// Brings an interval up to the impulses of the rows; returns by how much that changes the spin, rad/s.
    fn drive(&self, scope: &Scope<'_>, interval: &mut Interval, weight: &Vec3) -> f64 {
        let (mut impulse, mut moment) = (*weight, Vec3::zeros());
        let axes = interval.mean_axes();
        for row in &self.rows {
            impulse += row.world_impulse();
            moment += row.moment(&row.arms(&axes));
        }
        let before = interval.end.spin;
        interval.drive(scope.body, &impulse, &moment);
        (interval.end.spin - before).norm()
    }

    /// Brings the Delassus matrices of some rows up to the mean of two sets of body axes.
    fn weigh(&mut self, scope: &Scope<'_>, before: &Mat3, after: &Mat3, which: impl Fn(&Row) -> bool) {
        let mean = (before + after) * 0.5;
        let inv_inertia = mean * scope.body.inv_inertia * mean.transpose();
        for row in self.rows.iter_mut().filter(|row| which(row)) {
            row.weigh(scope.body.inv_mass, &inv_inertia, &row.arms(&mean));
        }
    }

    /// A plastic impact of all that is closed and approaches. After an interval its impulses count for the limits of
    /// friction, so that the impact also takes out what the interval has left of velocity in what is held.
    fn land(&mut self, scope: &Scope<'_>, state: &mut State, fresh: bool) {
        let axes = state.axes();
        self.mark_closed(scope, &axes);
        let (mut moves, mut closed, mut fastest) = (false, 0, 0.0_f64);
        for row in self.rows.iter_mut().filter(|row| row.closed) {
            closed += 1;
            row.speed = row.velocity(&state.velocity, &state.spin, &row.arms(&axes));
            fastest = fastest.max(-row.speed.x);
            moves |= row.speed.x < -scope.tolerance;
            moves |= !fresh && row.sticks && row.speed.yz().norm() > scope.tolerance;
        }
        if !moves {
            return;
        }
        self.weigh(scope, &axes, &axes, |row| row.closed);
        for row in self.rows.iter_mut() {
            if fresh {
                row.impulse = Vec3::zeros();
            }
            row.total -= row.impulse;
            row.least = row.impulse.x;
        }
        let mut change = [Vec3::zeros(); 2];
        let alone = closed == 1 && fastest > BLOW * scope.tolerance;
        if let Some(row) = self.rows.iter_mut().find(|row| alone && row.closed) {
            row.strike(scope.body.inv_mass, &mut change);
        }
        for _ in 0..if alone { 0 } else { MAX_SWEEPS } {
            let mut largest = 0.0_f64;
            for row in self.rows.iter_mut().filter(|row| row.closed) {
                largest = row.solve(scope.body.inv_mass, &mut change).max(largest);
            }
            if largest <= scope.tolerance {
                break;
            }
        }
        for row in &mut self.rows {
            row.total += row.impulse;
            row.least = 0.0;
        }
        state.velocity += change[0];
        state.spin += change[1];
    }

    /// Hands the impulses to the contact cache; those of the last interval as over `h` seconds.
    fn end(&self, pairs: &mut [Pair], h: f64) {
        let share = h / self.span;
        for row in &self.rows {
            let pair = &mut pairs[row.at.0];
            let point = &mut pair.manifolds[row.at.1].points[row.at.2];
            point.step_impulse += row.total.x;
            pair.touching |= point.step_impulse > 0.0;
            point.step_friction += row.total.yz();
            point.normal_impulse = row.kept.x * share;
            point.tangent_impulse = row.kept.yz() * share;
            point.slip = Vec2::zeros();
        }
    }
}

/// Without contacts.
fn fly(body: &Body, start: &State, gravity: &Vec3, span: f64) -> State {
    let mut end = *start;
    end.frame.position += (start.velocity + gravity * (0.5 * span)) * span;
    end.velocity += gravity * span;
    let inertia = [&body.inertia, &body.inv_inertia];
    (end.frame.rotation, end.spin) = body.rotor.turned(inertia, &start.frame.rotation, &start.spin, span);
    end
}
