//! Small islands whose load paths sweeps cannot follow, solved directly.
//!
//! Sequential impulses carry a load down a stack of n bodies in about n² sweeps, and under a mass ratio r in about r.
//! Here the contact law of a whole island is met at once, by the method of multipliers: with multipliers λ̂ and
//! penalties R the impulses are λ(v) = Π(λ̂ - R (J v + b)), Π the projection on Coulomb's cone of the last friction
//! limit, and M (v - v*) = Jᵀ λ(v) is solved by Newton's method on the bodies' 6 × 6 blocks. Multipliers are kept from
//! substep to substep, so that a load which stays needs one solve. Penetration and slip are corrected by a
//! displacement of their own that never becomes velocity.
//!
//! Alart and Curnier 1991 for the projection; Le Lidec et al. 2024 (arXiv 2405.17020) for multipliers with Coulomb
//! friction.

mod choose;
mod matrix;

use nalgebra::{Matrix6, Vector6};

use crate::body::Body;
use crate::collide::manifold::Point;
use crate::collide::pair::Pair;
use crate::math::{Vec2, Vec3, rotated};
use crate::plan::Plan;
use crate::solve::wide::StepContext;

pub(crate) use choose::Islands;
use matrix::BlockMatrix;

/// Penalty over effective mass: what one solve leaves of an error is about its inverse over the island's worst
/// conditioning, and rounding in f64 allows more than this.
const PENALTY: f64 = 1e5;
/// Newton steps, and updates of the multipliers, a substep.
const MAX_NEWTON: u32 = 40;
const MAX_UPDATES: u32 = 6;
const MAX_HALVINGS: u32 = 12;
/// Impulse over that of the island's weight in a substep which is a blow and no load.
const BLOW: f64 = 10.0;
/// Share of an overlap or a slip that is taken back a substep.
const CORRECTION: f64 = 0.25;
/// Share of gravity's speed in a substep by which a multiplier update may still change a velocity.
const TOLERANCE: f64 = 1e-5;

const GROUND: usize = usize::MAX;

/// One contact point of an island.
#[derive(Clone)]
struct Row {
    /// Pair, manifold and point in the contact cache.
    at: (usize, usize, usize),
    /// Place of A and B among the island's bodies, or the ground.
    bodies: [usize; 2],
    /// Normal and tangents.
    axes: [Vec3; 3],
    arms: [Vec3; 2],
    friction: f64,
    /// kg, penalties along the normal and the tangents.
    penalty: [f64; 2],
    /// m, along the normal; and how far it has slipped since it last stuck.
    gap: f64,
    slip: Vec2,
    /// m/s, what the normal velocity is to exceed, negated.
    bias: f64,
    /// N s
    multiplier: Vec3,
    impulse: Vec3,
    /// m/s, its velocity and how a Newton step changes that.
    along: [Vec3; 2],
    /// Its normal and its tangents push back at the present velocities.
    presses: bool,
    sticks: bool,
    /// They did when the matrix was put together.
    held: [bool; 2],
}

/// The bodies and contacts of one island, with storage for all.
#[derive(Clone, Default)]
pub(crate) struct Direct {
    bodies: Vec<usize>,
    place: Vec<usize>,
    rows: Vec<Row>,
    /// s that each body has to go in this substep; and whether a contact carries it.
    spans: Vec<f64>,
    carried: Vec<bool>,
    mass: Vec<Matrix6<f64>>,
    free: Vec<Vector6<f64>>,
    velocity: Vec<Vector6<f64>>,
    change: Vec<Vector6<f64>>,
    work: Vec<Vector6<f64>>,
    matrix: BlockMatrix,
    factored: bool,
    /// The last substep's velocities and multipliers belong to each other.
    settled: bool,
}

impl Direct {
    /// Moves the bodies of one island, of which members and contacts are given, over a step and hands its impulses to the
    /// contact cache; `left` is what a body
    /// has still to go of the first substep, s.
    pub(crate) fn step(
        &mut self,
        island: (&[u32], &[(u32, u32)]),
        bodies: &mut [Body],
        pairs: &mut [Pair],
        left: impl Fn(usize) -> f64,
        substeps: u32,
        context: &StepContext<'_>,
    ) {
        self.begin(context.plan, island, bodies, pairs);
        self.spans.clear();
        self.spans.extend(self.bodies.iter().map(|&i| left(i)));
        for _ in 0..substeps {
            self.substep(bodies, pairs, context);
            self.spans.fill(context.h);
        }
        self.end(pairs, context.gravity.norm() * context.h);
    }

