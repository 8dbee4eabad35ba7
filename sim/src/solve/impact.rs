//! Impacts at their time: bodies fly exactly to the moment at which they meet, bounce, and fly on.
//!
//! A pair whose surfaces approach faster than [`Impacts::threshold`] and have a coefficient of restitution is
//! taken out of the contact solver's hands: earliest meeting first, both bodies are moved to that moment, the
//! impulses of all points then touching are found together, and the pairs that share a body are looked at again.
//! So a blow runs down a row of balls one pair after the other, as it does in a cradle.
//!
//! What the impulses are is [`crate::solve::blow`]'s business.

use crate::body::Body;
use crate::collide::manifold::{Manifold, Point};
use crate::collide::pair::Pair;
use crate::frame::{Event, SleepState};
use crate::math::{Frame3, Vec2, Vec3, rotated, tangents};
use crate::plan::Plan;
use crate::solve::blow::{Blow, BlowBuffers, Row, slowest_bounce};
use crate::solve::micro_collision::Sliding;
use crate::work::Work;

/// Impacts of one pair in a substep that bounce. Those after are plastic, the end of a Zeno sequence, and pass a blow
/// on through a pile until the last of them is left to the contact solver.
const MAX_BOUNCES_A_PAIR: u32 = 16;
const MAX_IMPACTS_A_PAIR: u32 = 32;

/// Storage of the phase, which serves all steps.
#[derive(Clone, Default)]
pub(crate) struct ImpactBuffers {
    /// Pairs of which impacts are looked for; when they meet next, s; and how often they still may.
    bouncy: Vec<usize>,
    meetings: Vec<Option<f64>>,
    left: Vec<u32>,
    rows: Vec<Row>,
    blow: BlowBuffers,
}

/// The impact phase of one substep.
pub(crate) struct Impacts<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) work: &'a mut Work,
    pub(crate) bodies: &'a mut [Body],
    pub(crate) pairs: &'a mut [Pair],
    /// m/s²
    pub(crate) gravity: Vec3,
    /// s
    pub(crate) h: f64,
    /// m/s. Slower contacts do not bounce (see [`slowest_bounce`]): gravity alone adds such a speed in a substep or two.
    pub(crate) threshold: f64,
    /// s into the substep at which each body is.
    pub(crate) elapsed: &'a mut [f64],
    pub(crate) buffers: &'a mut ImpactBuffers,
    pub(crate) events: &'a mut Vec<Event>,
}

