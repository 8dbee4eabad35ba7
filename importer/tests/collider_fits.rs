//! Meshes of exact shapes give those shapes back, and the rungs' errors say so.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::f64::consts::{PI, TAU};

use importer::collider::{Candidate, ColliderError, Rung, Shape, cheapest, ladder, surface};
use importer::{Mesh, Options, measure, weld};

fn candidates(mesh: &Mesh) -> Vec<Candidate> {
    let welded = weld(mesh);
    ladder(&welded.mesh, &measure(&welded), &Options::default())
}

fn rung(ladder: &[Candidate], rung: Rung) -> &Candidate {
    ladder.iter().find(|candidate| candidate.rung == rung).unwrap_or_else(|| panic!("no {rung:?}"))
}

/// A surface of revolution about Y from a profile of (radius, height), bottom to top.
fn lathe(profile: &[(f64, f64)], around: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for &(radius, height) in profile {
        for step in 0..around {
            let (sin, cos) = (TAU * f64::from(step) / f64::from(around)).sin_cos();
            mesh.positions.push([radius * cos, height, radius * sin]);
        }
    }
    for ring in 0..profile.len() as u32 - 1 {
        for step in 0..around {
            let (a, b) = (ring * around + step, ring * around + (step + 1) % around);
            let (c, d) = (a + around, b + around);
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    mesh
}

fn sphere(radius: f64) -> Mesh {
    let profile: Vec<(f64, f64)> = (0..=24)
        .map(|i| {
            let angle = PI * f64::from(i) / 24.0;
            (radius * angle.sin(), -radius * angle.cos())
        })
        .collect();
    lathe(&profile, 48)
}

fn cylinder(radius: f64, half_height: f64) -> Mesh {
    lathe(&[(0.0, -half_height), (radius, -half_height), (radius, half_height), (0.0, half_height)], 64)
}

fn capsule(radius: f64, half_height: f64) -> Mesh {
    let cap = |side: f64| {
        (0..=12).map(move |i| {
            let angle = PI / 2.0 * f64::from(i) / 12.0;
            let angle = if side < 0.0 { angle } else { PI / 2.0 - angle };
            (radius * angle.sin(), side * (half_height + radius * angle.cos()))
        })
    };
    lathe(&cap(-1.0).chain(cap(1.0)).collect::<Vec<_>>(), 48)
}

fn cuboid(center: [f64; 3], half: [f64; 3]) -> Mesh {
    let positions = (0..8)
        .map(|i| std::array::from_fn(|k| center[k] + if i >> k & 1 == 0 { -half[k] } else { half[k] }))
        .collect();
    #[rustfmt::skip]
    let triangles = vec![
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ];
    Mesh { positions, triangles }
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        let offset = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| i + offset)));
    }
    all
}

/// Turned about an axis through the origin (Rodrigues), then moved.
fn placed(mut mesh: Mesh, axis: [f64; 3], angle: f64, offset: [f64; 3]) -> Mesh {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let k = axis.map(|x| x / length);
    let (sin, cos) = angle.sin_cos();
    for p in &mut mesh.positions {
        let along = k[0] * p[0] + k[1] * p[1] + k[2] * p[2];
        let cross = [k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2], k[0] * p[1] - k[1] * p[0]];
        *p = std::array::from_fn(|i| p[i] * cos + cross[i] * sin + k[i] * along * (1.0 - cos) + offset[i]);
    }
    mesh
}

fn worst(error: &ColliderError) -> f64 {
    error.surface_max.max(error.growth_max)
}

#[test]
fn a_box_is_a_box_wherever_it_stands() {
    for (angle, offset) in [(0.0, [0.0; 3]), (0.7, [5.0, -3.0, 100.0])] {
        let mesh = placed(cuboid([0.0; 3], [1.0, 2.0, 0.5]), [1.0, 2.0, 0.5], angle, offset);
        let ladder = candidates(&mesh);
        let chosen = cheapest(&ladder, 0.02).expect("a candidate");
        assert_eq!(chosen.rung, Rung::Box, "angle {angle}");
        assert!(worst(&chosen.error) < 1e-6, "{:?}", chosen.error);
        assert!((chosen.error.volume_ratio.expect("closed") - 1.0).abs() < 1e-6);
        let Shape::Box { center, half_extents, rotation } = &chosen.shapes[0] else { panic!("{chosen:?}") };
        let mut sides = *half_extents;
        sides.sort_by(f64::total_cmp);
        for (side, expected) in sides.iter().zip([0.5, 1.0, 2.0]) {
            assert!((side - expected).abs() < 1e-6, "{sides:?}");
        }
        for k in 0..3 {
            assert!((center[k] - offset[k]).abs() < 1e-6, "{center:?}");
        }
        if angle == 0.0 {
            assert_eq!(*rotation, [0.0, 0.0, 0.0, 1.0]);
        }
        assert!(!ladder.iter().any(|candidate| candidate.rung == Rung::Decomposition));
    }
}

