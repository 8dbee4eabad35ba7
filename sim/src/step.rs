//! One step, verbs in order.

use crate::body::Body;
use crate::collide::narrow;
use crate::flight::Launch;
use crate::frame::{Event, SleepState};
use crate::math::{Vec3, quaternion};
use crate::phase::{Observer, Phase};
use crate::rotation::Rotor;
use crate::scene::Change;
use crate::sleep;
use crate::solve::hold;
use crate::solve::wide::simd_available;
use crate::work::Work;
use crate::world::World;

/// What a step did; it never fails.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    pub pairs: u32,
    pub manifolds: u32,
    pub impacts: u32,
    pub quarantined: u32,
    /// What was done for it.
    pub work: Work,
}

impl World {
    /// Advances by [`crate::Settings::dt_s`].
    pub fn step(&mut self) -> StepReport {
        self.step_observed(&mut ())
    }

    /// [`World::step`] with somebody who is told of its phases.
    pub fn step_observed(&mut self, observer: &mut dyn Observer) -> StepReport {
        let mut report = StepReport::default();
        self.output.clear();
        observer.enters(Phase::Actions);
        self.act();
        self.note_start();
        if self.plan.meetings() {
            observer.enters(Phase::BroadPhase);
            self.update_pairs(&mut report);
            observer.enters(Phase::NarrowPhase);
            self.update_manifolds(&mut report);
        }
        observer.enters(Phase::Prepare);
        self.mark_free(&mut report);
        if self.bodies.iter().any(Body::substeps) {
            self.solve(&mut report, observer);
            hold::hold(&mut self.bodies, &mut self.pairs, &self.narrow.fast);
        }
        observer.enters(Phase::Flight);
        self.fly();
        observer.enters(Phase::Sleep);
        self.quarantine(&mut report);
        self.step += 1;
        let now_s = self.time_s();
        sleep::update(
            &mut self.sleepers,
            &mut self.bodies,
            &self.pairs,
            &self.settings,
            now_s,
            &mut self.output.events,
        );
        report
    }

    /// Applies the actions that fall into this step and wakes what they touch.
    fn act(&mut self) {
        let end = self.time_s() + self.settings.dt_s;
        while let Some((index, action)) = self.actions.get(self.next_action).copied() {
            // A hair of the step, so that an action at a step's very end is not taken a step early by rounding.
            if action.time_s >= end - 1e-9 * self.settings.dt_s {
                break;
            }
            self.next_action += 1;
            let body = &mut self.bodies[action.entity];
            match action.change {
                Change::SetPose(pose) => {
                    body.position = pose.position.into();
                    body.rotation = quaternion(pose.rotation);
                }
                Change::SetVelocity(velocity) if !body.is_static() => {
                    body.velocity = velocity.linear.into();
                    body.spin = velocity.angular.into();
                }
                Change::SetVelocity(_) => {}
            }
            body.flies = !body.is_static();
            self.output.events.push(Event::Acted { index });
            self.wake_neighbourhood(action.entity);
        }
    }

    /// Wakes a body and everything that it touched.
    fn wake_neighbourhood(&mut self, entity: usize) {
        let touched: Vec<usize> = self
            .pairs
            .iter()
            .filter(|pair| pair.a as usize == entity || pair.b as usize == entity)
            .flat_map(|pair| [pair.a as usize, pair.b as usize])
            .chain([entity])
            .collect();
        for i in touched {
            let body = &mut self.bodies[i];
            if !body.is_static() {
                body.sleep = SleepState::Active;
                body.still_s = 0.0;
                body.still_from = body.frame();
            }
        }
    }

    /// How far beyond where its velocity takes it a body may meet others within the step, m.
    fn reach(&self, body: &Body) -> f64 {
        let dt = self.settings.dt_s;
        let margin = 0.05 * body.inner_radius;
        if !body.is_awake() {
            return margin;
        }
        // What bounces may come back the way it went.
        let back = if self.plan.impacts() { body.velocity.norm() } else { 0.0 };
        margin + dt * (back + body.spin.norm() * body.reach + dt * self.gravity.norm())
    }

    /// Where every body is, should one have to be put back there.
    fn note_start(&mut self) {
        self.start.clear();
        self.start.extend(self.bodies.iter().map(Body::frame));
    }

