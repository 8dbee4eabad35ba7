//! Residuals of the contact laws, from what an engine says of its contacts and from its velocities after the step.
//!
//! After "Contact Models in Robotics: a Comparative Analysis" (Le Lidec et al., arXiv 2304.06372, section IV): no
//! trajectory has to be known for them. Weighted by impulse, so that a contact that carries nothing counts nothing.

use serde::Serialize;
use sim::measure::{cross, dot, length};
use sim::{Meeting, Pose, Scene, Velocity};

use super::running::Touch;

/// m/s: below this nothing is called sliding.
const SLIDING: f64 = 1e-3;

/// Means over a run; 0 where the law holds, absent where nothing can be said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Laws {
    /// Signorini: Σ |v_n| λ_n / Σ λ_n, m/s. What is pressed together neither parts nor closes.
    pub signorini_m_s: Option<f64>,
    /// Coulomb: Σ (|λ_t| - mu λ_n)⁺ / Σ mu λ_n. The impulse lies in the cone.
    pub coulomb: Option<f64>,
    /// Maximum dissipation: Σ (mu λ_n |v_t| + λ_t · v_t) / Σ mu λ_n |v_t| over what slides. Friction is full, and
    /// against the slip.
    pub dissipation: Option<f64>,
}

/// Sums up over the steps of a run.
#[derive(Default)]
pub(super) struct LawSums {
    normal: f64,
    parting: f64,
    limit: f64,
    outside: f64,
    slip: f64,
    missing: f64,
    frictions: bool,
}

impl LawSums {
    pub(super) fn add(&mut self, scene: &Scene, touches: &[Touch], poses: &[Pose], velocities: &[Velocity]) {
        for touch in touches.iter().filter(|touch| touch.normal_impulse > 0.0) {
            let at = |i: usize| {
                let arm = std::array::from_fn(|k| touch.position[k] - poses[i].position[k]);
                let turning = cross(velocities[i].angular, arm);
                let velocity: [f64; 3] = std::array::from_fn(|k| velocities[i].linear[k] + turning[k]);
                velocity
            };
            let (a, b) = (at(touch.a), at(touch.b));
            let relative: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
            let along = dot(relative, touch.normal);
            self.normal += touch.normal_impulse;
            self.parting += along.abs() * touch.normal_impulse;
            let Some(friction) = touch.friction_impulse else { continue };
            self.frictions = true;
            let slip: [f64; 3] = std::array::from_fn(|k| relative[k] - along * touch.normal[k]);
            let most = friction_of(scene, touch) * touch.normal_impulse;
            self.limit += most;
            self.outside += (length(friction) - most).max(0.0);
            if length(slip) > SLIDING {
                self.slip += most * length(slip);
                self.missing += (most * length(slip) + dot(friction, slip)).abs();
            }
        }
    }

    pub(super) fn laws(&self) -> Laws {
        let share = |value: f64, over: f64| (over > 0.0).then(|| value / over);
        Laws {
            signorini_m_s: share(self.parting, self.normal),
            coulomb: share(self.outside, self.limit).filter(|_| self.frictions),
            dissipation: share(self.missing, self.slip).filter(|_| self.frictions),
        }
    }
}

/// Of the entities' first shapes: the scenes of the gallery have one material a body where friction counts.
fn friction_of(scene: &Scene, touch: &Touch) -> f64 {
    let surface = |i: usize| scene.entities[i].shapes.first().map(|child| child.surface);
    match (surface(touch.a), surface(touch.b)) {
        (Some(a), Some(b)) => Meeting::of(&scene.pairs, &a, &b).friction,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use sim::gallery::build::{cube, floor, scene, surface};

    use super::*;

    fn sums(normal_speed: f64, slip: f64, friction: [f64; 3]) -> Laws {
        let s = surface(0.5, 0.0);
        let scene = scene("laws", vec![floor(s), cube([0.0, 0.5, 0.0], s)]);
        let poses: Vec<Pose> = scene.entities.iter().map(|entity| entity.pose).collect();
        let moving = Velocity { linear: [slip, normal_speed, 0.0], angular: [0.0; 3] };
        let touch = Touch {
            a: 0,
            b: 1,
            position: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
            normal_impulse: 10.0,
            friction_impulse: Some(friction),
        };
        let mut sums = LawSums::default();
        sums.add(&scene, &[touch], &poses, &[Velocity::default(), moving]);
        sums.laws()
    }

    #[test]
    fn each_law_has_its_own_residual() {
        let right = sums(0.0, 2.0, [-5.0, 0.0, 0.0]);
        assert_eq!(right, Laws { signorini_m_s: Some(0.0), coulomb: Some(0.0), dissipation: Some(0.0) });
        assert_eq!(sums(0.25, 0.0, [0.0; 3]).signorini_m_s, Some(0.25));
        let outside = sums(0.0, 0.0, [6.0, 0.0, 0.0]).coulomb.unwrap_or_default();
        assert!((outside - 0.2).abs() < 1e-12);
        let askew = sums(0.0, 2.0, [0.0, 0.0, 5.0]);
        assert_eq!(askew.dissipation, Some(1.0));
    }
}
