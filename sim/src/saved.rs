//! The state of a world between two steps, to go back to.

use crate::body::Body;
use crate::collide::broad::BroadPhase;
use crate::collide::pair::Pair;
use crate::output::Output;
use crate::solve::rolling::RollingConstraint;
use crate::world::World;

/// Everything of a [`World`] that a step changes and the next one reads. What a solver keeps beside it is storage.
#[derive(Clone)]
pub struct SavedState {
    bodies: Vec<Body>,
    pairs: Vec<Pair>,
    broad: BroadPhase,
    rolling: Vec<RollingConstraint>,
    next_action: usize,
    step: u64,
    output: Output,
}

impl World {
    /// The state as it is now.
    #[must_use]
    pub fn save(&self) -> SavedState {
        SavedState {
            bodies: self.bodies.clone(),
            pairs: self.pairs.clone(),
            broad: self.broad.clone(),
            rolling: self.rolling.clone(),
            next_action: self.next_action,
            step: self.step,
            output: self.output.clone(),
        }
    }

    /// Goes back to `state`, from which this world or another of the same scene, settings and plan continues with the
    /// same bits as the one that was saved.
    pub fn restore(&mut self, state: &SavedState) {
        self.bodies.clone_from(&state.bodies);
        self.pairs.clone_from(&state.pairs);
        self.broad.clone_from(&state.broad);
        self.rolling.clone_from(&state.rolling);
        self.next_action = state.next_action;
        self.step = state.step;
        self.output = state.output.clone();
    }
}
