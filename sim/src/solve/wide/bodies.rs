//! The bodies as the kernels see them: velocities and displacements since the step began.
//!
//! A body that no contact carries during a step is left to exact flight in f64; the others take what the rows say.

use crate::body::Body;
use crate::math::{Frame3, Quat, Vec3, rotated};

use super::kernel::{CARRIED, FLIES};
use super::lanes::{Eight, Scalar};

/// Share of gravity by which an acceleration may change between substeps and still be called steady.
const STEADY_SHARE: f64 = 0.02;

/// What a row needs between the sweeps.
#[derive(Clone)]
pub(crate) struct RowState<S> {
    pub(crate) body: u32,
    /// Where the body was when the step began.
    start: Frame3,
    /// Its velocity before the substep.
    before: [S; 3],
    /// m/s² over the last substep; and the same if it hardly differs from the one before, else zero.
    acceleration: [S; 3],
    steady: [S; 3],
    /// m/s and rad/s after gravity, before contacts; and what these then changed.
    free: [S; 6],
    pushed: [S; 6],
    /// rad/s: half of what its own rotation changed of its spin in the substep, so that it turns by the mean.
    swing: [S; 3],
    /// s: what is left of the substep after an impact.
    span: S,
    /// A contact has carried it during the step.
    pub(crate) touched: bool,
}

impl<S: Scalar> RowState<S> {
    /// The row of a body that has `span` s of the substep still to go.
    pub(crate) fn new(index: u32, body: &Body, span: f64) -> (Self, Eight<S>) {
        let narrow = |v: &Vec3| [S::of(v.x), S::of(v.y), S::of(v.z)];
        let state = Self {
            body: index,
            start: body.frame(),
            before: [S::default(); 3],
            free: [S::default(); 6],
            pushed: [S::default(); 6],
            swing: [S::default(); 3],
            acceleration: narrow(&body.acceleration),
            steady: narrow(&body.steady_acceleration),
            span: S::of(span),
            touched: false,
        };
        let flies = if body.flies { 1.0 } else { 0.0 };
        let (v, w) = (body.velocity, body.spin);
        (state, Eight([v.x, v.y, v.z, w.x, w.y, w.z, 0.0, flies].map(S::of)))
    }

    /// Of the body, when the step began.
    pub(crate) fn start_rotation(&self) -> &Quat {
        &self.start.rotation
    }

    /// Gravity, what the rotation of an uneven body does to its own spin, and what contacts did in the substep before:
    /// arms and inertia stay for the step, so that their impulses once more are the same change of velocity.
    pub(crate) fn accelerate(
        &mut self,
        body: &Body,
        gravity: &[S; 3],
        h: S,
        velocity: &mut Eight<S>,
        moved: &Eight<S>,
    ) {
        let v = &mut velocity.0;
        self.before = [v[0], v[1], v[2]];
        v[CARRIED] = S::default();
        let span = if v[FLIES] > S::default() { self.span } else { h };
        for axis in 0..3 {
            v[axis] = v[axis] + gravity[axis] * span;
        }
        let spin = Vec3::new(v[3].wide(), v[4].wide(), v[5].wide());
        if body.tumbles(&spin, h.wide()) {
            let turned = Vec3::new(moved.0[3].wide(), moved.0[4].wide(), moved.0[5].wide());
            let spin = body.torque_free_spin(&rotated(&self.start.rotation, &turned), &spin, h.wide());
            for axis in 0..3 {
                let turned = S::of(spin[axis]);
                self.swing[axis] = (turned - v[3 + axis]) * S::of(0.5);
                v[3 + axis] = turned;
            }
        } else {
            self.swing = [S::default(); 3];
        }
        self.free = [v[0], v[1], v[2], v[3], v[4], v[5]];
        for (v, pushed) in v.iter_mut().zip(&self.pushed) {
            *v = *v + *pushed;
        }
    }

    /// Moves by the substep's velocity.
    ///
    /// The mean of the velocities before and after moves a body along its parabola: exact in flight. What slides or
    /// rolls accelerates as steadily, so the acceleration of the substep before takes gravity's place; what a
    /// contact stops or throws does not, and moves with the velocity that the contact left it.
    pub(crate) fn advance(&mut self, gravity: &[S; 3], velocity: &mut Eight<S>, moved: &mut Eight<S>) {
        let (v, d) = (&mut velocity.0, &mut moved.0);
        let carried = v[CARRIED] > S::default();
        self.touched |= carried;
        v[FLIES] = if carried { S::default() } else { S::of(1.0) };
        let acceleration = if carried { &self.steady } else { gravity };
        let half = S::of(0.5);
        let turn: [S; 3] = std::array::from_fn(|axis| (v[3 + axis] - self.swing[axis]) * self.span);
        for axis in 0..3 {
            d[axis] = d[axis] + (v[axis] - acceleration[axis] * half * self.span) * self.span;
        }
        turn_on(d, &turn);
    }

