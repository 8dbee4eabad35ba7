//! What is measured: a scene of the gallery, a user's, or real tosses.

use sim::Scene;
use sim::gallery::{Exhibit, Group, Judgement, Track};

use super::tosses::Tosses;

/// A scene, how long it runs, and what it is judged by.
pub struct Subject {
    pub name: String,
    pub about: String,
    /// Where it stands in the report.
    pub group: &'static str,
    pub scene: Scene,
    pub duration_s: f64,
    pub dt_s: f64,
    truth: Truth,
}

enum Truth {
    Unknown,
    Exhibit(&'static Exhibit),
    Tosses(Tosses),
}

impl Subject {
    #[must_use]
    pub fn of(exhibit: &'static Exhibit) -> Self {
        Self {
            name: exhibit.name.to_owned(),
            about: exhibit.about.to_owned(),
            group: exhibit.group.title(),
            scene: (exhibit.scene)(),
            duration_s: exhibit.duration_s,
            dt_s: sim::Settings::default().dt_s,
            truth: Truth::Exhibit(exhibit),
        }
    }

    /// A scene of no known truth.
    #[must_use]
    pub fn scene(name: String, about: String, scene: Scene, duration_s: f64, dt_s: f64) -> Self {
        Self { name, about, group: "Scenes of the user's", scene, duration_s, dt_s, truth: Truth::Unknown }
    }

    /// A scene of the project's that needs files.
    #[must_use]
    pub fn in_group(name: &str, about: String, group: &'static str, scene: Scene, duration_s: f64) -> Self {
        let dt_s = sim::Settings::default().dt_s;
        Self { group, ..Self::scene(name.to_owned(), about, scene, duration_s, dt_s) }
    }

    #[must_use]
    pub fn tosses(tosses: Tosses) -> Self {
        Self {
            name: "cube-tosses".to_owned(),
            about: tosses.about(),
            group: "Real measurements",
            scene: tosses.scene(),
            duration_s: tosses.duration_s(),
            dt_s: tosses.dt_s(),
            truth: Truth::Tosses(tosses),
        }
    }

    #[must_use]
    pub fn judge(&self, track: &Track) -> Vec<Judgement> {
        match &self.truth {
            Truth::Unknown => Vec::new(),
            Truth::Exhibit(exhibit) => exhibit.judge(track),
            Truth::Tosses(tosses) => tosses.judge(track),
        }
    }

    /// How many steps of `dt_s` its time takes.
    #[must_use]
    pub fn steps(&self, dt_s: f64) -> usize {
        (self.duration_s / dt_s).round() as usize
    }

    /// How many bodies move.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.scene.entities.iter().filter(|entity| sim::measure::mass_of(entity).is_some()).count()
    }

    /// Whether a motion has a closed form, so that the engine's own limit says nothing more.
    #[must_use]
    pub fn has_closed_form(&self) -> bool {
        matches!(self.truth, Truth::Exhibit(exhibit) if exhibit.group == Group::Exact)
    }
}
