//! Scenes with a known truth, by name, and the figures they are judged by: for tests, benchmarks, the demo and
//! reports alike, of any engine.

mod baseline;
pub mod build;
mod criterion;
mod exact;
mod figure;
mod track;

pub use criterion::{Criterion, Judgement};
pub use track::{Moment, Track};

use crate::scene::Scene;

/// What a scene of the gallery is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The scenes of the 2013 paper and of the comparison of engines.
    Baseline,
    /// Motions with a closed form.
    Exact,
}

/// A scene of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Exhibit {
    /// `seed-` for the scenes of the 2013 paper.
    pub name: &'static str,
    /// One line: what it shows.
    pub about: &'static str,
    pub group: Group,
    /// s
    pub duration_s: f64,
    /// Builds it.
    pub scene: fn() -> Scene,
    /// The first is the scene's error in plots of speed against error.
    pub criteria: &'static [Criterion],
}

/// All scenes, in the order of the reports.
pub fn all() -> impl Iterator<Item = &'static Exhibit> {
    [baseline::EXHIBITS, exact::EXHIBITS].into_iter().flatten()
}

/// The scene called `name`.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Exhibit> {
    all().find(|exhibit| exhibit.name == name)
}
