//! The thread that turns blocks into columns and sends them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::thread::JoinHandle;

use rerun::{Points3D, RecordingStream, TextDocument, ViewCoordinates};

use crate::aggregate::Aggregate;
use crate::block::Block;
use crate::blueprint::{Layout, Panel};
use crate::error::ViewerError;
use crate::grid::{Cell, Grid};
use crate::mesh::Mesh;
use crate::output::{Opened, Written};
use crate::palette;
use crate::path;
use crate::queue::Queue;
use crate::scenery::Script;
use crate::track::{Stage, Track};
use crate::visual::VisualMesh;

/// What the stepping threads ask for. Tracks are numbered by whoever opens them.
pub(crate) enum Message {
    Begin { track: usize, stage: Stage, script: Box<Script> },
    Block { track: usize, block: Block },
    End { track: usize },
    Still { track: usize, cell: Cell, meshes: Vec<VisualMesh> },
    Text { entity: Vec<String>, markdown: String },
}

/// What the recording as a whole is.
pub(crate) enum Show {
    Scene { title: String },
    Gallery { title: String, grid: Grid, slots: Vec<Cell> },
}

/// The worker's end of the queue, closed also when the worker ends by a fault, so that no run waits for it.
struct Guard(Arc<Queue<Message>>);

impl Drop for Guard {
    fn drop(&mut self) {
        self.0.close();
    }
}

/// What a worker leaves: the sum, and a live viewer's fault if there was one.
type Outcome = Result<(Written, Option<String>), ViewerError>;

/// A running worker.
pub(crate) struct Worker {
    pub(crate) queue: Arc<Queue<Message>>,
    thread: Option<JoinHandle<Outcome>>,
}

impl Worker {
    pub(crate) fn start(opened: Opened, show: Show) -> Self {
        let queue = Arc::new(Queue::new());
        let guard = Guard(Arc::clone(&queue));
        let spawned = std::thread::Builder::new().name("physique-viewer".to_owned()).spawn(move || {
            let mut writer = Writer::new(opened, show);
            let mut first = writer.begin();
            // After a fault the queue closes, and what is left in it is dropped.
            while first.is_ok() {
                let Some(message) = guard.0.pop() else { break };
                first = writer.take(message, &guard.0);
            }
            drop(guard);
            let last = writer.end();
            let closed = writer.opened.close(writer.frames);
            first.and(last).and(closed)
        });
        // Without a thread the queue is closed by the guard that the failed closure dropped.
        Self { queue, thread: spawned.ok() }
    }

    /// Waits for all that was pushed to be written.
    pub(crate) fn finish(&mut self) -> Outcome {
        self.queue.close();
        let thread = self.thread.take().ok_or(ViewerError::Worker)?;
        thread.join().map_err(|_| ViewerError::Worker)?
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if self.thread.is_some() {
            // Nobody asked for the outcome.
            let _ = self.finish();
        }
    }
}

struct Writer {
    opened: Opened,
    show: Show,
    tracks: BTreeMap<usize, Track>,
    aggregate: Aggregate,
    /// Slots of a gallery that something stands in.
    taken: BTreeSet<usize>,
    frames: u64,
}

impl Writer {
    fn new(opened: Opened, show: Show) -> Self {
        let (tracks, taken) = (BTreeMap::new(), BTreeSet::new());
        Self { opened, show, tracks, aggregate: Aggregate::default(), taken, frames: 0 }
    }

    fn stream(&self) -> &RecordingStream {
        &self.opened.stream
    }

