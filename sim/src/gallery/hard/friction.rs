//! H4 to H6 and H17: what friction alone decides.

use crate::gallery::build::{cube, cuboid, cylinder, floor, hull, scene, sphere, surface, turn};
use crate::gallery::criterion::Criterion;
use crate::gallery::figure::sink;
use crate::gallery::{Exhibit, Group, Moment, Track};
use crate::scene::{Entity, Scene, Surface};

const G: f64 = 9.81;

/// Where a thing must fall: the share of its height that it has kept at the end.
const fn falls(measure: fn(&Track) -> f64) -> Criterion {
    Criterion { figure: "height kept, must fall", unit: "", limit: 0.8, measure }
}

/// Height of the `n`th moving body at the end over that at the start.
fn kept(track: &Track, n: usize) -> f64 {
    let i = track.body(n);
    track.end().poses[i].position[1] / track.start().poses[i].position[1]
}

/// Above and below a limit of friction.
const ABOVE: f64 = 1.02;
const BELOW: f64 = 0.98;

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Hard.exhibit(
        "h4-arch-stands",
        "an arch of 31 voussoirs, t/R = 0.1104",
        60.0,
        || arch(0.1104),
        &[sink(0.05)],
    ),
    Group::Hard.exhibit(
        "h4-arch-falls",
        "the same, t/R = 0.1040: below Milankovitch's 0.1075",
        60.0,
        || arch(0.1040),
        &[falls(|track| kept(track, 15))],
    ),
    Group::Hard.exhibit(
        "h5-frame-stands",
        "two cards lean at 25 degrees, friction 2 % above the limit",
        10.0,
        || frame(ABOVE),
        &[sink(0.02)],
    ),
    Group::Hard.exhibit(
        "h5-frame-falls",
        "the same, friction 2 % below the limit",
        10.0,
        || frame(BELOW),
        &[falls(|track| kept(track, 0))],
    ),
    Group::Hard.exhibit(
        "h5-card-house",
        "a house of cards, five levels, 25 degrees, friction 0.7",
        60.0,
        card_house,
        &[sink(0.02)],
    ),
    Group::Hard.exhibit(
        "h6-logs-stand",
        "three logs, friction 2 % above 2 - √3",
        10.0,
        || logs(ABOVE),
        &[sink(0.05)],
    ),
    Group::Hard.exhibit(
        "h6-logs-fall",
        "three logs, friction 2 % below 2 - √3",
        10.0,
        || logs(BELOW),
        &[falls(|t| kept(t, 2))],
    ),
    Group::Hard.exhibit(
        "h6-spheres-stand",
        "four spheres, friction 2 % above √3 - √2",
        10.0,
        || four_spheres(ABOVE),
        &[sink(0.05)],
    ),
    Group::Hard.exhibit(
        "h6-spheres-fall",
        "four spheres, friction 2 % below √3 - √2",
        10.0,
        || four_spheres(BELOW),
        &[falls(|t| kept(t, 3))],
    ),
    Group::Hard.exhibit("h6-sphere-stack", "ten spheres on each other", 5.0, sphere_stack, &[sink(5e-3)]),
    Group::Hard.exhibit(
        "h17-sticks",
        "a cube on a slope at 0.98 of the critical angle's tangent",
        10.0,
        || slope_at(0.98),
        &[Criterion {
            figure: "creep from 0.5 s",
            unit: "m",
            limit: 1e-3,
            measure: |track| track.moved_since_m(0.5).1,
        }],
    ),
    Group::Hard.exhibit(
        "h17-slips",
        "a cube on a slope at 1.02 of the critical angle's tangent",
        4.0,
        || slope_at(1.02),
        &[Criterion {
            figure: "distance",
            unit: "",
            limit: 0.01,
            measure: |track| {
                let g = track.scene.gravity;
                let expected = 0.5 * (g[0] + 0.5 * g[1]) * 16.0;
                (track.end().poses[1].position[0] / expected - 1.0).abs()
            },
        }],
    ),
    Group::Hard.exhibit(
        "h17-fan",
        "32 cubes slide apart at 5 m/s in all directions",
        2.0,
        fan,
        &[
            Criterion { figure: "stopping distance", unit: "", limit: 5e-3, measure: fan_distance_error },
            Criterion { figure: "turned off course", unit: "m", limit: 1e-3, measure: fan_course_error },
        ],
    ),
    Group::Hard.exhibit(
        "h17-disc",
        "a disc spins on its face: 3 R w / 4 mu g to stop",
        4.0,
        disc,
        &[Criterion {
            figure: "time to stop",
            unit: "",
            limit: 0.05,
            measure: |track| {
                let stops = track.moments.iter().find(|m| m.velocities[1].angular[1].abs() < 1e-2);
                let expected = 3.0 * 0.5 * 10.0 / (4.0 * 0.3 * G);
                stops.map_or(f64::INFINITY, |moment| (moment.time_s / expected - 1.0).abs())
            },
        }],
    ),
    Group::Hard.exhibit(
        "h17-spin-slide",
        "a disc slides and spins: both end at the same moment, v / R w going to 0.653 (Farkas et al. 2003)",
        4.0,
        spinning_slide,
        &[
            Criterion { figure: "v / R w near the end", unit: "", limit: 0.1, measure: spin_slide_error },
            Criterion {
                figure: "between the ends of sliding and spinning",
                unit: "",
                limit: 0.05,
                measure: |track| {
                    let last = |moves: fn(&Moment) -> f64| {
                        let moving = track.moments.iter().rev().find(|m| moves(m) > 1e-2);
                        moving.map_or(0.0, |moment| moment.time_s)
                    };
                    let (slid, spun) = (last(slide_speed), last(spin_speed));
                    (slid - spun).abs() / slid.max(spun)
                },
            },
        ],
    ),
];