    fn begin(
        &mut self,
        plan: &Plan,
        (members, contacts): (&[u32], &[(u32, u32)]),
        bodies: &[Body],
        pairs: &[Pair],
    ) {
        self.bodies.clear();
        self.bodies.extend(members.iter().map(|i| *i as usize));
        self.place.clear();
        self.place.resize(bodies.len(), GROUND);
        self.mass.clear();
        for (place, &i) in self.bodies.iter().enumerate() {
            self.place[i] = place;
            let body = &bodies[i];
            let turn = body.rotation.to_rotation_matrix();
            let inertia = turn.matrix() * body.inertia * turn.matrix().transpose();
            let mut mass = Matrix6::zeros();
            mass.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(body.mass);
            mass.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
            self.mass.push(mass);
        }
        self.rows.clear();
        for &(p, m) in contacts {
            let pair = &pairs[p as usize];
            if pair.apart {
                continue;
            }
            let manifold = &pair.manifolds[m as usize];
            let (a, b) = (&bodies[pair.a as usize], &bodies[pair.b as usize]);
            for (index, point) in manifold.points.iter().enumerate() {
                let arms = [point.anchor_a.arm(&a.frame()), point.anchor_b.arm(&b.frame())];
                let axes = [manifold.normal, manifold.tangents[0], manifold.tangents[1]];
                let places = [pair.a, pair.b].map(|i| self.place[i as usize]);
                let delassus = |axis: &Vec3| -> f64 {
                    [a, b]
                        .iter()
                        .zip(arms)
                        .zip(places)
                        .filter(|(_, place)| *place != GROUND)
                        .map(|((body, arm), _)| {
                            let lever = arm.cross(axis);
                            body.inv_mass + lever.dot(&(body.world_inv_inertia() * lever))
                        })
                        .sum()
                };
                let [n, u, v] = axes.map(|axis| delassus(&axis));
                self.rows.push(Row {
                    at: (p as usize, m as usize, index),
                    bodies: places,
                    axes,
                    arms,
                    friction: if plan.friction(manifold.friction) { manifold.friction } else { 0.0 },
                    penalty: [PENALTY / n, PENALTY / u.max(v)],
                    gap: 0.0,
                    slip: point.slip,
                    bias: 0.0,
                    multiplier: Vec3::new(
                        point.normal_impulse,
                        point.tangent_impulse.x,
                        point.tangent_impulse.y,
                    ),
                    impulse: Vec3::zeros(),
                    along: [Vec3::zeros(); 2],
                    presses: false,
                    sticks: false,
                    held: [false; 2],
                });
            }
        }
        let links = self.rows.iter().filter(|row| !row.bodies.contains(&GROUND));
        self.matrix.plan(self.bodies.len(), links.map(|row| (row.bodies[0], row.bodies[1])));
        self.factored = false;
    }

    fn substep(&mut self, bodies: &mut [Body], pairs: &mut [Pair], context: &StepContext<'_>) {
        let StepContext { h, gravity, .. } = *context;
        self.free.clear();
        self.velocity.clear();
        for (&i, span) in self.bodies.iter().zip(&self.spans) {
            let body = &bodies[i];
            let spin = if body.tumbles(&body.spin, h) {
                body.torque_free_spin(&body.rotation, &body.spin, h)
            } else {
                body.spin
            };
            let v = body.velocity + gravity * if body.flies { *span } else { h };
            // Starts from where a body at rest stays: if the loads of the substep before still hold, it is the answer.
            let (old, turn) = (body.velocity, body.spin);
            self.velocity.push(Vector6::new(old.x, old.y, old.z, turn.x, turn.y, turn.z));
            self.free.push(Vector6::new(v.x, v.y, v.z, spin.x, spin.y, spin.z));
        }
        for row in &mut self.rows {
            let pair = &pairs[row.at.0];
            let manifold = &pair.manifolds[row.at.1];
            let frames = [pair.a, pair.b].map(|i| bodies[i as usize].frame());
            row.gap = manifold.separation(&manifold.points[row.at.2], &frames[0], &frames[1]);
            row.bias = row.gap.max(0.0) / h;
        }
        self.find_velocities(gravity.norm() * h);
        self.find_corrections(h, context.max_push_speed);
        self.advance(bodies, pairs, context);
    }

