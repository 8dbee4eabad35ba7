//! Why the solver works as it does on a scene, and what came of it: the plan, the work done, the time of each phase.

use std::io::{self, Write};

use serde::Serialize;
use sim::{Choice, Phase, Plan, Scene, Work};

/// What `simulate --explain` tells.
#[derive(Clone, Debug, Serialize)]
pub struct Explained {
    pub plan: Vec<Planned>,
    pub work: Vec<Counted>,
    pub phases: Vec<Timed>,
}

/// A choice of the plan.
#[derive(Clone, Debug, Serialize)]
pub struct Planned {
    pub aspect: &'static str,
    pub scope: String,
    pub model: &'static str,
    pub reason: String,
    /// Empty where nothing is left out.
    pub leaves_out: &'static str,
}

/// What was done, counted over all steps.
#[derive(Clone, Debug, Serialize)]
pub struct Counted {
    pub what: &'static str,
    pub count: u64,
}

/// The mean time of a phase in a step, the clock's own included.
#[derive(Clone, Debug, Serialize)]
pub struct Timed {
    pub phase: &'static str,
    pub ms_per_step: f64,
    /// Of the whole step.
    pub share: f64,
}

/// The plan of a scene.
#[must_use]
pub fn planned(scene: &Scene) -> Vec<Planned> {
    let choices = Plan::of(scene).choices().into_iter();
    choices
        .map(|Choice { aspect, scope, model, reason, skips }| Planned {
            aspect: aspect.name(),
            scope,
            model,
            reason,
            leaves_out: skips,
        })
        .collect()
}

impl Explained {
    /// Of a run of `steps` steps in which each phase took the given seconds.
    #[must_use]
    pub fn new(scene: &Scene, work: &Work, seconds: &[f64; Phase::ALL.len()], steps: u64) -> Self {
        let total: f64 = seconds.iter().sum();
        let timed = |phase: Phase| Timed {
            phase: phase.name(),
            ms_per_step: seconds[phase as usize] * 1e3 / steps.max(1) as f64,
            share: if total > 0.0 { seconds[phase as usize] / total } else { 0.0 },
        };
        Self {
            plan: planned(scene),
            work: work.counts().into_iter().map(|(what, count)| Counted { what, count }).collect(),
            phases: Phase::ALL.into_iter().map(timed).collect(),
        }
    }

    /// Writes it for a reader.
    ///
    /// # Errors
    /// What writing meets.
    pub fn text(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "\n  plan")?;
        for Planned { aspect, scope, model, reason, leaves_out } in &self.plan {
            writeln!(out, "  {aspect:<17} {model}")?;
            writeln!(out, "  {:<17} for {scope}: {reason}", "")?;
            if !leaves_out.is_empty() {
                writeln!(out, "  {:<17} leaves out {leaves_out}", "")?;
            }
        }
        writeln!(out, "\n  work over all steps")?;
        for Counted { what, count } in &self.work {
            writeln!(out, "  {what:<28} {count:>12}")?;
        }
        writeln!(out, "\n  phase             ms a step   share")?;
        for Timed { phase, ms_per_step, share } in &self.phases {
            writeln!(out, "  {phase:<15} {ms_per_step:>11.5} {:>6.1} %", share * 100.0)?;
        }
        Ok(())
    }
}
