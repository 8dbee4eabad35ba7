//! Impacts: of spheres, of a rocking block, of rods and corners.

use super::{G, error};
use crate::gallery::build::{body, cuboid, floor, scene, sphere, surface, then, turn};
use crate::gallery::figure::energy_rise;
use crate::gallery::{Exhibit, Group, Moment, Track};
use crate::measure::{cross, energy, length, mass_of, momentum, rotate, rotate_back};
use crate::scene::{Mass, Motion, Pose, Scene, Shape};

pub(super) const EXHIBITS: &[Exhibit] = &[
    Group::Exact.exhibit(
        "oblique-stick",
        "a sphere strikes the floor askew, and grips",
        0.2,
        || oblique(0.8),
        &[error("speed along the floor", "m/s", 1e-4, |t| oblique_error(t, 0.8))],
    ),
    Group::Exact.exhibit(
        "oblique-slip",
        "a sphere strikes the floor askew, and slips",
        0.2,
        || oblique(0.05),
        &[error("speed along the floor", "m/s", 1e-4, |t| oblique_error(t, 0.05))],
    ),
    Group::Exact.exhibit(
        "cradle-10",
        "Newton's cradle of five spheres, e = 1",
        2.0,
        || cradle(1.0),
        &[error("speed of the last", "", 1e-3, |t| cradle_error(t, 1.0))],
    ),
    Group::Exact.exhibit(
        "cradle-095",
        "Newton's cradle of five spheres, e = 0.95",
        2.0,
        || cradle(0.95),
        &[error("speed of the last", "", 1e-3, |t| cradle_error(t, 0.95))],
    ),
    Group::Exact.exhibit(
        "cradle-09",
        "Newton's cradle of five spheres, e = 0.9",
        2.0,
        || cradle(0.9),
        &[error("speed of the last", "", 1e-3, |t| cradle_error(t, 0.9))],
    ),
    Group::Exact.exhibit(
        "two-balls",
        "a small ball above a large one strike the floor",
        0.5,
        two_balls,
        &[error("speed of the small one", "", 1e-3, |t| {
            // After its own bounce at speed 1 the large ball meets the small one: v' = (3 m1 - m2) / (m1 + m2).
            let (large, small) = (1.0, 0.2f64.powi(3));
            let expected = (3.0 * large - small) / (large + small);
            (t.end().velocities[2].linear[1] / expected - 1.0).abs()
        })],
    ),
    Group::Exact.exhibit(
        "rocking-block",
        "a slender block rocks from edge to edge (Housner 1963)",
        3.0,
        rocking_block,
        &[
            error("energy kept by the first impact", "", 0.03, rocking_error),
            error("time to the first impact", "", 0.01, |t| {
                // A quarter of T = 4/p acosh(1 / (1 - θ0/α)) for θ0 = α/2, of the linear theory.
                first_upright_s(t).map_or(f64::INFINITY, |time| (time / (1.3868 / 4.0) - 1.0).abs())
            }),
        ],
    ),
    Group::Exact.exhibit(
        "painleve",
        "a rod slides on its tip into Painlevé's paradox",
        2.0,
        painleve,
        &[
            energy_rise(1e-6),
            error("fastest over the start", "", 3.0, |t| {
                let speed = |m: &Moment| length(m.velocities[1].linear) / 4.0;
                t.moments.iter().map(speed).fold(0.0, f64::max)
            }),
        ],
    ),
    Group::Exact.exhibit(
        "micro-rod",
        "rods strike the floor with a tip: eight micro-collisions",
        0.16,
        micro_rod,
        &[error("speed of the tip after", "m/s", 1e-4, |t| {
            let tip = |i: usize, rod: &Rod| {
                let after = contact_velocity(t, i, rod.arm());
                (after[0] - rod.after[0]).hypot(after[1] - rod.after[1])
            };
            RODS.iter().enumerate().map(|(i, rod)| tip(i + 1, rod)).fold(0.0, f64::max)
        })],
    ),
    Group::Exact.exhibit(
        "micro-box",
        "boxes strike the floor with a corner: five micro-collisions",
        0.083,
        micro_box,
        &[error("speed of the corner after", "m/s", 1e-4, |t| {
            let corner = |i: usize, after: &[f64; 3]| {
                let found = contact_velocity(t, i, z_up(BOX_ARM));
                let expected = z_up(*after);
                length(std::array::from_fn(|k| found[k] - expected[k]))
            };
            BOXES.iter().enumerate().map(|(i, (_, _, _, after))| corner(i + 1, after)).fold(0.0, f64::max)
        })],
    ),
];

