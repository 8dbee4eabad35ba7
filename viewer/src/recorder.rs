//! The stepping thread's side of a recording: copy, hand over, return.

use std::sync::Arc;
use std::time::{Duration, Instant};

use sim::{Frame, Plan, Scene, Settings};

use crate::block::Block;
use crate::queue::Queue;
use crate::scenery::Script;
use crate::track::Stage;
use crate::visual::{ColliderMesh, Visual};
use crate::worker::Message;

/// How many frames are kept, and how long they are gathered: a run that is faster than the eye sends few large
/// blocks, a slow one shows each frame soon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cadence {
    /// Kept frames a second of simulated time.
    pub(crate) rate_hz: f64,
    /// Of real time, and [`WAIT_A_BODY`] more a body; `None`: until the end.
    pub(crate) wait: Option<Duration>,
}

/// A body's columns cost some two kilobytes however few rows they have.
const WAIT_A_BODY: Duration = Duration::from_millis(2);

/// A block is handed over at this size whatever the time.
const MAX_BLOCK_BYTES: usize = 4 << 20;

/// So many rows without contacts that the next one's are kept however many they are.
const KEEP_CONTACTS: usize = usize::MAX / 2;

/// One scene's way into the queue.
pub(crate) struct Recorder {
    queue: Arc<Queue<Message>>,
    track: usize,
    stage: Option<Stage>,
    visuals: Vec<Visual>,
    colliders: Vec<ColliderMesh>,
    cadence: Cadence,
    stride: u64,
    block: Block,
    /// The newest frame where it is not one of the kept: a run's last must not be lost.
    tail: Block,
    handed: Instant,
    open: bool,
}

impl Recorder {
    pub(crate) fn new(
        queue: Arc<Queue<Message>>,
        track: usize,
        stage: Stage,
        cadence: Cadence,
        visuals: Vec<Visual>,
        colliders: Vec<ColliderMesh>,
    ) -> Self {
        let (block, tail, handed) = (Block::default(), Block::default(), Instant::now());
        let stage = Some(stage);
        Self { queue, track, stage, visuals, colliders, cadence, stride: 1, block, tail, handed, open: false }
    }

    /// A second call changes nothing.
    pub(crate) fn begin(&mut self, scene: &Scene, settings: &Settings) {
        let Some(stage) = self.stage.take() else { return };
        let entity = match &stage {
            Stage::Alone => vec!["plan".to_owned()],
            Stage::Cell(cell) => ["models", &cell.category, &cell.name, "plan"].map(str::to_owned).to_vec(),
        };
        let plan = format!("```text\n{}```\n", Plan::of(scene));
        let bytes = plan.len();
        self.queue.push(Message::Text { entity, markdown: plan }, bytes);
        let (visuals, colliders) = (std::mem::take(&mut self.visuals), std::mem::take(&mut self.colliders));
        let script = Box::new(Script::new(scene, settings.dt_s, visuals, colliders));
        self.stride = stride(settings.dt_s, self.cadence.rate_hz);
        self.queue.push(Message::Begin { track: self.track, stage, script }, 0);
        self.block = self.queue.block();
        self.block.bodies = scene.entities.len();
        let bodies = u32::try_from(scene.entities.len()).unwrap_or(u32::MAX).min(300);
        self.cadence.wait = self.cadence.wait.map(|wait| wait + WAIT_A_BODY * bodies);
        self.handed = Instant::now();
        self.open = true;
    }

    pub(crate) fn frame(&mut self, frame: &Frame<'_>) {
        if !self.open {
            return;
        }
        if !frame.events.is_empty() {
            self.block.push_events(frame);
        }
        self.tail.clear();
        if !frame.step.is_multiple_of(self.stride) {
            self.tail.bodies = self.block.bodies;
            self.tail.rows_without_contacts = KEEP_CONTACTS;
            self.tail.push(frame);
            return;
        }
        self.block.push(frame);
        let full = self.block.bytes() >= MAX_BLOCK_BYTES;
        if full || self.cadence.wait.is_some_and(|wait| self.handed.elapsed() >= wait) {
            self.hand_over();
        }
    }

    fn hand_over(&mut self) {
        self.handed = Instant::now();
        if self.block.is_empty() {
            return;
        }
        let mut next = self.queue.block();
        next.bodies = self.block.bodies;
        next.rows_without_contacts = self.block.rows_without_contacts;
        let block = std::mem::replace(&mut self.block, next);
        let bytes = block.bytes();
        self.queue.push(Message::Block { track: self.track, block }, bytes);
    }

    /// A second call changes nothing.
    pub(crate) fn end(&mut self) {
        if std::mem::take(&mut self.open) {
            self.hand_over();
            self.block = std::mem::take(&mut self.tail);
            self.hand_over();
            self.queue.push(Message::End { track: self.track }, 0);
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.end();
    }
}

/// Steps from one kept frame to the next.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn stride(dt_s: f64, rate_hz: f64) -> u64 {
    let steps = 1.0 / (dt_s * rate_hz);
    if steps.is_finite() { steps.round().clamp(1.0, 1e9) as u64 } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stride_holds_the_rate() {
        assert_eq!(stride(1.0 / 60.0, 60.0), 1);
        assert_eq!(stride(1.0 / 60.0, 30.0), 2);
        assert_eq!(stride(1.0 / 1000.0, 60.0), 17);
        assert_eq!(stride(0.05, 60.0), 1);
        assert_eq!(stride(0.0, 60.0), 1);
    }
}
