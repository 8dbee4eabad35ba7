//! Points of the mesh that can be seen from outside, in an order in which those in a box are soon found.

use super::prepared::{Vec3, bounds};

#[derive(Clone, Debug)]
pub(super) struct Seen {
    axis: usize,
    /// In order along the axis.
    points: Vec<Vec3>,
}

impl Seen {
    pub fn new(mut points: Vec<Vec3>) -> Self {
        let (low, high) = bounds(&points);
        let axis = (high - low).imax();
        points.sort_by(|p, q| p[axis].total_cmp(&q[axis]));
        Self { axis, points }
    }

    pub fn iter(&self) -> impl Iterator<Item = &Vec3> {
        self.points.iter()
    }

    /// Those in the box.
    pub fn within(&self, low: Vec3, high: Vec3) -> impl Iterator<Item = &Vec3> {
        let first = self.points.partition_point(|p| p[self.axis] < low[self.axis]);
        let last = self.points.partition_point(|p| p[self.axis] <= high[self.axis]);
        let range = self.points.get(first..last).unwrap_or(&[]);
        range.iter().filter(move |p| (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]))
    }

    /// About `count` of them.
    pub fn thinned(&self, count: usize) -> Self {
        let step = self.points.len().div_ceil(count).max(1);
        self.with(self.points.iter().step_by(step))
    }

    /// Some of them, in their order.
    pub fn with<'a>(&self, points: impl Iterator<Item = &'a Vec3>) -> Self {
        Self { axis: self.axis, points: points.copied().collect() }
    }
}
