//! A body's state and what of it never changes.

use crate::error::SceneError;
use crate::flight::Launch;
use crate::frame::SleepState;
use crate::math::{Frame3, Mat3, Quat, Vec3, quaternion, symmetric};
use crate::plan::Plan;
use crate::rotation::Rotor;
use crate::scene::{Entity, Motion, Velocity};
use crate::shape::{Aabb, Collider};

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
    /// How it turns between contacts.
    pub(crate) rotor: Rotor,
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
    /// m²/s², twice the kinetic energy over mass, averaged over a short and a longer window.
    pub(crate) stir_now: f64,
    pub(crate) stir_lately: f64,
    pub(crate) quarantined: bool,
    /// Nothing touched it in the last substep: it moves on a parabola.
    pub(crate) flies: bool,
    /// Nothing is near enough to touch it within the step: it takes the step at once.
    pub(crate) free: bool,
    /// Of the flight under way.
    pub(crate) launch: Option<Launch>,
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
    pub(crate) fn new(entity: &Entity, plan: &Plan) -> Result<Self, SceneError> {
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
        let position = Vec3::from(entity.pose.position);
        let rotation = quaternion(entity.pose.rotation);
        let velocity = if is_static { Velocity::default() } else { entity.velocity };
        Ok(Self {
            mass,
            inv_mass: if is_static { 0.0 } else { 1.0 / mass },
            inertia,
            inv_inertia,
            rotor: if is_static { Rotor::Isotropic } else { plan.rotor(&inertia) },
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
            stir_now: 0.0,
            stir_lately: 0.0,
            quarantined: false,
            flies: !is_static,
            free: false,
            launch: None,
            steady_acceleration: Vec3::zeros(),
            acceleration: Vec3::zeros(),
            aabb: Aabb { min: position, max: position },
        })
    }

    pub(crate) fn is_static(&self) -> bool {
        self.inv_mass == 0.0
    }

    /// Goes through the small steps: awake, and something is near.
    pub(crate) fn substeps(&self) -> bool {
        self.is_awake() && !self.free
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
        if self.rotor == Rotor::Isotropic {
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
    pub(crate) fn turn(&mut self, h: f64) {
        let inertia = [&self.inertia, &self.inv_inertia];
        (self.rotation, self.spin) = self.rotor.turned(inertia, &self.rotation, &self.spin, h);
    }

    /// The spin after `h` seconds of turning at `spin` from `rotation` without torque.
    pub(crate) fn torque_free_spin(&self, rotation: &Quat, spin: &Vec3, h: f64) -> Vec3 {
        self.rotor.spun([&self.inertia, &self.inv_inertia], rotation, spin, h)
    }

    /// Whether a turn at `spin` for `h` seconds changes the spin to speak of.
    pub(crate) fn tumbles(&self, spin: &Vec3, h: f64) -> bool {
        const SLOW_TURN_RAD: f64 = 1e-4;
        self.rotor != Rotor::Isotropic && spin.norm() * h >= SLOW_TURN_RAD
    }

    /// Moves on its own for `span` seconds: a parabola, and angular momentum kept.
    pub(crate) fn fly(&mut self, gravity: &Vec3, span: f64) {
        self.position += (self.velocity + gravity * (0.5 * span)) * span;
        self.velocity += gravity * span;
        self.turn(span);
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
