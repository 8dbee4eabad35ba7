//! Manifolds between two bodies: one call a pair of bodies, one query a pair of child shapes.
//!
//! A query is left out while it cannot change anything: shapes that were apart by more than they have moved since are
//! still apart, and the axis of least overlap is still the best while the shapes have moved by less than half of
//! what it leads by. Where they have hardly moved at all the manifold itself is kept, and the solver measures its
//! separations from the anchors; not for what rolls, whose points of contact move while it does not.

use crate::body::Body;
use crate::collide::convex::{Core, Feature};
use crate::collide::gjk::CorePair;
use crate::collide::half_space;
use crate::collide::manifold::{Anchor, MAX_POINTS, Manifold, Point};
use crate::collide::mesh::Mesh;
use crate::collide::pair::{Memory, Pair};
use crate::collide::polytope::Polytope;
use crate::collide::region::{Region, RegionPoint};
use crate::collide::sat::{Relative, SatBuffers};
use crate::collide::surface::SurfaceBuffers;
use crate::collide::sweep::{Mover, Sweep};
use crate::collide::touch::TouchBuffers;
use crate::material::Meeting;
use crate::math::{Mat3, Vec3};
use crate::shape::{Collider, Geometry};

/// Shares of the smaller shape's inner radius: by how much two axes must differ to be told apart, the gap at which an
/// overlap is measured, and how near an old point's heir is.
const AXIS_SHARE: f64 = 1e-4;
const GAP_SHARE: f64 = 0.05;
const HEIR_SHARE: f64 = 0.1;
/// And the most that an axis may be said to lead by: the common normal of two edges turns faster than they do.
const LEAD_SHARE: f64 = 0.1;
/// Shares of it again: how far beyond what they may move in a step shapes are looked at, from what way in a step on their
/// meeting is foreseen, how near they then count as touching, how high a step in the ground is none, and how far a
/// step must lead for a seam to matter.
const MARGIN_SHARE: f64 = 0.05;
const FAST_SHARE: f64 = 0.5;
const TOUCH_SHARE: f64 = 1e-2;
const LIP_SHARE: f64 = 1e-2;
const SLIDE_SHARE: f64 = 1e-4;
/// And from what overlap on a pose is reported as one that cannot be.
const DEEP_SHARE: f64 = 0.25;
/// Points are made for a reach that much larger than asked for, so that a manifold can be kept while speeds vary.
const REACH_IN_STOCK: f64 = 1.25;
/// Cosine between the normal and a mantle's below which a shape does not lie on it.
const ON_MANTLE: f64 = 0.02;

/// Marks the features of corners that were added.
const CORNER: u64 = 1 << 62;

/// Buffers of the narrow phase, one a thread.
#[derive(Clone, Debug)]
pub(crate) struct NarrowBuffers {
    sat: SatBuffers,
    touch: TouchBuffers,
    out: Found,
    surface: SurfaceBuffers,
    /// Numbers of a surface's planes, with the plane.
    named: Vec<(u32, usize)>,
    triangles: Vec<u32>,
    sheet: Polytope,
    /// Children of B near A.
    near_b: Vec<u32>,
}

/// The region found last, and what is needed to hand it to the cache.
#[derive(Clone, Debug, Default)]
struct Found {
    region: Region,
    feature: Feature,
    old: Vec<Point>,
}

impl Default for NarrowBuffers {
    fn default() -> Self {
        Self {
            sat: SatBuffers::default(),
            touch: TouchBuffers::default(),
            out: Found::default(),
            surface: SurfaceBuffers::default(),
            named: Vec::new(),
            triangles: Vec::new(),
            sheet: Polytope::sheet(),
            near_b: Vec::new(),
        }
    }
}

/// What a step may bring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead {
    /// s
    pub(crate) dt: f64,
    /// m/s², its magnitude.
    pub(crate) gravity: f64,
    /// [`crate::Settings::contact_keep_share`]
    pub(crate) keep_share: f64,
}