    fn update_pairs(&mut self, report: &mut StepReport) {
        let dt = self.settings.dt_s;
        for i in 0..self.bodies.len() {
            let reach = self.reach(&self.bodies[i]);
            let body = &mut self.bodies[i];
            let frame = (&body.frame()).into();
            let bounds = body
                .colliders
                .iter_mut()
                .map(|child| child.place(&frame))
                .reduce(|all, one| all.merged(&one));
            if let Some(bounds) = bounds {
                let way = if body.is_awake() { body.velocity * dt } else { Vec3::zeros() };
                body.aabb = bounds.merged(&bounds.shifted(&way)).grown(reach);
            }
        }
        let (near, changed) = self.broad.update(&self.bodies, self.settings.dt_s);
        if changed {
            self.pair_cache.carry_over(&mut self.pairs, near);
        }
        report.work.broad_phases += 1;
        report.pairs = u32::try_from(self.pairs.len()).unwrap_or(u32::MAX);
    }

    fn update_manifolds(&mut self, report: &mut StepReport) {
        let ahead = narrow::Ahead {
            dt: self.settings.dt_s,
            gravity: self.gravity.norm(),
            keep_share: self.settings.contact_keep_share,
            simd: self.settings.simd && simd_available(),
            piecewise: self.plan.impacts(),
        };
        let events = &mut self.output.events;
        let deep = |a, b, depth_m| events.push(Event::Overlap { a, b, depth_m });
        let moving = (&*self.bodies, self.broad.travels());
        let manifolds = self.narrow.update(&mut self.pairs, moving, ahead, self.settings.threads, deep);
        report.manifolds = u32::try_from(manifolds).unwrap_or(u32::MAX);
    }

    /// What has no surface near takes the step at once; the rest goes through the small steps.
    fn mark_free(&mut self, report: &mut StepReport) {
        let flight = self.plan.flight();
        for body in &mut self.bodies {
            body.free = flight && body.is_awake();
        }
        let awake = |bodies: &[Body], i: u32| bodies[i as usize].is_awake();
        for pair in &mut self.pairs {
            // Who solves a pair's contacts says anew whether it touches.
            pair.touching &= !awake(&self.bodies, pair.a) && !awake(&self.bodies, pair.b);
            if !pair.manifolds.is_empty() {
                self.bodies[pair.a as usize].free = false;
                self.bodies[pair.b as usize].free = false;
            }
        }
        let work = &mut report.work;
        for body in self.bodies.iter_mut().filter(|body| body.is_awake()) {
            if body.free {
                work.flights += 1;
            } else {
                work.substepped += 1;
                body.launch = None;
            }
            match body.rotor {
                Rotor::Isotropic => work.isotropic_turns += 1,
                Rotor::Symmetric { .. } => work.symmetric_turns += 1,
                Rotor::Asymmetric => work.asymmetric_turns += 1,
            }
        }
    }

    /// Moves what is free by the whole step.
    fn fly(&mut self) {
        let (dt, gravity) = (self.settings.dt_s, self.gravity);
        for body in self.bodies.iter_mut().filter(|body| body.free) {
            let launch = Launch::fly(body.launch, &body.position, &body.velocity, &gravity, dt);
            [body.position, body.velocity] = launch.state();
            body.launch = Some(launch);
            body.turn(dt);
            body.flies = true;
            body.acceleration = gravity;
            body.steady_acceleration = gravity;
        }
    }

    /// Puts a body whose state is no number back to where the step began, stops it and takes it out of play: one
    /// bad body must not spoil the others.
    fn quarantine(&mut self, report: &mut StepReport) {
        for ((i, body), start) in (0..).zip(&mut self.bodies).zip(&self.start) {
            let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
            let good = finite(&body.position)
                && finite(&body.velocity)
                && finite(&body.spin)
                && body.rotation.coords.iter().all(|x| x.is_finite());
            if good || body.quarantined {
                continue;
            }
            body.position = start.position;
            body.rotation = start.rotation;
            body.velocity = Vec3::zeros();
            body.spin = Vec3::zeros();
            body.inv_mass = 0.0;
            body.inv_inertia = crate::math::Mat3::zeros();
            body.quarantined = true;
            report.quarantined += 1;
            self.output.events.push(Event::Quarantined { entity: i });
        }
    }
}