const OBLIQUE_E: f64 = 0.6;

fn oblique(friction: f64) -> Scene {
    let s = surface(friction, OBLIQUE_E);
    let mut ball = sphere([0.0, 0.6, 0.0], 0.5, 1000.0, s);
    ball.velocity.linear = [1.0, -2.0, 0.0];
    scene("oblique", vec![floor(s), ball])
}

/// u_t' = 5/7 u_t where mu (1 + e) |u_n| ≥ 2/7 |u_t|, else u_t - mu (1 + e) |u_n|.
fn oblique_error(track: &Track, friction: f64) -> f64 {
    let normal = (4.0 + 2.0 * G * 0.1f64).sqrt();
    let most = friction * (1.0 + OBLIQUE_E) * normal;
    let expected = if most >= 2.0 / 7.0 { 5.0 / 7.0 } else { 1.0 - most };
    (track.end().velocities[1].linear[0] - expected).abs()
}

fn cradle(e: f64) -> Scene {
    let ball = |i: u32| {
        let mut ball = sphere([f64::from(i), 0.0, 0.0], 0.5, 1000.0, surface(0.0, e));
        if i == 0 {
            ball.pose.position[0] = -1.0;
            ball.velocity.linear = [1.0, 0.0, 0.0];
        }
        ball
    };
    let mut scene = scene("cradle", (0..5).map(ball).collect());
    scene.gravity = [0.0; 3];
    scene
}

/// Blow by blow the last ball leaves with ((1 + e) / 2)^(N - 1) of the first one's speed.
fn cradle_error(track: &Track, e: f64) -> f64 {
    (track.end().velocities[4].linear[0] / (0.5 * (1.0 + e)).powi(4) - 1.0).abs()
}

fn two_balls() -> Scene {
    let s = surface(0.0, 1.0);
    let falling = |y, radius| {
        let mut ball = sphere([0.0, y, 0.0], radius, 1000.0, s);
        ball.velocity.linear = [0.0, -1.0, 0.0];
        ball
    };
    let mut scene = scene("two-balls", vec![floor(s), falling(0.6, 0.5), falling(1.3, 0.1)]);
    scene.gravity = [0.0; 3];
    scene
}

/// Half width and half height of the rocking block, m: α = atan(b / h) = 11.310 degrees.
const ROCKING: [f64; 2] = [0.1, 0.5];

fn rocking_block() -> Scene {
    let s = surface(1.0, 0.0);
    let [b, h] = ROCKING;
    let lean = 0.5 * libm::atan2(b, h).to_degrees();
    let mut block = cuboid([0.0; 3], [b, h, 0.2], 1000.0, s);
    block.pose.rotation = turn([0.0, 0.0, 1.0], -lean);
    // The lower right edge stays on the floor at x = b.
    let edge = rotate(block.pose.rotation, [b, -h, 0.0]);
    block.pose.position = [b - edge[0], -edge[1], 0.0];
    scene("rocking-block", vec![floor(s), block])
}

/// Lean of the block about z, rad.
fn lean(moment: &Moment) -> f64 {
    2.0 * libm::atan2(moment.poses[1].rotation[2], moment.poses[1].rotation[3])
}

/// When the block is upright for the first time, s, between moments along a straight line.
fn first_upright_s(track: &Track) -> Option<f64> {
    track.moments.windows(2).find_map(|pair| {
        let (from, to) = (lean(&pair[0]), lean(&pair[1]));
        let share = from / (from - to);
        (from < 0.0 && to >= 0.0).then(|| pair[0].time_s + share * (pair[1].time_s - pair[0].time_s))
    })
}

