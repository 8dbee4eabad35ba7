//! Every quick scene of the gallery is judged by its figures. What fails stands in `known_failures.txt` with its
//! distance, and the test turns red when a figure begins to fail and when one begins to pass unnoticed.
//!
//! `GOLDEN_WRITE=1 cargo test -p sim --test gallery` writes the table anew. The long scenes are the report's.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use sim::gallery::{self, Exhibit, Judgement, Track};
use sim::{Event, Settings, World};

/// Steps times moving bodies that a scene may have here.
const QUICK: usize = 8_000;

fn run(exhibit: &Exhibit) -> Vec<Judgement> {
    run_at(exhibit, Settings::default().dt_s)
}

fn run_at(exhibit: &Exhibit, dt_s: f64) -> Vec<Judgement> {
    let scene = (exhibit.scene)();
    let settings = Settings { sleeping: false, dt_s, ..Settings::default() };
    let steps = exhibit.steps(settings.dt_s);
    let Ok(mut world) = World::new(&scene, &settings) else {
        return vec![Judgement { figure: "is built", unit: "", limit: 0.0, value: f64::INFINITY }];
    };
    let mut track = Track::new(&scene, steps);
    let push = |track: &mut Track, world: &World| {
        let frame = world.frame();
        let rigid = frame.rigid.unwrap();
        let acted = frame.events.iter().any(|event| matches!(event, Event::Acted { .. }));
        track.push(frame.time_s, rigid.poses, rigid.velocities, acted);
    };
    push(&mut track, &world);
    for _ in 0..steps {
        world.step();
        push(&mut track, &world);
    }
    track.finish();
    exhibit.judge(&track)
}

fn is_quick(exhibit: &Exhibit) -> bool {
    let scene = (exhibit.scene)();
    let moving = scene.entities.iter().filter(|entity| sim::measure::mass_of(entity).is_some()).count();
    moving * exhibit.steps(Settings::default().dt_s) <= QUICK
}

fn table() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/known_failures.txt")
}

const HEAD: &str = "# Figures of quick gallery scenes that fail today: scene | figure | value | limit. GOLDEN_WRITE=1 writes it.\n";

fn line(exhibit: &str, judgement: &Judgement) -> (String, String) {
    let key = format!("{exhibit} | {}", judgement.figure);
    (key, format!("{:.2e} {} | {:.0e}", judgement.value, judgement.unit, judgement.limit))
}

#[test]
fn what_passes_and_what_fails_is_known() {
    let text = std::fs::read_to_string(table()).expect("the table of known failures");
    let known: BTreeMap<&str, &str> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| {
            let second = line.match_indices(" | ").nth(1)?.0;
            Some((&line[..second], &line[second + 3..]))
        })
        .collect();
    let quick: Vec<&Exhibit> = gallery::all().filter(|exhibit| is_quick(exhibit)).collect();
    assert!(quick.len() > 40, "only {} scenes are quick", quick.len());
    let (here, there) = quick.split_at(quick.len() / 2);
    let judged = |exhibits: &[&'static Exhibit]| -> Vec<(&'static str, Vec<Judgement>)> {
        exhibits.iter().map(|exhibit| (exhibit.name, run(exhibit))).collect()
    };
    let all = std::thread::scope(|scope| {
        let other = scope.spawn(|| judged(there));
        let mut all = judged(here);
        all.extend(other.join().expect("no scene panics"));
        all
    });
    let failing: BTreeMap<String, String> = all
        .iter()
        .flat_map(|(name, judgements)| judgements.iter().map(move |judgement| (name, judgement)))
        .filter(|(_, judgement)| !judgement.passes())
        .map(|(name, judgement)| line(name, judgement))
        .collect();
    if std::env::var_os("GOLDEN_WRITE").is_some() {
        let mut blessed = HEAD.to_owned();
        for (key, value) in &failing {
            let _ = writeln!(blessed, "{key} | {value}");
        }
        std::fs::write(table(), blessed).expect("the table can be written");
        return;
    }
    let mut wrong = String::new();
    for (key, value) in failing.iter().filter(|(key, _)| !known.contains_key(key.as_str())) {
        let _ = writeln!(wrong, "fails now: {key} | {value}");
    }
    for (key, value) in known.iter().filter(|(key, _)| !failing.contains_key(**key)) {
        let _ = writeln!(wrong, "passes now: {key} (was {value})");
    }
    assert!(
        wrong.is_empty(),
        "the table of known failures is not true any more; GOLDEN_WRITE=1 writes it anew\n{wrong}"
    );
}

/// What is solved between its events does not depend on where the steps fall.
#[test]
fn a_lone_body_is_as_right_at_any_step() {
    for name in
        ["rocking-block", "painleve", "h11-heavy-top", "h18-coin", "roll-cylinder", "slope-20", "h17-disc"]
    {
        let exhibit = gallery::by_name(name).unwrap();
        for rate in [30.0, 59.0, 60.000_001, 61.7, 120.0] {
            for Judgement { figure, unit, limit, value } in run_at(exhibit, 1.0 / rate) {
                assert!(
                    value <= limit,
                    "{name} at 1/{rate} s: {figure} is {value:e} {unit}, limit {limit:e}"
                );
            }
        }
    }
}

#[test]
fn every_scene_is_built_named_once_and_judged() {
    let mut names = std::collections::BTreeSet::new();
    for exhibit in gallery::all() {
        assert!(names.insert(exhibit.name), "{} is there twice", exhibit.name);
        assert!(!exhibit.criteria.is_empty(), "{} has no figure", exhibit.name);
        if !is_quick(exhibit) {
            // The quick ones are built where they are judged.
            World::new(&(exhibit.scene)(), &Settings::default())
                .unwrap_or_else(|error| panic!("{}: {error}", exhibit.name));
        }
    }
}

/// H21: what is no solid is refused by name, and nothing panics.
#[test]
fn hulls_without_thickness_are_refused_or_rest() {
    use sim::gallery::build::{body, floor, scene, surface};
    let mass = sim::Mass { mass_kg: 1.0, inertia_kg_m2: [0.1, 0.1, 0.1, 0.0, 0.0, 0.0] };
    let flat = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let line = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let point = vec![[0.0; 3]; 5];
    let lost = vec![[0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (name, points) in [("flat", flat), ("line", line), ("point", point), ("not a number", lost)] {
        let s = surface(0.5, 0.0);
        let shape = sim::Shape::Hull { points };
        let scene = scene(name, vec![floor(s), body(name, mass, [0.0, 0.2, 0.0], shape, s)]);
        match World::new(&scene, &Settings::default()) {
            Err(error) => assert!(error.to_string().contains(name), "{name}: {error}"),
            Ok(mut world) => {
                for _ in 0..120 {
                    world.step();
                }
                let finite = world.frame().rigid.unwrap().poses[1].position.iter().all(|x| x.is_finite());
                assert!(finite, "{name}: lost");
            }
        }
    }
}
