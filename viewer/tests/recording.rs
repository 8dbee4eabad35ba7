//! Recordings of made-up frames: on disk while the run goes on, whole at its end, readable after a crash.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use sim::{
    ChildShape, ContactBlock, ContactPoint, Entity, Event, FRAME_VERSION, Frame, FrameSink, Mass, Metrics,
    Motion, Pose, RigidBlock, Scene, Settings, Shape, SleepState, Surface, Velocity,
};
use viewer::{Gallery, Output, RERUN_VERSION, Recording, RerunSink, Slot, ViewerError, Visual, VisualMesh};

type Done = Result<(), Box<dyn Error>>;

/// Set for the child of [`a_killed_run_leaves_the_old_file_and_one_that_opens`].
const CHILD: &str = "PHYSIQUE_VIEWER_TEST_CHILD";

fn scene(bodies: usize) -> Scene {
    let surface = Surface::new(0.5, 0.1);
    let child = |shape| ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 };
    let hull = (0..8u8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 1 { 0.2 } else { -0.2 })).collect();
    let shapes = [
        Shape::Sphere { radius: 0.2 },
        Shape::Box { half_extents: [0.2, 0.1, 0.3] },
        Shape::Capsule { half_height: 0.2, radius: 0.1 },
        Shape::Cylinder { half_height: 0.2, radius: 0.1 },
        Shape::Hull { points: hull },
    ];
    let entity = |(i, shape): (usize, &Shape)| Entity {
        name: format!("body {}", i % 4),
        motion: Motion::Dynamic(Mass { mass_kg: 2.0, inertia_kg_m2: [0.1, 0.1, 0.1, 0.0, 0.0, 0.0] }),
        pose: Pose::at([0.5 * i as f64, 1.0, 0.0]),
        velocity: Velocity::default(),
        shapes: vec![child(shape.clone())],
    };
    let floor = Entity {
        name: "floor".to_owned(),
        motion: Motion::Static,
        pose: Pose::IDENTITY,
        velocity: Velocity::default(),
        shapes: vec![child(Shape::HalfSpace)],
    };
    let mut entities: Vec<Entity> = shapes.iter().cycle().take(bodies).enumerate().map(entity).collect();
    entities.push(floor);
    Scene::new("test", entities)
}

/// Pushes steps `from..to` of a fall with an impact, a contact and a body that falls asleep.
fn push(sink: &mut dyn FrameSink, scene: &Scene, from: u32, to: u32) {
    let count = scene.entities.len();
    for step in from..to {
        let time_s = f64::from(step) / 60.0;
        let pose = |entity: &Entity| {
            let [x, y, z] = entity.pose.position;
            let fall = if entity.motion == Motion::Static { 0.0 } else { (0.5 * time_s).min(0.8) };
            Pose::at([x, y - fall, z])
        };
        let poses: Vec<Pose> = scene.entities.iter().map(pose).collect();
        let state = if step < 90 { SleepState::Active } else { SleepState::Asleep };
        let point = ContactPoint {
            a: 0,
            b: 1,
            position: [0.0, 0.1, 0.0],
            normal: [0.0, 1.0, 0.0],
            depth_m: 1e-4,
            normal_impulse_n_s: 0.3,
            friction_impulse_n_s: [0.0; 3],
        };
        let points = if step % 40 < 20 { vec![point; 3] } else { Vec::new() };
        let impact = [Event::Impact { a: 0, b: 1, speed_m_s: 1.0 }];
        sink.frame(&Frame {
            version: FRAME_VERSION,
            step: u64::from(step),
            time_s,
            rigid: Some(RigidBlock {
                poses: &poses,
                velocities: &vec![Velocity::default(); count],
                sleep: &vec![state; count],
            }),
            soft: None,
            fluid: None,
            contacts: Some(ContactBlock { points: &points }),
            events: if step == 30 { &impact } else { &[] },
            metrics: Metrics { kinetic_j: 1.0, awake: u32::from(step < 90), ..Metrics::default() },
        });
    }
}

