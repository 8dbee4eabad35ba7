//! Two child shapes that may meet within the step: one query, and for how long its answer holds.
//!
//! A query is left out while it cannot change anything: shapes that were apart by more than they have moved since are
//! still apart, and the axis of least overlap is still the best while the shapes have moved by less than half of
//! what it leads by. Where they have hardly moved at all the manifold itself is kept, and the solver measures its
//! separations from the anchors; not for what rolls, whose points of contact move while it does not.

use crate::body::Body;
use crate::collide::anchor::Anchor;
use crate::collide::cache::Cache;
use crate::collide::convex::{Core, Feature};
use crate::collide::gjk::CorePair;
use crate::collide::half_space;
use crate::collide::manifold::{MAX_POINTS, Point};
use crate::collide::mesh::Mesh;
use crate::collide::narrow::NarrowBuffers;
use crate::collide::pair::Memory;
use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint};
use crate::collide::relative::Relative;
use crate::collide::slide::Slide;
use crate::collide::sweep::{Mover, Sweep};
use crate::material::Meeting;
use crate::math::Vec3;
use crate::shape::{Collider, Geometry};

/// Shares of the smaller shape's inner radius: by how much two axes must differ to be told apart, the gap at which an
/// overlap is measured, and how near an old point's heir is.
const AXIS_SHARE: f64 = 1e-4;
const GAP_SHARE: f64 = 0.05;
const HEIR_SHARE: f64 = 0.1;
/// And the most that an axis may be said to lead by: the common normal of two edges turns faster than they do.
const LEAD_SHARE: f64 = 0.1;
/// Shares of it again: how near what is foreseen counts as touching, how high a step in the ground is none, and how far
/// a step must lead for a seam to matter.
const TOUCH_SHARE: f64 = 1e-2;
const LIP_SHARE: f64 = 1e-2;
const SLIDE_SHARE: f64 = 1e-4;
/// Share of the motion for which a manifold may be kept that a pair may make before its poses are looked at again:
/// normals turn with body A meanwhile, and are left as they were.
const UNSEEN_SHARE: f64 = 0.1;
/// Points are made for a reach that much larger than asked for, so that a manifold can be kept while speeds vary.
const REACH_IN_STOCK: f64 = 1.25;
/// Cosine above which the normals of two planes of a surface are those of one, from step to step.
const SAME_PLANE: f64 = 0.99;

