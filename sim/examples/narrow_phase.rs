//! Nanoseconds a pair of shapes beside the error of its depth, ours and parry's: `narrow_phase`.
//!
//! Each pair is moved through the same 2,000 poses, by a jump each (what a first meeting costs), by a drift of 2 mm a
//! pose (what falls and slides) and not at all (what rests). The error is that of the deepest point against the
//! distance of the supporting planes over 20,000 directions and about the best of them, in f64.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a tool for the terminal")]

use std::time::Instant;

use parry3d::math::{Pose as ParryPose, Rot3, Vector};
use parry3d::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::{Ball, Capsule, ConvexPolyhedron, Cuboid, Cylinder, Shape as ParryShape};
use sim::gallery::build::{cuboid, noise};
use sim::{Entity, Pose, Probe, Shape, Surface};

const POSES: u32 = 2_000;
const MARGIN: f64 = 0.02;

fn main() {
    let rock = |seed: u32| Shape::Hull {
        points: (0..12)
            .map(|i| {
                let axis = |k: u32| noise(100 * seed + i, k) - 0.5;
                let v = [axis(1), axis(2), axis(3)];
                let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                v.map(|x| 0.5 * x / length)
            })
            .collect(),
    };
    let cube = Shape::Box { half_extents: [0.5; 3] };
    let ball = Shape::Sphere { radius: 0.5 };
    let drum = Shape::Cylinder { half_height: 0.5, radius: 0.5 };
    let pill = Shape::Capsule { half_height: 0.3, radius: 0.3 };
    println!("pair                    jump ns      drift ns     rest ns     error m (jump)");
    println!("                       ours parry   ours parry   ours parry    ours    parry");
    // With how far apart their centres are: most poses overlap by a few centimetres.
    for (name, a, b, reach) in [
        ("box box", &cube, &cube, 1.1),
        ("hull hull (12)", &rock(1), &rock(2), 0.75),
        ("box hull", &cube, &rock(2), 0.95),
        ("sphere box", &ball, &cube, 1.0),
        ("sphere hull", &ball, &rock(1), 0.85),
        ("cylinder box", &drum, &cube, 1.1),
        ("cylinder cylinder", &drum, &drum, 1.05),
        ("capsule box", &pill, &cube, 0.9),
    ] {
        let mut row = String::new();
        for step in [1.0, 0.002, 0.0] {
            let poses: Vec<[Pose; 2]> = (0..POSES).map(|i| poses(i, step, reach)).collect();
            row += &format!("  {:5.0} {:5.0}", ours(a, b, &poses), parry(a, b, &poses));
        }
        let poses: Vec<[Pose; 2]> = (0..100).map(|i| poses(i, 1.0, reach)).collect();
        let [ours, parry] = errors(a, b, &poses);
        println!("{name:20} {row}   {ours:8.1e} {parry:8.1e}");
    }
}

/// A at the origin and B at `reach` metres from it; `step` is how much of a new place each pose brings.
fn poses(i: u32, step: f64, reach: f64) -> [Pose; 2] {
    let walk = |k: u32| {
        if step == 1.0 {
            noise(i, k) - 0.5
        } else {
            (noise(0, k) - 0.5) + step * f64::from(i % 50) * (noise(1, k) - 0.5)
        }
    };
    let (x, y, z) = (walk(1), walk(2), walk(3));
    let length = (x * x + y * y + z * z).sqrt();
    let position = [x, y, z].map(|v| v / length * reach);
    let turn = [walk(4), walk(5), walk(6), 1.0];
    let norm = turn.iter().map(|v| v * v).sum::<f64>().sqrt();
    [Pose::IDENTITY, Pose { position, rotation: turn.map(|v| v / norm) }]
}

fn entity(shape: &Shape) -> Entity {
    let mut entity = cuboid([0.0; 3], [0.5; 3], 1000.0, Surface::new(0.5, 0.0));
    entity.shapes[0].shape = shape.clone();
    entity
}

fn time(mut query: impl FnMut(&[Pose; 2]) -> usize, poses: &[[Pose; 2]]) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let begin = Instant::now();
        let found: usize = poses.iter().map(&mut query).sum();
        std::hint::black_box(found);
        best = best.min(begin.elapsed().as_secs_f64() * 1e9 / poses.len() as f64);
    }
    best
}

fn ours(a: &Shape, b: &Shape, poses: &[[Pose; 2]]) -> f64 {
    let mut probe = Probe::new(&entity(a), &entity(b)).unwrap();
    time(|poses| probe.query(*poses, MARGIN), poses)
}