fn to_file(path: &Path) -> Output {
    Output { file: Some(path.to_owned()), ..Output::default() }
}

fn open(path: &Path) -> Result<RerunSink, ViewerError> {
    Recording::new(to_file(path), "test", vec![triangle(0)], "| a | b |\n|---|---|\n| 1 | 2 |\n").open()
}

fn triangle(entity: usize) -> Visual {
    let positions = vec![[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, 0.0]];
    let mesh = VisualMesh { positions, triangles: vec![[0, 1, 2]], color: [200, 120, 60, 255] };
    Visual { entity, meshes: vec![mesh] }
}

fn length(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |meta| meta.len())
}

/// Waits until the file is longer than `than`.
fn grows(path: &Path, than: u64) -> bool {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(30) {
        if length(path) > than {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

/// Has rerun's own tool read the file; passes, saying so, where there is no such tool.
fn verify(path: &Path, footer: bool) -> Done {
    if viewer::viewer_version().as_deref() != Some(RERUN_VERSION) {
        eprintln!("skipped: `rerun rrd verify` needs rerun {RERUN_VERSION} on PATH");
        return Ok(());
    }
    let mut command = Command::new("rerun");
    command.args(["rrd", "verify", "--check-footers", if footer { "true" } else { "false" }]).arg(path);
    let output = command.stdin(Stdio::null()).output()?;
    assert!(output.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stderr));
    Ok(())
}

#[test]
fn frames_reach_the_file_while_the_run_goes_on() -> Done {
    let folder = tempfile::tempdir()?;
    let recording = folder.path().join("run.rrd");
    let path = recording.with_extension("part.rrd");
    let scene = scene(7);
    let mut sink = open(&recording)?;
    sink.begin(&scene, &Settings::default());
    // What is logged once is on disk when it grows no more; then frames come as a slow run gives them.
    assert!(grows(&path, 2000));
    let mut before = 0;
    while std::mem::replace(&mut before, length(&path)) != length(&path) {
        std::thread::sleep(Duration::from_millis(500));
    }
    let (mut step, start) = (0, Instant::now());
    while length(&path) <= before && start.elapsed() < Duration::from_secs(30) {
        push(&mut sink, &scene, step, step + 1);
        step += 1;
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(length(&path) > before, "frames are on disk before the end, {step} pushed");
    let written = sink.finish()?;
    assert_eq!((written.frames, written.bytes), (u64::from(step), length(&recording)));
    verify(&recording, true)
}

#[test]
fn a_sink_that_is_dropped_writes_the_rest_and_the_footer() -> Done {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("dropped.rrd");
    let scene = scene(5);
    let mut sink = open(&path)?;
    sink.begin(&scene, &Settings::default());
    push(&mut sink, &scene, 0, 10);
    drop(sink);
    assert!(length(&path) > 2000);
    verify(&path, true)
}

#[test]
fn many_bodies_are_instances_and_take_no_more_room_than_their_poses() -> Done {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("many.rrd");
    let scene = scene(1000);
    let mut sink = Recording::new(to_file(&path), "many", Vec::new(), "").open()?;
    sink.begin(&scene, &Settings::default());
    push(&mut sink, &scene, 0, 120);
    let written = sink.finish()?;
    // All of them fall for 96 of the 120 steps: a pose is 28 bytes.
    let poses = 1000 * 97 * 28;
    assert!(written.bytes < poses + 200_000, "{}", written.bytes);
    verify(&path, true)
}

#[test]
fn a_gallery_holds_moving_and_still_models() -> Done {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("gallery.rrd");
    let slot = |(category, name): (&str, &str)| Slot { category: category.to_owned(), name: name.to_owned() };
    let slots =
        [("chair", "a/one.glb"), ("chair", "a/two.glb"), ("lamp", "b.obj"), ("lamp", "c.obj")].map(slot);
    let gallery = Gallery::open(to_file(&path), "models", "all", slots.to_vec())?;
    std::thread::scope(|scope| {
        for index in 0..2 {
            let gallery = &gallery;
            scope.spawn(move || {
                let scene = scene(1);
                let mut sink = gallery.sink(index, vec![triangle(0)], "its attributes");
                sink.begin(&scene, &Settings::default());
                push(&mut sink, &scene, 0, 120);
                sink.end();
            });
        }
    });
    gallery.still(2, triangle(0).meshes, "soft");
    let mut nowhere = gallery.sink(99, Vec::new(), "");
    nowhere.begin(&scene(1), &Settings::default());
    drop(nowhere);
    gallery.set_summary("two moved");
    let written = gallery.finish()?;
    assert_eq!(written.frames, 2 * 61, "thinned to 30 Hz, the last kept");
    verify(&path, true)
}

#[test]
fn outputs_that_cannot_be_are_refused_by_name() -> Done {
    let folder = tempfile::tempdir()?;
    let refused =
        |output: Output| Recording::new(output, "", Vec::new(), "").open().err().map(|e| e.to_string());
    assert!(refused(Output::default()).is_some_and(|text| text.contains("nowhere to record to")));
    let missing = folder.path().join("no/such/folder.rrd");
    let text = refused(to_file(&missing)).unwrap_or_default();
    assert!(text.contains("folder.rrd") && text.contains("folder that exists"), "{text}");
    assert!(refused(to_file(folder.path())).is_some_and(|text| text.contains("cannot write")));
    let to = |address: &str| Output { connect: Some(address.to_owned()), ..Output::default() };
    // Port 1 is nobody's; the answer comes at once.
    let text = refused(to("127.0.0.1:1")).unwrap_or_default();
    assert!(text.contains("127.0.0.1:1") && text.contains("no viewer answers"), "{text}");
    let text = refused(to("http://a b/")).unwrap_or_default();
    assert!(text.contains("no viewer's address"), "{text}");
    Ok(())
}

#[test]
fn a_wrong_address_leaves_an_old_recording_alone() -> Done {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("old.rrd");
    std::fs::write(&path, b"old")?;
    let output = Output { connect: Some("127.0.0.1:1".to_owned()), ..to_file(&path) };
    assert!(Recording::new(output, "", Vec::new(), "").open().is_err());
    assert_eq!(std::fs::read(&path)?, b"old");
    Ok(())
}

#[cfg(unix)]
#[test]
fn a_file_that_is_being_written_is_refused() -> Done {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("busy.rrd");
    let first = open(&path)?;
    let second = open(&path).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(second.contains("busy.rrd") && second.contains("another run"), "{second}");
    first.finish()?;
    open(&path)?.finish()?;
    Ok(())
}

#[test]
fn a_killed_run_leaves_the_old_file_and_one_that_opens() -> Done {
    if let Some(path) = std::env::var_os(CHILD).map(PathBuf::from) {
        let scene = scene(5);
        let mut sink = open(&path)?;
        sink.begin(&scene, &Settings::default());
        for step in 0..300 {
            push(&mut sink, &scene, step, step + 1);
            std::thread::sleep(Duration::from_millis(2));
        }
        grows(&path.with_extension("part.rrd"), 5000);
        std::process::abort();
    }
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("killed.rrd");
    std::fs::write(&path, b"old")?;
    let mut child = Command::new(std::env::current_exe()?);
    child.args(["--exact", "a_killed_run_leaves_the_old_file_and_one_that_opens"]).env(CHILD, &path);
    let status = child.stdout(Stdio::null()).stderr(Stdio::null()).status()?;
    assert!(!status.success());
    assert_eq!(std::fs::read(&path)?, b"old");
    let part = path.with_extension("part.rrd");
    assert!(length(&part) > 5000, "{}", length(&part));
    verify(&part, false)
}

#[test]
fn the_command_that_opens_a_file_is_quoted_where_it_must() {
    let command = |path: &str| viewer::open_command(Path::new(path));
    assert_eq!(command("out/run.rrd"), "rerun out/run.rrd");
    assert_eq!(command("my models/it's.rrd"), r"rerun 'my models/it'\''s.rrd'");
    assert_eq!(command("-x.rrd"), "rerun ./-x.rrd");
}
