//! H14: far from the origin everything goes as it does there.

use crate::gallery::build::{cube, cuboid, floor, scene, sphere, surface, turn};
use crate::gallery::criterion::Criterion;
use crate::gallery::{Exhibit, Group, Moment, Track};
use crate::measure::length;
use crate::scene::Scene;

/// m along x
const PLACES: [f64; 4] = [0.0, 1e3, 1e5, 1e7];
/// Bodies at each place.
const BODIES: usize = 4;

const fn apart(figure: &'static str, measure: fn(&Track) -> f64) -> Criterion {
    Criterion { figure, unit: "m", limit: 1e-3, measure }
}

pub(super) const EXHIBITS: &[Exhibit] = &[Group::Hard.exhibit(
    "h14-far",
    "the same little collapse at 0, 1e3, 1e5 and 1e7 m from the origin",
    2.0,
    far,
    &[
        apart("off the run at the origin, at 1e7 m", |track| difference(track, 3)),
        apart("at 1e5 m", |track| difference(track, 2)),
        apart("at 1e3 m", |track| difference(track, 1)),
    ],
)];

fn far() -> Scene {
    let s = surface(0.5, 0.2);
    let mut entities = vec![floor(s)];
    for x in PLACES {
        let mut tipping = cuboid([x + 0.25, 2.75, 0.0], [0.5, 0.25, 0.5], 1000.0, s);
        tipping.pose.rotation = turn([0.0, 0.0, 1.0], 10.0);
        entities.extend([cube([x, 0.5, 0.0], s), cube([x + 0.125, 1.5, 0.0], s), tipping]);
        entities.push(sphere([x - 0.125, 4.0, 0.125], 0.25, 1000.0, s));
    }
    scene("far", entities)
}

/// Largest distance between a body and its like at the origin, each from its own place.
fn difference(track: &Track, place: usize) -> f64 {
    let bodies: Vec<usize> = track.dynamic().collect();
    let apart = |moment: &Moment, n: usize| {
        let near = moment.poses[bodies[n]].position;
        let far = moment.poses[bodies[BODIES * place + n]].position;
        length([far[0] - PLACES[place] - near[0], far[1] - near[1], far[2] - near[2]])
    };
    let moments = track.moments.iter();
    moments.flat_map(|moment| (0..BODIES).map(move |n| apart(moment, n))).fold(0.0, f64::max)
}
