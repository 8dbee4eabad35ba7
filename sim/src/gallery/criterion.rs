//! What a scene of the gallery must show, as numbers.

use super::Exhibit;
use super::track::Track;

/// One figure of a scene: an error, 0 where nothing is wrong, that passes up to a limit.
#[derive(Clone, Copy, Debug)]
pub struct Criterion {
    pub figure: &'static str,
    /// SI; empty for a share.
    pub unit: &'static str,
    pub limit: f64,
    /// From poses and velocities alone. Not a number counts as failed.
    pub measure: fn(&Track) -> f64,
}

/// One figure of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    pub figure: &'static str,
    pub unit: &'static str,
    pub limit: f64,
    pub value: f64,
}

impl Judgement {
    #[must_use]
    pub fn passes(&self) -> bool {
        self.value <= self.limit
    }
}

impl Exhibit {
    /// Every figure of a run of this scene.
    #[must_use]
    pub fn judge(&self, track: &Track) -> Vec<Judgement> {
        let judge = |criterion: &Criterion| Judgement {
            figure: criterion.figure,
            unit: criterion.unit,
            limit: criterion.limit,
            value: (criterion.measure)(track),
        };
        self.criteria.iter().map(judge).collect()
    }
}
