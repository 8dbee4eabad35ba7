//! How fast, and how wrong at that speed: scenes with a known truth in Physique and in rapier, side by side.
//!
//! Every setup of an engine is judged in one run, by the one ruler of [`sim::measure`], and timed in others,
//! round by round in turn with all the rest, so that what the machine does besides falls on all alike.

mod budget;
mod clock;
pub mod dog;
mod engine;
mod laws;
mod machine;
mod overview;
mod page;
mod ratio;
#[cfg(feature = "validate")]
mod remote;
mod run;
mod running;
mod subject;
mod text;
mod tosses;
mod trial;

pub use budget::{Budget, length_m};
pub use clock::{CLOCK, cpu_time};
pub use engine::{Engine, Programs, Setup};
pub use laws::Laws;
pub use machine::Machine;
pub use overview::Overview;
pub use page::{Report, write_report};
pub use ratio::{Ratio, ratio};
pub use run::{Effort, Row, Sheet, run};
pub use running::{Running, Touch};
pub use subject::Subject;
pub use text::write_sheet;
pub use tosses::Tosses;
pub use trial::{Errors, Figure, HORIZON_S, judge, record, time};
