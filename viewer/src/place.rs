//! Single-precision poses for drawing, and where a model stands in the picture.

use sim::Pose;

/// Position and unit quaternion `x, y, z, w`, as drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drawn {
    pub(crate) position: [f32; 3],
    pub(crate) rotation: [f32; 4],
}

impl Drawn {
    #[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
    pub(crate) fn of(pose: &Pose) -> Self {
        Self { position: pose.position.map(|x| x as f32), rotation: pose.rotation.map(|x| x as f32) }
    }

    pub(crate) fn apply(&self, point: [f32; 3]) -> [f32; 3] {
        let turned = rotate(self.rotation, point);
        std::array::from_fn(|i| turned[i] + self.position[i])
    }

    /// `self` after `inner`.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self { position: self.apply(inner.position), rotation: product(self.rotation, inner.rotation) }
    }
}

/// Rotation of a vector by a unit quaternion: `v + 2 w (q × v) + 2 q × (q × v)`.
pub(crate) fn rotate([x, y, z, w]: [f32; 4], v: [f32; 3]) -> [f32; 3] {
    let cross = |a: [f32; 3], b: [f32; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let t = cross([x, y, z], v).map(|c| 2.0 * c);
    let u = cross([x, y, z], t);
    std::array::from_fn(|i| v[i] + w * t[i] + u[i])
}

/// Hamilton product.
fn product(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    [
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    ]
}

/// From a scene to the picture: `picture = scale * scene + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) offset: [f32; 3],
    pub(crate) scale: f32,
}

impl Placement {
    pub(crate) const IDENTITY: Self = Self { offset: [0.0; 3], scale: 1.0 };

    pub(crate) fn apply(&self, point: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|i| point[i] * self.scale + self.offset[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUARTER: f32 = std::f32::consts::FRAC_1_SQRT_2;

    fn near(a: [f32; 3], b: [f32; 3]) -> bool {
        (0..3).all(|i| (a[i] - b[i]).abs() < 1e-6)
    }

    #[test]
    fn quarter_turn_about_y_takes_z_to_x() {
        assert!(near(rotate([0.0, QUARTER, 0.0, QUARTER], [0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]));
    }

    #[test]
    fn composition_is_application_in_turn() {
        let a = Drawn { position: [1.0, 2.0, 3.0], rotation: [0.0, QUARTER, 0.0, QUARTER] };
        let b = Drawn { position: [0.5, 0.0, -1.0], rotation: [QUARTER, 0.0, 0.0, QUARTER] };
        let point = [0.3, -0.7, 2.0];
        assert!(near(a.after(&b).apply(point), a.apply(b.apply(point))));
    }
}
