//! What finding contacts costs in a step, scene by scene: `collide_share [STEPS]`.
//!
//! The pyramid rests, the heap of 4,096 hulls of 12 corners falls and piles up, the pit holds cylinders, cubes and balls.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for the terminal")]

use std::time::Instant;

use sim::gallery::build::{body, fixed, floor, noise};
use sim::{Entity, Mass, Observer, Phase, Pose, Scene, Settings, Shape, StepReport, Surface, World, gallery};

struct Stopwatch {
    phase: Phase,
    since: Instant,
    spent_ms: [f64; Phase::ALL.len()],
}

impl Observer for Stopwatch {
    fn enters(&mut self, phase: Phase) {
        self.spent_ms[self.phase as usize] += self.since.elapsed().as_secs_f64() * 1e3;
        (self.phase, self.since) = (phase, Instant::now());
    }

    fn ended(&mut self, _: &StepReport) -> bool {
        self.enters(Phase::Actions);
        true
    }
}

fn main() {
    let steps: u32 = std::env::args().nth(1).map_or(240, |steps| steps.parse().unwrap());
    let settings = Settings { sleeping: false, ..Settings::default() };
    println!(
        "scene        bodies    pairs  manifolds   broad ms  narrow ms  whole ms   (mean of {steps} steps)"
    );
    for (name, scene) in [
        ("pyramid", (gallery::by_name("pyramid").unwrap().scene)()),
        ("seed-8g", (gallery::by_name("seed-8g").unwrap().scene)()),
        ("heap", heap(16)),
    ] {
        let mut world = World::new(&scene, &settings).unwrap();
        let mut watch =
            Stopwatch { phase: Phase::Actions, since: Instant::now(), spent_ms: [0.0; Phase::ALL.len()] };
        let (mut pairs, mut manifolds) = (0, 0);
        let begin = Instant::now();
        for _ in 0..steps {
            watch.since = Instant::now();
            let report = world.step_observed(&mut watch);
            watch.ended(&report);
            (pairs, manifolds) = (report.pairs, report.manifolds);
        }
        let whole = begin.elapsed().as_secs_f64() * 1e3 / f64::from(steps);
        let spent = |phase: Phase| watch.spent_ms[phase as usize] / f64::from(steps);
        println!(
            "{name:12} {:6} {pairs:8} {manifolds:10} {:10.3} {:10.3} {whole:9.3}",
            scene.entities.len(),
            spent(Phase::BroadPhase),
            spent(Phase::NarrowPhase),
        );
    }
}

/// `side`³ rocks over a pit.
fn heap(side: u32) -> Scene {
    let surface = Surface::new(0.5, 0.0);
    let mut entities: Vec<Entity> = vec![floor(surface)];
    for at in [-11.5, 11.5] {
        let wall =
            |position, half_extents| fixed("wall", Pose::at(position), Shape::Box { half_extents }, surface);
        entities.push(wall([at, 15.0, 0.0], [0.5, 15.0, 12.0]));
        entities.push(wall([0.0, 15.0, at], [12.0, 15.0, 0.5]));
    }
    let rock = |seed: u32| Shape::Hull {
        points: (0..12)
            .map(|i| {
                let v = [1, 2, 3].map(|k| noise(100 * seed + i, k) - 0.5);
                let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                v.map(|x| 0.5 * x / length)
            })
            .collect(),
    };
    let mass = Mass { mass_kg: 400.0, inertia_kg_m2: [35.0, 35.0, 35.0, 0.0, 0.0, 0.0] };
    let mut n = 0;
    for y in 0..side {
        for x in 0..side {
            for z in 0..side {
                let spread = |i: u32, k: u32| {
                    (f64::from(i) - 0.5 * f64::from(side - 1)) * 1.3 + 0.2 * (noise(n, k) - 0.5)
                };
                let position = [spread(x, 1), 0.8 + 1.1 * f64::from(y), spread(z, 2)];
                entities.push(body("rock", mass, position, rock(n % 8), surface));
                n += 1;
            }
        }
    }
    Scene { name: "heap".to_owned(), ..gallery::build::scene("heap", entities) }
}
