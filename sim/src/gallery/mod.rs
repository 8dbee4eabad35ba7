//! Scenes with a known truth, by name, for tests, benchmarks, the demo and reports alike.

mod baseline;
pub mod build;

use crate::scene::Scene;

/// A scene of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Exhibit {
    /// `seed-` for the scenes of the 2013 paper.
    pub name: &'static str,
    /// One line: what it shows.
    pub about: &'static str,
    /// s
    pub duration_s: f64,
    /// Builds it.
    pub scene: fn() -> Scene,
}

/// All scenes, in the order of the reports.
#[must_use]
pub fn all() -> &'static [Exhibit] {
    baseline::EXHIBITS
}

/// The scene called `name`.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Exhibit> {
    all().iter().find(|exhibit| exhibit.name == name)
}
