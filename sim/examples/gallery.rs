//! Runs the gallery and prints what a step costs beside what went wrong: `gallery [NAME] [SUBSTEPS]`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for the terminal")]

use std::time::Instant;

use sim::{Settings, World, gallery};

fn main() {
    let mut args = std::env::args().skip(1);
    let wanted = args.next().filter(|name| name != "all");
    let mut settings = Settings { sleeping: false, ..Settings::default() };
    if let Some(substeps) = args.next() {
        settings.substeps = substeps.parse().unwrap();
    }
    if let Some(hertz) = args.next() {
        settings.contact_hertz = hertz.parse().unwrap();
    }
    if let Some(zeta) = args.next() {
        settings.contact_damping_ratio = zeta.parse().unwrap();
    }
    println!(
        "scene            bodies  ms/step   max ms  pen mm  end mm  drift mm   sink mm  energy rise J  impacts"
    );
    for exhibit in gallery::all().filter(|e| wanted.as_ref().is_none_or(|name| name == e.name)) {
        let scene = (exhibit.scene)();
        let mut world = World::new(&scene, &settings).unwrap();
        let start = world.frame().rigid.unwrap().poses.to_vec();
        let energy = |world: &World| {
            let metrics = world.frame().metrics;
            metrics.kinetic_j + metrics.potential_j
        };
        let (mut lowest, mut rise, mut deepest, mut impacts) = (energy(&world), 0.0_f64, 0.0_f64, 0);
        let mut times = Vec::new();
        for _ in 0..(exhibit.duration_s / settings.dt_s).round() as u32 {
            let begin = Instant::now();
            let report = world.step();
            times.push(begin.elapsed().as_secs_f64() * 1e3);
            impacts += report.impacts;
            if !world.frame().events.iter().any(|e| matches!(e, sim::Event::Acted { .. })) {
                rise = rise.max(energy(&world) - lowest);
            }
            lowest = lowest.min(energy(&world));
            deepest = deepest.max(world.frame().metrics.max_penetration_m);
        }
        let frame = world.frame();
        let moved = |axes: &[usize]| {
            frame
                .rigid
                .unwrap()
                .poses
                .iter()
                .zip(&start)
                .map(|(end, start)| {
                    axes.iter().map(|&k| (end.position[k] - start.position[k]).powi(2)).sum::<f64>().sqrt()
                })
                .fold(0.0, f64::max)
        };
        println!(
            "{:16} {:6} {:8.3} {:8.3} {:7.2} {:7.2} {:9.1} {:9.1} {:14.3} {:8}",
            exhibit.name,
            scene.entities.len(),
            times.iter().sum::<f64>() / times.len() as f64,
            times.iter().copied().fold(0.0, f64::max),
            deepest * 1e3,
            frame.metrics.max_penetration_m * 1e3,
            moved(&[0, 2]) * 1e3,
            moved(&[1]) * 1e3,
            rise,
            impacts,
        );
    }
}
