//! Mass properties against closed forms, and the laws they keep.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

#[path = "support/shapes.rs"]
mod shapes;

use std::f64::consts::PI;

use importer::{BodyRole, MassProperties, Mesh, VolumeMethod, measure, weld};
use proptest::prelude::*;
use shapes::{cuboid, inside_out, sphere, tetrahedron, torus};

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} for {expected}, off by {:e}", found - expected);
}

#[track_caller]
fn all_near<const N: usize>(found: [f64; N], expected: [f64; N], tolerance: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        near(found, expected, tolerance);
    }
}

fn solid(mesh: &Mesh) -> (MassProperties, VolumeMethod) {
    let measures = measure(&weld(mesh));
    (measures.solid.unwrap(), measures.solid_method.unwrap())
}

fn shell(mesh: &Mesh) -> MassProperties {
    measure(&weld(mesh)).shell
}

/// Rotation by a unit quaternion, then a move.
fn moved(mesh: &Mesh, [x, y, z, w]: [f64; 4], offset: [f64; 3]) -> Mesh {
    let rotate = |[px, py, pz]: [f64; 3]| {
        let (tx, ty, tz) = (2.0 * (y * pz - z * py), 2.0 * (z * px - x * pz), 2.0 * (x * py - y * px));
        [
            px + w * tx + y * tz - z * ty + offset[0],
            py + w * ty + z * tx - x * tz + offset[1],
            pz + w * tz + x * ty - y * tx + offset[2],
        ]
    };
    Mesh {
        positions: mesh.positions.iter().map(|&at| rotate(at)).collect(),
        triangles: mesh.triangles.clone(),
    }
}