/// A semicircular arch of 31 voussoirs, mean radius 5 m, 1 m deep, its feet on the floor.
fn arch(thickness_over_radius: f64) -> Scene {
    let s = surface(0.8, 0.0);
    let (n, radius, depth) = (31_u32, 5.0, 0.5);
    let half = 0.5 * thickness_over_radius * radius;
    let mut entities = vec![floor(s)];
    for i in 0..n {
        let mut points = Vec::new();
        for k in [i, i + 1] {
            let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(k) / f64::from(n));
            for r in [radius - half, radius + half] {
                // The last foot must lie in the floor's plane, not a rounding below it.
                let y = if k == 0 || k == n { 0.0 } else { r * sin };
                points.extend([[-r * cos, y, -depth], [-r * cos, y, depth]]);
            }
        }
        entities.push(hull([0.0; 3], &points, 2000.0, s));
    }
    scene("arch", entities)
}

/// Length, thickness and half width of a card, m, and its lean.
const CARD: [f64; 3] = [0.4, 0.004, 0.1];
const LEAN_DEG: f64 = 25.0;

/// A card that leans by `side` · 25 degrees, its inner foot at `x` and `y`; the top towards +x for `side` 1.
fn card(x: f64, y: f64, side: f64, s: Surface) -> Entity {
    let [length, thick, half_wide] = CARD;
    let (sin, cos) = libm::sincos(LEAN_DEG.to_radians());
    // The foot is the corner at +side · thickness / 2 and -length / 2.
    let (a, b) = (0.5 * thick, 0.5 * length);
    let center = [x + side * (b * sin - a * cos), y + b * cos + a * sin, 0.0];
    let mut card = cuboid(center, [0.5 * thick, 0.5 * length, half_wide], 700.0, s);
    card.pose.rotation = turn([0.0, 0.0, 1.0], -side * LEAN_DEG);
    card
}

/// Two cards whose inner upper edges meet at x = `middle`.
fn two_cards(middle: f64, y: f64, s: Surface) -> [Entity; 2] {
    let spread = CARD[0] * libm::sin(LEAN_DEG.to_radians());
    [card(middle - spread, y, 1.0, s), card(middle + spread, y, -1.0, s)]
}

/// Moments about the foot give the limit (tan φ - t / L) / 2; the floor and the cards have the same friction.
fn frame(share: f64) -> Scene {
    let limit = 0.5 * (libm::tan(LEAN_DEG.to_radians()) - CARD[1] / CARD[0]);
    let s = surface(share * limit, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend(two_cards(0.0, 0.0, s));
    scene("frame", entities)
}

fn card_house() -> Scene {
    let s = surface(0.7, 0.0);
    let [length, thick, half_wide] = CARD;
    let (sin, cos) = libm::sincos(LEAN_DEG.to_radians());
    let spacing = 2.0 * (length * sin + thick);
    // The highest point of a leaning card is its outer upper edge.
    let rise = length * cos + thick * sin;
    let mut entities = vec![floor(s)];
    let mut y = 0.0;
    for level in (1..=5_u32).rev() {
        let at = |j: u32, count: u32| (f64::from(j) - 0.5 * f64::from(count - 1)) * spacing;
        entities.extend((0..level).flat_map(|j| two_cards(at(j, level), y, s)));
        for j in 0..level - 1 {
            let half = [0.5 * (spacing - 0.25 * thick), 0.5 * thick, half_wide];
            entities.push(cuboid([at(j, level - 1), y + rise + 0.5 * thick, 0.0], half, 700.0, s));
        }
        y += rise + thick;
    }
    scene("card-house", entities)
}

/// Two logs side by side and one on them, friction a share of 2 - √3; the floor grips.
fn logs(share: f64) -> Scene {
    let s = surface(share * (2.0 - 3f64.sqrt()), 0.0);
    let log = |x: f64, y: f64| {
        let mut log = cylinder([x, y, 0.0], 1.0, 0.5, 1000.0, s);
        log.pose.rotation = turn([1.0, 0.0, 0.0], 90.0);
        log
    };
    let up = 0.5 + 0.75f64.sqrt();
    scene("logs", vec![floor(surface(1.0, 0.0)), log(-0.5, 0.5), log(0.5, 0.5), log(0.0, up)])
}

/// Three spheres that touch and one on them, friction a share of √3 - √2; the floor grips.
fn four_spheres(share: f64) -> Scene {
    let s = surface(share * (3f64.sqrt() - 2f64.sqrt()), 0.0);
    let ring = 1.0 / 3f64.sqrt();
    let mut entities = vec![floor(surface(1.0, 0.0))];
    entities.extend((0..3).map(|k| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / 3.0);
        sphere([ring * cos, 0.5, ring * sin], 0.5, 1000.0, s)
    }));
    entities.push(sphere([0.0, 0.5 + (2.0_f64 / 3.0).sqrt(), 0.0], 0.5, 1000.0, s));
    scene("four-spheres", entities)
}

