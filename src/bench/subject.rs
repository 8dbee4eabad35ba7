//! What is measured: a scene of the gallery, or a user's.

use sim::Scene;
use sim::gallery::{Exhibit, Judgement, Track};

/// A scene, how long it runs, and what it is judged by.
pub struct Subject {
    pub name: String,
    pub about: String,
    pub scene: Scene,
    pub duration_s: f64,
    pub dt_s: f64,
    exhibit: Option<&'static Exhibit>,
}

impl Subject {
    #[must_use]
    pub fn of(exhibit: &'static Exhibit) -> Self {
        Self {
            name: exhibit.name.to_owned(),
            about: exhibit.about.to_owned(),
            scene: (exhibit.scene)(),
            duration_s: exhibit.duration_s,
            dt_s: sim::Settings::default().dt_s,
            exhibit: Some(exhibit),
        }
    }

    /// A scene of no known truth.
    #[must_use]
    pub fn scene(name: String, scene: Scene, duration_s: f64, dt_s: f64) -> Self {
        Self { name, about: "a scene file".to_owned(), scene, duration_s, dt_s, exhibit: None }
    }

    #[must_use]
    pub fn judge(&self, track: &Track) -> Vec<Judgement> {
        self.exhibit.map(|exhibit| exhibit.judge(track)).unwrap_or_default()
    }

    /// How many steps of `dt_s` its time takes.
    #[must_use]
    pub fn steps(&self, dt_s: f64) -> usize {
        (self.duration_s / dt_s).round() as usize
    }
}