#[test]
fn a_ball_is_a_ball() {
    let ladder = candidates(&placed(sphere(0.3), [0.0, 0.0, 1.0], 1.0, [1.0, 2.0, 3.0]));
    let chosen = cheapest(&ladder, 0.02).expect("a candidate");
    assert_eq!(chosen.rung, Rung::Sphere);
    // The mesh's own facets lie inside of the ball by r (1 - cos(pi / 24)), 0.3 % of the diagonal.
    assert!(worst(&chosen.error) < 4e-3, "{:?}", chosen.error);
    let Shape::Sphere { center, radius } = &chosen.shapes[0] else { panic!("{chosen:?}") };
    assert!((radius - 0.3).abs() < 3e-3, "{radius}");
    assert!((0..3).all(|k| (center[k] - [1.0, 2.0, 3.0][k]).abs() < 1e-3), "{center:?}");
}

#[test]
fn a_can_is_a_cylinder_and_a_pill_a_capsule() {
    for (axis, angle) in [([1.0, 0.0, 0.0], 0.0), ([1.0, 0.0, 0.0], PI / 2.0), ([1.0, 0.3, 0.2], 0.6)] {
        let offset = [1.0, 0.0, -2.0];
        let can = candidates(&placed(cylinder(0.5, 0.8), axis, angle, offset));
        let chosen = cheapest(&can, 0.02).expect("a candidate");
        assert_eq!(chosen.rung, Rung::Cylinder, "angle {angle}");
        let Shape::Cylinder { center, half_height, radius, .. } = &chosen.shapes[0] else {
            panic!("{chosen:?}")
        };
        assert!((radius - 0.5).abs() < 3e-3 && (half_height - 0.8).abs() < 3e-3, "{radius} {half_height}");
        assert!((0..3).all(|k| (center[k] - offset[k]).abs() < 3e-3), "{center:?}");

        let pill = candidates(&placed(capsule(0.4, 0.9), axis, angle, offset));
        let chosen = cheapest(&pill, 0.02).expect("a candidate");
        assert_eq!(chosen.rung, Rung::Capsule, "angle {angle}");
        assert!(worst(&chosen.error) < 5e-3, "{:?}", chosen.error);
    }
}

#[test]
fn rotations_put_the_shape_where_the_mesh_is() {
    let (axis, angle) = ([1.0, 0.3, 0.2], 0.6);
    let ladder = candidates(&placed(cylinder(0.2, 1.0), axis, angle, [0.0; 3]));
    let Shape::Cylinder { rotation: [x, y, z, w], .. } = rung(&ladder, Rung::Cylinder).shapes[0] else {
        panic!("no cylinder")
    };
    // The second column of the quaternion's matrix is where local Y goes.
    let turned = [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)];
    let expected =
        placed(Mesh { positions: vec![[0.0, 1.0, 0.0]], triangles: vec![] }, axis, angle, [0.0; 3]);
    let along: f64 = (0..3).map(|k| turned[k] * expected.positions[0][k]).sum();
    assert!(along.abs() > 1.0 - 1e-4, "{turned:?} against {:?}", expected.positions[0]);
}

/// Whether a point lies in the convex hull of the shape's points, by the separating directions of the hull's
/// own point pairs' cross products: exact for boxes, and enough to tell a filled notch from an open one.
fn inside_bounds(shape: &Shape, p: [f64; 3]) -> bool {
    let (points, _) = surface(shape);
    (0..3).all(|k| {
        let along = || points.iter().map(|q| q[k]);
        p[k] > along().fold(f64::INFINITY, f64::min) && p[k] < along().fold(f64::NEG_INFINITY, f64::max)
    })
}