    /// The method of multipliers on the velocities.
    fn find_velocities(&mut self, speed: f64) {
        self.settled = true;
        for _ in 0..MAX_UPDATES {
            let mut found = false;
            for _ in 0..MAX_NEWTON {
                if self.residual() <= TOLERANCE * speed {
                    found = true;
                    break;
                }
                if !self.newton() {
                    break;
                }
            }
            if !found {
                // The velocities are as good as any before; impulses that do not belong to them are worse than old ones.
                self.settled = false;
                break;
            }
            let mut largest = 0.0_f64;
            for row in &mut self.rows {
                let error = row.impulse - row.multiplier;
                largest =
                    largest.max((error.x / row.penalty[0]).abs()).max(error.yz().norm() / row.penalty[1]);
                row.multiplier = row.impulse;
            }
            if largest <= TOLERANCE * speed {
                break;
            }
        }
    }

    /// Puts M (free - v) + Jᵀ λ(v) into `change`; the largest of it over a body's mass, m/s.
    fn residual(&mut self) -> f64 {
        self.change.clear();
        self.change.extend(
            self.mass.iter().zip(&self.free).zip(&self.velocity).map(|((mass, free), v)| mass * (free - v)),
        );
        for row in &mut self.rows {
            row.impulse = row.respond(&self.velocity).0;
            row.push(&row.impulse, &mut self.change);
        }
        let size = |(left, mass): (&Vector6<f64>, &Matrix6<f64>)| {
            let reach = (mass[(3, 3)] + mass[(4, 4)] + mass[(5, 5)]) / mass[(0, 0)];
            left.fixed_rows::<3>(0).norm().max(left.fixed_rows::<3>(3).norm() / reach.sqrt()) / mass[(0, 0)]
        };
        self.change.iter().zip(&self.mass).map(size).fold(0.0, f64::max)
    }

    /// One Newton step from the residual in `change`; `false` if there is none.
    fn newton(&mut self) -> bool {
        if !self.factor() {
            return false;
        }
        self.matrix.solve(&mut self.change, &mut self.work);
        self.search();
        true
    }

    /// Puts the matrix together as the contacts are now, and factors it.
    fn factor(&mut self) -> bool {
        self.matrix.clear();
        for (i, mass) in self.mass.iter().enumerate() {
            self.matrix.add(i, i, mass);
        }
        for row in &mut self.rows {
            let (_, stiffness) = row.respond(&self.velocity);
            row.held = [row.presses, row.sticks];
            row.stiffen(&stiffness, &mut self.matrix);
        }
        self.factored = self.matrix.factor();
        self.factored
    }

    /// Goes along the Newton step as far as its convex function falls: the whole way, but for the first few steps
    /// after a blow. What it makes least is the kinetic energy of the change from free motion, and the penalties; along
    /// the step the one is a parabola, and the contacts' velocities are linear.
    fn search(&mut self) {
        let (mut slope, mut curvature) = (0.0, 0.0);
        for (((v, free), change), mass) in
            self.velocity.iter().zip(&self.free).zip(&self.change).zip(&self.mass)
        {
            let momentum = mass * change;
            slope += (v - free).dot(&momentum);
            curvature += change.dot(&momentum);
        }
        for row in &mut self.rows {
            row.along = [row.relative(&self.velocity), row.relative(&self.change)];
        }
        let rows = &self.rows;
        let rise = |share: f64| {
            let penalties = rows.iter().map(|row| row.penalty(&(row.along[0] + row.along[1] * share)));
            share * (slope + 0.5 * share * curvature) + penalties.sum::<f64>()
        };
        let before = rise(0.0);
        let mut share = 1.0;
        for _ in 0..MAX_HALVINGS {
            if rise(share) <= before {
                break;
            }
            share *= 0.5;
        }
        self.velocity.iter_mut().zip(&self.change).for_each(|(v, change)| *v += change * share);
    }

