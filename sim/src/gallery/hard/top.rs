//! H11: a heavy top on its tip.

use crate::gallery::build::{body, floor, scene, surface, turn};
use crate::gallery::criterion::Criterion;
use crate::gallery::figure::energy_rise;
use crate::gallery::{Exhibit, Group, Moment, Track};
use crate::measure::rotate;
use crate::scene::{Mass, Pose, Scene, Shape};

const G: f64 = 9.81;
/// A solid cone on its tip: kg, and m.
const MASS_KG: f64 = 30.0;
const HEIGHT: f64 = 0.4;
const RADIUS: f64 = 0.3;
/// Spin about its axis, rad/s, and the lean of the axis.
const SPIN: f64 = 75.0;
const LEAN_DEG: f64 = 15.0;

pub(super) const EXHIBITS: &[Exhibit] = &[Group::Hard.exhibit(
    "h11-heavy-top",
    "a cone spins on its tip at 75 rad/s and precesses steadily",
    3.0,
    heavy_top,
    &[
        Criterion { figure: "precession", unit: "", limit: 0.01, measure: precession_error },
        Criterion { figure: "nutation", unit: "rad", limit: 0.02, measure: nutation },
        energy_rise(1e-3),
    ],
)];

/// Moments about the axis and across it through the centre of mass, which is at 3/4 of the height above the tip.
fn moments() -> [f64; 2] {
    [0.3 * MASS_KG * RADIUS * RADIUS, MASS_KG * (0.15 * RADIUS * RADIUS + 0.0375 * HEIGHT * HEIGHT)]
}

/// The slow root of I1 W² cos θ - I3 w3 W + M g d = 0, I1 about the tip.
fn precession() -> f64 {
    let ([i3, across], d) = (moments(), 0.75 * HEIGHT);
    let a = (across + MASS_KG * d * d) * libm::cos(LEAN_DEG.to_radians());
    let (b, c) = (i3 * SPIN, MASS_KG * G * d);
    2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())
}

fn heavy_top() -> Scene {
    let [i3, across] = moments();
    let mass = Mass { mass_kg: MASS_KG, inertia_kg_m2: [across, i3, across, 0.0, 0.0, 0.0] };
    let s = surface(1.0, 0.0);
    let shape = Shape::Cone { half_height: 0.5 * HEIGHT, radius: RADIUS };
    let mut top = body("top", mass, [0.0; 3], shape, s);
    // The shape's tip is up, and the middle of its height is a quarter of it below the centre of mass.
    top.shapes[0].body_from_shape =
        Pose { position: [0.0, -0.25 * HEIGHT, 0.0], rotation: turn([1.0, 0.0, 0.0], 180.0) };
    top.pose.rotation = turn([0.0, 0.0, 1.0], -LEAN_DEG);
    let axis = rotate(top.pose.rotation, [0.0, 1.0, 0.0]);
    let turning = precession();
    // Of the turning, the part along the axis belongs to the spin.
    let along = SPIN - turning * axis[1];
    let d = 0.75 * HEIGHT;
    top.pose.position = axis.map(|x| d * x);
    top.velocity.angular = [axis[0] * along, axis[1] * along + turning, axis[2] * along];
    top.velocity.linear = crate::measure::cross([0.0, turning, 0.0], top.pose.position);
    scene("heavy-top", vec![floor(s), top])
}

fn axis(moment: &Moment) -> [f64; 3] {
    rotate(moment.poses[1].rotation, [0.0, 1.0, 0.0])
}

/// Angle by which the axis has gone round the vertical over that of steady precession, less 1.
fn precession_error(track: &Track) -> f64 {
    let heading = |moment: &Moment| {
        let [x, _, z] = axis(moment);
        libm::atan2(-z, x)
    };
    let turn = std::f64::consts::TAU;
    let mut round = 0.0;
    for pair in track.moments.windows(2) {
        let step = heading(&pair[1]) - heading(&pair[0]);
        round += step - turn * (step / turn).round();
    }
    (round / (precession() * track.duration_s()) - 1.0).abs()
}

/// Largest change of the lean.
fn nutation(track: &Track) -> f64 {
    let lean = |moment: &Moment| libm::acos(axis(moment)[1].clamp(-1.0, 1.0));
    track.moments.iter().map(|m| (lean(m) - LEAN_DEG.to_radians()).abs()).fold(0.0, f64::max)
}
