//! A body's state and what of it never changes.

use crate::error::SceneError;
use crate::frame::SleepState;
use crate::math::{Frame3, Mat3, Quat, Quaternion, Vec3, quaternion, rotated, symmetric};
use crate::scene::{Entity, Motion, Velocity};
use crate::shape::{Aabb, Collider};

/// rad a substep up to which the midpoint rule turns a body within 1e-12 of the truth.
const SLOW_TURN_RAD: f64 = 1e-4;

/// A rigid body: a frame at its centre of mass, state in f64 in the world.
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) colliders: Vec<Collider>,
    /// kg; 0 with `inv_mass` 0 for what never moves.
    pub(crate) mass: f64,
    pub(crate) inv_mass: f64,
    /// kg m², body frame.
    pub(crate) inertia: Mat3,
    pub(crate) inv_inertia: Mat3,
    /// All principal moments equal: no gyroscopic torque, and the tensor is the same in every frame.
    pub(crate) isotropic: bool,
    /// Largest distance of a point of the body from its centre of mass, m.
    pub(crate) reach: f64,
    /// Half the smallest extent of its smallest shape, m.
    pub(crate) inner_radius: f64,

    pub(crate) position: Vec3,
    pub(crate) rotation: Quat,
    pub(crate) velocity: Vec3,
    pub(crate) spin: Vec3,

    pub(crate) sleep: SleepState,
    /// s for which it has been still.
    pub(crate) still_s: f64,
    /// s into the run at which it became still.
    pub(crate) still_since_s: f64,
    /// Where it was when it became still: what it has crept since counts against sleep.
    pub(crate) still_from: Frame3,
    pub(crate) quarantined: bool,
    /// Nothing touched it in the last substep: it moves on a parabola.
    pub(crate) flies: bool,
    /// m/s², over the last substep, relaxation included; zero unless it hardly differs from the one before.
    pub(crate) steady_acceleration: Vec3,
    /// m/s², the same as it is.
    pub(crate) acceleration: Vec3,
    /// Bounds of all shapes, grown by what the body can do in a step.
    pub(crate) aabb: Aabb,
}

