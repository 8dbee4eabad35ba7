//! Nothing makes the ladder panic, lose a shape or change between runs.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use importer::collider::{Candidate, Shape, cheapest, ladder};
use importer::{Mesh, Options, measure, weld};
use proptest::prelude::*;

fn candidates(mesh: &Mesh) -> Vec<Candidate> {
    let welded = weld(mesh);
    ladder(&welded.mesh, &measure(&welded), &Options::default())
}

fn numbers(shape: &Shape) -> Vec<f64> {
    match shape {
        Shape::Sphere { center, radius } => [center.as_slice(), &[*radius]].concat(),
        Shape::Box { center, rotation, half_extents } => {
            [center.as_slice(), rotation.as_slice(), half_extents.as_slice()].concat()
        }
        Shape::Capsule { center, rotation, half_height, radius }
        | Shape::Cylinder { center, rotation, half_height, radius } => {
            [center.as_slice(), rotation.as_slice(), &[*half_height, *radius]].concat()
        }
        Shape::Frustum { center, rotation, half_height, radius_bottom, radius_top } => {
            [center.as_slice(), rotation.as_slice(), &[*half_height, *radius_bottom, *radius_top]].concat()
        }
        Shape::Hull { points } => points.iter().flatten().copied().collect(),
        Shape::TriangleMesh { positions, .. } => positions.iter().flatten().copied().collect(),
    }
}

/// Finite, and no convex shape without volume.
fn check(ladder: &[Candidate], diagonal: f64) -> Result<(), TestCaseError> {
    for candidate in ladder {
        let e = &candidate.error;
        for value in
            [e.surface_max, e.surface_p95, e.growth_max, e.growth_p95, e.outside_share, candidate.cost]
        {
            prop_assert!(value.is_finite() && value >= 0.0, "{candidate:?}");
        }
        for shape in &candidate.shapes {
            prop_assert!(numbers(shape).iter().all(|x| x.is_finite()), "{shape:?}");
            match shape {
                Shape::Box { half_extents, .. } => {
                    prop_assert!(half_extents.iter().all(|h| *h >= diagonal * 9e-4))
                }
                Shape::Cylinder { half_height, radius, .. } => {
                    prop_assert!(half_height.min(*radius) >= diagonal * 9e-4);
                }
                Shape::Sphere { radius, .. } | Shape::Capsule { radius, .. } => prop_assert!(*radius > 0.0),
                Shape::Hull { points } => prop_assert!(points.len() >= 4, "{points:?}"),
                Shape::Frustum { half_height, radius_bottom, radius_top, .. } => {
                    prop_assert!(half_height.min(*radius_bottom).min(*radius_top) >= diagonal * 9e-4);
                }
                Shape::TriangleMesh { .. } => {}
            }
        }
    }
    Ok(())
}

fn soup() -> impl Strategy<Value = Mesh> {
    let coordinate = prop_oneof![Just(0.0), Just(1.0), Just(-0.0), -1.0..1.0f64];
    (2usize..20).prop_flat_map(move |count| {
        let positions = prop::collection::vec(prop::array::uniform3(coordinate.clone()), count);
        let triangles = prop::collection::vec(prop::array::uniform3(0..count as u32), 0..25);
        (positions, triangles).prop_map(|(positions, triangles)| Mesh { positions, triangles })
    })
}

fn diagonal(mesh: &Mesh) -> f64 {
    let used: Vec<[f64; 3]> = mesh.triangles.iter().flatten().map(|i| mesh.positions[*i as usize]).collect();
    let side = |k: usize| {
        let along = || used.iter().map(|p| p[k]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    if used.is_empty() { 0.0 } else { (0..3).map(|k| side(k) * side(k)).sum::<f64>().sqrt() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn any_soup_at_any_scale_gives_usable_candidates(mesh in soup(), exponent in -6i32..=6, axis in 0usize..4) {
        let mut mesh = mesh;
        for p in &mut mesh.positions {
            // A quarter of the cases each: flat in x, y or z, and not flat.
            if axis < 3 {
                p[axis] = 0.5;
            }
            *p = p.map(|x| x * 10f64.powi(exponent));
        }
        // As read, not welded: the ladder must do without.
        let raw = ladder(&mesh, &measure(&weld(&mesh)), &Options::default());
        check(&raw, diagonal(&mesh))?;
        prop_assert_eq!(raw.is_empty(), diagonal(&mesh) == 0.0);
        if !raw.is_empty() {
            prop_assert!(cheapest(&raw, 0.02).is_some());
        }
        prop_assert_eq!(&raw, &ladder(&mesh, &measure(&weld(&mesh)), &Options::default()));
    }
}

#[test]
fn nothing_comes_of_nothing() {
    let point = [1.0, 2.0, 3.0];
    let one_point = Mesh { positions: vec![point; 3], triangles: vec![[0, 1, 2], [0, 0, 0]] };
    for mesh in [Mesh::default(), Mesh { positions: vec![point; 5], triangles: vec![] }, one_point] {
        let measures = measure(&weld(&mesh));
        assert!(ladder(&mesh, &measures, &Options::default()).is_empty());
    }
    assert!(cheapest(&[], 0.02).is_none());
}

#[test]
fn lines_and_sheets_get_thickness_and_say_so() {
    let line =
        Mesh { positions: vec![[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]], triangles: vec![[0, 1, 2]] };
    let sheet = Mesh {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    for mesh in [line, sheet] {
        let measures = measure(&weld(&mesh));
        let ladder = ladder(&mesh, &measures, &Options::default());
        let chosen = cheapest(&ladder, 0.02).expect("a candidate");
        assert!(chosen.error.surface_max < 0.002 && chosen.error.growth_max < 0.002, "{:?}", chosen.error);
        assert!(ladder.iter().any(|c| c.fallback.as_deref().is_some_and(|note| note.contains("thickened"))));
    }
}

#[test]
fn broken_numbers_and_indices_are_left_out() {
    let mut mesh = Mesh {
        positions: vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [f64::NAN; 3],
            [f64::INFINITY; 3],
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    };
    let measures = measure(&weld(&mesh));
    let sound = ladder(&mesh, &measures, &Options::default());
    mesh.triangles.extend([[0, 1, 4], [5, 1, 2], [0, 1, 99]]);
    assert_eq!(sound, ladder(&mesh, &measures, &Options::default()));
}

#[test]
fn scale_changes_nothing_but_the_unit() {
    let mesh = Mesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
    };
    let base = candidates(&mesh);
    // Powers of two scale floating-point numbers without rounding.
    for scale in [2f64.powi(-40), 2f64.powi(40)] {
        let mut scaled = mesh.clone();
        scaled.positions.iter_mut().flatten().for_each(|x| *x *= scale);
        for (a, b) in base.iter().zip(candidates(&scaled)) {
            assert_eq!((a.rung, a.error.surface_max, a.vertices), (b.rung, b.error.surface_max, b.vertices));
        }
    }
}