/// Marks the features of corners that were added, and the ball that was.
const CORNER: u64 = 1 << 62;
const BALL: u64 = 1 << 61;

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
    region: Region,
    feature: Feature,
    old: Vec<Point>,
    /// Anchor of the ball that was added.
    ball: Anchor,
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
    /// For what is fast: finds when the shapes will meet, and makes the manifold that they will have then, whose anchors
    /// and normal hold them there. A normal of now may be that of another side, and let a bullet through. Where they miss
    /// each other, what is nearer than `stray` metres is still looked at: that far they may leave their straight way, or
    /// have it left. `false` where one side is a half-space, whose normal is the same everywhere.
    pub(crate) fn foresee(
        &self,
        (a, b): (&Body, &Body),
        (margin, stray): (f64, f64),
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> bool {
        if [self.a, self.b].iter().any(|shape| matches!(shape.geometry, Geometry::HalfSpace)) {
            return false;
        }
        let sweep = Sweep {
            a: Mover::new(self.a, a),
            b: Mover::new(self.b, b),
            span: self.dt,
            touching: TOUCH_SHARE * self.size(),
        };
        match sweep.meeting(&mut buffers.triangles, &mut buffers.sheet) {
            Some(0.0) => {
                Near { foreseen: Some(2.0 * self.reach), ..*self }.update(cache, buffers);
            }
            Some(time) => {
                cache.forget(self.key);
                let (world_a, world_b) = (sweep.a.at(time), sweep.b.at(time));
                // A free end may whip round at twice the speed.
                let way = 2.0 * (1.0 - time / self.dt) * self.reach;
                let then = Near { world_a, world_b, reach: margin, foreseen: Some(way), ..*self };
                if let Holds::Apart(_) = then.update(cache, buffers) {
                    // The search ended on its way: an end that hardly moves goes before one that whips.
                    cache.forget(self.key);
                    Near { reach: self.reach, ..then }.update(cache, buffers);
                }
                cache.forget(self.key);
            }
            None => {
                Near { reach: stray, ..*self }.update(cache, buffers);
            }
        }
        true
    }

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

    /// Adds what of the smaller shape may come down on the plane of the region in the rest of the step: its corners, since
    /// what hits with one end whips round it and would be through with the other before the next step; and a ball
    /// inside of it, the anchor of one of them on the mover with what hangs from it: however fast it whips, its middle
    /// stays in front.
    fn add_rest(&self, relative: &Relative, way: f64, out: &mut Found) {
        let Found { region, feature, ball, .. } = out;
        let normal = region.normal;
        let b_moves = self.b_moves();
        let (mover, other) = if b_moves { (self.b, self.a) } else { (self.a, self.b) };
        let Some((core, radius)) = mover.geometry.core() else { return };
        let Some(first) = region.points.first().copied() else { return };
        let direction = if b_moves { relative.rotation.tr_mul(&-normal) } else { normal };
        core.extremes(&direction, feature);
        // On the surface of the other.
        let foot = if b_moves { first.on_a } else { first.on_a + normal * first.separation };
        let over = |point: &Vec3, radius: f64, feature: u64| {
            let point = if b_moves { relative.point(point) } else { *point };
            let height = (point - foot).dot(&normal) * if b_moves { 1.0 } else { -1.0 };
            let aside = (point - foot).norm_squared() - height * height;
            let separation = height - radius;
            let on_a = if b_moves { point - normal * height } else { point + normal * radius };
            let comes_down = separation < way && aside < other.shape_reach * other.shape_reach;
            comes_down.then_some(RegionPoint { on_a, separation, feature })
        };
        let corners = feature.corners.iter();
        region.points.extend(corners.filter_map(|(p, id)| over(p, radius, CORNER | u64::from(*id))));
        region.reduce::<{ MAX_POINTS - 1 }>();
        let (center, inside) = core.ball_inside();
        region.points.extend(over(&center, inside + radius, BALL));
        let outward = if b_moves { -normal } else { normal };
        let offset = self.world_a.rotation * outward * (inside + radius);
        *ball = Anchor { core: mover.in_body(&center), offset };
    }

    /// Whether B is the smaller shape.
    fn b_moves(&self) -> bool {
        self.b.shape_reach <= self.a.shape_reach
    }

    /// m: what the tolerances of this pair are shares of.
    pub(crate) fn size(&self) -> f64 {
        self.a.inner_radius.min(self.b.inner_radius)
    }

    /// m by which the shapes may move while their manifold is kept.
    fn keep(&self) -> f64 {
        self.keep_share * self.size()
    }

    /// How far any point of the smaller shape has moved against the other since, at most, m: where they touch, that is
    /// all the motion there is.
    fn motion(&self, relative: &Relative, before: &Relative) -> f64 {
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
        let mut slides = None;
        if !axis_holds {
            let found = sat.separation(shapes, relative, reach, tolerance, memory.axis);
            memory.queried_at = Some(*relative);
            memory.distance = found.distance;
            memory.lead = found.lead.clamp(tolerance, LEAD_SHARE * self.size());
            memory.axis = (found.distance < reach).then_some(found.axis);
            memory.normal = found.normal;
            if memory.axis.is_some()
                && let Some(slide) = self.slide()
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
        if !out.region.points.is_empty() {
            memory.normal = out.region.normal;
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

    /// A mesh, which is A or B, and a convex shape: a manifold for every plane of the mesh that is near. A plane keeps
    /// its number while it turns little from step to step, so that what the solver knew of it is found again.
    fn surface(
        &self,
        (mesh, mesh_is_a): (&Mesh, bool),
        relative: &Relative,
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) -> Holds {
        let (i, j) = self.key;
        let mut memory = cache.recall(self.key);
        if let Some((before, reach)) = &memory.region_at {
            let left = self.keep() - self.motion(relative, before);
            if self.reach <= *reach && left >= 0.0 {
                let holds = Holds::Stands { way: left.min(UNSEEN_SHARE * self.keep()), reach: *reach };
                cache.keep_all(self.key);
                cache.remember(memory);
                return holds;
            }
        }
        let NarrowBuffers { sat, touch, out, surface, named, .. } = buffers;
        let reach = REACH_IN_STOCK * self.reach;
        let (shape, seen) = if mesh_is_a { (self.b, *relative) } else { (self.a, relative.inverse()) };
        let lengths = (GAP_SHARE * shape.inner_radius, AXIS_SHARE * shape.inner_radius);
        surface.find(mesh, shape, &seen, reach, lengths, (sat, touch));

        named.clear();
        let world = if mesh_is_a { self.world_a.rotation } else { -self.world_b.rotation };
        for (plane, normal) in surface.normals.iter().enumerate() {
            let normal = world * normal;
            let known = cache.left(self.key).find(|manifold| {
                manifold.normal.dot(&normal) > SAME_PLANE
                    && !named.iter().any(|(name, _)| *name == manifold.key.2)
            });
            let taken = |name: &u32| {
                named.iter().any(|(other, _)| other == name)
                    || cache.left(self.key).any(|manifold| manifold.key.2 == *name)
            };
            let name = known.map_or_else(|| (0..).find(|name| !taken(name)).unwrap_or(0), |m| m.key.2);
            named.push((name, plane));
        }
        named.sort_unstable();
        let mut rolls = false;
        for &(name, plane) in named.iter() {
            surface.region(plane, &mut out.region);
            if !mesh_is_a {
                out.region.flip(relative);
            }
            rolls |= self.write(relative, cache, out, name);
        }
        cache.drop_left((i, j));
        let kept = !rolls && !named.is_empty();
        memory.region_at = kept.then_some((*relative, reach));
        cache.remember(memory);
        if kept {
            Holds::Stands { way: UNSEEN_SHARE * self.keep(), reach }
        } else if surface.is_far() {
            Holds::Apart(reach)
        } else {
            Holds::Once
        }
    }

    /// Hands the region to the cache, if it has points; whether any of them rolls.
    fn write(&self, relative: &Relative, cache: &mut Cache<'_>, out: &mut Found, subshape: u32) -> bool {
        if out.region.points.is_empty() {
            return false;
        }
        if let Some(way) = self.foreseen {
            self.add_rest(relative, way, out);
        }
        let Found { region, old, ball, .. } = out;
        region.reduce::<MAX_POINTS>();
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
        manifold.renew(self.world_a.rotation * region.normal, points, HEIR_SHARE * self.size(), old);
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
