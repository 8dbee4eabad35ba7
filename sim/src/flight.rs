//! Flight: motion of a body that nothing can touch within the step, in closed form and all at once.
//!
//! The parabola is evaluated from the state at launch, `x = x₀ + v₀ τ + g τ² / 2`, not added up step by step: a
//! body a thousand steps in the air is where the formula says, to the last bits. Rotation is
//! [`crate::rotation`]'s.

use crate::math::Vec3;

/// The state at which a flight began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Launch {
    position: Vec3,
    velocity: Vec3,
    /// Whole steps since.
    steps: u64,
    /// Where it was left after them: a state that differs was changed from outside, and the flight begins anew.
    left: [Vec3; 2],
}

impl Launch {
    /// Position (m) and velocity (m/s) one step of `dt` seconds later under gravity `g` (m/s²), and the launch to go
    /// on from.
    pub(crate) fn fly(launch: Option<Self>, position: &Vec3, velocity: &Vec3, g: &Vec3, dt: f64) -> Self {
        let mut launch = launch.filter(|launch| launch.left == [*position, *velocity]).unwrap_or(Self {
            position: *position,
            velocity: *velocity,
            steps: 0,
            left: [*position, *velocity],
        });
        launch.steps += 1;
        #[expect(clippy::cast_precision_loss, reason = "2^53 steps are three million years")]
        let time = launch.steps as f64 * dt;
        launch.left =
            [launch.position + (launch.velocity + g * (0.5 * time)) * time, launch.velocity + g * time];
        launch
    }

    /// Position, m, and velocity, m/s, after the steps flown.
    pub(crate) fn state(&self) -> [Vec3; 2] {
        self.left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_flight_meets_the_parabola_to_the_last_bits() {
        let (x0, v0, g) =
            (Vec3::new(0.1, 5.0, -3.0), Vec3::new(20.0, 300.0, 0.7), Vec3::new(0.0, -9.81, 0.0));
        let (mut launch, mut state) = (None, [x0, v0]);
        let dt = 1.0 / 60.0;
        for _ in 0..6000 {
            let next = Launch::fly(launch, &state[0], &state[1], &g, dt);
            (launch, state) = (Some(next), next.state());
        }
        let t = 6000.0 * dt;
        let expected = x0 + v0 * t + g * (0.5 * t * t);
        assert!(
            (state[0] - expected).norm() < 1e-14 * expected.norm(),
            "{:?}, expected {expected:?}",
            state[0]
        );
    }

    #[test]
    fn a_changed_state_launches_anew() {
        let g = Vec3::new(0.0, -10.0, 0.0);
        let first = Launch::fly(None, &Vec3::zeros(), &Vec3::x(), &g, 0.1);
        let [x, _] = first.state();
        let pushed = Launch::fly(Some(first), &x, &Vec3::zeros(), &g, 0.1);
        assert_eq!(pushed.state()[0], x + g * (0.5 * 0.1 * 0.1));
    }
}
