//! SimBenchmark's rolling, bouncing and 666 scenes (leggedrobotics), in our own formulas.

use super::build::{cuboid, floor, noise, scene, sphere, surface};
use super::criterion::Criterion;
use super::figure::{energy_change, energy_rise};
use super::track::Track;
use super::{Exhibit, Group};
use crate::measure::Depths;
use crate::scene::{Entity, Scene, Surface};

/// Time mean of the squared velocity errors of the box and a ball, over that of their speeds at the end.
const ROLLING: Criterion =
    Criterion { figure: "velocity of box and ball", unit: "", limit: 1e-3, measure: rolling_error };

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::SimBench.exhibit(
        "sim-rolling",
        "a box slides down with 25 balls rolling on it",
        1.5,
        || rolling(0.0),
        &[ROLLING],
    ),
    Group::SimBench.exhibit(
        "sim-rolling-xy",
        "the same, askew to the axes",
        1.5,
        || rolling(30.0),
        &[ROLLING],
    ),
    Group::SimBench.exhibit(
        "sim-bouncing",
        "49 elastic balls bounce from 5 m",
        20.0,
        bouncing,
        &[energy_change(1e-4), energy_rise(1e-4)],
    ),
    Group::SimBench.exhibit(
        "sim-666",
        "216 balls pile up from a lattice",
        10.0,
        || lattice(0.101, 0.0),
        &[Criterion {
            figure: "time mean of the summed squared depths",
            unit: "m2",
            limit: 1e-3,
            measure: squared_depths,
        }],
    ),
    Group::SimBench.exhibit(
        "sim-666-elastic",
        "216 elastic balls bounce from a lattice",
        10.0,
        || lattice(1.101, 1.0),
        &[energy_change(1e-4), energy_rise(1e-4)],
    ),
];

/// Mass of box and balls, kg; how many; friction of box on floor and of ball on box; the slope, degrees.
const BOX_KG: f64 = 10.0;
const BALL_KG: f64 = 1.0;
const BALLS: u32 = 25;
const SLIDE: f64 = 0.4;
const SLOPE_DEG: f64 = 45.0;

/// The benchmark pushes the box; here the slope does: in the frame that falls along, the equations are the same.
/// `askew_deg`: how far from x the slope points.
fn rolling(askew_deg: f64) -> Scene {
    // Geometric means: 0.8 on the box and the balls, 0.2 on the floor give 0.4 and 0.8.
    let (grip, ground) = (surface(0.8, 0.0), surface(0.2, 0.0));
    let half = [8.0, 0.1, 8.0];
    let volume = 8.0 * half[0] * half[1] * half[2];
    let mut entities = vec![floor(ground), cuboid([0.0, half[1], 0.0], half, BOX_KG / volume, grip)];
    let radius = 0.1;
    let ball_density = BALL_KG / (4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius);
    for n in 0..BALLS {
        let at = |i: u32| 0.6 * (f64::from(i) - 2.0);
        entities.push(sphere([at(n % 5), 2.0 * half[1] + radius, at(n / 5)], radius, ball_density, grip));
    }
    let mut scene = scene("sim-rolling", entities);
    let [along, down, _] = super::build::slope(SLOPE_DEG);
    let (sin, cos) = libm::sincos(askew_deg.to_radians());
    scene.gravity = [along * cos, down, along * sin];
    scene
}

/// The box's way down: M d = -mu (M + n m) g_n - n m d / 3.5 with d = a - g_t, and a_ball = g_t + d / 3.5.
fn rolling_error(track: &Track) -> f64 {
    let [gx, gy, gz] = track.scene.gravity;
    let along = gx.hypot(gz);
    let n = f64::from(BALLS);
    let slower = -SLIDE * (BOX_KG + n * BALL_KG) * -gy / (BOX_KG + n * BALL_KG / 3.5);
    let accelerations = [along + slower, along + slower / 3.5];
    let unit = [gx / along, 0.0, gz / along];
    let error = |(i, acceleration): (usize, f64)| {
        let squares = track.moments.iter().map(|moment| {
            let v = moment.velocities[i].linear;
            let off: f64 = (0..3).map(|k| (v[k] - unit[k] * acceleration * moment.time_s).powi(2)).sum();
            off
        });
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        let mean = squares.sum::<f64>() / track.moments.len() as f64;
        mean.sqrt() / (acceleration * track.duration_s())
    };
    [(1, accelerations[0]), (2, accelerations[1])].into_iter().map(error).fold(0.0, f64::max)
}

fn ball(position: [f64; 3], s: Surface) -> Entity {
    let radius: f64 = 0.1;
    sphere(position, radius, 10.0 / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)), s)
}

fn bouncing() -> Scene {
    let s = surface(0.0, 1.0);
    let mut entities = vec![floor(s)];
    entities.extend((0..49).map(|n| ball([f64::from(n % 7), 5.0, f64::from(n / 7)], s)));
    scene("sim-bouncing", entities)
}

fn lattice(low: f64, e: f64) -> Scene {
    let s = surface(if e > 0.0 { 0.0 } else { 0.8 }, e);
    let mut entities = vec![floor(s)];
    for n in 0..216_u32 {
        let at = |i: u32, seed| 0.21 * f64::from(i) + 1e-3 * noise(n, seed);
        entities.push(ball([at(n % 6, 1), low + at(n / 36, 2), at(n / 6 % 6, 3)], s));
    }
    scene("sim-666", entities)
}

fn squared_depths(track: &Track) -> f64 {
    let depths = Depths::new(&track.scene);
    let sum = |moment: &super::Moment| -> f64 {
        depths.all(&moment.poses).iter().map(|overlap| overlap.depth_m * overlap.depth_m).sum()
    };
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let count = track.moments.len() as f64;
    track.moments.iter().map(sum).sum::<f64>() / count
}