fn sphere_stack() -> Scene {
    let s = surface(0.6, 0.0);
    let mut entities = vec![floor(s)];
    entities.extend((0..10).map(|i| sphere([0.0, 0.5 + f64::from(i), 0.0], 0.5, 1000.0, s)));
    scene("sphere-stack", entities)
}

/// A cube of friction 0.5 on a slope whose tangent is a share of it.
fn slope_at(share: f64) -> Scene {
    let s = surface(0.5, 0.0);
    let mut scene = scene("slope", vec![floor(s), cube([0.0, 0.5, 0.0], s)]);
    scene.gravity = crate::gallery::build::slope(libm::atan(0.5 * share).to_degrees());
    scene
}

const FAN: u32 = 32;
const FAN_SPEED: f64 = 5.0;

fn fan_direction(k: u32) -> [f64; 2] {
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(FAN));
    [cos, sin]
}

fn fan() -> Scene {
    let s = surface(0.6, 0.0);
    let mut entities = vec![floor(s)];
    for k in 0..FAN {
        let [cos, sin] = fan_direction(k);
        let mut body = cuboid([8.0 * cos, 0.25, 8.0 * sin], [0.25; 3], 1000.0, s);
        body.velocity.linear = [FAN_SPEED * cos, 0.0, FAN_SPEED * sin];
        entities.push(body);
    }
    scene("fan", entities)
}

/// Way along its course and away from it, of every cube, m.
fn fan_ways(track: &Track) -> Vec<[f64; 2]> {
    (0..FAN)
        .zip(track.dynamic())
        .map(|(k, i)| {
            let [cos, sin] = fan_direction(k);
            let (from, to) = (track.start().poses[i].position, track.end().poses[i].position);
            let (x, z) = (to[0] - from[0], to[2] - from[2]);
            [x * cos + z * sin, z * cos - x * sin]
        })
        .collect()
}

fn fan_distance_error(track: &Track) -> f64 {
    let expected = FAN_SPEED * FAN_SPEED / (2.0 * 0.6 * G);
    fan_ways(track).iter().map(|[along, _]| (along / expected - 1.0).abs()).fold(0.0, f64::max)
}

fn fan_course_error(track: &Track) -> f64 {
    fan_ways(track).iter().map(|[_, across]| across.abs()).fold(0.0, f64::max)
}

const DISC_RADIUS: f64 = 0.5;

fn slide_speed(moment: &Moment) -> f64 {
    let [x, _, z] = moment.velocities[1].linear;
    x.hypot(z)
}

fn spin_speed(moment: &Moment) -> f64 {
    DISC_RADIUS * moment.velocities[1].angular[1].abs()
}

fn spinning_slide() -> Scene {
    let mut scene = disc();
    scene.entities[1].velocity.linear = [3.0, 0.0, 0.0];
    scene
}

/// At the last moment at which both are above a tenth of their start.
fn spin_slide_error(track: &Track) -> f64 {
    let fast = |m: &&Moment| slide_speed(m) > 0.3 && spin_speed(m) > 0.5;
    let last = track.moments.iter().rev().find(fast);
    last.map_or(f64::INFINITY, |m| (slide_speed(m) / spin_speed(m) / 0.653 - 1.0).abs())
}

fn disc() -> Scene {
    let s = surface(0.3, 0.0);
    let mut disc = cylinder([0.0, 0.05, 0.0], 0.05, DISC_RADIUS, 1000.0, s);
    disc.velocity.angular = [0.0, 10.0, 0.0];
    scene("disc", vec![floor(s), disc])
}
