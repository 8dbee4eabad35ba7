//! A scene through every setup: judged once each, then timed in interleaved rounds.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use serde::Serialize;

use super::engine::{Engine, Programs, Setup};
use super::ratio::{Ratio, ratio};
use super::subject::Subject;
use super::trial::{Errors, judge, time};
use crate::simulate::Milliseconds;

/// Errors are compared no finer than this share of what must be reached.
const RIGHT_SHARE: f64 = 1e-3;

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

    /// Errors are compared no finer than this: below it all are right.
    #[must_use]
    pub fn least_error(&self) -> f64 {
        let figure = self.errors.as_ref().and_then(|errors| errors.figures.first());
        let limit = figure.map(|figure| figure.limit).filter(|limit| *limit > 0.0 && limit.is_finite());
        limit.map_or(1e-12, |limit| RIGHT_SHARE * limit)
    }

    /// Whether every figure of the scene is good enough; `None` where there is none to reach.
    #[must_use]
    pub fn passes(&self) -> Option<bool> {
        let mut figures = self.errors.as_ref()?.figures.iter().filter(|f| f.limit.is_finite()).peekable();
        figures.peek()?;
        Some(figures.all(|figure| figure.passes))
    }

    /// ms of CPU a step; infinite where it was not timed.
    #[must_use]
    pub fn mean_ms(&self) -> f64 {
        self.ms.map_or(f64::INFINITY, |ms| ms.mean)
    }
}

impl Sheet {
    /// The row of an engine as it comes.
    #[must_use]
    pub fn default_of(&self, engine: Engine) -> Option<&Row> {
        self.rows.iter().find(|row| row.setup.engine == engine && row.is_default)
    }

    /// The fastest setup of rapier, in either build, that is as right as Physique as it comes; and the time of
    /// Physique over its. `None` where none that was tried is. What passes with a margin (`RIGHT_SHARE`) counts as
    /// equally right.
    #[must_use]
    pub fn at_equal_error(&self) -> Option<(&Row, f64)> {
        let ours = self.default_of(Engine::Physique)?;
        let enough = ours.error()?.max(ours.least_error());
        let theirs = self
            .rows
            .iter()
            .filter(|row| row.setup.engine != Engine::Physique && row.ms.is_some())
            .filter(|row| row.error().is_some_and(|error| error <= enough))
            .min_by(|a, b| a.mean_ms().total_cmp(&b.mean_ms()))?;
        Some((theirs, ours.mean_ms() / theirs.mean_ms()))
    }

    /// rapier as it comes, in whichever of its builds is faster here.
    #[must_use]
    pub fn rapier(&self) -> Option<&Row> {
        [Engine::Rapier, Engine::RapierSimd8]
            .into_iter()
            .filter_map(|engine| self.default_of(engine))
            .min_by(|a, b| a.mean_ms().total_cmp(&b.mean_ms()))
    }
}

/// Runs `subject`. Ends early, with what is there, once `stop` is set.
pub fn run(subject: &Subject, effort: &Effort, programs: &Programs, stop: &AtomicBool) -> Sheet {
    let engines = programs.engines();
    let defaults: Vec<Setup> =
        engines.iter().map(|engine| Setup::default_of(*engine, subject.dt_s)).collect();
    let mut rows = judged(subject, &defaults, programs, stop);
    let mut clocked: Vec<Vec<Milliseconds>> = Vec::new();
    let begun = Instant::now();
    for row in &mut rows {
        clocked.push(round(subject, row, programs, stop).into_iter().collect());
    }
    let cost_s = begun.elapsed().as_secs_f64();
    // A sweep judges and times each engine in seven more setups.
    if effort.sweep && 12.0 * cost_s < effort.seconds {
        let sweep: Vec<Setup> =
            engines.iter().flat_map(|engine| Setup::sweep_of(*engine, subject.dt_s)).collect();
        rows.extend(judged(subject, &sweep, programs, stop));
        clocked.resize(rows.len(), Vec::new());
    }
    // A dear scene gets fewer rounds, and a very dear one only one more of the defaults.
    let a_round_s = cost_s * if rows.len() > engines.len() { 8.0 } else { 1.0 };
    let very_dear = cost_s > effort.seconds;
    let least = if very_dear { 1 } else { 2 };
    let rounds = ((effort.seconds / a_round_s.max(1e-6)) as usize).clamp(least, effort.rounds.max(least));
    for turn in 0..rounds {
        let mut order: Vec<usize> = (0..rows.len()).collect();
        // Back and forth, so that a machine that slows down meanwhile slows all alike.
        if turn % 2 == 1 {
            order.reverse();
        }
        for i in order {
            clocked[i].extend(round(subject, &mut rows[i], programs, stop));
        }
    }
    for (row, times) in rows.iter_mut().zip(&mut clocked) {
        // The first clocked round of the defaults measured what a round costs; it had no neighbours.
        if row.is_default && times.len() > 1 && !very_dear {
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

/// A row of every setup, judged and not yet timed, on as many threads as there are cores: nothing is clocked here.
fn judged(subject: &Subject, setups: &[Setup], programs: &Programs, stop: &AtomicBool) -> Vec<Row> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while !stop.load(Ordering::Relaxed)
            && let Some((i, setup)) = setups.iter().enumerate().nth(next.fetch_add(1, Ordering::Relaxed))
        {
            done.push((i, row(setup, judge(subject, setup, programs))));
        }
        done
    };
    let threads = thread::available_parallelism().map_or(1, usize::from).min(setups.len());
    let mut rows: Vec<(usize, Row)> = thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let own = work();
        // A thread that panicked has said so, and takes its rows with it.
        others.into_iter().filter_map(|other| other.join().ok()).flatten().chain(own).collect()
    });
    rows.sort_by_key(|(i, _)| *i);
    rows.into_iter().map(|(_, row)| row).collect()
}

fn row(setup: &Setup, judged: Result<Errors, String>) -> Row {
    Row {
        setup: *setup,
        label: setup.label(),
        is_default: setup.is_default(),
        refused: judged.as_ref().err().cloned(),
        errors: judged.ok(),
        ms: None,
        rounds_ms: Vec::new(),
        over_rapier: None,
    }
}

fn round(subject: &Subject, row: &mut Row, programs: &Programs, stop: &AtomicBool) -> Option<Milliseconds> {
    if row.refused.is_some() || stop.load(Ordering::Relaxed) {
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
