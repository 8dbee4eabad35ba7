//! All scenes in a few numbers.

use std::fmt;

use serde::Serialize;

use super::engine::Engine;
use super::run::{Row, Sheet};

/// What the engines as they come have shown on all scenes together.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Overview {
    /// Scenes with something to reach.
    pub scenes: usize,
    /// Scenes on which every figure is reached.
    pub physique_right: usize,
    pub rapier_right: usize,
    /// Geometric mean over the scenes of the time over rapier's, in whichever of its builds is faster on each.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_rapier: Option<f64>,
    /// The same where rapier was as right in some setup that was tried, over the fastest such; on how many scenes it
    /// was, of those whose errors were compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_equal_error: Option<f64>,
    pub equalled: usize,
    pub compared: usize,
}

impl Overview {
    #[must_use]
    pub fn of(sheets: &[Sheet]) -> Self {
        let right = |of: fn(&Sheet) -> Option<&Row>| {
            sheets.iter().filter(|sheet| of(sheet).and_then(Row::passes) == Some(true)).count()
        };
        let ours: fn(&Sheet) -> Option<&Row> = |sheet| sheet.default_of(Engine::Physique);
        let ratios = sheets.iter().filter_map(|sheet| Some(ours(sheet)?.over_rapier?.mean));
        let equal: Vec<f64> =
            sheets.iter().filter_map(|sheet| sheet.at_equal_error().map(|(_, ratio)| ratio)).collect();
        let comparable =
            |sheet: &&Sheet| ours(sheet).is_some_and(|row| row.error().is_some()) && sheet.rapier().is_some();
        Self {
            scenes: sheets
                .iter()
                .filter(|sheet| ours(sheet).is_some_and(|row| row.passes().is_some()))
                .count(),
            physique_right: right(ours),
            rapier_right: right(Sheet::rapier),
            over_rapier: geometric_mean(ratios),
            equalled: equal.len(),
            at_equal_error: geometric_mean(equal.into_iter()),
            compared: sheets.iter().filter(comparable).count(),
        }
    }
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values
        .filter(|value| *value > 0.0 && value.is_finite())
        .fold((0.0, 0.0), |(sum, count), value| (sum + value.ln(), count + 1.0));
    (count > 0.0).then(|| (sum / count).exp())
}

/// A sentence each.
impl fmt::Display for Overview {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "Physique reaches every figure on {} of {} scenes, rapier on {}.",
            self.physique_right, self.scenes, self.rapier_right
        )?;
        if let Some(ratio) = self.over_rapier {
            write!(out, " A step takes {ratio:.2} times rapier's, both as they come (geometric mean).")?;
        }
        if let Some(ratio) = self.at_equal_error {
            write!(
                out,
                " In some setup that was tried rapier errs as little on {} of {}; there a step takes {ratio:.2} times \
                 that setup's.",
                self.equalled, self.compared
            )?;
        }
        Ok(())
    }
}