    /// Displacements that take back overlap and slip, by the last factor: what presses keeps its contact meanwhile.
    fn find_corrections(&mut self, h: f64, max_push_speed: f64) {
        self.change.clear();
        self.change.resize(self.bodies.len(), Vector6::zeros());
        let off = |row: &Row| row.presses && (row.gap < 0.0 || row.slip != Vec2::zeros());
        if !self.rows.iter().any(off) || !self.factored && !self.factor() {
            return;
        }
        for row in &self.rows {
            if !row.held[0] {
                continue;
            }
            let push = (-CORRECTION * row.gap.min(0.0)).min(max_push_speed * h);
            let back = if row.held[1] { row.slip * -CORRECTION } else { Vec2::zeros() };
            let impulse = Vec3::new(row.penalty[0] * push, row.penalty[1] * back.x, row.penalty[1] * back.y);
            row.push(&impulse, &mut self.change);
        }
        self.matrix.solve(&mut self.change, &mut self.work);
    }

    fn advance(&mut self, bodies: &mut [Body], pairs: &mut [Pair], context: &StepContext<'_>) {
        let StepContext { h, gravity, .. } = *context;
        for row in &mut self.rows {
            let moved = row.relative(&self.velocity) * h + row.relative(&self.change);
            row.slip =
                if row.multiplier.x > 0.0 && row.sticks { row.slip + moved.yz() } else { Vec2::zeros() };
            let point = &mut pairs[row.at.0].manifolds[row.at.1].points[row.at.2];
            point.step_impulse += row.multiplier.x;
            point.step_friction += row.multiplier.yz();
        }
        self.carried.clear();
        self.carried.resize(self.bodies.len(), false);
        for row in self.rows.iter().filter(|row| row.impulse.x > 0.0) {
            for place in row.bodies.into_iter().filter(|place| *place != GROUND) {
                self.carried[place] = true;
            }
        }
        for (place, &i) in self.bodies.iter().enumerate() {
            let body = &mut bodies[i];
            let span = self.spans[place];
            body.flies = !self.carried[place];
            if body.flies {
                body.acceleration = gravity;
                body.steady_acceleration = gravity;
                body.fly(&gravity, span);
                continue;
            }
            let (v, d) = (&self.velocity[place], &self.change[place]);
            let velocity = Vec3::new(v[0], v[1], v[2]);
            let acceleration = (velocity - body.velocity) / h;
            // What slides or rolls accelerates as steadily: the mean of its velocities moves it.
            let steady = (acceleration - body.acceleration).norm() < 0.02 * gravity.norm();
            body.acceleration = acceleration;
            body.steady_acceleration = if steady { acceleration } else { Vec3::zeros() };
            body.position +=
                (velocity - body.steady_acceleration * (0.5 * span)) * span + Vec3::new(d[0], d[1], d[2]);
            body.velocity = velocity;
            body.spin = Vec3::new(v[3], v[4], v[5]);
            body.rotation = rotated(&body.rotation, &(body.spin * span + Vec3::new(d[3], d[4], d[5])));
        }
    }

    /// Where the last solve did not settle its multipliers are those of an earlier moment. A load that builds up needs some
    /// steps and goes on from them; those of a blow nobody may start from. `speed` is gravity's in a substep.
    fn end(&mut self, pairs: &mut [Pair], speed: f64) {
        let weight: f64 = self.mass.iter().map(|mass| mass[(0, 0)] * speed).sum();
        let blow = |row: &Row| row.multiplier.norm() > BLOW * weight;
        if !self.settled && self.rows.iter().any(blow) {
            self.rows.iter_mut().for_each(|row| row.multiplier = Vec3::zeros());
        }
        for row in &self.rows {
            let pair = &mut pairs[row.at.0];
            let point: &mut Point = &mut pair.manifolds[row.at.1].points[row.at.2];
            pair.touching |= point.step_impulse > 0.0;
            point.normal_impulse = row.multiplier.x;
            point.tangent_impulse = Vec2::new(row.multiplier.y, row.multiplier.z);
            point.slip = row.slip;
        }
    }
}

impl Row {
    /// Velocity of B's surface from A's along normal and tangents.
    fn relative(&self, velocity: &[Vector6<f64>]) -> Vec3 {
        let at = |side: usize| {
            let body = self.bodies[side];
            if body == GROUND {
                return Vec3::zeros();
            }
            let v = &velocity[body];
            Vec3::new(v[0], v[1], v[2]) + Vec3::new(v[3], v[4], v[5]).cross(&self.arms[side])
        };
        let relative = at(1) - at(0);
        Vec3::new(self.axes[0].dot(&relative), self.axes[1].dot(&relative), self.axes[2].dot(&relative))
    }

