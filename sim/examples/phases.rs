//! CPU milliseconds a step by phase, scene by scene: `phases [NAME [STEPS]]`. What the plan leaves out must not show.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for the terminal")]

use std::time::Duration;

use sim::{Observer, Phase, Settings, Work, World, gallery};

/// Of this process, so that what else the machine does is left out.
#[cfg(unix)]
fn cpu_time() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

#[cfg(not(unix))]
fn cpu_time() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// Time by phase, and the phase that runs.
struct Clock {
    spent: [Duration; Phase::ALL.len()],
    running: Option<(Phase, Duration)>,
}

impl Observer for Clock {
    fn enters(&mut self, phase: Phase) {
        let now = cpu_time();
        if let Some((before, since)) = self.running {
            self.spent[before as usize] += now - since;
        }
        self.running = Some((phase, now));
    }
}

fn main() {
    let wanted = std::env::args().nth(1);
    let steps: u32 = std::env::args().nth(2).map_or(120, |steps| steps.parse().unwrap());
    print!("{:16} {:>6} {:>6} {:>9} {:>8}", "scene", "bodies", "pairs", "manifolds", "ms/step");
    Phase::ALL.iter().for_each(|phase| print!(" {:>12}", phase.name()));
    println!("  (of {steps} steps)");
    for exhibit in gallery::all().filter(|e| wanted.as_ref().is_none_or(|name| name == e.name)) {
        let settings = Settings { sleeping: false, ..Settings::default() };
        let scene = (exhibit.scene)();
        let mut world = World::new(&scene, &settings).unwrap();
        let mut clock = Clock { spent: [Duration::ZERO; Phase::ALL.len()], running: None };
        let mut work = Work::default();
        let (mut pairs, mut manifolds) = (0, 0);
        for _ in 0..steps {
            let report = world.step_observed(&mut clock);
            clock.enters(Phase::Actions);
            clock.running = None;
            work.add(&report.work);
            (pairs, manifolds) = (report.pairs, report.manifolds);
        }
        let ms = |spent: &Duration| spent.as_secs_f64() * 1e3 / f64::from(steps);
        let whole = clock.spent.iter().map(ms).sum::<f64>();
        print!("{:16} {:>6} {pairs:>6} {manifolds:>9} {whole:>8.3}", exhibit.name, scene.entities.len());
        clock.spent.iter().for_each(|spent| print!(" {:>12.4}", ms(spent)));
        println!();
        for (what, count) in work.counts().into_iter().filter(|(_, count)| *count > 0) {
            println!("{:18}{what}: {count}", "");
        }
    }
}