/// Brings the manifolds of a pair up to its bodies' poses; points that cannot meet within the step are left out. Where
/// the bodies have come to overlap so deeply that no motion explains it, returns by how much, m, once.
pub(crate) fn update(
    pair: &mut Pair,
    a: &Body,
    b: &Body,
    ahead: Ahead,
    buffers: &mut NarrowBuffers,
) -> Option<f64> {
    let turning = |body: &Body| if body.is_static() { 0.0 } else { body.spin.norm() * body.reach };
    let closing = (a.velocity - b.velocity).norm() + turning(a) + turning(b);
    let margin = MARGIN_SHARE * a.inner_radius.min(b.inner_radius);
    let way = ahead.dt * (closing + ahead.dt * ahead.gravity);
    let reach = margin + way;
    // A compound's children that are far from the other body are looked at once, not once for each of its children.
    let mut near_b = std::mem::take(&mut buffers.near_b);
    near_b.clear();
    near_b.extend(
        (0..)
            .zip(&b.colliders)
            .filter(|(_, child)| child.bounds.grown(reach).overlaps(&a.aabb))
            .map(|(j, _)| j),
    );
    let mut cache = Cache { pair, manifold: 0, memory: 0 };
    for (i, child_a) in (0..).zip(&a.colliders) {
        let bounds_a = child_a.bounds.grown(reach);
        if !bounds_a.overlaps(&b.aabb) {
            continue;
        }
        for &j in near_b.iter() {
            let child_b = &b.colliders[j as usize];
            if bounds_a.overlaps(&child_b.bounds) {
                let near = Near {
                    a: child_a,
                    b: child_b,
                    world_a: child_a.world,
                    world_b: child_b.world,
                    velocity: b.velocity - a.velocity,
                    stands: [a.is_static(), b.is_static()],
                    dt: ahead.dt,
                    keep_share: ahead.keep_share,
                    key: (i, j),
                    reach,
                    foreseen: None,
                };
                if way <= FAST_SHARE * near.size() || !near.foresee((a, b), margin, &mut cache, buffers) {
                    near.update(&mut cache, buffers);
                }
            }
        }
    }
    let (manifolds, memories) = (cache.manifold, cache.memory);
    pair.manifolds.truncate(manifolds);
    pair.memories.truncate(memories);
    buffers.near_b = near_b;
    let points = pair.manifolds.iter().flat_map(|manifold| &manifold.points);
    let depth = points.map(|point| -point.separation).fold(0.0, f64::max);
    let was_deep = std::mem::replace(&mut pair.deep, depth > DEEP_SHARE * a.inner_radius.min(b.inner_radius));
    (pair.deep && !was_deep).then_some(depth)
}

/// A pair's cache while its child shapes are gone through in the order of their keys: what was passed over is dropped.
struct Cache<'a> {
    pair: &'a mut Pair,
    manifold: usize,
    memory: usize,
}

impl Cache<'_> {
    /// Takes the memory of `key` out of the cache; [`Cache::remember`] puts it back.
    fn recall(&mut self, key: (u32, u32)) -> Memory {
        let memories = &mut self.pair.memories;
        while memories.get(self.memory).is_some_and(|memory| memory.key < key) {
            memories.remove(self.memory);
        }
        match memories.get(self.memory) {
            Some(memory) if memory.key == key => memory.clone(),
            _ => {
                memories.insert(self.memory, Memory { key, ..Memory::default() });
                memories[self.memory].clone()
            }
        }
    }

    /// Empties the memory of `key`, the one to come next or the one just put back.
    fn forget(&mut self, key: (u32, u32)) {
        for at in [self.memory, self.memory.wrapping_sub(1)] {
            if let Some(memory) = self.pair.memories.get_mut(at).filter(|memory| memory.key == key) {
                *memory = Memory { key, ..Memory::default() };
            }
        }
    }

    fn remember(&mut self, memory: Memory) {
        self.pair.memories[self.memory] = memory;
        self.memory += 1;
    }

    /// The manifold of `key` if there is one, moved past.
    fn keep(&mut self, key: (u32, u32, u32)) -> Option<&mut Manifold> {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|manifold| manifold.key < key) {
            manifolds.remove(self.manifold);
        }
        let found = manifolds.get_mut(self.manifold).filter(|manifold| manifold.key == key)?;
        self.manifold += 1;
        Some(found)
    }

    /// Manifolds of two child shapes that have not been moved past.
    fn left(&self, (i, j): (u32, u32)) -> impl Iterator<Item = &Manifold> {
        let left = self.pair.manifolds[self.manifold..].iter();
        left.skip_while(move |manifold| manifold.key < (i, j, 0))
            .take_while(move |manifold| (manifold.key.0, manifold.key.1) == (i, j))
    }

    /// Moves past all manifolds of two child shapes.
    fn keep_all(&mut self, (i, j): (u32, u32)) {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|manifold| manifold.key < (i, j, 0)) {
            manifolds.remove(self.manifold);
        }
        while manifolds.get(self.manifold).is_some_and(|manifold| (manifold.key.0, manifold.key.1) == (i, j))
        {
            self.manifold += 1;
        }
    }

    /// Drops the manifolds of two child shapes that have not been moved past.
    fn drop_left(&mut self, (i, j): (u32, u32)) {
        let manifolds = &mut self.pair.manifolds;
        while manifolds.get(self.manifold).is_some_and(|m| (m.key.0, m.key.1) <= (i, j)) {
            manifolds.remove(self.manifold);
        }
    }

    /// The manifold of `key`, an empty one if it is new.
    fn entry(&mut self, key: (u32, u32, u32)) -> &mut Manifold {
        if self.keep(key).is_none() {
            self.pair.manifolds.insert(self.manifold, Manifold { key, ..Manifold::default() });
            self.manifold += 1;
        }
        &mut self.pair.manifolds[self.manifold - 1]
    }
}