    /// Impulse at these velocities, and how it stiffens against a change of them.
    fn respond(&mut self, velocity: &[Vector6<f64>]) -> (Vec3, nalgebra::Matrix3<f64>) {
        let u = self.relative(velocity);
        let mut stiffness = nalgebra::Matrix3::zeros();
        let normal = (self.multiplier.x - self.penalty[0] * (u.x + self.bias)).max(0.0);
        self.presses = normal > 0.0;
        if self.presses {
            stiffness.m11 = self.penalty[0];
        }
        // The friction limit is that of the last multiplier: so each Newton problem is a convex one.
        let limit = self.limit();
        if limit == 0.0 {
            self.sticks = false;
            return (Vec3::new(normal, 0.0, 0.0), stiffness);
        }
        let trial = self.multiplier.yz() - u.yz() * self.penalty[1];
        let size = trial.norm();
        self.sticks = size <= limit;
        let tangent = if self.sticks {
            stiffness.m22 = self.penalty[1];
            stiffness.m33 = self.penalty[1];
            trial
        } else {
            let direction = trial / size;
            let across = self.penalty[1] * limit / size;
            let block = (crate::math::Mat2::identity() - direction * direction.transpose()) * across;
            stiffness.fixed_view_mut::<2, 2>(1, 1).copy_from(&block);
            direction * limit
        };
        (Vec3::new(normal, tangent.x, tangent.y), stiffness)
    }

    fn limit(&self) -> f64 {
        self.friction * self.multiplier.x.max(0.0)
    }

    /// The convex function of the contact's velocity of which [`Self::respond`] is the negative slope.
    fn penalty(&self, u: &Vec3) -> f64 {
        let normal = (self.multiplier.x - self.penalty[0] * (u.x + self.bias)).max(0.0);
        let limit = self.limit();
        let size = (self.multiplier.yz() - u.yz() * self.penalty[1]).norm();
        let tangent = if size <= limit { 0.5 * size * size } else { limit * (size - 0.5 * limit) };
        0.5 * normal * normal / self.penalty[0] + tangent / self.penalty[1]
    }

    fn world(&self, along: &Vec3) -> Vec3 {
        self.axes[0] * along.x + self.axes[1] * along.y + self.axes[2] * along.z
    }

    /// Adds Jᵀ impulse.
    fn push(&self, impulse: &Vec3, to: &mut [Vector6<f64>]) {
        let world = self.world(impulse);
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            if self.bodies[side] != GROUND {
                let torque = self.arms[side].cross(&world);
                let to = &mut to[self.bodies[side]];
                for axis in 0..3 {
                    to[axis] += sign * world[axis];
                    to[3 + axis] += sign * torque[axis];
                }
            }
        }
    }

    /// Adds Jᵀ D J.
    fn stiffen(&self, stiffness: &nalgebra::Matrix3<f64>, matrix: &mut BlockMatrix) {
        if stiffness.iter().all(|x| *x == 0.0) {
            return;
        }
        let basis = nalgebra::Matrix3::from_columns(&self.axes);
        let world = basis * stiffness * basis.transpose();
        // With J = ±[1, -r×] of a side: the block of sides (i, j) is [k, -k r_j×; r_i× k, -r_i× k r_j×].
        for i in 0..2 {
            for j in 0..=i {
                let (a, b) = (self.bodies[i], self.bodies[j]);
                if a == GROUND || b == GROUND {
                    continue;
                }
                let sign = if i == j { 1.0 } else { -1.0 };
                let (left, right) = (self.arms[i].cross_matrix(), self.arms[j].cross_matrix());
                let mut block = Matrix6::zeros();
                block.fixed_view_mut::<3, 3>(0, 0).copy_from(&(world * sign));
                block.fixed_view_mut::<3, 3>(0, 3).copy_from(&(world * right * -sign));
                block.fixed_view_mut::<3, 3>(3, 0).copy_from(&(left * world * sign));
                block.fixed_view_mut::<3, 3>(3, 3).copy_from(&(left * world * right * -sign));
                matrix.add(a, b, &block);
            }
        }
    }
}
