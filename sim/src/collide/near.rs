//! Two child shapes that may meet within the step: one query, and for how long its answer holds.
//!
//! A query is left out while it cannot change anything: shapes that were apart by more than they have moved since are
//! still apart, and the axis of least overlap is still the best while the shapes have moved by less than half of
//! what it leads by. Where they have hardly moved at all the manifold itself is kept, and the solver measures its
//! separations from the anchors; not for what rolls, whose points of contact move while it does not.

use crate::collide::anchor::Anchor;
use crate::collide::cache::Cache;
use crate::collide::convex::{Core, Feature};
use crate::collide::foresee::BALL;
use crate::collide::gjk::CorePair;
use crate::collide::half_space;
use crate::collide::manifold::{MAX_POINTS, Point};
use crate::collide::narrow::NarrowBuffers;
use crate::collide::pair::Memory;
use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint};
use crate::collide::relative::Relative;
use crate::collide::sat::{self, Axis, SatBuffers};
use crate::collide::slide::Slide;
use crate::material::Meeting;
use crate::math::Vec3;
use crate::shape::{Collider, Geometry};

/// Shares of the smaller shape's inner radius: by how much two axes must differ to be told apart, the gap at which an
/// overlap is measured, and how near an old point's heir is.
pub(crate) const AXIS_SHARE: f64 = 1e-4;
pub(crate) const GAP_SHARE: f64 = 0.05;
const HEIR_SHARE: f64 = 0.1;
/// And the most that an axis may be said to lead by: the common normal of two edges turns faster than they do.
const LEAD_SHARE: f64 = 0.1;
/// Shares of it again: how high a step in the ground is none, and how far a step must lead for a seam to matter.
const LIP_SHARE: f64 = 1e-2;
const SLIDE_SHARE: f64 = 1e-4;
/// And how far the region may reach beyond the points that stand for it.
const SPAN_SHARE: f64 = 1e-2;
/// Share of the motion for which a manifold may be kept that a pair may make before its poses are looked at again:
/// normals turn with body A meanwhile, and are left as they were.
pub(crate) const UNSEEN_SHARE: f64 = 0.1;
/// Points are made for a reach that much larger than asked for, so that a manifold can be kept while speeds vary.
pub(crate) const REACH_IN_STOCK: f64 = 1.25;

/// For how long an answer holds.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Holds {
    /// The shapes are that far apart, m, at least.
    Apart(f64),
    /// The manifolds stand until the shapes have moved by `way` metres or may move in a step by more than `reach`.
    Stands { way: f64, reach: f64 },
    /// For this step.
    Once,
}

/// The region found last, and what is needed to hand it to the cache.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    pub(crate) region: Region,
    pub(crate) feature: Feature,
    old: Vec<Point>,
    /// Anchor of the ball that was added.
    pub(crate) ball: Anchor,
}

/// Two child shapes whose bounds overlap.
pub(crate) struct Near<'a> {
    pub(crate) a: &'a Collider,
    pub(crate) b: &'a Collider,
    /// Where they are, or will be when they meet.
    pub(crate) world_a: Relative,
    pub(crate) world_b: Relative,
    /// m/s, of B against A, world.
    pub(crate) velocity: Vec3,
    /// The same of what of B lies at the world's origin, and rad/s.
    pub(crate) drift: Vec3,
    pub(crate) spin: Vec3,
    /// Whether A and B never move.
    pub(crate) stands: [bool; 2],
    /// s
    pub(crate) dt: f64,
    /// [`crate::Settings::contact_keep_share`]
    pub(crate) keep_share: f64,
    pub(crate) key: (u32, u32),
    /// m: points farther apart are left out.
    pub(crate) reach: f64,
    /// m that they may still move after a meeting that was foreseen.
    pub(crate) foreseen: Option<f64>,
}