impl Impacts<'_> {
    /// Resolves every impact of the substep in the order of time; returns how many there were.
    pub(crate) fn resolve(&mut self) -> u32 {
        let ImpactBuffers { mut bouncy, mut meetings, mut left, rows, blow } = std::mem::take(self.buffers);
        *self.buffers = ImpactBuffers { rows, blow, ..ImpactBuffers::default() };
        bouncy.clear();
        bouncy.extend(
            (0..self.pairs.len())
                .filter(|&i| self.pairs[i].manifolds.iter().any(|manifold| self.bounces(manifold))),
        );
        self.work.impact_searches += bouncy.len() as u64;
        meetings.clear();
        meetings.extend(bouncy.iter().map(|&i| self.meeting(i)));
        left.clear();
        left.resize(bouncy.len(), MAX_IMPACTS_A_PAIR);
        let mut count = 0;
        while let Some((at, time)) = earliest(&meetings) {
            let pair = bouncy[at];
            let (a, b) = (self.pairs[pair].a, self.pairs[pair].b);
            self.advance(a as usize, time);
            self.advance(b as usize, time);
            let bounces = MAX_IMPACTS_A_PAIR - left[at] < MAX_BOUNCES_A_PAIR;
            self.collide(pair, bounces);
            count += 1;
            left[at] -= 1;
            for (other, meeting) in meetings.iter_mut().enumerate() {
                let near = &self.pairs[bouncy[other]];
                if near.a == a || near.b == a || near.a == b || near.b == b {
                    let moves = |i: u32| !self.bodies[i as usize].is_static();
                    let shared = [a, b].iter().any(|&i| moves(i) && (near.a == i || near.b == i));
                    if shared {
                        *meeting = if left[other] == 0 { None } else { self.meeting(bouncy[other]) };
                    }
                }
            }
        }
        for &pair in &bouncy {
            let apart = self.stays_apart(pair);
            self.pairs[pair].apart = apart;
            if apart {
                self.pairs[pair].manifolds.iter_mut().for_each(Manifold::unload);
            }
        }
        (self.buffers.bouncy, self.buffers.meetings, self.buffers.left) = (bouncy, meetings, left);
        count
    }

    /// Whether impacts of this region are looked for.
    fn bounces(&self, manifold: &Manifold) -> bool {
        manifold.restitution > 0.0 || self.plan.every_pair_bounces()
    }

    /// Acceleration of a body between contacts.
    fn acceleration(&self, body: &Body) -> Vec3 {
        if body.flies && body.is_awake() { self.gravity } else { Vec3::zeros() }
    }

    /// Moves body `i` on its own to `time` into the substep.
    fn advance(&mut self, i: usize, time: f64) {
        let span = time - self.elapsed[i];
        let acceleration = self.acceleration(&self.bodies[i]);
        let body = &mut self.bodies[i];
        if body.is_awake() && span > 0.0 {
            body.position += body.velocity * span + acceleration * (0.5 * span * span);
            body.velocity += acceleration * span;
            body.turn(span);
            self.elapsed[i] = time;
        }
    }

    /// When the surfaces of a pair meet, s into the substep, if they do and fast enough.
    fn meeting(&self, pair: usize) -> Option<f64> {
        let (start, path_a, path_b) = self.paths(pair);
        self.pairs[pair]
            .manifolds
            .iter()
            .filter(|manifold| self.bounces(manifold))
            .flat_map(|manifold| manifold.points.iter().map(move |point| (manifold, point)))
            .filter_map(|(manifold, point)| {
                let slowest = slowest_bounce(self.threshold, manifold.restitution);
                Gap::new(manifold, point, &path_a, &path_b).meeting(self.h - start, slowest)
            })
            .min_by(f64::total_cmp)
            .map(|wait| start + wait)
    }

    /// Whether no surface of a pair meets another in what is left of the substep, however slowly.
    fn stays_apart(&self, pair: usize) -> bool {
        let (start, path_a, path_b) = self.paths(pair);
        let span = self.h - start;
        // What something else carries has no known path: it may lose its hold, and fall so far.
        let Pair { a, b, .. } = self.pairs[pair];
        let carried =
            [a, b].iter().any(|&i| !self.bodies[i as usize].is_static() && !self.bodies[i as usize].flies);
        let margin = if carried { 0.5 * self.gravity.norm() * self.h * self.h } else { 0.0 };
        self.pairs[pair].manifolds.iter().all(|manifold| {
            let open = |point| {
                let gap = Gap::new(manifold, point, &path_a, &path_b);
                gap.at(0.0).0 > 0.0 && gap.at(span).0 > margin
            };
            manifold.points.iter().all(open)
        })
    }

    /// The time at which both bodies of a pair are known, s into the substep, and their motion from there on.
    fn paths(&self, pair: usize) -> (f64, Path, Path) {
        let (a, b) = (self.pairs[pair].a as usize, self.pairs[pair].b as usize);
        let now = |i: usize| if self.bodies[i].is_awake() { self.elapsed[i] } else { 0.0 };
        let start = now(a).max(now(b));
        (start, self.path(a, start - now(a)), self.path(b, start - now(b)))
    }

    /// Motion of a body from `ahead` seconds after its present state on.
    fn path(&self, i: usize, ahead: f64) -> Path {
        let body = &self.bodies[i];
        if !body.is_awake() {
            return Path {
                frame: body.frame(),
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                g: Vec3::zeros(),
            };
        }
        let g = self.acceleration(body);
        let mut frame = body.frame();
        if ahead > 0.0 {
            frame.position += body.velocity * ahead + g * (0.5 * ahead * ahead);
            frame.rotation = rotated(&frame.rotation, &(body.spin * ahead));
        }
        Path { frame, velocity: body.velocity + g * ahead, spin: body.spin, g }
    }

    /// Finds and applies the impulses of everything that touches between the two bodies now; plastic unless it
    /// `bounces`.
    fn collide(&mut self, pair: usize, bounces: bool) {
        let pair = &mut self.pairs[pair];
        let (a, b) = (pair.a as usize, pair.b as usize);
        for i in [a, b] {
            if self.bodies[i].sleep == SleepState::Asleep {
                self.bodies[i].sleep = SleepState::Active;
                self.bodies[i].still_s = 0.0;
            }
        }
        let (frame_a, frame_b) = (self.bodies[a].frame(), self.bodies[b].frame());
        let touching = 1e-4 * self.bodies[a].inner_radius.min(self.bodies[b].inner_radius);
        let rows = &mut self.buffers.rows;
        rows.clear();
        for (m, manifold) in pair.manifolds.iter_mut().enumerate() {
            turn_round_contact(manifold, &frame_a, &frame_b);
            for (p, point) in manifold.points.iter().enumerate() {
                if manifold.separation(point, &frame_a, &frame_b) < touching {
                    rows.push(Row {
                        at: (m, p),
                        normal: manifold.normal,
                        arm_a: point.anchor_a.arm(&frame_a),
                        arm_b: point.anchor_b.arm(&frame_b),
                        friction: manifold.friction,
                        restitution: if bounces { manifold.restitution } else { 0.0 },
                    });
                }
            }
        }
        let mut blow = Blow::new(&self.bodies[a], &self.bodies[b]);
        let integrate = self.plan.integrates_every_impact();
        let (speed, sliding) =
            blow.resolve(rows, self.threshold, integrate, &mut self.buffers.blow, |at, impulse| {
                let manifold = &mut pair.manifolds[at.0];
                let [u, v] = manifold.tangents;
                let point = &mut manifold.points[at.1];
                point.step_impulse += impulse.dot(&manifold.normal);
                pair.touching |= point.step_impulse > 0.0;
                point.step_friction += Vec2::new(impulse.dot(&u), impulse.dot(&v));
            });
        *match sliding {
            Some(Sliding::Frictionless) => &mut self.work.frictionless_impacts,
            Some(Sliding::Straight) => &mut self.work.straight_impacts,
            Some(Sliding::Turning) => &mut self.work.turning_impacts,
            None => &mut self.work.patch_impacts,
        } += 1;
        for (i, [velocity, spin]) in [a, b].into_iter().zip(blow.state) {
            self.bodies[i].velocity = velocity;
            self.bodies[i].spin = spin;
        }
        self.events.push(Event::Impact { a: pair.a, b: pair.b, speed_m_s: speed });
    }
}

