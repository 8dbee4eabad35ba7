//! Small scenes for the tests: SI, unit cubes of 1,000 kg, gravity as the project uses it.
#![allow(dead_code, unused_imports, reason = "each test file takes what it needs")]
#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

pub use sim::gallery::build::{self, body, child, cube, cuboid, fixed, floor, sphere};
use sim::{Entity, Frame, FrameSink, Pose, RunLimit, RunReport, Scene, Settings, Surface, Velocity};

pub const G: f64 = 9.81;

pub fn surface(friction: f64, restitution: f64) -> Surface {
    Surface::new(friction, restitution)
}

pub fn cylinder(position: [f64; 3], half_height: f64, radius: f64, surface: Surface) -> Entity {
    build::cylinder(position, half_height, radius, 1000.0, surface)
}

pub fn scene(entities: Vec<Entity>) -> Scene {
    build::scene("test", entities)
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