fn l_profile() -> Mesh {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.5], [0.5, 0.5], [0.5, 2.0], [0.0, 2.0]];
    let mut mesh = Mesh::default();
    for z in [0.0, 1.0] {
        mesh.positions.extend(outline.map(|[x, y]| [x, y, z]));
    }
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]] {
        mesh.triangles.extend([[a, c, b], [a + 6, b + 6, c + 6]]);
    }
    for i in 0..6 {
        let j = (i + 1) % 6;
        mesh.triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    mesh
}

#[test]
fn an_l_keeps_its_notch_open() {
    let ladder = candidates(&l_profile());
    let chosen = cheapest(&ladder, 0.02).expect("a candidate");
    assert_eq!(chosen.rung, Rung::Primitives);
    assert_eq!(chosen.shapes.len(), 2);
    assert!(worst(&chosen.error) < 5e-3, "{:?}", chosen.error);
    assert!((chosen.error.volume_ratio.expect("closed") - 1.0).abs() < 0.02, "{:?}", chosen.error);
    for p in [[1.0, 1.0, 0.5], [0.6, 0.6, 0.5], [1.9, 0.6, 0.5]] {
        assert!(!chosen.shapes.iter().any(|shape| inside_bounds(shape, p)), "{p:?} is filled");
    }
    let hull = rung(&ladder, Rung::Hull);
    // The bridge over the notch is farthest from the mesh at (1.25, 1.25), 0.75 from either wall; the notch's
    // corner lies 0.5 from the hull's back. The diagonal is 3.
    assert!((hull.error.growth_max - 0.25).abs() < 3e-3, "{:?}", hull.error);
    assert!((hull.error.surface_max - 0.5 / 3.0).abs() < 3e-3, "{:?}", hull.error);
}

#[test]
fn a_table_is_its_top_and_its_legs() {
    let mut pieces = vec![cuboid([0.0, 0.75, 0.0], [0.8, 0.03, 0.5])];
    for (x, z) in [(-0.7, -0.4), (-0.7, 0.4), (0.7, -0.4), (0.7, 0.4)] {
        pieces.push(cuboid([x, 0.36, z], [0.04, 0.36, 0.04]));
    }
    let ladder = candidates(&joined(&pieces));
    let chosen = cheapest(&ladder, 0.02).expect("a candidate");
    assert_eq!(chosen.rung, Rung::Primitives);
    assert_eq!(chosen.shapes.len(), 5);
    assert!(chosen.shapes.iter().all(|shape| matches!(shape, Shape::Box { .. })), "{:?}", chosen.shapes);
    assert!(worst(&chosen.error) < 0.02, "{:?}", chosen.error);
    assert!(
        !chosen.shapes.iter().any(|shape| inside_bounds(shape, [0.0, 0.3, 0.0])),
        "the space below is filled"
    );
}

#[test]
fn a_cup_stays_hollow() {
    let wall = [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.85, 2.0), (0.85, 0.2), (0.0, 0.2)];
    let ladder = candidates(&lathe(&wall, 32));
    let chosen = cheapest(&ladder, 0.02).expect("a candidate");
    assert!(matches!(chosen.rung, Rung::Decomposition | Rung::Primitives), "{:?}", chosen.rung);
    assert!(chosen.error.growth_max < 0.035, "{:?}", chosen.error);
    assert!(chosen.error.volume_ratio.expect("closed") < 1.3, "{:?}", chosen.error);
}

#[test]
fn the_ladder_goes_from_cheap_to_dear_and_ends_with_the_mesh() {
    let ladder = candidates(&l_profile());
    let rungs: Vec<Rung> = ladder.iter().map(|candidate| candidate.rung).collect();
    assert_eq!(
        rungs,
        [
            Rung::Sphere,
            Rung::Box,
            Rung::Capsule,
            Rung::Cylinder,
            Rung::Frustum,
            Rung::Hull,
            Rung::Primitives,
            Rung::Decomposition,
            Rung::TriangleMesh
        ]
    );
    assert_ne!(cheapest(&ladder, 0.0).map(|chosen| chosen.rung), Some(Rung::TriangleMesh));
}
