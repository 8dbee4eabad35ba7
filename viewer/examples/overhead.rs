//! What a recording costs the thread that steps: `overhead [FILE.rrd] [BODIES] [FRAMES]`, 200 bodies, 600 frames.
//!
//! First made-up frames, every body in motion and with four contacts, that come at the pace of a solver that takes
//! 2 ms a step, as a scene of that size does; only the calls into the sink are timed. Then a real fall of as many
//! boxes, stepped in turn without and with a recording, where the worker and the solver share the machine.

#![allow(clippy::print_stdout, reason = "a measuring program prints what it measured")]

use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use sim::{
    ChildShape, ContactBlock, ContactPoint, Entity, FRAME_VERSION, Frame, FrameSink, Mass, Metrics, Motion,
    Pose, RigidBlock, Scene, Settings, Shape, SleepState, Surface, Velocity,
};
use viewer::{Output, Recording};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let file = args.next().map_or_else(|| std::env::temp_dir().join("overhead.rrd"), PathBuf::from);
    let bodies: u32 = args.next().map_or(Ok(200), |n| n.parse())?;
    let frames: u32 = args.next().map_or(Ok(600), |n| n.parse())?;
    let surface = Surface::new(0.5, 0.0);
    let shape = Shape::Box { half_extents: [0.2; 3] };
    let child = ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 };
    let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [0.1, 0.1, 0.1, 0.0, 0.0, 0.0] };
    let entity = |i: u32| Entity {
        name: format!("box {i}"),
        motion: Motion::Dynamic(mass),
        pose: pose(i, 0),
        velocity: Velocity::default(),
        shapes: vec![child.clone()],
    };
    let scene = Scene::new("overhead", (0..bodies).map(entity).collect());
    let open = || {
        let output = Output { file: Some(file.clone()), ..Output::default() };
        Recording::new(output, "overhead", Vec::new(), "").open()
    };
    let mut sink = open()?;
    let settings = Settings::default();
    let begin = Instant::now();
    sink.begin(&scene, &settings);
    let begin = begin.elapsed();
    let velocities = vec![Velocity::default(); bodies as usize];
    let sleep = vec![SleepState::Active; bodies as usize];
    let mut costs = Vec::new();
    for f in 0..frames {
        let poses: Vec<Pose> = (0..bodies).map(|i| pose(i, f)).collect();
        let touch = |k: u32| ContactPoint {
            a: k / 4,
            b: 0,
            position: poses[(k / 4) as usize].position,
            normal: [0.0, 1.0, 0.0],
            depth_m: 1e-4,
            normal_impulse_n_s: 0.1,
            friction_impulse_n_s: [0.0; 3],
        };
        let points: Vec<ContactPoint> = (0..4 * bodies).map(touch).collect();
        let frame = Frame {
            version: FRAME_VERSION,
            step: u64::from(f),
            time_s: f64::from(f) / 60.0,
            rigid: Some(RigidBlock { poses: &poses, velocities: &velocities, sleep: &sleep }),
            soft: None,
            fluid: None,
            contacts: Some(ContactBlock { points: &points }),
            events: &[],
            metrics: Metrics::default(),
        };
        let start = Instant::now();
        sink.frame(&frame);
        costs.push(start.elapsed());
        std::thread::sleep(Duration::from_millis(2));
    }
    let total: Duration = costs.iter().sum();
    costs.sort();
    let micros = |d: Duration| d.as_secs_f64() * 1e6;
    let at = |share: f64| micros(costs[((costs.len() - 1) as f64 * share) as usize]);
    let end = Instant::now();
    let written = sink.finish()?;
    println!(
        "{bodies} bodies, {frames} frames: {:.1} us a frame (median {:.1}, p99 {:.1}, max {:.1}); begin {:.0} us; \
         the rest was written {:.0} ms after the last frame; {} bytes",
        micros(total) / f64::from(frames),
        at(0.5),
        at(0.99),
        at(1.0),
        micros(begin),
        end.elapsed().as_secs_f64() * 1e3,
        written.bytes,
    );
    let [mut bare, mut recorded] = [[Duration::MAX; 2]; 2];
    let least = |a: [Duration; 2], b: [Duration; 2]| [a[0].min(b[0]), a[1].min(b[1])];
    for _ in 0..7 {
        bare = least(bare, steps(&scene, frames, None)?);
        let mut sink = open()?;
        recorded = least(recorded, steps(&scene, frames, Some(&mut sink))?);
        sink.finish()?;
    }
    let each = |d: Duration| micros(d) / f64::from(frames);
    for (clock, name) in ["by the wall", "of the stepping thread's own processor time"].iter().enumerate() {
        let (without, with) = (each(bare[clock]), each(recorded[clock]));
        let more = 100.0 * (with / without - 1.0);
        println!(
            "a real fall: {without:.1} us a step without, {with:.1} us with a recording, {more:+.1} %, {name}"
        );
    }
    Ok(())
}

/// Processor time of this thread where Linux tells it.
fn own_time() -> Duration {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    Duration::from_nanos(stat.split(' ').next().and_then(|text| text.parse().ok()).unwrap_or(0))
}

/// Time of `count` steps and, with a sink, of the calls into it: by the wall and the thread's own.
fn steps(
    scene: &Scene,
    count: u32,
    sink: Option<&mut dyn FrameSink>,
) -> Result<[Duration; 2], Box<dyn Error>> {
    let settings = Settings::default();
    let mut entities = scene.entities.clone();
    let floor = ChildShape { shape: Shape::HalfSpace, ..entities[0].shapes[0].clone() };
    for (i, entity) in (0u32..).zip(&mut entities) {
        let (column, row) = (f64::from(i % 20), f64::from(i / 20));
        entity.pose = Pose::at([0.5 * column, 0.3 + 0.45 * row, 0.01 * column]);
    }
    entities.push(Entity {
        name: "floor".to_owned(),
        motion: Motion::Static,
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes: vec![floor],
    });
    let scene = Scene { entities, ..scene.clone() };
    let mut world = sim::World::new(&scene, &settings)?;
    let (start, own) = (Instant::now(), own_time());
    match sink {
        None => (0..count).for_each(|_| {
            world.step();
        }),
        Some(sink) => {
            sink.begin(&scene, &settings);
            for _ in 0..count {
                world.step();
                sink.frame(&world.frame());
            }
        }
    }
    Ok([start.elapsed(), own_time().saturating_sub(own)])
}

fn pose(i: u32, frame: u32) -> Pose {
    let (i, t) = (f64::from(i), f64::from(frame) / 60.0);
    let half = 0.5 * t + i;
    Pose {
        position: [i % 20.0, 1.0 + (t + i).sin(), (i / 20.0).floor()],
        rotation: [0.0, half.sin(), 0.0, half.cos()],
    }
}
