//! What the trace of a settling body does not tell: when it landed, whether it was thrown, and how it rolls.

use sim::{ContactPoint, Entity, Event, Frame, FrameSink, Pose, Scene, Settings, Velocity, measure};

use super::scenes::BODY;

/// A body rolls where its points of contact slip at less than this share of its own speed.
const SLIP_SHARE: f64 = 0.1;

/// Watches the one body of a trial.
pub(super) struct Watch {
    body: Option<Entity>,
    start_m: f64,
    pub(super) contact_s: Option<f64>,
    pub(super) rise_m: f64,
    pub(super) tunnelled: bool,
    pub(super) quarantined: bool,
    /// Level speed with which it rolls right now, without slipping; absent where it does not.
    pub(super) rolls_m_s: Option<f64>,
}

impl Watch {
    pub(super) fn new(scene: &Scene) -> Self {
        let body = scene.entities.get(BODY).cloned();
        let start_m = body.as_ref().map_or(0.0, |body| body.pose.position[1]);
        Self {
            body,
            start_m,
            contact_s: None,
            rise_m: f64::NEG_INFINITY,
            tunnelled: false,
            quarantined: false,
            rolls_m_s: None,
        }
    }
}

impl FrameSink for Watch {
    fn begin(&mut self, _: &Scene, _: &Settings) {}

    fn frame(&mut self, frame: &Frame<'_>) {
        let (Some(rigid), Some(body)) = (frame.rigid, &self.body) else { return };
        let Some(pose) = rigid.poses.get(BODY) else { return };
        let contacts = frame.contacts.map_or(&[][..], |contacts| contacts.points);
        self.rolls_m_s = rigid.velocities.get(BODY).and_then(|velocity| rolls_m_s(contacts, pose, velocity));
        let touches =
            !contacts.is_empty() || frame.events.iter().any(|event| matches!(event, Event::Impact { .. }));
        if touches && self.contact_s.is_none() {
            self.contact_s = Some(frame.time_s);
        }
        if self.contact_s.is_some() {
            self.rise_m = self.rise_m.max(pose.position[1] - self.start_m);
        }
        let top = measure::body_support(&body.shapes, pose, [0.0, 1.0, 0.0]);
        self.tunnelled |= top.is_some_and(|top| top < 0.0);
        self.quarantined |= frame.events.iter().any(|event| matches!(event, Event::Quarantined { .. }));
    }

    fn end(&mut self) {}
}

/// Level speed of a body that rolls in this moment; `None` where it is in the air or slips.
fn rolls_m_s(contacts: &[ContactPoint], pose: &Pose, velocity: &Velocity) -> Option<f64> {
    let [x, _, z] = velocity.linear;
    let speed = x.hypot(z);
    let slips = |contact: &ContactPoint| {
        let arm = std::array::from_fn(|axis| contact.position[axis] - pose.position[axis]);
        let turning = measure::cross(velocity.angular, arm);
        (x + turning[0]).hypot(z + turning[2]) > SLIP_SHARE * speed
    };
    (speed > 0.0 && !contacts.is_empty() && !contacts.iter().any(slips)).then_some(speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_as_it_goes_rolls_and_what_slides_does_not() {
        let contact = ContactPoint {
            a: 0,
            b: 1,
            position: [1.0, 0.0, 0.0],
            normal: [0.0, 1.0, 0.0],
            depth_m: 0.0,
            normal_impulse_n_s: 0.0,
            friction_impulse_n_s: [0.0; 3],
        };
        let pose = Pose::at([1.0, 0.5, 0.0]);
        let velocity = |turning: f64| Velocity { linear: [2.0, 0.0, 0.0], angular: [0.0, 0.0, turning] };
        assert_eq!(rolls_m_s(&[contact], &pose, &velocity(-4.0)), Some(2.0));
        assert_eq!(rolls_m_s(&[contact], &pose, &velocity(0.0)), None);
        assert_eq!(rolls_m_s(&[], &pose, &velocity(-4.0)), None);
    }
}