impl Near<'_> {
    /// Brings the manifolds of the two shapes up to their poses.
    pub(crate) fn update(&self, cache: &mut Cache<'_>, buffers: &mut NarrowBuffers) -> Holds {
        let relative = self.world_a.inverse_compose(&self.world_b);
        match (&self.a.geometry, &self.b.geometry) {
            (Geometry::HalfSpace, _) => self.on_plane(&relative, cache, &mut buffers.out),
            (_, Geometry::HalfSpace) => self.plane_below(&relative, cache, &mut buffers.out),
            (Geometry::Sphere { radius: ra }, Geometry::Sphere { radius: rb }) => {
                let distance = spheres(&relative.translation, *ra, *rb, self.reach, &mut buffers.out.region);
                self.finish(&relative, distance, self.reach, cache, &mut buffers.out).0
            }
            (Geometry::Polytope(a), Geometry::Polytope(b)) => {
                self.polytopes((a, b), &relative, cache, buffers)
            }
            (Geometry::Mesh(mesh), _) => self.surface((mesh, true), &relative, cache, buffers),
            (_, Geometry::Mesh(mesh)) => self.surface((mesh, false), &relative, cache, buffers),
            (a, b) => match (a.core(), b.core()) {
                (Some((a, ra)), Some((b, rb))) => {
                    self.convex(&CorePair { a, b, relative }, [ra, rb], cache, buffers)
                }
                _ => Holds::Once,
            },
        }
    }

    /// m: what the tolerances of this pair are shares of.
    pub(crate) fn size(&self) -> f64 {
        self.a.inner_radius.min(self.b.inner_radius)
    }

    /// m by which the shapes may move while their manifold is kept.
    pub(crate) fn keep(&self) -> f64 {
        self.keep_share * self.size()
    }

    /// How far any point of the smaller shape has moved against the other since, at most, m: where they touch, that is
    /// all the motion there is.
    pub(crate) fn motion(&self, relative: &Relative, before: &Relative) -> f64 {
        let (a, b) = (self.a.shape_reach, self.b.shape_reach);
        if b <= a {
            relative.motion_since(before, b)
        } else {
            relative.inverse().motion_since(&before.inverse(), a)
        }
    }

    fn on_plane(&self, relative: &Relative, cache: &mut Cache<'_>, out: &mut Found) -> Holds {
        let Some((core, radius)) = self.b.geometry.core() else { return Holds::Once };
        let reach = REACH_IN_STOCK * self.reach;
        let distance = half_space::region(&core, radius, relative, reach, &mut out.feature, &mut out.region);
        self.finish(relative, distance, reach, cache, out).0
    }

    /// The plane is B: its points seen from A.
    fn plane_below(&self, relative: &Relative, cache: &mut Cache<'_>, out: &mut Found) -> Holds {
        let Some((core, radius)) = self.a.geometry.core() else { return Holds::Once };
        let reach = REACH_IN_STOCK * self.reach;
        let seen = relative.inverse();
        let distance = half_space::region(&core, radius, &seen, reach, &mut out.feature, &mut out.region);
        out.region.flip(relative);
        self.finish(relative, distance, reach, cache, out).0
    }

    fn polytopes(
        &self,
        shapes: (&Polytope, &Polytope),
        relative: &Relative,
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> Holds {
        let mut memory = cache.recall(self.key);
        let reach = REACH_IN_STOCK * self.reach;
        let cores = (Core::Polytope(shapes.0), Core::Polytope(shapes.1));
        let pair = CorePair { a: cores.0, b: cores.1, relative: *relative };
        if let Some(holds) = self.still_known(&pair, [0.0; 2], reach, &mut memory, cache) {
            cache.remember(memory);
            return holds;
        }
        let NarrowBuffers { sat, out, .. } = buffers;
        let tolerance = AXIS_SHARE * self.size();
        let axis_holds = memory.axis.is_some()
            && memory.queried_at.is_some_and(|before| 2.0 * self.motion(relative, &before) < memory.lead);
        let most = match (&memory.witness, axis_holds) {
            (Some(witness), false) => sat::most(shapes, relative, witness),
            _ => f64::INFINITY,
        };
        let proven = |axis: Axis| {
            let along = SatBuffers::distance_along(shapes, relative, axis);
            along.is_some_and(|along| along < reach && most < along + tolerance)
        };
        let slide = self.slide();
        let axis_holds = axis_holds || slide.is_none() && most < reach && memory.axis.is_some_and(proven);
        let mut slides = None;
        if !axis_holds {
            let found = sat.separation(shapes, relative, (reach, most), tolerance, memory.axis);
            memory.queried_at = Some(*relative);
            memory.distance = found.distance;
            memory.lead = found.lead.clamp(tolerance, LEAD_SHARE * self.size());
            memory.axis = (found.distance < reach).then_some(found.axis);
            memory.normal = found.normal;
            if memory.axis.is_some()
                && let Some(slide) = slide
            {
                slides = slide.axis(shapes, relative, &found.normal, sat);
                if slides.is_some() {
                    memory.queried_at = None;
                }
            }
        }
        let Some(axis) = slides.or(memory.axis) else {
            let distance = memory.distance;
            memory.region_at = None;
            cache.remember(memory);
            return Holds::Apart(distance);
        };
        sat.region(shapes, relative, axis, reach, slides.is_none(), &mut out.region);
        self.hand_over(relative, f64::NEG_INFINITY, reach, memory, cache, out)
    }

    fn convex(
        &self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> Holds {
        let mut memory = cache.recall(self.key);
        let reach = REACH_IN_STOCK * self.reach;
        if let Some(holds) = self.still_known(pair, radii, reach, &mut memory, cache) {
            cache.remember(memory);
            return holds;
        }
        let NarrowBuffers { touch, out, .. } = buffers;
        let region = &mut out.region;
        let gap = GAP_SHARE * self.size();
        let guess = if memory.queried_at.is_some() { memory.normal } else { pair.start(gap) };
        memory.distance = touch.region(pair, radii, &guess, gap, reach, region);
        memory.queried_at = Some(pair.relative);
        memory.normal = region.normal;
        if let Some(slide) = self.slide() {
            slide.over_side(pair, radii, reach, touch, region);
        }
        let distance = memory.distance;
        self.hand_over(&pair.relative, distance, reach, memory, cache, out)
    }

    /// The motion, where one side stands and the other moves fast enough for a seam to matter.
    fn slide(&self) -> Option<Slide> {
        let matters =
            (self.stands[0] || self.stands[1]) && self.velocity.norm() * self.dt > SLIDE_SHARE * self.size();
        matters.then(|| Slide {
            velocity: self.world_a.rotation.tr_mul(&self.velocity),
            lip: LIP_SHARE * self.size(),
            stands: self.stands,
        })
    }

    /// What need not be asked: the shapes are still apart, by the motion since or by the normal that parted them, or have
    /// moved so little that the manifold stands.
    fn still_known(
        &self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        reach: f64,
        memory: &mut Memory,
        cache: &mut Cache<'_>,
    ) -> Option<Holds> {
        let relative = &pair.relative;
        let parted = memory.queried_at.as_ref().map(|before| (before, memory.distance > self.reach));
        if let Some((before, true)) = parted {
            let left = memory.distance - self.motion(relative, before);
            if left > self.reach {
                return Some(Holds::Apart(left));
            }
        }
        // Else by the normal that parted them last, or the line between their middles.
        let normal = match parted {
            Some((_, true)) => Some(memory.normal),
            Some((_, false)) => None,
            None => pair.between(),
        };
        if let Some(normal) = normal {
            let distance = pair.separation_along(&normal).distance - radii[0] - radii[1];
            if distance > reach {
                *memory = Memory {
                    key: memory.key,
                    queried_at: Some(*relative),
                    distance,
                    normal,
                    ..Memory::default()
                };
                return Some(Holds::Apart(distance));
            }
        }
        let (before, reach) = memory.region_at.as_ref()?;
        let left = self.keep() - self.motion(relative, before);
        if self.reach > *reach || left < 0.0 {
            return None;
        }
        let (i, j) = self.key;
        let manifold = cache.keep((i, j, 0))?;
        let normal = self.world_a.rotation * memory.normal;
        if (normal - manifold.normal).norm_squared() > 1e-14 {
            manifold.turn(normal);
        }
        Some(Holds::Stands { way: left.min(UNSEEN_SHARE * self.keep()), reach: *reach })
    }

    /// Hands the region to the cache with what is to be remembered of it.
    fn hand_over(
        &self,
        relative: &Relative,
        distance: f64,
        reach: f64,
        mut memory: Memory,
        cache: &mut Cache<'_>,
        out: &mut Found,
    ) -> Holds {
        let lowest = out.region.points.iter().min_by(|p, q| p.separation.total_cmp(&q.separation));
        if let Some(point) = lowest {
            memory.normal = out.region.normal;
            let on_b = point.on_a + out.region.normal * point.separation - relative.translation;
            // A corner beside the face that it lies over is on one of the shapes alone.
            let on_both = point.feature != u64::MAX;
            memory.witness = on_both.then(|| [point.on_a, relative.rotation.tr_mul(&on_b)]);
        }
        let (holds, kept) = self.finish(relative, distance, reach, cache, out);
        memory.region_at = kept.then_some((*relative, reach));
        cache.remember(memory);
        holds
    }

    /// Hands the region to the cache, whose shapes are `distance` metres apart; whether the manifold may be kept.
    fn finish(
        &self,
        relative: &Relative,
        distance: f64,
        reach: f64,
        cache: &mut Cache<'_>,
        out: &mut Found,
    ) -> (Holds, bool) {
        if out.region.points.is_empty() {
            return (if distance >= reach { Holds::Apart(distance) } else { Holds::Once }, false);
        }
        let rolls = self.write(relative, cache, out, 0);
        if rolls {
            return (Holds::Once, false);
        }
        (Holds::Stands { way: UNSEEN_SHARE * self.keep(), reach }, true)
    }

    /// The separation that a point may come to within the step, m: by the way that it takes and half as much again, as
    /// contacts elsewhere turn it.
    fn clearance(&self, point: &RegionPoint, normal: &Vec3) -> f64 {
        let speed = (self.drift + self.spin.cross(&self.world_a.point(&point.on_a))).dot(normal);
        point.separation + 1.5 * self.dt * speed.min(0.0)
    }

    /// Hands the region to the cache, if it has points; whether any of them rolls.
    pub(crate) fn write(
        &self,
        relative: &Relative,
        cache: &mut Cache<'_>,
        out: &mut Found,
        subshape: u32,
    ) -> bool {
        if out.region.points.is_empty() {
            return false;
        }
        out.region.thin(SPAN_SHARE * self.size());
        if let Some(way) = self.foreseen {
            self.add_rest(relative, way, out);
        }
        let Found { region, old, ball, .. } = out;
        let normal = self.world_a.rotation * region.normal;
        region.reduce::<MAX_POINTS>(GAP_SHARE * self.size(), |point| self.clearance(point, &normal));
        let (i, j) = self.key;
        let manifold = cache.entry((i, j, subshape));
        let meeting = Meeting::of(&self.a.pairs, &self.a.surface, &self.b.surface);
        (manifold.friction, manifold.restitution) = (meeting.friction, meeting.restitution);
        let outward_b = relative.rotation.tr_mul(&-region.normal);
        let mut rolls = false;
        let points = region.points.iter().map(|point| {
            let on_b = point.on_a + region.normal * point.separation - relative.translation;
            let anchor_a = Anchor::new(self.a, &self.world_a, &point.on_a, &region.normal);
            let anchor_b = Anchor::new(self.b, &self.world_b, &relative.rotation.tr_mul(&on_b), &outward_b);
            let (anchor_a, anchor_b) = match (point.feature == BALL, self.b_moves()) {
                (true, true) => (anchor_a, *ball),
                (true, false) => (*ball, anchor_b),
                (false, _) => (anchor_a, anchor_b),
            };
            rolls |= anchor_a.rolls() || anchor_b.rolls();
            Point {
                anchor_a,
                anchor_b,
                feature: point.feature,
                separation: point.separation,
                ..Point::default()
            }
        });
        manifold.renew(normal, points, HEIR_SHARE * self.size(), old);
        rolls
    }
}

/// The region of two spheres, and how far they are apart, m.
fn spheres(between: &Vec3, radius_a: f64, radius_b: f64, reach: f64, region: &mut Region) -> f64 {
    let centers = between.norm();
    region.normal = if centers > 1e-12 { between / centers } else { Vec3::y() };
    region.points.clear();
    let separation = centers - radius_a - radius_b;
    if separation < reach {
        region.points.push(RegionPoint { on_a: region.normal * radius_a, separation, feature: 0 });
    }
    separation
}