fn parry_shape(shape: &Shape) -> Box<dyn ParryShape> {
    match shape {
        Shape::Sphere { radius } => Box::new(Ball::new(*radius as f32)),
        Shape::Box { half_extents } => Box::new(Cuboid::new(vector(*half_extents))),
        Shape::Capsule { half_height, radius } => {
            Box::new(Capsule::new_y(*half_height as f32, *radius as f32))
        }
        Shape::Cylinder { half_height, radius } => {
            Box::new(Cylinder::new(*half_height as f32, *radius as f32))
        }
        Shape::Hull { points } => {
            let points: Vec<Vector> = points.iter().map(|p| vector(*p)).collect();
            Box::new(ConvexPolyhedron::from_convex_hull(&points).unwrap())
        }
        _ => unreachable!("not among the pairs"),
    }
}

fn vector(v: [f64; 3]) -> Vector {
    Vector::from_array(v.map(|x| x as f32))
}

fn parry_pose(pose: &Pose) -> ParryPose {
    ParryPose::from_parts(vector(pose.position), Rot3::from_array(pose.rotation.map(|x| x as f32)))
}

fn parry_query(
    (a, b): (&dyn ParryShape, &dyn ParryShape),
    poses: &[Pose; 2],
    manifolds: &mut Vec<ContactManifold<(), ()>>,
) -> usize {
    let relative = parry_pose(&poses[0]).inv_mul(&parry_pose(&poses[1]));
    let _ = DefaultQueryDispatcher.contact_manifolds(&relative, a, b, MARGIN as f32, manifolds, &mut None);
    manifolds.len()
}

fn parry(a: &Shape, b: &Shape, poses: &[[Pose; 2]]) -> f64 {
    let (a, b) = (parry_shape(a), parry_shape(b));
    let mut manifolds = Vec::new();
    time(|poses| parry_query((a.as_ref(), b.as_ref()), poses, &mut manifolds), poses)
}

/// Largest error of the depth where the shapes overlap, ours and parry's, m.
fn errors(a: &Shape, b: &Shape, poses: &[[Pose; 2]]) -> [f64; 2] {
    let mut probe = Probe::new(&entity(a), &entity(b)).unwrap();
    let (parry_a, parry_b) = (parry_shape(a), parry_shape(b));
    let mut worst = [0.0_f64; 2];
    for poses in poses {
        let truth = depth(a, b, &poses[1]);
        if truth < 1e-3 {
            continue;
        }
        probe.forget();
        probe.query(*poses, MARGIN);
        let ours = probe.contacts().iter().map(|point| point.depth_m).fold(f64::MIN, f64::max);
        let mut manifolds = Vec::new();
        parry_query((parry_a.as_ref(), parry_b.as_ref()), poses, &mut manifolds);
        let points = manifolds.iter().flat_map(|manifold| &manifold.points);
        let theirs = points.map(|point| -f64::from(point.dist)).fold(f64::MIN, f64::max);
        for (worst, depth) in worst.iter_mut().zip([ours, theirs]) {
            *worst = worst.max((depth - truth).abs().min(1.0));
        }
    }
    worst
}

/// The least overlap over all directions.
fn depth(a: &Shape, b: &Shape, pose: &Pose) -> f64 {
    let overlap = |n: [f64; 3]| {
        let local = rotate_back(pose.rotation, n.map(|x| -x));
        support(a, n) + support(b, local) - n.iter().zip(pose.position).map(|(x, y)| x * y).sum::<f64>()
    };
    let golden = 2.399_963_229_728_653;
    let mut best = (f64::INFINITY, [0.0; 3]);
    for i in 0..20_000 {
        let y = 1.0 - (f64::from(i) + 0.5) / 10_000.0;
        let (sin, cos) = (golden * f64::from(i)).sin_cos();
        let across = (1.0 - y * y).sqrt();
        let n = [across * cos, y, across * sin];
        let found = overlap(n);
        if found < best.0 {
            best = (found, n);
        }
    }
    // Closer in, by chance.
    let mut width = 0.02;
    for i in 0..4_000_u32 {
        let near: [f64; 3] = std::array::from_fn(|k| best.1[k] + width * (noise(i, k as u32 + 11) - 0.5));
        let length = near.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = near.map(|x| x / length);
        let found = overlap(n);
        if found < best.0 {
            best = (found, n);
        } else {
            width *= 0.997;
        }
    }
    best.0
}

fn support(shape: &Shape, n: [f64; 3]) -> f64 {
    let dot = |p: &[f64; 3]| p.iter().zip(n).map(|(x, y)| x * y).sum::<f64>();
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Box { half_extents: h } => (0..3).map(|k| h[k] * n[k].abs()).sum(),
        Shape::Capsule { half_height, radius } => half_height * n[1].abs() + radius,
        Shape::Cylinder { half_height, radius } => half_height * n[1].abs() + radius * n[0].hypot(n[2]),
        Shape::Hull { points } => points.iter().map(dot).fold(f64::MIN, f64::max),
        _ => unreachable!("not among the pairs"),
    }
}

fn rotate_back([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let (x, y, z) = (-x, -y, -z);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let t = cross([x, y, z], v).map(|c| 2.0 * c);
    let u = cross([x, y, z], t);
    std::array::from_fn(|k| v[k] + w * t[k] + u[k])
}