fn earliest(meetings: &[Option<f64>]) -> Option<(usize, f64)> {
    let known = meetings.iter().enumerate().filter_map(|(i, time)| time.map(|time| (i, time)));
    known.min_by(|(i, s), (j, t)| s.total_cmp(t).then(i.cmp(j)))
}

/// A body's motion without contacts: a parabola and constant spin.
struct Path {
    frame: Frame3,
    velocity: Vec3,
    spin: Vec3,
    g: Vec3,
}

/// The gap at a contact point while both bodies move on their own, to second order in time.
struct Gap {
    /// Between the cores: position, velocity and half the acceleration.
    between: [Vec3; 3],
    /// From A's core to B's, over both surfaces.
    reach: Vec3,
    /// Along this, or between the centres of what is round on both sides.
    normal: Vec3,
    radii: Option<f64>,
}

impl Gap {
    fn new(manifold: &Manifold, point: &Point, a: &Path, b: &Path) -> Self {
        let ends = |path: &Path, core: &Vec3| {
            let arm = path.frame.rotation * core;
            let turning = path.spin.cross(&arm);
            [path.frame.position + arm, path.velocity + turning, (path.g + path.spin.cross(&turning)) * 0.5]
        };
        let (on_a, on_b) = (ends(a, &point.anchor_a.core), ends(b, &point.anchor_b.core));
        Self {
            between: std::array::from_fn(|i| on_b[i] - on_a[i]),
            reach: point.anchor_b.offset - point.anchor_a.offset,
            normal: manifold.normal,
            radii: is_round(point).then(|| point.anchor_a.offset.norm() + point.anchor_b.offset.norm()),
        }
    }

    /// Gap, m, and its rate, m/s, after `t` seconds.
    fn at(&self, t: f64) -> (f64, f64) {
        let [p, v, c] = &self.between;
        let between = p + v * t + c * (t * t);
        let rate = v + c * (2.0 * t);
        match self.radii {
            Some(radii) => {
                let distance = between.norm().max(1e-12);
                (distance - radii, rate.dot(&between) / distance)
            }
            None => ((between + self.reach).dot(&self.normal), rate.dot(&self.normal)),
        }
    }

    /// Seconds until it closes, at more than `threshold` m/s and within `span` seconds.
    fn meeting(&self, span: f64, threshold: f64) -> Option<f64> {
        let (now, rate_now) = self.at(0.0);
        if now <= 0.0 {
            return (rate_now < -threshold).then_some(0.0);
        }
        if self.at(span).0 > 0.0 {
            return None;
        }
        // The gap changes sign once: Newton's method inside a bracket that bisection keeps.
        let (mut low, mut high, mut t) = (0.0, span, (now / -rate_now).clamp(0.0, span));
        for _ in 0..60 {
            let (distance, rate) = self.at(t);
            if distance > 0.0 {
                low = t;
            } else {
                high = t;
            }
            let next = t - distance / rate;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - t).abs() <= 1e-16 * span || next == t {
                break;
            }
            t = next;
        }
        (self.at(t).1 < -threshold).then_some(t)
    }
}

fn is_round(point: &Point) -> bool {
    point.anchor_a.offset != Vec3::zeros() && point.anchor_b.offset != Vec3::zeros()
}

/// Between two round surfaces the normal follows the centres: bring it up to the moment of the impact.
fn turn_round_contact(manifold: &mut Manifold, a: &Frame3, b: &Frame3) {
    let [point] = &mut manifold.points[..] else { return };
    if !is_round(point) {
        return;
    }
    let (radius_a, radius_b) = (point.anchor_a.offset.norm(), point.anchor_b.offset.norm());
    let between = b.point(&point.anchor_b.core) - a.point(&point.anchor_a.core);
    let distance = between.norm();
    if distance > 1e-12 {
        manifold.normal = between / distance;
        manifold.tangents = tangents(&manifold.normal);
        point.anchor_a.offset = manifold.normal * radius_a;
        point.anchor_b.offset = manifold.normal * -radius_b;
    }
}
