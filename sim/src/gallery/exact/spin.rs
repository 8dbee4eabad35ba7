//! Free tops.

use super::error;
use crate::gallery::build::{body, scene, surface, turn};
use crate::gallery::figure::energy_change;
use crate::gallery::{Exhibit, Group, Moment, Track};
use crate::measure::{length, rotate, rotate_back};
use crate::scene::{Mass, Scene, Shape};

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Exact.exhibit(
        "top",
        "I: a free top of inertia 1, 2, 3 spun about its middle axis tumbles",
        20.0,
        || top(5.0),
        &[
            error("four reversals", "s", 0.01, |t| reversal_error(t, &[2.7411, 7.7670, 12.7929, 17.8189])),
            error("momentum", "", 1e-6, angular_momentum_error),
            energy_change(1e-6),
        ],
    ),
    Group::Exact.exhibit(
        "top-fast",
        "the same, twice as fast",
        8.0,
        || top(10.0),
        &[
            error("three reversals", "s", 0.01, |t| reversal_error(t, &[1.4905, 4.2436, 6.9967])),
            error("momentum", "", 1e-6, angular_momentum_error),
            energy_change(1e-6),
        ],
    ),
    Group::Exact.exhibit(
        "top-symmetric",
        "a free symmetric top precesses at L / I1",
        10.0,
        symmetric_top,
        &[
            error("precession", "rad", 1e-4, precession_error),
            error("momentum", "", 1e-6, angular_momentum_error),
            energy_change(1e-6),
        ],
    ),
];

fn free(mass: Mass, spin: [f64; 3]) -> Scene {
    let shape = Shape::Sphere { radius: 0.5 };
    let mut top = body("top", mass, [0.0; 3], shape, surface(0.5, 0.0));
    top.velocity.angular = spin;
    let mut scene = scene("top", vec![top]);
    scene.gravity = [0.0; 3];
    scene
}

fn top(spin: f64) -> Scene {
    free(Mass { mass_kg: 1.0, inertia_kg_m2: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0] }, [0.01, spin, 0.01])
}

/// Times at which the spin about the middle axis is zero, between moments along a straight line; against the
/// zeros of the Jacobi elliptic function that solves Euler's equations.
fn reversal_error(track: &Track, expected: &[f64]) -> f64 {
    let spin: Vec<f64> =
        track.moments.iter().map(|m| rotate_back(m.poses[0].rotation, m.velocities[0].angular)[1]).collect();
    let zeros: Vec<f64> = (1..spin.len())
        .filter(|&i| spin[i - 1] * spin[i] < 0.0)
        .map(|i| {
            let (from, to) = (track.moments[i - 1].time_s, track.moments[i].time_s);
            from + (to - from) * spin[i - 1] / (spin[i - 1] - spin[i])
        })
        .collect();
    if zeros.len() != expected.len() {
        return f64::INFINITY;
    }
    zeros.iter().zip(expected).map(|(zero, expected)| (zero - expected).abs()).fold(0.0, f64::max)
}

fn angular_momentum_error(track: &Track) -> f64 {
    let at = |moment| track.momentum(moment).angular;
    let start = at(track.start());
    let off = |moment| length(std::array::from_fn(|k| at(moment)[k] - start[k])) / length(start);
    track.moments.iter().map(off).fold(0.0, f64::max)
}

/// Inertia (2, 1, 2): symmetric about Y, tilted by 30 degrees, spinning about its axis and turning with it.
fn symmetric_top() -> Scene {
    let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [2.0, 1.0, 2.0, 0.0, 0.0, 0.0] };
    free(mass, [1.0, 4.0, 0.0])
}

/// Angle between the top's axis and where it must be: it turns about the constant L at the rate L / I1.
fn precession_error(track: &Track) -> f64 {
    let start = track.momentum(track.start()).angular;
    let l = length(start);
    let about = start.map(|x| x / l);
    let degrees_a_second = (l / 2.0).to_degrees();
    let axis_at = |moment: &Moment| rotate(moment.poses[0].rotation, [0.0, 1.0, 0.0]);
    let axis = axis_at(track.start());
    let off = |moment: &Moment| {
        let expected = rotate(turn(about, degrees_a_second * moment.time_s), axis);
        length(std::array::from_fn(|k| axis_at(moment)[k] - expected[k]))
    };
    track.moments.iter().map(off).fold(0.0, f64::max)
}
