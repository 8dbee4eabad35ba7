//! A scene through every setup: judged once each, then timed in interleaved rounds.

use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::engine::{Engine, Setup};
use super::ratio::{Ratio, ratio};
use super::subject::Subject;
use super::trial::{Errors, judge, time};
use crate::simulate::Milliseconds;

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
    /// Its time over that of rapier's default, round by round.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_rapier: Option<Ratio>,
}

/// What all setups showed on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Sheet {
    pub scene: String,
    pub about: String,
    pub bodies: usize,
    pub duration_s: f64,
    pub dt_s: f64,
    pub rows: Vec<Row>,
}

/// Runs `subject` in every setup, `rounds` times for the clock. Ends early, with what is there, once `stop` is set.
pub fn run(subject: &Subject, setups: &[Setup], rounds: usize, stop: &AtomicBool) -> Sheet {
    let mut rows: Vec<Row> = Vec::new();
    for setup in setups {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let judged = judge(subject, setup);
        rows.push(Row {
            setup: *setup,
            label: setup.label(),
            is_default: setup.is_default(),
            refused: judged.as_ref().err().cloned(),
            errors: judged.ok(),
            ms: None,
            rounds_ms: Vec::new(),
            over_rapier: None,
        });
    }
    let mut clocked: Vec<Vec<Milliseconds>> = vec![Vec::new(); rows.len()];
    for _ in 0..rounds {
        for (row, times) in rows.iter_mut().zip(&mut clocked).filter(|(row, _)| row.refused.is_none()) {
            if stop.load(Ordering::Relaxed) {
                break;
            }
            match time(subject, &row.setup) {
                Ok(ms) => times.push(ms),
                Err(reason) => row.refused = Some(reason),
            }
        }
    }
    for (row, times) in rows.iter_mut().zip(&clocked) {
        row.rounds_ms = times.iter().map(|ms| ms.mean).collect();
        row.ms = medians(times);
    }
    let rapier = rows.iter().find(|row| row.setup.engine == Engine::Rapier && row.is_default);
    if let Some(theirs) = rapier.map(|row| row.rounds_ms.clone()) {
        for row in &mut rows {
            row.over_rapier = ratio(&row.rounds_ms, &theirs);
        }
    }
    Sheet {
        scene: subject.name.clone(),
        about: subject.about.clone(),
        bodies: subject
            .scene
            .entities
            .iter()
            .filter(|entity| sim::measure::mass_of(entity).is_some())
            .count(),
        duration_s: subject.duration_s,
        dt_s: subject.dt_s,
        rows,
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
