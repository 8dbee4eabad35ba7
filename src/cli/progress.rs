//! How far the work is, on stderr: a bar where someone watches, else a line a stage.

use std::io::IsTerminal as _;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::time::Instant;

use importer::Outcome;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::args::Global;
use super::output;
use crate::report::plural;

/// Rate and time left of the stage under way.
pub(super) struct Bars {
    quiet: bool,
    verbose: bool,
    stage: Mutex<Option<Stage>>,
}

struct Stage {
    name: &'static str,
    bar: ProgressBar,
    begun: Instant,
}

impl Bars {
    #[must_use]
    pub(super) fn new(global: &Global) -> Self {
        Self { quiet: global.quiet, verbose: global.verbose > 0, stage: Mutex::new(None) }
    }

    fn start(&self, name: &'static str, models: usize) {
        self.finish();
        let target = if self.quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(10)
        };
        let bar = ProgressBar::with_draw_target(Some(models as u64), target).with_prefix(name);
        // The template is fixed text: it parses, or every run shows the plain bar.
        if let Ok(style) = ProgressStyle::with_template(
            "{prefix:>8} [{bar:30}] {pos}/{len} {per_sec:>12}, {eta} left {wide_msg}",
        ) {
            bar.set_style(style.progress_chars("=> "));
        }
        let stage = Stage { name, bar, begun: Instant::now() };
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = Some(stage);
    }

    /// Ends the stage under way.
    pub(super) fn finish(&self) {
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(Stage { name, bar, begun }) = stage else { return };
        // Finishing moves the bar to its end, wherever the work has stopped.
        let (done, of) = (bar.position(), bar.length().unwrap_or(0));
        bar.finish_and_clear();
        if !self.quiet {
            let models = plural(usize::try_from(of).unwrap_or(usize::MAX), "model");
            let done = if done == of { String::new() } else { format!("{done} of ") };
            output::notice(&format!("{name:>8}  {done}{models} in {:.1} s", begun.elapsed().as_secs_f64()));
        }
    }

    fn with_bar(&self, then: impl FnOnce(&ProgressBar)) {
        let bar =
            self.stage.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(|stage| stage.bar.clone());
        if let Some(bar) = bar {
            then(&bar);
        }
    }
}

impl importer::Progress for Bars {
    fn total(&self, models: usize) {
        self.start("import", models);
    }

    fn done(&self, model: &str, outcome: Outcome) {
        self.with_bar(|bar| {
            bar.inc(1);
            bar.set_message(model.to_owned());
        });
        if self.verbose {
            let word = match outcome {
                Outcome::Imported => "imported",
                Outcome::Cached => "unchanged",
                Outcome::Failed => "failed",
            };
            crate::pipeline::Progress::notice(self, &format!("{word:>10}  {model}"));
        }
    }
}

impl crate::pipeline::Progress for Bars {
    fn begin(&self, stage: &'static str, models: usize) {
        self.start(stage, models);
    }

    fn advance(&self) {
        self.with_bar(|bar| bar.inc(1));
    }

    fn notice(&self, text: &str) {
        if self.quiet {
            return;
        }
        let mut told = false;
        self.with_bar(|bar| {
            bar.suspend(|| output::notice(text));
            told = true;
        });
        if !told {
            output::notice(text);
        }
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        self.finish();
    }
}