    /// Notes the substep's acceleration once its velocity is final.
    pub(crate) fn note(&mut self, noise: S, h: S, velocity: &Eight<S>) {
        let v = &velocity.0;
        self.touched |= v[CARRIED] > S::default();
        self.pushed = std::array::from_fn(|axis| v[axis] - self.free[axis]);
        let per_h = S::of(1.0 / h.wide());
        let acceleration: [S; 3] = std::array::from_fn(|axis| (v[axis] - self.before[axis]) * per_h);
        let change: [S; 3] = std::array::from_fn(|axis| acceleration[axis] - self.acceleration[axis]);
        let size = change[0] * change[0] + change[1] * change[1] + change[2] * change[2];
        self.steady = if size < noise * noise { acceleration } else { [S::default(); 3] };
        self.acceleration = acceleration;
        self.span = h;
    }

    /// Hands the state back: what was carried moves as the rows say, the rest flies `span` s on its own.
    pub(crate) fn store(
        &mut self,
        body: &mut Body,
        gravity: &Vec3,
        span: f64,
        velocity: &Eight<S>,
        moved: &Eight<S>,
    ) {
        let wide = |x: &[S]| Vec3::new(x[0].wide(), x[1].wide(), x[2].wide());
        body.flies = velocity.0[FLIES] > S::default();
        body.acceleration = wide(&self.acceleration);
        body.steady_acceleration = wide(&self.steady);
        if self.touched {
            body.position = self.start.position + wide(&moved.0[..3]);
            body.rotation = rotated(&self.start.rotation, &wide(&moved.0[3..6]));
            body.velocity = wide(&velocity.0[..3]);
            body.spin = wide(&velocity.0[3..6]);
        } else {
            body.fly(gravity, span);
        }
    }
}

/// The row of what has not moved: no displacement, no rotation.
pub(crate) fn unmoved<S: Scalar>() -> Eight<S> {
    Eight([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5].map(S::of))
}

/// rad² up to which short series are exact to the last bit of f32.
const SMALL_TURN: f64 = 0.04;

/// Adds `turn` to the rotation of a row, and brings up `sin θ / θ` and `(1 - cos θ) / θ²`, by which an arm turns.
fn turn_on<S: Scalar>(d: &mut [S; 8], turn: &[S; 3]) {
    let old = [d[3], d[4], d[5]];
    let size = |x: &[S; 3]| x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    if (size(&old) + size(turn)).wide() < SMALL_TURN {
        for axis in 0..3 {
            // log(exp(a) exp(b)) = a + b + [a, b] / 2 + …
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let swirl = turn[next] * old[last] - turn[last] * old[next];
            d[3 + axis] = old[axis] + turn[axis] + S::of(0.5) * swirl;
        }
        let x = size(&[d[3], d[4], d[5]]);
        d[6] = S::of(1.0) - x * (S::of(1.0 / 6.0) - x * S::of(1.0 / 120.0));
        d[7] = S::of(0.5) - x * (S::of(1.0 / 24.0) - x * S::of(1.0 / 720.0));
    } else {
        let wide = |x: &[S; 3]| Vec3::new(x[0].wide(), x[1].wide(), x[2].wide());
        let end = rotated(&rotated(&Quat::identity(), &wide(&old)), &wide(turn));
        let sine = end.imag().norm();
        let angle = 2.0 * libm::atan2(sine, end.w);
        let vector = if sine > 0.0 { end.imag() * (angle / sine) } else { Vec3::zeros() };
        let (sin, cos) = libm::sincos(angle);
        let (by_sin, by_cos) =
            if angle > 1e-3 { (sin / angle, (1.0 - cos) / (angle * angle)) } else { (1.0, 0.5) };
        let row = [vector.x, vector.y, vector.z, by_sin, by_cos];
        d[3..].iter_mut().zip(row).for_each(|(to, x)| *to = S::of(x));
    }
}

/// m/s² by which an acceleration may change between substeps and still be called steady.
pub(crate) fn steady_noise(gravity: &Vec3) -> f64 {
    STEADY_SHARE * gravity.norm()
}
