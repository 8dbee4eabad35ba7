//! The contact region of two shapes: a polygon of points with a common normal, matched between steps.

use std::ops::{Deref, DerefMut};

use crate::math::{Frame3, Vec2, Vec3, tangents};

/// Points of one region, at most: what two quadrilaterals can have in common. A larger polygon is reduced to the
/// corners that span it.
pub(crate) const MAX_POINTS: usize = 8;

/// Where a body touches, split into what turns with it and what does not.
///
/// A corner turns with its body. The lowest point of a sphere does not: its centre turns (that is, stays) and the
/// radius hangs from it. Taking it for a corner would let a ball that rolls by an angle sink by r (1 - cos).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Anchor {
    /// In the body frame.
    pub(crate) core: Vec3,
    /// World vector from the core to the surface.
    pub(crate) offset: Vec3,
}

impl Anchor {
    /// Material point `point` (world) of a body at `frame`.
    pub(crate) fn corner(frame: &Frame3, point: &Vec3) -> Self {
        Self { core: frame.rotation.inverse() * (point - frame.position), offset: Vec3::zeros() }
    }

    /// A surface point at `offset` from the world point `core` of a body at `frame`.
    pub(crate) fn round(frame: &Frame3, core: &Vec3, offset: Vec3) -> Self {
        Self { core: frame.rotation.inverse() * (core - frame.position), offset }
    }

    /// From the centre of mass to the surface point, world.
    pub(crate) fn arm(&self, frame: &Frame3) -> Vec3 {
        frame.rotation * self.core + self.offset
    }
}

/// One contact point and what the solver has accumulated on it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub(crate) anchor_a: Anchor,
    pub(crate) anchor_b: Anchor,
    pub(crate) feature: u64,
    /// m, as of the bodies' present poses; kept by the solver.
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

impl FromIterator<Point> for Points {
    fn from_iter<I: IntoIterator<Item = Point>>(points: I) -> Self {
        let mut kept = Self::default();
        points.into_iter().for_each(|point| kept.push(point));
        kept
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

/// The region between shape `shapes.0` of body A and `shapes.1` of body B.
#[derive(Clone, Debug)]
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

    /// Forgets its impulses: the surfaces have parted.
    pub(crate) fn unload(&mut self) {
        for point in &mut self.points {
            point.normal_impulse = 0.0;
            point.tangent_impulse = Vec2::zeros();
            point.slip = Vec2::zeros();
        }
    }

    /// Takes over what the solver knew of the same points in the step before.
    pub(crate) fn inherit(&mut self, old: &Self) {
        for point in &mut self.points {
            let Some(before) = old.points.iter().find(|before| before.feature == point.feature) else {
                continue;
            };
            point.normal_impulse = before.normal_impulse;
            // Impulse and slip as world vectors, on the tangents of today.
            let world = |v: &Vec2| old.tangents[0] * v.x + old.tangents[1] * v.y;
            let today = |v: Vec3| Vec2::new(v.dot(&self.tangents[0]), v.dot(&self.tangents[1]));
            point.tangent_impulse = today(world(&before.tangent_impulse));
            point.slip = today(world(&before.slip));
        }
    }
}

/// A point before reduction: position along the plane of contact, and separation.
pub(crate) struct Candidate {
    pub(crate) position: Vec3,
    pub(crate) separation: f64,
}

/// Indices of at most [`MAX_POINTS`] candidates, ascending: the deepest, and the extreme ones in seven or eight
/// directions of the plane, so that the polygon they span is nearly the whole region's.
///
/// Depth counts as well as reach, or a shallow corner far away would push out the deep ones. Rejected: the usual
/// deepest, farthest, largest triangle. With many equally deep corners it picks others each step, and the body
/// rocks.
pub(crate) fn reduce(candidates: &[Candidate], normal: &Vec3) -> Vec<usize> {
    if candidates.len() <= MAX_POINTS {
        return (0..candidates.len()).collect();
    }
    const DEPTH_OVER_REACH: f64 = 4.0;
    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let [u, v] = tangents(normal);
    let depth = |i: &usize| -candidates[*i].separation;
    let deepest = (0..candidates.len()).max_by(|i, j| depth(i).total_cmp(&depth(j)).then(j.cmp(i)));
    let extremes = [[1.0, 0.0], [DIAGONAL, DIAGONAL], [0.0, 1.0], [-DIAGONAL, DIAGONAL]]
        .into_iter()
        .flat_map(|[x, y]| [u * x + v * y, -(u * x + v * y)])
        .filter_map(|direction| {
            let score = |i: &usize| {
                candidates[*i].position.dot(&direction) - DEPTH_OVER_REACH * candidates[*i].separation
            };
            (0..candidates.len()).max_by(|i, j| score(i).total_cmp(&score(j)).then(j.cmp(i)))
        });
    let mut kept = Vec::with_capacity(MAX_POINTS);
    for index in deepest.into_iter().chain(extremes) {
        if kept.len() < MAX_POINTS && !kept.contains(&index) {
            kept.push(index);
        }
    }
    kept.sort_unstable();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reduction_keeps_the_span_and_the_deepest() {
        let ring = (0..32).map(|i| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 32.0);
            Candidate { position: Vec3::new(cos, 0.0, sin), separation: if i == 5 { -0.1 } else { 0.0 } }
        });
        let ring: Vec<_> = ring.collect();
        let kept = reduce(&ring, &Vec3::y());
        assert!(kept.len() <= MAX_POINTS && kept.contains(&5), "{kept:?}");
        let area: f64 = kept
            .iter()
            .zip(kept.iter().cycle().skip(1))
            .map(|(i, j)| 0.5 * ring[*j].position.cross(&ring[*i].position).y)
            .sum();
        assert!(area > 0.85 * std::f64::consts::PI, "span {area}");
    }
}
