//! Makes recordings to look at: `show scene|pile|wall|slow|gallery FILE.rrd [COUNT] [view|HOST:PORT]`.

mod models;

use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use sim::{Entity, RunLimit, Scene, Settings};
use viewer::{Gallery, Output, Recording, Slot, Visual, VisualMesh, open_command};

type Done = Result<(), Box<dyn Error>>;

fn main() -> Done {
    let args: Vec<String> = std::env::args().collect();
    let [_, what, file, rest @ ..] = args.as_slice() else { return Err("what and FILE.rrd, please".into()) };
    let count: usize = rest.first().map_or(Ok(0), |n| n.parse())?;
    let view = rest.get(1).is_some_and(|how| how == "view");
    let connect = rest.get(1).filter(|how| *how != "view").cloned();
    let output = Output { file: Some(PathBuf::from(file)), view, connect };
    match what.as_str() {
        "scene" => scene(output, models::teapot("teapot.glb"))?,
        "pile" => pile(output)?,
        "wall" | "slow" => wall(output, count.max(10), what == "slow")?,
        "gallery" => gallery(output, count.max(8))?,
        other => return Err(format!("{other}: scene, pile, wall, slow or gallery").into()),
    }
    eprintln!("{}", open_command(&PathBuf::from(file)));
    Ok(())
}

const LIMIT: RunLimit = RunLimit { max_time_s: 6.0, stop_at_rest: true };

fn world(name: &str, entities: Vec<Entity>) -> Scene {
    Scene::new(name, entities)
}

fn record(output: Output, scene: &Scene, visuals: Vec<Visual>) -> Done {
    let mut sink = Recording::new(output, scene.name.clone(), visuals, TABLE).open()?;
    sink.notices().iter().for_each(|notice| eprintln!("{notice}"));
    let start = Instant::now();
    let report = sim::run(scene, &Settings::default(), &LIMIT, &mut [&mut sink])?;
    let (ran, written) = (start.elapsed(), sink.finish()?);
    eprintln!("{} steps in {ran:.2?}, all written after {:.2?}, {written:?}", report.steps, start.elapsed());
    Ok(())
}

const TABLE: &str = "### household/teapot\n\n| attribute | value | unit | from |\n|---|---|---|---|\n\
| kind | rigid | | catalog.yaml:41 |\n| density | 2400 | kg/m3 | preset porcelain, catalog.yaml:212 |\n\
| mass | 0.61 | kg | shell 4 mm |\n| friction | 0.4 | | preset porcelain, catalog.yaml:214 |\n\
| restitution | 0.3 | | built-in default |\n";

fn scene(output: Output, model: models::Model) -> Done {
    let (body, visual) = model.entity(1, 0.1, [0.0, 0.0], 0.35);
    record(output, &world("teapot.glb", vec![models::floor(), body]), vec![visual])
}

fn pile(output: Output) -> Done {
    let (mut entities, mut visuals) = (vec![models::floor()], Vec::new());
    for (k, model) in (0u32..).zip(models::many(16)) {
        let at = [0.9 * f64::from(k % 4) - 1.4, 0.9 * f64::from(k / 4) - 1.4];
        let (mut body, visual) = model.entity(entities.len(), 0.2, at, 0.3 * f64::from(k % 5));
        body.name = format!("{} {k}", model.category);
        entities.push(body);
        visuals.push(visual);
    }
    record(output, &world("a room turned over", entities), visuals)
}

/// Cubes in a wall; `slow` steps at the pace of a heavy scene, to be killed on the way.
fn wall(output: Output, count: usize, slow: bool) -> Done {
    let mut entities = vec![models::floor()];
    for k in (0u32..).take(count) {
        let (column, row) = (k % 21, k / 21);
        let x = 0.52 * f64::from(column) + 0.26 * f64::from(row % 2) - 5.5;
        entities.push(models::cube(format!("cube {k}"), [x, 0.26 + 0.51 * f64::from(row), 0.0]));
    }
    let mut ball = models::cube("ball".to_owned(), [0.0, 2.0, 6.0]);
    ball.shapes[0].shape = sim::Shape::Sphere { radius: 0.6 };
    ball.velocity.linear = [0.0, 2.0, -14.0];
    entities.push(ball);
    let scene = world("wall", entities);
    if !slow {
        return record(output, &scene, Vec::new());
    }
    let mut sink = Recording::new(output, "slow", Vec::new(), "").open()?;
    let settings = Settings::default();
    let mut world = sim::World::new(&scene, &settings)?;
    sim::FrameSink::begin(&mut sink, &scene, &settings);
    for _ in 0..600 {
        sim::FrameSink::frame(&mut sink, &world.frame());
        world.step();
        std::thread::sleep(Duration::from_millis(10));
    }
    sink.finish()?;
    Ok(())
}

fn gallery(output: Output, count: usize) -> Done {
    let models = models::many(count);
    let slots =
        models.iter().map(|m| Slot { category: m.category.to_owned(), name: m.name.clone() }).collect();
    let gallery = Gallery::open(output, format!("{count} models"), "# Summary\n\nAll well.\n", slots)?;
    gallery.notices().iter().for_each(|notice| eprintln!("{notice}"));
    let start = Instant::now();
    for (slot, model) in models.iter().enumerate() {
        if slot % 13 == 7 {
            let meshes: Vec<VisualMesh> = model.meshes.clone();
            gallery.still(slot, meshes, "soft: not simulated yet");
        } else if slot % 29 != 11 {
            let (body, visual) = model.entity(1, 0.1, [0.0, 0.0], if slot % 3 == 0 { 0.25 } else { 0.0 });
            let scene = world(&model.name, vec![models::floor(), body]);
            let mut sink = gallery.sink(slot, vec![visual], TABLE);
            sim::run(&scene, &Settings::default(), &LIMIT, &mut [&mut sink])?;
        }
    }
    let (ran, written) = (start.elapsed(), gallery.finish()?);
    eprintln!("{ran:.2?}, all written after {:.2?}, {written:?}", start.elapsed());
    Ok(())
}
