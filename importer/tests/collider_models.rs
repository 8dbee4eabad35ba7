//! Real models: no part is lost, the recorded errors are true, and nothing depends on the run or the thread.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

#[allow(dead_code, reason = "this test reads no table")]
mod support;

use std::path::{Path, PathBuf};

use importer::collider::{Candidate, cheapest, ladder, surface};
use importer::{Mesh, Options, discover, measure, read, weld};
use parry3d::math::{Pose, Vector};
use parry3d::query::PointQuery;
use parry3d::shape::ConvexPolyhedron;
use rayon::prelude::*;

/// Every so many of the category models; all of the small hard cases.
const STRIDE: usize = 31;
const SMALL_TRIANGLES: usize = 300;
/// Points looked at on a model.
const POINTS: usize = 1500;

fn sample(root: &Path, options: &Options) -> Vec<(PathBuf, Mesh)> {
    let paths = discover(root).unwrap();
    let hard = |path: &PathBuf| path.starts_with(root.join("hard"));
    let (hard, plain): (Vec<_>, Vec<_>) = paths.into_iter().partition(hard);
    let mesh = |path: &PathBuf| read(path, options).ok().map(|source| weld(&source.merged()).mesh);
    let plain = plain.into_iter().skip(STRIDE / 2).step_by(STRIDE);
    let plain = plain.filter_map(|path| mesh(&path).map(|mesh| (path, mesh)));
    let hard = hard.into_iter().filter_map(|path| mesh(&path).map(|mesh| (path, mesh)));
    plain.chain(hard.filter(|(_, mesh)| mesh.triangles.len() <= SMALL_TRIANGLES)).collect()
}

fn candidates(mesh: &Mesh, options: &Options) -> Vec<Candidate> {
    ladder(mesh, &measure(&weld(mesh)), options)
}

/// Largest distance from points of the mesh to the union of the shapes, a share of the diagonal; `None` where parry
/// makes no hull of a piece.
fn farthest_outside(mesh: &Mesh, chosen: &Candidate) -> Option<f64> {
    let vector = |p: [f64; 3]| Vector::new(p[0] as f32, p[1] as f32, p[2] as f32);
    let measures = measure(&weld(mesh));
    let scale = 1.0 / measures.diagonal();
    let unit = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| (p[k] - measures.min[k]) * scale) };
    let mut hulls = Vec::new();
    for shape in &chosen.shapes {
        let points: Vec<_> = surface(shape).0.iter().map(|p| vector(unit(p))).collect();
        hulls.push(ConvexPolyhedron::from_convex_hull(&points)?);
    }
    let mut worst = 0.0f32;
    for i in 0..POINTS {
        // A triangle by a step that shares no factor with most counts, and a place on it by the golden ratio.
        let triangle = mesh.triangles[i * 7919 % mesh.triangles.len()];
        let (u, v) = ((i as f64 * 0.618_034).fract(), (i as f64 * 0.754_878).fract());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let [a, b, c] = triangle.map(|corner| unit(&mesh.positions[corner as usize]));
        let p = vector(std::array::from_fn(|k| a[k] + (b[k] - a[k]) * u + (c[k] - a[k]) * v));
        let gaps = hulls.iter().map(|hull| hull.distance_to_point(&Pose::identity(), p, true));
        worst = worst.max(gaps.fold(f32::INFINITY, f32::min));
    }
    Some(f64::from(worst))
}

#[test]
fn no_part_is_lost_and_nothing_depends_on_the_run_or_the_thread() {
    let Some(root) = support::models() else { return };
    let options = Options::default();
    let models = sample(&root, &options);
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let results: Vec<String> = models
        .par_iter()
        .filter_map(|(path, mesh)| {
            let first = candidates(mesh, &options);
            if first != alone.install(|| candidates(mesh, &options)) {
                return Some(format!("{}: another run gave another ladder", path.display()));
            }
            let chosen = cheapest(&first, options.collider_tolerance)?;
            let outside = farthest_outside(mesh, chosen)?;
            // What sticks out further than the collider's record says would be a part that nobody knows is lost.
            let recorded = chosen.error.surface_max.max(options.collider_tolerance);
            (outside > recorded + 2e-3).then(|| format!("{}: {outside} outside", path.display()))
        })
        .collect();
    println!("{} models", models.len());
    assert!(models.len() > 20, "{}", models.len());
    assert!(results.is_empty(), "{results:#?}");
}