/// Energy above the upright block at rest that is left at the second extreme of the lean, over that of the start:
/// (1 - 3/2 sin² α)² = 0.88794 by Housner's conservation of momentum about the new edge.
fn rocking_error(track: &Track) -> f64 {
    let Some(upright) = first_upright_s(track) else { return f64::INFINITY };
    let Motion::Dynamic(mass) = track.scene.entities[1].motion else { return f64::INFINITY };
    let rest = mass.mass_kg * G * ROCKING[1];
    let mut after = track.from(upright + 1e-9);
    let Some(mut extreme) = after.next() else { return f64::INFINITY };
    for moment in after {
        if lean(moment) < lean(extreme) {
            break;
        }
        extreme = moment;
    }
    let above_rest =
        |moment: &Moment| energy(&mass, &moment.poses[1], &moment.velocities[1], track.scene.gravity) - rest;
    (above_rest(extreme) / above_rest(track.start()) / 0.887_94 - 1.0).abs()
}

/// A uniform rod of 2 m at atan 2 to the floor, sliding on its tip at 4 m/s towards its lean, mu = 2 > 4/3.
fn painleve() -> Scene {
    let s = surface(2.0, 0.0);
    let degrees = libm::atan2(2.0, 1.0).to_degrees();
    let radius = 0.02;
    let i = 1.0 / 3.0;
    let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [i, 1e-3, i, 0.0, 0.0, 0.0] };
    let shape = Shape::Capsule { half_height: 1.0 - radius, radius };
    let mut rod = body("rod", mass, [0.0; 3], shape, s);
    rod.pose.rotation = turn([0.0, 0.0, 1.0], degrees - 90.0);
    let up = (1.0 - radius) * libm::sin(degrees.to_radians()) + radius;
    rod.pose.position = [0.0, up, 0.0];
    rod.velocity.linear = [-4.0, 0.0, 0.0];
    scene("painleve", vec![floor(s), rod])
}

/// A planar collision of a uniform rod (m = 1 kg, half length 1 m) at an angle to the floor: velocities of its tip
/// along and across the floor, by Stronge's energetic restitution integrated over the normal impulse.
struct Rod {
    degrees: f64,
    friction: f64,
    restitution: f64,
    before: [f64; 2],
    after: [f64; 2],
}

impl Rod {
    /// From the centre of mass to the tip, world. K_tn = -3 sin cos wants it down and to the left.
    fn arm(&self) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.degrees.to_radians());
        [-cos, -sin, 0.0]
    }
}

const fn rod(degrees: f64, friction: f64, restitution: f64, before: [f64; 2], after: [f64; 2]) -> Rod {
    Rod { degrees, friction, restitution, before, after }
}

const RODS: [Rod; 8] = [
    rod(45.0, 0.1, 0.5, [-1.0, -1.0], [-1.797_872, 0.5]),
    rod(45.0, 0.5, 0.5, [-1.0, -1.0], [-1.214_286, 0.5]),
    rod(45.0, 1.0, 0.5, [-1.0, -1.0], [0.0, 0.632_456]),
    rod(45.0, 0.5, 1.0, [-0.3, -1.0], [-0.585_714, 1.0]),
    rod(45.0, 0.5, 0.5, [0.5, -1.0], [-0.114_489, 0.392_334]),
    rod(45.0, 0.5, 1.0, [0.5, -1.0], [-0.170_537, 0.784_667]),
    rod(30.0, 0.6, 0.6, [0.1, -1.0], [-0.140_204, 0.562_422]),
    rod(63.4349, 2.0, 0.5, [-1.0, -1.0], [0.0, 0.662_628]),
];

/// Radius of the ball that makes the tip, m, and the height from which it comes.
const TIP: f64 = 1e-3;
const TIP_HEIGHT: f64 = 0.1;