/// Trace, sum of principal minors, determinant: what a rotation leaves of a symmetric matrix.
fn invariants([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [f64; 3] {
    [
        xx + yy + zz,
        xx * yy + yy * zz + zz * xx - xy * xy - xz * xz - yz * yz,
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz),
    ]
}

fn box_inertia(mass: f64, [a, b, c]: [f64; 3]) -> [f64; 6] {
    let (aa, bb, cc) = (a * a, b * b, c * c);
    [bb + cc, aa + cc, aa + bb, 0.0, 0.0, 0.0].map(|value| mass * value / 12.0)
}

#[test]
fn an_offset_box() {
    let (found, method) = solid(&cuboid([10.0, -3.0, 5.0], [12.0, 0.0, 9.0]));
    assert_eq!(method, VolumeMethod::Closed);
    near(found.measure, 24.0, 1e-12);
    all_near(found.centroid, [11.0, -1.5, 7.0], 1e-12);
    all_near(found.inertia, box_inertia(24.0, [2.0, 3.0, 4.0]), 1e-11);
}

#[test]
fn a_box_of_sheet() {
    let (a, b, c) = (2.0, 3.0, 4.0);
    let found = shell(&cuboid([0.0; 3], [a, b, c]));
    near(found.measure, 52.0, 1e-12);
    all_near(found.centroid, [1.0, 1.5, 2.0], 1e-12);
    // Faces in pairs: ∫ x² over those across x is 2 bc (a/2)², over the others 2 (ab + ac) a² / 12.
    let second = |a: f64, b: f64, c: f64| b * c * a * a / 2.0 + (a * b + a * c) * a * a / 6.0;
    let (xx, yy, zz) = (second(a, b, c), second(b, c, a), second(c, a, b));
    all_near(found.inertia, [yy + zz, xx + zz, xx + yy, 0.0, 0.0, 0.0], 1e-11);
}

#[test]
fn a_corner_tetrahedron() {
    let (found, _) = solid(&tetrahedron([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]));
    near(found.measure, 1.0 / 6.0, 1e-15);
    all_near(found.centroid, [0.25; 3], 1e-15);
    // ∫ x² = 1/60 and ∫ x y = 1/120 about the corner, less the centroid's share.
    let (square, product) = (1.0 / 60.0 - 1.0 / 96.0, 1.0 / 120.0 - 1.0 / 96.0);
    let (on, off) = (2.0 * square, -product);
    all_near(found.inertia, [on, on, on, off, off, off], 1e-15);
}

#[test]
fn a_sphere_converges_as_its_mesh_is_refined() {
    let error = |n: u32| {
        let (found, method) = solid(&sphere(n));
        assert_eq!(method, VolumeMethod::Closed);
        let volume = 4.0 / 3.0 * PI;
        let inertia = (found.inertia[0] / (0.4 * volume) - 1.0).abs();
        (found.measure / volume - 1.0).abs().max(inertia)
    };
    let (coarse, fine) = (error(16), error(32));
    assert!(fine < 3e-3, "{fine:e}");
    near(coarse / fine, 4.0, 0.3);
    let sheet = shell(&sphere(64));
    near(sheet.measure / (4.0 * PI), 1.0, 1e-3);
    near(sheet.inertia[2] / (8.0 / 3.0 * PI), 1.0, 2e-3);
}

#[test]
fn a_torus_converges_to_pappus() {
    let (big, small) = (3.0, 1.0);
    let (found, _) = solid(&torus(big, small, 256));
    let volume = 2.0 * PI * PI * big * small * small;
    near(found.measure / volume, 1.0, 1e-3);
    near(found.inertia[2] / (volume * (big * big + 0.75 * small * small)), 1.0, 1e-3);
    near(found.inertia[0] / (volume * (4.0 * big * big + 5.0 * small * small) / 8.0), 1.0, 1e-3);
}

#[test]
fn a_cavity_is_taken_away_and_an_inside_out_body_is_not() {
    let outer = cuboid([0.0; 3], [4.0; 3]);
    let mut inner = cuboid([1.0; 3], [2.0, 3.0, 3.0]);
    inside_out(&mut inner);
    let mut hollow = outer.clone();
    hollow.append(&inner);
    let (found, method) = solid(&hollow);
    assert_eq!(method, VolumeMethod::Closed);
    near(found.measure, 60.0, 1e-12);
    all_near(found.centroid, [(64.0 * 2.0 - 4.0 * 1.5) / 60.0, 2.0, 2.0], 1e-12);

    let mut beside = outer;
    beside.append(&moved(&inner, [0.0, 0.0, 0.0, 1.0], [10.0, 0.0, 0.0]));
    let (found, method) = solid(&beside);
    assert_eq!(method, VolumeMethod::Oriented);
    near(found.measure, 68.0, 1e-12);
    let measures = measure(&weld(&beside));
    assert_eq!(measures.inside_out_bodies, 1);
    near(measures.signed_volume.unwrap(), 60.0, 1e-12);
}

#[test]
fn flipped_faces_are_turned_back() {
    let mut mesh = sphere(12);
    let (upright, _) = solid(&mesh);
    for triangle in mesh.triangles.iter_mut().step_by(3) {
        triangle.swap(0, 1);
    }
    let (found, method) = solid(&mesh);
    assert_eq!(method, VolumeMethod::Oriented);
    near(found.measure, upright.measure, 1e-12);
    all_near(found.inertia, upright.inertia, 1e-12);
}

#[test]
fn an_open_box_is_closed_by_a_cap_and_a_sheet_encloses_nothing() {
    let mut open = cuboid([0.0; 3], [1.0, 2.0, 3.0]);
    open.triangles.truncate(10);
    let (found, method) = solid(&open);
    assert_eq!(method, VolumeMethod::Capped);
    near(found.measure, 6.0, 1e-9);
    open.triangles.truncate(2);
    let sheet = measure(&weld(&open));
    assert_eq!((sheet.solid, sheet.solid_method, sheet.hull_volume), (None, None, None));
    near(sheet.shell.measure, 6.0, 1e-12);
}

#[test]
fn bodies_are_told_apart_by_what_they_are_to_the_solid() {
    let mut mesh = cuboid([0.0; 3], [4.0; 3]);
    let mut hollow = cuboid([1.0; 3], [2.0; 3]);
    inside_out(&mut hollow);
    mesh.append(&hollow);
    mesh.append(&cuboid([2.5; 3], [3.5; 3]));
    mesh.append(&cuboid([10.0; 3], [11.0, 11.0, 10.0]));
    let measures = measure(&weld(&mesh));
    let told: Vec<(BodyRole, f64)> =
        measures.body_volumes.iter().map(|body| (body.role, body.volume)).collect();
    assert_eq!(told[0], (BodyRole::Outer, 64.0));
    assert!(told.contains(&(BodyRole::Cavity, 1.0)) && told.contains(&(BodyRole::Inner, 1.0)), "{told:?}");
}

#[test]
fn six_squares_a_hair_apart_make_a_cube() {
    let cube = cuboid([0.0; 3], [1.0; 3]);
    let mut apart = Mesh::default();
    for (face, pair) in cube.triangles.chunks(2).enumerate() {
        let hair = 3e-8 * face as f64;
        let square = Mesh { positions: cube.positions.clone(), triangles: pair.to_vec() };
        apart.append(&moved(&square, [0.0, 0.0, 0.0, 1.0], [hair, -hair, hair]));
    }
    let measures = measure(&weld(&apart));
    assert_eq!((measures.closed, measures.bodies), (false, 6));
    assert_eq!(measures.solid_method, Some(VolumeMethod::Oriented));
    near(measures.solid.unwrap().measure, 1.0, 1e-6);
}

fn unit_quaternion() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-1.0..1.0_f64).prop_filter_map("too short", |q: [f64; 4]| {
        let length = q.iter().map(|value| value * value).sum::<f64>().sqrt();
        (length > 0.1).then(|| q.map(|value| value / length))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn a_tilted_box_keeps_its_principal_moments(
        size in prop::array::uniform3(0.1..5.0_f64),
        turn in unit_quaternion(),
        offset in prop::array::uniform3(-20.0..20.0_f64),
    ) {
        let half = size.map(|side| side / 2.0);
        let mesh = moved(&cuboid(half.map(|side| -side), half), turn, offset);
        let (found, method) = solid(&mesh);
        prop_assert_eq!(method, VolumeMethod::Closed);
        let volume = size[0] * size[1] * size[2];
        prop_assert!((found.measure / volume - 1.0).abs() < 1e-11);
        for (centroid, offset) in found.centroid.into_iter().zip(offset) {
            prop_assert!((centroid - offset).abs() < 1e-11);
        }
        let expected = invariants(box_inertia(volume, size));
        for (found, expected) in invariants(found.inertia).into_iter().zip(expected) {
            prop_assert!((found / expected - 1.0).abs() < 1e-9, "{} for {}", found, expected);
        }
    }

    #[test]
    fn volume_and_area_do_not_care_where_and_how_a_tetrahedron_lies(
        corners in prop::array::uniform4(prop::array::uniform3(-1.0..1.0_f64)),
        turn in unit_quaternion(),
        offset in prop::array::uniform3(-50.0..50.0_f64),
    ) {
        let mesh = tetrahedron(corners);
        let (here, there) = (measure(&weld(&mesh)), measure(&weld(&moved(&mesh, turn, offset))));
        prop_assert!((here.shell.measure / there.shell.measure - 1.0).abs() < 1e-10);
        let (here, there) = (here.signed_volume.unwrap(), there.signed_volume.unwrap());
        prop_assert!((here - there).abs() < 1e-12);
    }

    #[test]
    fn any_soup_has_a_solid_that_could_be_or_none(
        positions in prop::collection::vec(prop::array::uniform3(-2..3_i32), 3..12),
        corners in prop::collection::vec(prop::array::uniform3(0..100_u32), 1..30),
    ) {
        let count = positions.len() as u32;
        let mesh = Mesh {
            positions: positions.into_iter().map(|position| position.map(f64::from)).collect(),
            triangles: corners.into_iter().map(|three| three.map(|corner| corner % count)).collect(),
        };
        let measures = measure(&weld(&mesh));
        prop_assert_eq!(measures.solid.is_some(), measures.solid_method.is_some());
        if let Some(solid) = measures.solid {
            prop_assert!(solid.measure > 0.0);
            // Every principal moment is at most the sum of the others: I ≤ tr(I)/2 in every direction.
            let [xx, yy, zz, ..] = solid.inertia;
            for moment in [xx, yy, zz] {
                prop_assert!(moment <= (xx + yy + zz) / 2.0 * (1.0 + 1e-9));
            }
        }
    }
}