/// Two child shapes whose bounds overlap.
struct Near<'a> {
    a: &'a Collider,
    b: &'a Collider,
    /// Where they are, or will be when they meet.
    world_a: Relative,
    world_b: Relative,
    /// m/s, of B against A, world.
    velocity: Vec3,
    /// Whether A and B never move.
    stands: [bool; 2],
    /// s
    dt: f64,
    keep_share: f64,
    key: (u32, u32),
    reach: f64,
    /// m that they may still move after a meeting that was foreseen.
    foreseen: Option<f64>,
}

impl Near<'_> {
    /// For what is fast: finds when the shapes will meet, and makes the manifold that they will have then, whose anchors
    /// and normal hold them there. A normal of now may be that of another side, and let a bullet through. `false`
    /// where they touch already or one side is a half-space, whose normal is the same everywhere.
    fn foresee(
        &self,
        (a, b): (&Body, &Body),
        margin: f64,
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
        let meeting = sweep.meeting(&mut buffers.triangles, &mut buffers.sheet);
        if meeting == Some(0.0) {
            return false;
        }
        cache.forget(self.key);
        if let Some(time) = meeting {
            let (world_a, world_b) = (sweep.a.at(time), sweep.b.at(time));
            let way = (1.0 - time / self.dt) * self.reach;
            Near { world_a, world_b, reach: margin, foreseen: Some(way), ..*self }.update(cache, buffers);
            cache.forget(self.key);
        }
        true
    }

    fn update(&self, cache: &mut Cache<'_>, buffers: &mut NarrowBuffers) {
        let relative = self.world_a.inverse_compose(&self.world_b);
        match (&self.a.geometry, &self.b.geometry) {
            (Geometry::HalfSpace, _) => self.on_plane(&relative, cache, buffers),
            (_, Geometry::HalfSpace) => self.plane_below(&relative, cache, buffers),
            (Geometry::Sphere { radius: ra }, Geometry::Sphere { radius: rb }) => {
                spheres(&relative.translation, *ra, *rb, &mut buffers.out.region);
                self.write(&relative, cache, &mut buffers.out, 0);
            }
            (Geometry::Polytope(a), Geometry::Polytope(b)) => {
                self.polytopes((a, b), &relative, cache, buffers)
            }
            (Geometry::Mesh(mesh), _) => self.surface((mesh, true), &relative, cache, buffers),
            (_, Geometry::Mesh(mesh)) => self.surface((mesh, false), &relative, cache, buffers),
            (a, b) => {
                if let (Some((a, ra)), Some((b, rb))) = (a.core(), b.core()) {
                    self.convex(&CorePair { a, b, relative }, [ra, rb], cache, buffers);
                }
            }
        }
    }

    /// Adds the smaller shape's corners that may come down on the plane of the region in the rest of the step: what hits
    /// with one end whips round it, and would be through with the other before the next step.
    fn add_corners(&self, relative: &Relative, way: f64, out: &mut Found) {
        let Found { region, feature, .. } = out;
        let normal = region.normal;
        let b_moves = self.b.shape_reach <= self.a.shape_reach;
        let (mover, other) = if b_moves { (self.b, self.a) } else { (self.a, self.b) };
        let Some((core, radius)) = mover.geometry.core() else { return };
        let Some(first) = region.points.first().copied() else { return };
        let direction = if b_moves { relative.rotation.tr_mul(&-normal) } else { normal };
        core.extremes(&direction, feature);
        // On the surface of the other.
        let foot = if b_moves { first.on_a } else { first.on_a + normal * first.separation };
        for (corner, id) in &feature.corners {
            let corner = if b_moves { relative.point(corner) } else { *corner };
            let height = (corner - foot).dot(&normal) * if b_moves { 1.0 } else { -1.0 };
            let aside = (corner - foot).norm_squared() - height * height;
            let separation = height - radius;
            if separation < way && aside < other.shape_reach * other.shape_reach {
                let on_a = if b_moves { corner - normal * height } else { corner + normal * radius };
                region.points.push(RegionPoint { on_a, separation, feature: CORNER | u64::from(*id) });
            }
        }
    }

    /// m: what the tolerances of this pair are shares of.
    fn size(&self) -> f64 {
        self.a.inner_radius.min(self.b.inner_radius)
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

    fn on_plane(&self, relative: &Relative, cache: &mut Cache<'_>, buffers: &mut NarrowBuffers) {
        let Some((core, radius)) = self.b.geometry.core() else { return };
        let out = &mut buffers.out;
        half_space::region(&core, radius, relative, self.reach, &mut out.feature, &mut out.region);
        self.write(relative, cache, out, 0);
    }

    /// The plane is B: its points seen from A.
    fn plane_below(&self, relative: &Relative, cache: &mut Cache<'_>, buffers: &mut NarrowBuffers) {
        let Some((core, radius)) = self.a.geometry.core() else { return };
        let out = &mut buffers.out;
        let seen = relative.inverse();
        half_space::region(&core, radius, &seen, self.reach, &mut out.feature, &mut out.region);
        flip(&mut out.region, relative);
        self.write(relative, cache, out, 0);
    }

    fn polytopes(
        &self,
        shapes: (&Polytope, &Polytope),
        relative: &Relative,
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) {
        let mut memory = cache.recall(self.key);
        if self.still_known(relative, &mut memory, cache) {
            cache.remember(memory);
            return;
        }
        let NarrowBuffers { sat, out, .. } = buffers;
        let region = &mut out.region;
        let tolerance = AXIS_SHARE * self.size();
        let reach = REACH_IN_STOCK * self.reach;
        let holds = memory.axis.filter(|_| {
            memory.queried_at.is_some_and(|before| 2.0 * self.motion(relative, &before) < memory.lead)
        });
        let mut slides = None;
        if holds.is_none() {
            let found = sat.separation(shapes, relative, reach, tolerance, memory.axis);
            memory.queried_at = Some(*relative);
            memory.distance = found.distance;
            memory.lead = found.lead.clamp(tolerance, LEAD_SHARE * self.size());
            memory.axis = (found.distance < reach).then_some(found.axis);
            if memory.axis.is_some() && self.slides() {
                let velocity = self.world_a.rotation.tr_mul(&self.velocity);
                let way = (&velocity, LIP_SHARE * self.size());
                slides = sat.sliding_axis(shapes, relative, &found.normal, way, self.stands);
            }
            if slides.is_some() {
                memory.queried_at = None;
            }
        }
        region.points.clear();
        if let Some(axis) = slides.or(memory.axis) {
            sat.region(shapes, relative, axis, reach, slides.is_none(), region);
        }
        self.finish(relative, reach, memory, cache, out);
    }

    fn convex(
        &self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) {
        let mut memory = cache.recall(self.key);
        if self.still_known(&pair.relative, &mut memory, cache) {
            cache.remember(memory);
            return;
        }
        let NarrowBuffers { touch, out, .. } = buffers;
        let region = &mut out.region;
        let reach = REACH_IN_STOCK * self.reach;
        let guess =
            if memory.queried_at.is_some() { memory.normal } else { pair.start(GAP_SHARE * self.size()) };
        memory.distance = touch.region(pair, radii, &guess, GAP_SHARE * self.size(), reach, region);
        memory.queried_at = Some(pair.relative);
        memory.normal = region.normal;
        self.slide_over(pair, radii, reach, touch, region);
        self.finish(&pair.relative, reach, memory, cache, out);
    }

    /// Whether one side stands and the other moves fast enough for a seam to matter.
    fn slides(&self) -> bool {
        (self.stands[0] || self.stands[1]) && self.velocity.norm() * self.dt > SLIDE_SHARE * self.size()
    }

    /// As [`SatBuffers::sliding_axis`] for what is round: where it touches an edge of a polytope that stands, but moves
    /// along a side that it hardly overlaps, only what lies over that side counts.
    fn slide_over(
        &self,
        pair: &CorePair<'_>,
        radii: [f64; 2],
        reach: f64,
        touch: &mut TouchBuffers,
        region: &mut Region,
    ) {
        const ALONG: f64 = 0.1;
        const STEADY: f64 = 1e-6;
        let (velocity, speed) = (self.world_a.rotation.tr_mul(&self.velocity), self.velocity.norm());
        if region.points.is_empty() || !self.slides() || velocity.dot(&region.normal) >= -STEADY * speed {
            return;
        }
        let flipped = !matches!((pair.a, self.stands[0]), (Core::Polytope(_), true));
        let (seen, turn) = if flipped {
            let seen = CorePair { a: pair.b, b: pair.a, relative: pair.relative.inverse() };
            (seen, -pair.relative.rotation.transpose())
        } else {
            (*pair, Mat3::identity())
        };
        let (Core::Polytope(ground), true) = (seen.a, self.stands[usize::from(flipped)]) else { return };
        let normal = turn * region.normal;
        // The other's velocity against the ground: that of B turned round is that of A against it.
        let velocity = turn * velocity;
        let overlap = |side: &Vec3| seen.separation_along(side).distance - radii[0] - radii[1];
        let side = ground
            .faces
            .iter()
            .map(|face| face.normal)
            .filter(|side| velocity.dot(side).abs() < ALONG * speed && normal.dot(side) < 1.0 - 1e-9)
            .map(|side| (overlap(&side), side))
            .filter(|(overlap, _)| overlap.abs() < LIP_SHARE * self.size())
            .max_by(|(p, _), (q, _)| p.total_cmp(q));
        if let Some((_, side)) = side {
            let radii = if flipped { [radii[1], radii[0]] } else { radii };
            touch.region_along(&seen, radii, &side, reach, region);
            if flipped {
                flip(region, &pair.relative);
            }
        }
    }

    /// Whether nothing has to be asked: the shapes are still apart, or have moved so little that the manifold stands.
    fn still_known(&self, relative: &Relative, memory: &mut Memory, cache: &mut Cache<'_>) -> bool {
        let Some(before) = &memory.queried_at else { return false };
        if memory.distance > self.reach && memory.distance - self.motion(relative, before) > self.reach {
            return true;
        }
        let Some((before, reach)) = &memory.region_at else { return false };
        if self.reach > *reach || self.motion(relative, before) > self.keep_share * self.size() {
            return false;
        }
        let (i, j) = self.key;
        let Some(manifold) = cache.keep((i, j, 0)) else { return false };
        let normal = self.world_a.rotation * memory.normal;
        if (normal - manifold.normal).norm_squared() > 1e-14 {
            manifold.turn(normal);
        }
        true
    }

    fn finish(
        &self,
        relative: &Relative,
        reach: f64,
        mut memory: Memory,
        cache: &mut Cache<'_>,
        out: &mut Found,
    ) {
        memory.normal = out.region.normal;
        let rolls = self.write(relative, cache, out, 0);
        memory.region_at = (!rolls && !out.region.points.is_empty()).then_some((*relative, reach));
        cache.remember(memory);
    }

    /// A mesh, which is A or B, and a convex shape: a manifold for every plane of the mesh that is near. A plane keeps
    /// its number while it turns little from step to step, so that what the solver knew of it is found again.
    fn surface(
        &self,
        (mesh, mesh_is_a): (&Mesh, bool),
        relative: &Relative,
        cache: &mut Cache<'_>,
        buffers: &mut NarrowBuffers,
    ) {
        const SAME_PLANE: f64 = 0.99;
        let (i, j) = self.key;
        let mut memory = cache.recall(self.key);
        if let Some((before, reach)) = &memory.region_at
            && self.reach <= *reach
            && self.motion(relative, before) <= self.keep_share * self.size()
        {
            cache.keep_all(self.key);
            cache.remember(memory);
            return;
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
                flip(&mut out.region, relative);
            }
            rolls |= self.write(relative, cache, out, name);
        }
        cache.drop_left((i, j));
        memory.region_at = (!rolls && !named.is_empty()).then_some((*relative, reach));
        cache.remember(memory);
    }

    /// Hands the region to the cache, if it has points; whether any of them rolls.
    fn write(&self, relative: &Relative, cache: &mut Cache<'_>, out: &mut Found, subshape: u32) -> bool {
        if out.region.points.is_empty() {
            return false;
        }
        if let Some(way) = self.foreseen {
            self.add_corners(relative, way, out);
        }
        let Found { region, old, .. } = out;
        region.reduce::<MAX_POINTS>();
        let (i, j) = self.key;
        let manifold = cache.entry((i, j, subshape));
        let meeting = Meeting::of(&self.a.pairs, &self.a.surface, &self.b.surface);
        (manifold.friction, manifold.restitution) = (meeting.friction, meeting.restitution);
        let outward_b = relative.rotation.tr_mul(&-region.normal);
        let mut rolls = false;
        let points = region.points.iter().map(|point| {
            let on_b = point.on_a + region.normal * point.separation - relative.translation;
            let anchor_a = anchor(self.a, &self.world_a, &point.on_a, &region.normal);
            let anchor_b = anchor(self.b, &self.world_b, &relative.rotation.tr_mul(&on_b), &outward_b);
            rolls |= anchor_a.offset != Vec3::zeros() || anchor_b.offset != Vec3::zeros();
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

/// Turns a region seen from B, on B and away from it, into one seen from A, on A and towards B.
fn flip(region: &mut Region, relative: &Relative) {
    let normal = relative.rotation * region.normal;
    region.normal = -normal;
    for point in &mut region.points {
        point.on_a = relative.point(&point.on_a) + normal * point.separation;
    }
}

fn spheres(between: &Vec3, radius_a: f64, radius_b: f64, region: &mut Region) {
    let distance = between.norm();
    region.normal = if distance > 1e-12 { between / distance } else { Vec3::y() };
    region.points.clear();
    region.points.push(RegionPoint {
        on_a: region.normal * radius_a,
        separation: distance - radius_a - radius_b,
        feature: 0,
    });
}

/// The anchor of a surface point where the outward normal is `outward`, both in the frame of the shape, which lies at
/// `world`. What rolls there hangs on the shape's axis.
fn anchor(shape: &Collider, world: &Relative, point: &Vec3, outward: &Vec3) -> Anchor {
    let arm = match &shape.geometry {
        Geometry::Sphere { radius } | Geometry::Capsule { radius, .. } => *radius,
        Geometry::Cylinder { radius, .. } if outward.y.abs() < ON_MANTLE => *radius,
        Geometry::Cone { half_height, radius } => {
            let slant = (4.0 * half_height * half_height + radius * radius).sqrt();
            let across = (1.0 - outward.y * outward.y).max(0.0).sqrt();
            if (outward.y - radius / slant).abs() < ON_MANTLE && across > ON_MANTLE {
                (point.x * point.x + point.z * point.z).sqrt() / across
            } else {
                0.0
            }
        }
        _ => 0.0,
    };
    if arm == 0.0 {
        return Anchor { core: shape.in_body(point), offset: Vec3::zeros() };
    }
    let offset = outward * arm;
    Anchor { core: shape.in_body(&(point - offset)), offset: world.rotation * offset }
}
