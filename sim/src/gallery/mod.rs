//! Scenes with a known truth, by name, and the figures they are judged by: for tests, benchmarks, the demo and
//! reports alike, of any engine.

mod baseline;
pub mod build;
mod criterion;
mod exact;
mod family;
mod figure;
mod hard;
mod simbench;
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
    /// Scenes on which engines are known to fail.
    Hard,
    /// Many bodies in heaps, in the manner of Box3D's benchmarks.
    Pile,
    /// SimBenchmark's scenes.
    SimBench,
}

impl Group {
    const fn exhibit(
        self,
        name: &'static str,
        about: &'static str,
        duration_s: f64,
        scene: fn() -> Scene,
        criteria: &'static [Criterion],
    ) -> Exhibit {
        Exhibit { name, about, group: self, duration_s, scene, criteria }
    }

    /// A heading for a report.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Baseline => "The paper's scenes and the engines'",
            Self::Exact => "Motions with a closed form",
            Self::Hard => "The hard set",
            Self::Pile => "Piles",
            Self::SimBench => "SimBenchmark's scenes",
        }
    }
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

impl Exhibit {
    /// How many steps of `dt_s` its time takes.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of steps")]
    pub fn steps(&self, dt_s: f64) -> usize {
        (self.duration_s / dt_s).round() as usize
    }
}

/// All scenes, in the order of the reports.
pub fn all() -> impl Iterator<Item = &'static Exhibit> {
    let piles = [family::EXHIBITS, simbench::EXHIBITS];
    [baseline::EXHIBITS].into_iter().chain(exact::EXHIBITS).chain(hard::EXHIBITS).chain(piles).flatten()
}

/// The scene called `name`.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Exhibit> {
    all().find(|exhibit| exhibit.name == name)
}
