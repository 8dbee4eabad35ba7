//! Where one shape lies, seen from another.

use crate::math::{Frame3, Mat3, Vec3};

/// Where shape B lies, seen from the frame of shape A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    pub(crate) rotation: Mat3,
    pub(crate) translation: Vec3,
}

impl From<&Frame3> for Relative {
    fn from(frame: &Frame3) -> Self {
        Self { rotation: *frame.rotation.to_rotation_matrix().matrix(), translation: frame.position }
    }
}

impl Relative {
    pub(crate) fn compose(&self, inner: &Self) -> Self {
        Self { rotation: self.rotation * inner.rotation, translation: self.point(&inner.translation) }
    }

    /// Where `other` lies, seen from here.
    pub(crate) fn inverse_compose(&self, other: &Self) -> Self {
        Self {
            rotation: self.rotation.tr_mul(&other.rotation),
            translation: self.rotation.tr_mul(&(other.translation - self.translation)),
        }
    }

    pub(crate) fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    pub(crate) fn point(&self, b: &Vec3) -> Vec3 {
        self.rotation * b + self.translation
    }

    /// How far a point within `reach` of B's origin may have moved against A since `before`, at most, m.
    pub(crate) fn motion_since(&self, before: &Self, reach: f64) -> f64 {
        // |ΔR| <= its Frobenius norm over sqrt 2, with equality for a rotation about one axis.
        let turn = (self.rotation - before.rotation).norm() * std::f64::consts::FRAC_1_SQRT_2;
        (self.translation - before.translation).norm() + turn * reach
    }
}
