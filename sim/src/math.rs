//! The only file that names a mathematics crate for the solver: aliases, borders, and rotation by libm, so that
//! every machine computes the same bits.

use crate::scene::Pose;

pub(crate) type Vec3 = nalgebra::Vector3<f64>;
pub(crate) type Mat3 = nalgebra::Matrix3<f64>;
pub(crate) type Mat2 = nalgebra::Matrix2<f64>;
pub(crate) type Vec2 = nalgebra::Vector2<f64>;
pub(crate) type Vec4 = nalgebra::Vector4<f64>;
pub(crate) type Quaternion = nalgebra::Quaternion<f64>;
pub(crate) type Quat = nalgebra::UnitQuaternion<f64>;

/// A rigid transformation: `outer = rotation * inner + position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame3 {
    pub(crate) position: Vec3,
    pub(crate) rotation: Quat,
}

impl Frame3 {
    pub(crate) fn point(&self, inner: &Vec3) -> Vec3 {
        self.rotation * inner + self.position
    }

    pub(crate) fn compose(&self, inner: &Self) -> Self {
        Self { position: self.point(&inner.position), rotation: self.rotation * inner.rotation }
    }

    pub(crate) fn to_pose(self) -> Pose {
        Pose { position: self.position.into(), rotation: self.rotation.coords.into() }
    }
}

impl From<&Pose> for Frame3 {
    fn from(pose: &Pose) -> Self {
        Self { position: pose.position.into(), rotation: quaternion(pose.rotation) }
    }
}

/// The unit quaternion of `x, y, z, w`, normalised.
pub(crate) fn quaternion([x, y, z, w]: [f64; 4]) -> Quat {
    Quat::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
}

/// `rotation` turned by the world rotation vector `turn` (rad): the exponential map, exact for constant
/// angular velocity.
pub(crate) fn rotated(rotation: &Quat, turn: &Vec3) -> Quat {
    let angle = turn.norm();
    // sin(angle / 2) / angle, whose series is exact to the last bit below this angle.
    let (scale, w) = if angle < 1e-4 {
        (0.5 - angle * angle / 48.0, 1.0 - angle * angle / 8.0)
    } else {
        let (sin, cos) = libm::sincos(0.5 * angle);
        (sin / angle, cos)
    };
    let delta = nalgebra::Quaternion::from_parts(w, turn * scale);
    Quat::from_quaternion(delta * rotation.quaternion())
}

/// Symmetric matrix of `[xx, yy, zz, xy, xz, yz]`.
pub(crate) fn symmetric([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Mat3 {
    Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Two unit vectors that with the unit vector `normal` make a right-handed basis; continuous but for one
/// meridian (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
pub(crate) fn tangents(normal: &Vec3) -> [Vec3; 2] {
    let sign = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_vector_series_meets_the_closed_form() {
        for angle in [0.5e-4, 0.999e-4, 1.001e-4, 0.3, 3.0] {
            let turn = Vec3::new(1.0, -2.0, 0.5).normalize() * angle;
            let ours = rotated(&Quat::identity(), &turn);
            assert!(ours.angle_to(&Quat::from_scaled_axis(turn)) < 1e-14, "at {angle} rad");
        }
    }

    #[test]
    fn tangents_are_a_right_handed_basis() {
        for normal in [Vec3::y(), -Vec3::y(), Vec3::z(), -Vec3::z(), Vec3::new(0.3, -0.5, 0.81).normalize()] {
            let [u, v] = tangents(&normal);
            assert!((u.cross(&v) - normal).norm() < 1e-15);
            assert!(u.dot(&v).abs() < 1e-15);
        }
    }
}