    fn begin(&mut self) -> Result<(), ViewerError> {
        let stream = self.stream();
        stream.log_static("world", &ViewCoordinates::RIGHT_HAND_Y_UP()).map_err(ViewerError::encode)?;
        let Show::Gallery { title, grid, .. } = &self.show else { return Ok(()) };
        let mut layout = Layout::new(title, grid.bounds(), self.opened.live);
        layout.from = [0.0, 1.25, 1.0];
        layout.plots = vec![
            Panel::new("Moving models", "/metrics/moving"),
            Panel::new("Penetration", "/metrics/penetration"),
        ];
        layout.texts = vec![Panel::new("Summary", "/info/summary")];
        layout.hidden = vec!["world/colliders".to_owned(), "world/contacts".to_owned()];
        layout.send(stream)?;
        let points = Points3D::new(grid.labels().map(|(place, _)| place))
            .with_labels(grid.labels().map(|(_, text)| text))
            .with_show_labels(true)
            .with_colors([palette::color(palette::LABEL)])
            .with_radii([rerun::Radius::new_ui_points(0.1)]);
        stream.log_static("world/labels", &points).map_err(ViewerError::encode)?;
        self.aggregate = Aggregate::begin(stream)?;
        Ok(())
    }

    fn take(&mut self, message: Message, queue: &Queue<Message>) -> Result<(), ViewerError> {
        match message {
            Message::Begin { track, stage, script } => {
                self.taken.insert(track);
                let made = Track::begin(self.stream(), stage, &script)?;
                if let Show::Scene { title } = &self.show {
                    scene_layout(title, &made, self.opened.live).send(self.stream())?;
                }
                self.tracks.insert(track, made);
            }
            Message::Block { track, block } => {
                self.frames += block.rows.len() as u64;
                if let Some(track) = self.tracks.get_mut(&track) {
                    track.block(&self.opened.stream, &block)?;
                }
                if matches!(self.show, Show::Gallery { .. }) {
                    self.aggregate.block(track, &block);
                }
                queue.give_back(block);
            }
            Message::End { track } => {
                self.tracks.remove(&track);
            }
            Message::Still { track, cell, meshes } => {
                self.taken.insert(track);
                self.still(&cell, &meshes)?;
            }
            Message::Text { entity, markdown } => {
                let names: Vec<&str> = entity.iter().map(String::as_str).collect();
                let text = TextDocument::from_markdown(markdown);
                let sent = self.stream().log_static(path::join("info", &names), &text);
                sent.map_err(ViewerError::encode)?;
            }
        }
        Ok(())
    }

    fn still(&self, cell: &Cell, meshes: &[VisualMesh]) -> Result<(), ViewerError> {
        cell.still_pad(self.stream(), palette::STILL_PAD)?;
        let mesh = Mesh::of(meshes);
        let bounds = mesh.bounds();
        if bounds.is_empty() {
            return Ok(());
        }
        let placement = cell.place(&bounds, bounds.min[1]);
        let at = path::join("world/models", &[&cell.category, &cell.name]);
        let place = rerun::Transform3D::update_fields()
            .with_translation(placement.offset)
            .with_scale(placement.scale);
        self.stream().log_static(at.clone(), &place).map_err(ViewerError::encode)?;
        self.stream().log_static(at, &mesh.archetype()).map_err(ViewerError::encode)
    }

    fn end(&mut self) -> Result<(), ViewerError> {
        let Show::Gallery { slots, .. } = &self.show else { return Ok(()) };
        for (slot, cell) in slots.iter().enumerate() {
            if !self.taken.contains(&slot) {
                cell.still_pad(self.stream(), palette::EMPTY_PAD)?;
            }
        }
        self.aggregate.end(self.stream())
    }
}

fn scene_layout(title: &str, track: &Track, live: bool) -> Layout {
    let mut layout = Layout::new(title, track.bounds, live);
    layout.floor = track.floor;
    layout.plots =
        vec![Panel::new("Energy", "/metrics/energy"), Panel::new("Penetration", "/metrics/penetration")];
    layout.texts = vec![Panel::new("Attributes", "/info/scene"), Panel::new("Plan", "/info/plan")];
    layout.log = Some(Panel::new("Events", "/events"));
    layout.hidden = vec!["world/colliders".to_owned()];
    layout
}
