//! A scene through every setup: judged once each, then timed in interleaved rounds.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::Serialize;

use super::engine::{Engine, Programs, Setup};
use super::ratio::{Ratio, ratio};
use super::subject::Subject;
use super::trial::{Errors, judge, time};
use crate::simulate::Milliseconds;

/// How much is run.
#[derive(Clone, Debug)]
pub struct Effort {
    /// Rounds for the clock, at most, and at least two of the defaults.
    pub rounds: usize,
    /// Also other numbers of substeps and stiffer contacts.
    pub sweep: bool,
    /// s of clocked rounds a scene, about: dear scenes get fewer rounds and no sweep.
    pub seconds: f64,
}

/// What one setup showed on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    #[serde(flatten)]
    pub setup: Setup,
    pub label: String,
    pub is_default: bool,
    /// Why it has no figures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// ms of CPU a step: medians over the rounds of each round's mean, median, p99, max and min.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ms: Option<Milliseconds>,
    /// Mean ms a step of every round.
    pub rounds_ms: Vec<f64>,
    /// Its time over that of rapier's default in the faster of its builds, round by round.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_rapier: Option<Ratio>,
}

/// What all setups showed on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Sheet {
    pub scene: String,
    pub about: String,
    pub group: &'static str,
    pub bodies: usize,
    pub duration_s: f64,
    pub dt_s: f64,
    pub rows: Vec<Row>,
}

impl Row {
    /// The scene's error in this setup, if it has one that is finite.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        let figure = self.errors.as_ref()?.figures.first()?;
        figure.value.is_finite().then_some(figure.value)
    }
}

impl Sheet {
    /// The row of an engine as it comes.
    #[must_use]
    pub fn default_of(&self, engine: Engine) -> Option<&Row> {
        self.rows.iter().find(|row| row.setup.engine == engine && row.is_default)
    }

    /// rapier as it comes, in whichever of its builds is faster here.
    #[must_use]
    pub fn rapier(&self) -> Option<&Row> {
        let mean = |row: &Row| row.ms.map_or(f64::INFINITY, |ms| ms.mean);
        [Engine::Rapier, Engine::RapierSimd8]
            .into_iter()
            .filter_map(|engine| self.default_of(engine))
            .min_by(|a, b| mean(a).total_cmp(&mean(b)))
    }
}

/// Runs `subject`. Ends early, with what is there, once `stop` is set.
pub fn run(subject: &Subject, effort: &Effort, programs: &Programs, stop: &AtomicBool) -> Sheet {
    let engines = programs.engines();
    let judged = |setup: Setup| {
        let begun = Instant::now();
        let judged = judge(subject, &setup, programs);
        let row = Row {
            setup,
            label: setup.label(),
            is_default: setup.is_default(),
            refused: judged.as_ref().err().cloned(),
            errors: judged.ok(),
            ms: None,
            rounds_ms: Vec::new(),
            over_rapier: None,
        };
        (row, begun.elapsed().as_secs_f64())
    };
    let mut rows: Vec<Row> = Vec::new();
    let mut clocked: Vec<Vec<Milliseconds>> = Vec::new();
    let mut cost_s = 0.0;
    for engine in &engines {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let (mut row, _) = judged(Setup::default_of(*engine, subject.dt_s));
        let begun = Instant::now();
        clocked.push(round(subject, &mut row, programs).into_iter().collect());
        cost_s += begun.elapsed().as_secs_f64();
        rows.push(row);
    }
    // A sweep judges and times each engine in seven more setups.
    if effort.sweep && 20.0 * cost_s < effort.seconds {
        for setup in engines.iter().flat_map(|engine| Setup::sweep_of(*engine, subject.dt_s)) {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            let (row, _) = judged(setup);
            rows.push(row);
            clocked.push(Vec::new());
        }
    }
    // A dear scene gets fewer rounds, but two more of the defaults whatever they cost.
    let a_round_s = cost_s * if rows.len() > engines.len() { 8.0 } else { 1.0 };
    let rounds = ((effort.seconds / a_round_s.max(1e-6)) as usize).clamp(2, effort.rounds.max(2));
    for _ in 0..rounds {
        for (row, times) in rows.iter_mut().zip(&mut clocked) {
            if row.refused.is_none() && !stop.load(Ordering::Relaxed) {
                times.extend(round(subject, row, programs));
            }
        }
    }
    for (row, times) in rows.iter_mut().zip(&mut clocked) {
        // The first clocked round of the defaults measured what a round costs; it had no neighbours.
        if row.is_default && times.len() > 1 {
            times.remove(0);
        }
        row.rounds_ms = times.iter().map(|ms| ms.mean).collect();
        row.ms = medians(times);
    }
    let mut sheet = Sheet {
        scene: subject.name.clone(),
        about: subject.about.clone(),
        group: subject.group,
        bodies: subject.bodies(),
        duration_s: subject.duration_s,
        dt_s: subject.dt_s,
        rows,
    };
    if let Some(theirs) = sheet.rapier().map(|row| row.rounds_ms.clone()) {
        for row in &mut sheet.rows {
            row.over_rapier = ratio(&row.rounds_ms, &theirs);
        }
    }
    sheet
}

fn round(subject: &Subject, row: &mut Row, programs: &Programs) -> Option<Milliseconds> {
    if row.refused.is_some() {
        return None;
    }
    match time(subject, &row.setup, programs) {
        Ok(ms) => Some(ms),
        Err(reason) => {
            row.refused = Some(reason);
            None
        }
    }
}

fn medians(rounds: &[Milliseconds]) -> Option<Milliseconds> {
    let median = |of: fn(&Milliseconds) -> f64| {
        let mut values: Vec<f64> = rounds.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    Some(Milliseconds {
        median: median(|ms| ms.median)?,
        mean: median(|ms| ms.mean)?,
        p99: median(|ms| ms.p99)?,
        max: median(|ms| ms.max)?,
        min: median(|ms| ms.min)?,
    })
}
