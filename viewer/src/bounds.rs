//! Axis-aligned bounds of what is drawn.

/// An empty box has `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
}

impl Bounds {
    pub(crate) const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// Non-finite points are left out.
    pub(crate) fn add(&mut self, point: [f32; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            self.min = std::array::from_fn(|i| self.min[i].min(point[i]));
            self.max = std::array::from_fn(|i| self.max[i].max(point[i]));
        }
    }

    pub(crate) fn of<'a>(points: impl IntoIterator<Item = &'a [f32; 3]>) -> Self {
        let mut bounds = Self::EMPTY;
        points.into_iter().for_each(|point| bounds.add(*point));
        bounds
    }

    pub(crate) fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.min[axis] > self.max[axis])
    }

    pub(crate) fn center(&self) -> [f32; 3] {
        std::array::from_fn(|i| if self.is_empty() { 0.0 } else { f32::midpoint(self.min[i], self.max[i]) })
    }

    pub(crate) fn size(&self) -> [f32; 3] {
        std::array::from_fn(|i| if self.is_empty() { 0.0 } else { self.max[i] - self.min[i] })
    }

    /// Half the diagonal.
    pub(crate) fn radius(&self) -> f32 {
        let [x, y, z] = self.size();
        0.5 * (x * x + y * y + z * z).sqrt()
    }
}
