//! The phases of a step, for whoever wants to time them: the simulation itself knows no clock.

/// What a step is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Phase {
    /// Timed actions of the scene.
    Actions,
    /// Which bodies are near each other.
    BroadPhase,
    /// Where their surfaces are near each other.
    NarrowPhase,
    /// Contact constraints from manifolds.
    Prepare,
    /// Rolling resistance is looked for; it is solved with the contacts.
    Rolling,
    /// Impacts at their time.
    Impacts,
    /// Gravity, soft contacts with friction and motion of what is near something.
    Contacts,
    /// Motion of what nothing can touch, the whole step at once.
    Flight,
    /// Bodies without a finite state, islands, sleep.
    Sleep,
}

impl Phase {
    /// In the order in which a step first enters them.
    pub const ALL: [Self; 9] = [
        Self::Actions,
        Self::BroadPhase,
        Self::NarrowPhase,
        Self::Prepare,
        Self::Rolling,
        Self::Impacts,
        Self::Contacts,
        Self::Flight,
        Self::Sleep,
    ];

    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Actions => "actions",
            Self::BroadPhase => "broad phase",
            Self::NarrowPhase => "narrow phase",
            Self::Prepare => "prepare",
            Self::Impacts => "impacts",
            Self::Contacts => "contacts",
            Self::Rolling => "rolling",
            Self::Flight => "flight",
            Self::Sleep => "sleep",
        }
    }
}

/// Sees a step from outside.
pub trait Observer {
    /// A step is about to begin.
    fn begins(&mut self) {}
    /// The step enters a phase and leaves the one before. Called many times a step.
    fn enters(&mut self, _phase: Phase) {}
    /// It is done; sinks come after this. Return `false` to end the run early.
    fn ended(&mut self, _report: &crate::StepReport) -> bool {
        true
    }
}

impl Observer for () {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phase_stands_in_the_list_at_its_own_place() {
        for (i, phase) in Phase::ALL.into_iter().enumerate() {
            assert_eq!(phase as usize, i, "{}", phase.name());
        }
    }
}
