//! The contact region of two shapes: a polygon of points with a common normal, matched between steps.

use std::ops::{Deref, DerefMut};

use crate::collide::anchor::Anchor;
use crate::math::{Frame3, Vec2, Vec3, tangents};

/// Points of one region, at most: what two quadrilaterals can have in common. A larger polygon is reduced to the
/// corners that span it.
pub(crate) const MAX_POINTS: usize = 8;

/// One contact point and what the solver has accumulated on it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub(crate) anchor_a: Anchor,
    pub(crate) anchor_b: Anchor,
    pub(crate) feature: u64,
    /// m, when its place was found.
    pub(crate) separation: f64,
    /// N s, over the last substep: the next one starts from it.
    pub(crate) normal_impulse: f64,
    /// N s, along the manifold's tangents.
    pub(crate) tangent_impulse: Vec2,
    /// m, how far friction has let it slip since it last stuck.
    pub(crate) slip: Vec2,
    /// N s, over the whole step, impacts included.
    pub(crate) step_impulse: f64,
    /// The same of friction, along the manifold's tangents.
    pub(crate) step_friction: Vec2,
}

/// The points of one region, in place: a slice whose storage needs no heap.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(crate) struct Points {
    len: usize,
    storage: [Point; MAX_POINTS],
}

impl Points {
    /// Appends `point`; a region that is full keeps what it has, so reduce before.
    pub(crate) fn push(&mut self, point: Point) {
        if let Some(slot) = self.storage.get_mut(self.len) {
            *slot = point;
            self.len += 1;
        }
    }

    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }
}

impl Deref for Points {
    type Target = [Point];

    fn deref(&self) -> &[Point] {
        &self.storage[..self.len]
    }
}

impl DerefMut for Points {
    fn deref_mut(&mut self) -> &mut [Point] {
        &mut self.storage[..self.len]
    }
}

impl<'a> IntoIterator for &'a Points {
    type Item = &'a Point;
    type IntoIter = std::slice::Iter<'a, Point>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a> IntoIterator for &'a mut Points {
    type Item = &'a mut Point;
    type IntoIter = std::slice::IterMut<'a, Point>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

/// The region between shape `shapes.0` of body A and `shapes.1` of body B. Laid out in this order, so that the first few
/// points lie beside the rest.
#[derive(Clone, Debug, Default)]
#[repr(C)]
pub(crate) struct Manifold {
    /// Children and, for a mesh, the triangle.
    pub(crate) key: (u32, u32, u32),
    /// World, from A to B.
    pub(crate) normal: Vec3,
    pub(crate) tangents: [Vec3; 2],
    pub(crate) friction: f64,
    pub(crate) restitution: f64,
    pub(crate) points: Points,
}

impl Manifold {
    /// Distance between the surfaces at `point` along the normal, negative where they overlap.
    pub(crate) fn separation(&self, point: &Point, a: &Frame3, b: &Frame3) -> f64 {
        let between = b.position - a.position + point.anchor_b.arm(b) - point.anchor_a.arm(a);
        between.dot(&self.normal)
    }

    /// A manifold that is kept starts a step without load, as a new one does.
    pub(crate) fn begin_step(&mut self) {
        for point in &mut self.points {
            (point.step_impulse, point.step_friction) = (0.0, Vec2::zeros());
        }
    }

    /// Forgets its impulses: the surfaces have parted.
    pub(crate) fn unload(&mut self) {
        for point in &mut self.points {
            point.normal_impulse = 0.0;
            point.tangent_impulse = Vec2::zeros();
            point.slip = Vec2::zeros();
        }
    }

    /// Takes new points and the normal that they have in common, and what the solver knew of the old ones: by
    /// feature, and where a feature is new by place on both bodies, `near` metres away at most. Each old point has one heir.
    /// `old` is a buffer.
    pub(crate) fn renew(
        &mut self,
        normal: Vec3,
        points: impl Iterator<Item = Point>,
        near: f64,
        old: &mut Vec<Point>,
    ) {
        old.clear();
        old.extend_from_slice(&self.points);
        let old_tangents = self.tangents;
        self.normal = normal;
        self.tangents = tangents(&normal);
        self.points.clear();
        points.for_each(|point| self.points.push(point));
        let mut free = [true; MAX_POINTS];
        let mut orphan = [false; MAX_POINTS];
        for (i, point) in self.points.iter_mut().enumerate() {
            let before = old.iter().position(|before| before.feature == point.feature);
            orphan[i] = before.is_none();
            if let Some(before) = before {
                free[before] = false;
                inherit(point, &old[before], &old_tangents, &self.tangents);
            }
        }
        if !free[..old.len()].contains(&true) {
            return;
        }
        for (point, _) in self.points.iter_mut().zip(orphan).filter(|(_, orphan)| *orphan) {
            let apart = |before: &Point| {
                let on_a = (before.anchor_a.core - point.anchor_a.core).norm_squared();
                on_a.max((before.anchor_b.core - point.anchor_b.core).norm_squared())
            };
            let heir = (0..old.len())
                .filter(|&i| free[i] && apart(&old[i]) < near * near)
                .min_by(|&i, &j| apart(&old[i]).total_cmp(&apart(&old[j])));
            if let Some(heir) = heir {
                free[heir] = false;
                inherit(point, &old[heir], &old_tangents, &self.tangents);
            }
        }
    }

    /// Turns the normal, and what is measured along the tangents with it.
    pub(crate) fn turn(&mut self, normal: Vec3) {
        let old_tangents = std::mem::replace(&mut self.tangents, tangents(&normal));
        self.normal = normal;
        for point in &mut self.points {
            let before = *point;
            inherit(point, &before, &old_tangents, &self.tangents);
        }
    }
}

/// Impulse and slip are handed on as world vectors.
fn inherit(point: &mut Point, before: &Point, old_tangents: &[Vec3; 2], tangents: &[Vec3; 2]) {
    point.normal_impulse = before.normal_impulse;
    let world = |v: &Vec2| old_tangents[0] * v.x + old_tangents[1] * v.y;
    let today = |v: Vec3| Vec2::new(v.dot(&tangents[0]), v.dot(&tangents[1]));
    point.tangent_impulse = today(world(&before.tangent_impulse));
    point.slip = today(world(&before.slip));
}