fn micro_rod() -> Scene {
    let mut entities = vec![floor(surface(1.0, 0.0))];
    for (rod, k) in RODS.iter().zip(0..) {
        let i = 1.0 / 3.0;
        let mass = Mass { mass_kg: 1.0, inertia_kg_m2: [i, i, i, 0.0, 0.0, 0.0] };
        // The floor's friction is 1 and a pair takes the geometric mean.
        let s = surface(rod.friction * rod.friction, rod.restitution);
        let arm = rod.arm();
        let at = [0.0, TIP_HEIGHT - arm[1], 10.0 * f64::from(k)];
        let mut entity = body("rod", mass, at, Shape::Sphere { radius: TIP }, s);
        entity.shapes[0].body_from_shape.position = [arm[0], arm[1] + TIP, 0.0];
        entity.velocity.linear = [rod.before[0], rod.before[1], 0.0];
        entities.push(entity);
    }
    let mut scene = scene("micro-rod", entities);
    scene.gravity = [0.0; 3];
    scene
}

/// From axes with z up to ours.
const fn z_up([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, z, -y]
}

/// From the centre of mass to the lowest corner of the box, z up.
const BOX_ARM: [f64; 3] = [0.388_923, -0.209_808, -0.393_344];

/// mu, e, and the corner's velocity before and after, z up.
type Blow = (f64, f64, [f64; 3], [f64; 3]);

const BOXES: [Blow; 5] = [
    (0.1, 0.5, [1.0, 0.5, -2.0], [2.290_87, -1.049_15, 0.987_94]),
    (0.3, 0.5, [1.0, 0.5, -2.0], [1.948_97, -1.067_60, 0.960_91]),
    (0.3, 0.5, [-1.0, 0.5, -2.0], [0.536_05, -0.496_62, 0.835_63]),
    (0.8, 0.5, [1.0, 0.5, -2.0], [0.684_27, -0.426_56, 0.889_79]),
    (0.3, 1.0, [0.2, -0.4, -2.0], [1.864_92, -1.619_99, 1.998_88]),
];

fn micro_box() -> Scene {
    let mut entities = vec![floor(surface(1.0, 0.0))];
    let [x, y, z] = [0.5f64, 0.3, 0.1];
    let moment = |a: f64, b: f64| (a * a + b * b) / 3.0;
    let mass =
        Mass { mass_kg: 1.0, inertia_kg_m2: [moment(y, z), moment(x, z), moment(x, y), 0.0, 0.0, 0.0] };
    let tilt = then(turn([1.0, 0.0, 0.0], 30.0), turn([0.0, 1.0, 0.0], 20.0));
    for ((friction, restitution, before, _), k) in BOXES.iter().zip(0..) {
        let at = [10.0 * f64::from(k), 0.1 - BOX_ARM[2], 0.0];
        let shape = Shape::Box { half_extents: [x, y, z] };
        let mut entity = body("box", mass, at, shape, surface(friction * friction, *restitution));
        entity.pose.rotation = then(tilt, turn([1.0, 0.0, 0.0], -90.0));
        entity.velocity.linear = z_up(*before);
        entities.push(entity);
    }
    let mut scene = scene("micro-box", entities);
    scene.gravity = [0.0; 3];
    scene
}

/// Velocity of the point that touched, as it was just after: nothing acts on the body but the one blow, so that what
/// has stayed since are its momenta, not its spin, and it had not turned before.
fn contact_velocity(track: &Track, entity: usize, arm: [f64; 3]) -> [f64; 3] {
    let (end, start) = (track.end(), track.start().poses[entity]);
    let Some(mass) = mass_of(&track.scene.entities[entity]) else { return [f64::NAN; 3] };
    let turning_momentum =
        momentum(&mass, &Pose { position: [0.0; 3], ..end.poses[entity] }, &end.velocities[entity]);
    let body = rotate_back(start.rotation, turning_momentum.angular);
    // Both bodies' frames lie along their principal axes.
    let spin = rotate(start.rotation, std::array::from_fn(|k| body[k] / mass.inertia_kg_m2[k]));
    let turning = cross(spin, arm);
    std::array::from_fn(|k| end.velocities[entity].linear[k] + turning[k])
}
