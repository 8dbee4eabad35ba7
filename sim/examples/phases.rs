//! The share of each phase in a step, scene by scene: `phases [NAME]`. What the plan leaves out must not show.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for the terminal")]

use std::time::Instant;

use sim::{Observer, Phase, Settings, Work, World, gallery};

/// Seconds by phase, and the phase that runs.
struct Clock {
    seconds: [f64; Phase::ALL.len()],
    running: Option<(Phase, Instant)>,
}

impl Observer for Clock {
    fn enters(&mut self, phase: Phase) {
        let now = Instant::now();
        if let Some((before, since)) = self.running {
            self.seconds[before as usize] += (now - since).as_secs_f64();
        }
        self.running = Some((phase, now));
    }
}

fn main() {
    let wanted = std::env::args().nth(1);
    print!("{:16}  ms/step", "scene");
    Phase::ALL.iter().for_each(|phase| print!(" {:>12}", phase.name()));
    println!("  (% of the step)");
    for exhibit in gallery::all().filter(|e| wanted.as_ref().is_none_or(|name| name == e.name)) {
        let settings = Settings { sleeping: false, ..Settings::default() };
        let mut world = World::new(&(exhibit.scene)(), &settings).unwrap();
        let mut clock = Clock { seconds: [0.0; Phase::ALL.len()], running: None };
        let mut work = Work::default();
        let steps = 120;
        for _ in 0..steps {
            work.add(&world.step_observed(&mut clock).work);
            clock.running = None;
        }
        let total: f64 = clock.seconds.iter().sum();
        print!("{:16} {:8.4}", exhibit.name, total * 1e3 / f64::from(steps));
        clock.seconds.iter().for_each(|seconds| print!(" {:>12.2}", 100.0 * seconds / total));
        println!();
        for (what, count) in work.counts().into_iter().filter(|(_, count)| *count > 0) {
            println!("{:18}{what}: {count}", "");
        }
    }
}
