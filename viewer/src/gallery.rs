//! Many models, each in a scene of its own, on one grid and one timeline.

use std::sync::Arc;

use sim::{Frame, FrameSink, Scene, Settings};

use crate::error::ViewerError;
use crate::grid::{Cell, Grid};
use crate::output::{Output, Written};
use crate::queue::Queue;
use crate::recorder::{Cadence, Recorder};
use crate::track::Stage;
use crate::visual::{Visual, VisualMesh};
use crate::worker::{Message, Show, Worker};

/// Thinned: most models rest within seconds, and there may be hundreds. A model's frames are sent in one block at its
/// end, since a viewer loads few large chunks faster than many small ones.
const CADENCE: Cadence = Cadence { rate_hz: 30.0, wait: None };

/// A place in the gallery.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot {
    pub category: String,
    pub name: String,
}

/// A recording of many models. Each is scaled to its cell; the pad under it shows its state.
pub struct Gallery {
    worker: Worker,
    cells: Vec<Cell>,
    notices: Vec<String>,
}

impl Gallery {
    /// Lays out the grid in the order of `slots`; neighbours of one category share a label.
    ///
    /// # Errors
    /// As [`crate::Recording::open`].
    pub fn open(
        output: Output,
        title: impl Into<String>,
        info_markdown: impl Into<String>,
        slots: Vec<Slot>,
    ) -> Result<Self, ViewerError> {
        let title = title.into();
        let mut opened = output.open(&title)?;
        let notices = std::mem::take(&mut opened.notices);
        let categories: Vec<&str> = slots.iter().map(|slot| slot.category.as_str()).collect();
        let grid = Grid::of(&categories);
        let cell = |(index, slot): (usize, &Slot)| Cell::new(&slot.category, &slot.name, grid.center(index));
        let cells: Vec<Cell> = slots.iter().enumerate().map(cell).collect();
        let worker = Worker::start(opened, Show::Gallery { title, grid, slots: cells.clone() });
        let gallery = Self { worker, cells, notices };
        gallery.set_summary(info_markdown);
        Ok(gallery)
    }

    /// What the user should know: no viewer to open, or one of another version.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// The text shown first; the last one given stays.
    pub fn set_summary(&self, markdown: impl Into<String>) {
        self.text(vec!["summary".to_owned()], markdown.into());
    }

    fn text(&self, entity: Vec<String>, markdown: String) {
        let bytes = markdown.len();
        self.worker.queue.push(Message::Text { entity, markdown }, bytes);
    }

    fn info(&self, slot: usize, markdown: String) {
        if let Some(cell) = self.cells.get(slot) {
            self.text(vec!["models".to_owned(), cell.category.clone(), cell.name.clone()], markdown);
        }
    }

    /// A sink for the scene of the model in `slot`, for any thread. A slot that does not exist takes frames and
    /// shows nothing.
    #[must_use]
    pub fn sink(&self, slot: usize, visuals: Vec<Visual>, info_markdown: impl Into<String>) -> GallerySink {
        self.info(slot, info_markdown.into());
        let queue: Arc<Queue<Message>> = Arc::clone(&self.worker.queue);
        let recorder = self
            .cells
            .get(slot)
            .map(|cell| Recorder::new(queue, slot, Stage::Cell(cell.clone()), CADENCE, visuals, Vec::new()));
        GallerySink { recorder }
    }

    /// A model that is not simulated stands where it is put, on a blue pad. Meshes in metres, Y up, any origin.
    pub fn still(&self, slot: usize, meshes: Vec<VisualMesh>, info_markdown: impl Into<String>) {
        self.info(slot, info_markdown.into());
        if let Some(cell) = self.cells.get(slot).cloned() {
            let bytes = meshes.iter().map(|mesh| 12 * (mesh.positions.len() + mesh.triangles.len())).sum();
            self.worker.queue.push(Message::Still { track: slot, cell, meshes }, bytes);
        }
    }

    /// Waits until all is written.
    ///
    /// # Errors
    /// What went wrong in writing since the gallery was opened.
    pub fn finish(mut self) -> Result<Written, ViewerError> {
        self.worker.finish().map(|(written, _)| written)
    }
}

/// Takes the frames of one model of a gallery.
pub struct GallerySink {
    recorder: Option<Recorder>,
}

impl FrameSink for GallerySink {
    fn begin(&mut self, scene: &Scene, settings: &Settings) {
        if let Some(recorder) = &mut self.recorder {
            recorder.begin(scene, settings);
        }
    }

    fn frame(&mut self, frame: &Frame<'_>) {
        if let Some(recorder) = &mut self.recorder {
            recorder.frame(frame);
        }
    }

    fn end(&mut self) {
        if let Some(recorder) = &mut self.recorder {
            recorder.end();
        }
    }
}
