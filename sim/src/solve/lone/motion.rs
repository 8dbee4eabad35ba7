//! The motion of one rigid body over an interval under impulses, energy and momentum kept (Simo and Wong 1991).

use crate::body::Body;
use crate::math::{Frame3, Mat3, Quat, Quaternion, Vec3};

/// What a body's motion is at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) frame: Frame3,
    /// m/s
    pub(super) velocity: Vec3,
    /// rad/s, world.
    pub(super) spin: Vec3,
}

impl State {
    pub(super) fn of(body: &Body) -> Self {
        Self { frame: body.frame(), velocity: body.velocity, spin: body.spin }
    }

    pub(super) fn store(&self, body: &mut Body) {
        body.position = self.frame.position;
        body.rotation = self.frame.rotation;
        body.velocity = self.velocity;
        body.spin = self.spin;
    }

    /// R, of which the columns are the body's axes.
    pub(super) fn axes(&self) -> Mat3 {
        self.frame.rotation.to_rotation_matrix().into_inner()
    }
}

/// `rotation` turned by Cayley's map of the world vector `turn`: by 2 atan(|turn| / 2) about it. With it an arm r is
/// carried by exactly `turn` × the mean of r before and after.
pub(super) fn cayley(rotation: &Quat, turn: &Vec3) -> Quat {
    Quat::from_quaternion(Quaternion::from_parts(1.0, turn * 0.5) * rotation.quaternion())
}

/// An interval under way to its end: the end as it is known so far, and the means over the interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// s
    span: f64,
    start: State,
    /// Body spin and world angular momentum at the start; R then.
    body_spin: Vec3,
    momentum: Vec3,
    pub(super) start_axes: Mat3,
    pub(super) end: State,
    pub(super) end_axes: Mat3,
    /// (v₀ + v₁) / 2 and R₀ (W₀ + W₁) / 2, W the spin in the body's axes.
    pub(super) mean_velocity: Vec3,
    pub(super) mean_spin: Vec3,
}

impl Interval {
    /// As the body would go on turning.
    pub(super) fn new(body: &Body, start: &State, span: f64) -> Self {
        let start_axes = start.axes();
        let body_spin = start_axes.tr_mul(&start.spin);
        let mut end = *start;
        end.frame.rotation = cayley(&start.frame.rotation, &(start.spin * span));
        Self {
            span,
            start: *start,
            body_spin,
            momentum: start_axes * (body.inertia * body_spin),
            start_axes,
            end_axes: end.axes(),
            end,
            mean_velocity: start.velocity,
            mean_spin: start.spin,
        }
    }

    /// (R₀ + R₁) / 2, by which arms are the mean of theirs before and after.
    pub(super) fn mean_axes(&self) -> Mat3 {
        (self.start_axes + self.end_axes) * 0.5
    }

    /// Brings the end up to the impulse and the moment (N s, N m s, about the centre of mass) that act over the
    /// interval, weight included in the impulse. The rotation is one fixed-point step nearer, which contracts by the angle turned.
    ///
    /// R₁ I W₁ = R₀ I W₀ + moment and R₁ = cay(span R₀ (W₀ + W₁) / 2) R₀: then the work of the moment on the mean spin is
    /// just the change of energy.
    pub(super) fn drive(&mut self, body: &Body, impulse: &Vec3, moment: &Vec3) {
        self.end.velocity = self.start.velocity + impulse * body.inv_mass;
        self.mean_velocity = (self.start.velocity + self.end.velocity) * 0.5;
        self.end.frame.position = self.start.frame.position + self.mean_velocity * self.span;
        let spin_at_end = body.inv_inertia * self.end_axes.tr_mul(&(self.momentum + moment));
        self.mean_spin = self.start_axes * ((self.body_spin + spin_at_end) * 0.5);
        self.end.frame.rotation = cayley(&self.start.frame.rotation, &(self.mean_spin * self.span));
        self.end_axes = self.end.axes();
        self.end.spin = self.end_axes * spin_at_end;
    }
}
