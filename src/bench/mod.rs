//! How fast, and how wrong at that speed: scenes with a known truth in Physique and in rapier, side by side.
//!
//! Every setup of an engine is judged in one run, by the one ruler of [`sim::measure`], and timed in others,
//! round by round in turn with all the rest, so that what the machine does besides falls on all alike.

mod clock;
mod engine;
mod ratio;
mod run;
mod subject;
mod text;
mod trial;

pub use clock::{CLOCK, cpu_time};
pub use engine::{Engine, Running, Setup};
pub use ratio::{Ratio, ratio};
pub use run::{Row, Sheet, run};
pub use subject::Subject;
pub use text::write_sheet;
pub use trial::{Errors, Figure, judge, record, time};
