//! One scene, one recording.

use std::time::Duration;

use sim::{Frame, FrameSink, Scene, Settings};

use crate::error::ViewerError;
use crate::output::{Output, Written};
use crate::recorder::{Cadence, Recorder};
use crate::track::Stage;
use crate::visual::{ColliderMesh, Visual};
use crate::worker::{Message, Show, Worker};

/// What to record of a scene, and where to.
#[derive(Clone, Debug)]
pub struct Recording {
    pub output: Output,
    pub title: String,
    /// Entities without one are drawn by their shapes.
    pub visuals: Vec<Visual>,
    /// Drawn as the overlay in place of the shapes.
    pub colliders: Vec<ColliderMesh>,
    /// Shown beside the scene: attributes and where they come from.
    pub info_markdown: String,
    /// Kept frames a second of simulated time.
    pub rate_hz: f64,
}

impl Recording {
    /// At 60 frames a second, colliders drawn from the shapes.
    pub fn new(
        output: Output,
        title: impl Into<String>,
        visuals: Vec<Visual>,
        info_markdown: impl Into<String>,
    ) -> Self {
        let (title, info_markdown) = (title.into(), info_markdown.into());
        Self { output, title, visuals, colliders: Vec::new(), info_markdown, rate_hz: 60.0 }
    }

    /// Opens the output and starts the thread that writes to it.
    ///
    /// # Errors
    /// Where a file cannot be written or is being written by another run, where nobody answers at an address, where
    /// a viewer is the only output and cannot be opened, or where there is no output at all.
    pub fn open(self) -> Result<RerunSink, ViewerError> {
        let mut opened = self.output.open(&self.title)?;
        let notices = std::mem::take(&mut opened.notices);
        let worker = Worker::start(opened, Show::Scene { title: self.title });
        let bytes = self.info_markdown.len();
        let info = Message::Text { entity: vec!["scene".to_owned()], markdown: self.info_markdown };
        worker.queue.push(info, bytes);
        let cadence = Cadence { rate_hz: self.rate_hz, wait: Some(Duration::from_millis(100)) };
        let queue = worker.queue.clone();
        let recorder = Recorder::new(queue, 0, Stage::Alone, cadence, self.visuals, self.colliders);
        Ok(RerunSink { recorder, worker, notices, outcome: None })
    }
}

/// Takes the frames of one scene. Dropped before its end it still writes all it was given, and the file's footer.
pub struct RerunSink {
    recorder: Recorder,
    worker: Worker,
    notices: Vec<String>,
    outcome: Option<Result<Written, ViewerError>>,
}

impl RerunSink {
    /// What the user should know: no viewer to open, or one of another version.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// Waits until all is written.
    ///
    /// # Errors
    /// What went wrong in writing since the recording was opened.
    pub fn finish(mut self) -> Result<Written, ViewerError> {
        self.end();
        self.outcome.unwrap_or(Err(ViewerError::Worker))
    }
}

impl FrameSink for RerunSink {
    fn begin(&mut self, scene: &Scene, settings: &Settings) {
        self.recorder.begin(scene, settings);
    }

    fn frame(&mut self, frame: &Frame<'_>) {
        self.recorder.frame(frame);
    }

    /// Writes the rest and the file's footer.
    fn end(&mut self) {
        self.recorder.end();
        if self.outcome.is_none() {
            let outcome = self.worker.finish();
            self.outcome = Some(outcome.map(|(written, fault)| {
                self.notices.extend(fault.map(|fault| format!("the live viewer did not get all: {fault}")));
                written
            }));
        }
    }
}