impl Body {
    /// # Errors
    /// A [`SceneError`] that names the entity.
    pub(crate) fn new(entity: &Entity) -> Result<Self, SceneError> {
        let not_finite = |what| SceneError::NotFinite { entity: entity.name.clone(), what };
        let finite = |what, values: &[f64]| {
            if values.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(not_finite(what)) }
        };
        finite("position", &entity.pose.position)?;
        finite("rotation", &entity.pose.rotation)?;
        finite("velocity", &entity.velocity.linear)?;
        finite("angular velocity", &entity.velocity.angular)?;
        if entity.pose.rotation.iter().map(|x| x * x).sum::<f64>() < 1e-12 {
            return Err(not_finite("rotation (a quaternion of length 0)"));
        }
        let is_static = matches!(entity.motion, Motion::Static);
        let colliders = entity
            .shapes
            .iter()
            .enumerate()
            .map(|(index, child)| Collider::new(child, &entity.name, index, is_static))
            .collect::<Result<Vec<_>, _>>()?;
        let (mass, inertia) = match &entity.motion {
            Motion::Static => (0.0, Mat3::zeros()),
            Motion::Dynamic(mass) => {
                if !(mass.mass_kg > 0.0 && mass.mass_kg.is_finite()) {
                    return Err(SceneError::Mass { entity: entity.name.clone(), mass_kg: mass.mass_kg });
                }
                finite("inertia tensor", &mass.inertia_kg_m2)?;
                (mass.mass_kg, symmetric(mass.inertia_kg_m2))
            }
        };
        let inv_inertia = if is_static { Mat3::zeros() } else { invert(&inertia, &entity.name)? };
        let moments = [inertia.m11, inertia.m22, inertia.m33];
        let largest = moments.iter().copied().fold(0.0, f64::max);
        let off = inertia.m12.abs().max(inertia.m13.abs()).max(inertia.m23.abs());
        let spread = moments.iter().map(|m| (m - largest).abs()).fold(off, f64::max);
        let position = Vec3::from(entity.pose.position);
        let rotation = quaternion(entity.pose.rotation);
        let velocity = if is_static { Velocity::default() } else { entity.velocity };
        Ok(Self {
            mass,
            inv_mass: if is_static { 0.0 } else { 1.0 / mass },
            inertia,
            inv_inertia,
            isotropic: spread <= 1e-9 * largest,
            reach: colliders.iter().map(|c| c.reach).fold(0.0, f64::max),
            inner_radius: colliders.iter().map(|c| c.inner_radius).fold(f64::INFINITY, f64::min),
            colliders,
            position,
            rotation,
            velocity: velocity.linear.into(),
            spin: velocity.angular.into(),
            sleep: SleepState::Active,
            still_s: 0.0,
            still_since_s: 0.0,
            still_from: Frame3 { position, rotation },
            quarantined: false,
            flies: !is_static,
            steady_acceleration: Vec3::zeros(),
            acceleration: Vec3::zeros(),
            aabb: Aabb { min: position, max: position },
        })
    }

    pub(crate) fn is_static(&self) -> bool {
        self.inv_mass == 0.0
    }

    /// Moves, and is not asleep.
    pub(crate) fn is_awake(&self) -> bool {
        !self.is_static() && self.sleep != SleepState::Asleep
    }

    pub(crate) fn frame(&self) -> Frame3 {
        Frame3 { position: self.position, rotation: self.rotation }
    }

    /// R I⁻¹ Rᵀ: the inverse inertia tensor in the world.
    pub(crate) fn world_inv_inertia(&self) -> Mat3 {
        if self.isotropic {
            return self.inv_inertia;
        }
        let r = self.rotation.to_rotation_matrix();
        r.matrix() * self.inv_inertia * r.matrix().transpose()
    }

    /// Angular momentum about the centre of mass, world, kg m²/s.
    pub(crate) fn angular_momentum(&self) -> Vec3 {
        self.rotation * (self.inertia * (self.rotation.inverse() * self.spin))
    }

    /// J, of translation and rotation.
    pub(crate) fn kinetic_j(&self) -> f64 {
        0.5 * (self.mass * self.velocity.norm_squared() + self.spin.dot(&self.angular_momentum()))
    }

    /// Turns the body for `h` seconds without torque.
    ///
    /// Isotropic: constant spin, exact. Else the angular momentum L is held in the world, |L| to round-off, and
    /// the rotation follows q' = ω q / 2 with ω = R I⁻¹ Rᵀ L: by the midpoint rule where it hardly turns, by
    /// Runge and Kutta's fourth order where it does. Rejected: implicit Euler on ω, the games' choice, which
    /// damps the tumbling away.
    pub(crate) fn turn(&mut self, h: f64) {
        if self.isotropic {
            self.rotation = rotated(&self.rotation, &(self.spin * h));
            return;
        }
        let momentum = self.angular_momentum();
        let spin_at = |rotation: &Quat| rotation * (self.inv_inertia * (rotation.inverse() * momentum));
        let start = self.rotation;
        let end = if self.spin.norm() * h < SLOW_TURN_RAD {
            let middle = rotated(&start, &(self.spin * (0.5 * h)));
            rotated(&start, &(spin_at(&middle) * h))
        } else {
            let rate = |q: &Quat| Quaternion::from_imag(spin_at(q) * 0.5) * q.quaternion();
            let moved = |rate: &Quaternion, h: f64| Quat::from_quaternion(start.quaternion() + rate * h);
            let k1 = rate(&start);
            let k2 = rate(&moved(&k1, 0.5 * h));
            let k3 = rate(&moved(&k2, 0.5 * h));
            let k4 = rate(&moved(&k3, h));
            moved(&(k1 + (k2 + k3) * 2.0 + k4), h / 6.0)
        };
        self.spin = spin_at(&end);
        self.rotation = end;
    }

    /// Velocity of the material point at `arm` from the centre of mass.
    pub(crate) fn velocity_at(&self, arm: &Vec3) -> Vec3 {
        self.velocity + self.spin.cross(arm)
    }
}

/// Inverse of a physical inertia tensor.
fn invert(inertia: &Mat3, entity: &str) -> Result<Mat3, SceneError> {
    let moments = inertia.symmetric_eigenvalues();
    let refused = || SceneError::Inertia {
        entity: entity.to_owned(),
        moments_kg_m2: [moments.x, moments.y, moments.z],
    };
    let sum = moments.sum();
    // A thin sheet meets the triangle inequality with equality, so leave room for rounding.
    if moments.iter().any(|m| *m <= 0.0 || sum - m < m * (1.0 - 1e-6)) {
        return Err(refused());
    }
    inertia.try_inverse().ok_or_else(refused)
}
