//! Small scenes for the tests: SI, unit cubes of 1,000 kg, gravity as the project uses it.
#![allow(dead_code, unreachable_pub, reason = "each test file takes what it needs")]
#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use sim::{
    ChildShape, Entity, Frame, FrameSink, Mass, Motion, Pose, RunLimit, RunReport, Scene, Settings, Shape,
    Surface, Velocity,
};

pub const G: f64 = 9.81;

pub fn surface(friction: f64, restitution: f64) -> Surface {
    Surface { friction, restitution }
}

pub fn child(shape: Shape, surface: Surface) -> ChildShape {
    ChildShape { shape, body_from_shape: Pose::IDENTITY, surface, part: 0 }
}

pub fn body(name: &str, mass: Mass, position: [f64; 3], shape: Shape, surface: Surface) -> Entity {
    Entity {
        name: name.to_owned(),
        motion: Motion::Dynamic(mass),
        pose: Pose::at(position),
        velocity: Velocity::default(),
        shapes: vec![child(shape, surface)],
    }
}

pub fn sphere(position: [f64; 3], radius: f64, density: f64, surface: Surface) -> Entity {
    let mass_kg = density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let i = 0.4 * mass_kg * radius * radius;
    body(
        "sphere",
        Mass { mass_kg, inertia_kg_m2: [i, i, i, 0.0, 0.0, 0.0] },
        position,
        Shape::Sphere { radius },
        surface,
    )
}

pub fn cuboid(position: [f64; 3], half: [f64; 3], density: f64, surface: Surface) -> Entity {
    let mass_kg = density * 8.0 * half[0] * half[1] * half[2];
    let moment = |a: usize, b: usize| mass_kg / 3.0 * (half[a] * half[a] + half[b] * half[b]);
    let inertia_kg_m2 = [moment(1, 2), moment(0, 2), moment(0, 1), 0.0, 0.0, 0.0];
    body("box", Mass { mass_kg, inertia_kg_m2 }, position, Shape::Box { half_extents: half }, surface)
}

pub fn cube(position: [f64; 3], surface: Surface) -> Entity {
    cuboid(position, [0.5; 3], 1000.0, surface)
}

pub fn cylinder(position: [f64; 3], half_height: f64, radius: f64, surface: Surface) -> Entity {
    let mass_kg = 1000.0 * std::f64::consts::TAU * half_height * radius * radius;
    let across = mass_kg * (3.0 * radius * radius + 4.0 * half_height * half_height) / 12.0;
    let inertia_kg_m2 = [across, 0.5 * mass_kg * radius * radius, across, 0.0, 0.0, 0.0];
    body(
        "cylinder",
        Mass { mass_kg, inertia_kg_m2 },
        position,
        Shape::Cylinder { half_height, radius },
        surface,
    )
}

pub fn floor(surface: Surface) -> Entity {
    fixed("floor", Pose::IDENTITY, Shape::HalfSpace, surface)
}

pub fn fixed(name: &str, pose: Pose, shape: Shape, surface: Surface) -> Entity {
    Entity {
        name: name.to_owned(),
        motion: Motion::Static,
        pose,
        velocity: Velocity::default(),
        shapes: vec![child(shape, surface)],
    }
}

pub fn scene(entities: Vec<Entity>) -> Scene {
    Scene { name: "test".to_owned(), gravity: Scene::GRAVITY, entities, actions: Vec::new() }
}

/// Gravity tilted about z by `degrees`: a slope without turning the floor. Down the slope is +x.
pub fn slope(degrees: f64) -> [f64; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [G * sin, -G * cos, 0.0]
}

pub fn awake() -> Settings {
    Settings { sleeping: false, ..Settings::default() }
}

/// Every pose and velocity of one entity, a row a step.
#[derive(Default)]
pub struct Track {
    pub entity: usize,
    pub times: Vec<f64>,
    pub poses: Vec<Pose>,
    pub velocities: Vec<Velocity>,
    pub energy: Vec<f64>,
}

impl FrameSink for Track {
    fn begin(&mut self, _: &Scene, _: &Settings) {}

    fn frame(&mut self, frame: &Frame<'_>) {
        let rigid = frame.rigid.unwrap();
        self.times.push(frame.time_s);
        self.poses.push(rigid.poses[self.entity]);
        self.velocities.push(rigid.velocities[self.entity]);
        self.energy.push(frame.metrics.kinetic_j + frame.metrics.potential_j);
    }

    fn end(&mut self) {}
}

pub fn track(scene: &Scene, settings: &Settings, entity: usize, seconds: f64) -> (Track, RunReport) {
    let mut track = Track { entity, ..Track::default() };
    let limit = RunLimit { max_time_s: seconds, stop_at_rest: false };
    let report = sim::run(scene, settings, &limit, &mut [&mut track]).unwrap();
    (track, report)
}
