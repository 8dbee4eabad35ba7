//! The rungs, cheap to dear.

use super::error::Reference;
use super::fit_box::{self, FittedBox};
use super::hull::Hull;
use super::prepared::{Prepared, Vec3};
use super::solid::Solid;
use super::{Candidate, ColliderError, Rung, Shape, compound, decompose, fit_frustum, fit_round, fit_sphere};
use crate::Options;
use crate::asset::Mesh;
use crate::measure::Measures;

/// Least thickness given to flat shapes, as a share of the diagonal.
pub(super) const THIN: f64 = 0.002;
/// Corners of the hull on which orientations are searched.
const SEARCH_CORNERS: usize = 192;

/// Colliders that could stand for `mesh`, in file units, cheap to dear: sphere, box, capsule, cylinder,
/// cone frustum and hull always; where none of those keeps to `options.collider_tolerance` a convex
/// decomposition, and before it the same with primitives where they stand for its pieces; the mesh itself, for
/// statics, last.
///
/// `mesh` is taken as read, not welded. Empty where no triangle with finite corners spans a length. The
/// result depends on nothing but the arguments: equal input gives equal bits.
#[must_use]
pub fn ladder(mesh: &Mesh, measures: &Measures, options: &Options) -> Vec<Candidate> {
    let Some(prepared) = Prepared::from_mesh(mesh) else { return Vec::new() };
    let reference = Reference::new(&prepared, options.error_samples, measures);

    let mut rungs = Rungs { reference: &reference, ladder: Vec::new() };
    let coarse = Hull::of(&prepared.positions, SEARCH_CORNERS, 0.0).ok();
    primitives(&mut rungs, coarse.as_ref());
    hull(&mut rungs, options);
    if !rungs.ladder.iter().any(|candidate| candidate.error.excess(options.collider_tolerance) <= 1.0) {
        let count = prepared.triangles.len() as u64;
        if count <= options.max_decomposition_triangles {
            let made = decompose::decompose(&reference, options);
            let compound =
                compound::compound(&reference, &made.field, &made.pieces, options.collider_tolerance);
            if let Some((pieces, error)) = compound {
                rungs.push_measured(Rung::Primitives, pieces, error, None);
            }
            let pieces = made.pieces.into_iter().map(Solid::Hull).collect();
            rungs.push_measured(Rung::Decomposition, pieces, made.error, made.fallback);
        } else {
            let most = options.max_decomposition_triangles;
            rungs.note(format!("no decomposition: {count} triangles, at most {most}"));
        }
    }
    triangle_mesh(&mut rungs, options);
    rungs.ladder
}

struct Rungs<'a> {
    reference: &'a Reference<'a>,
    ladder: Vec<Candidate>,
}

impl Rungs<'_> {
    fn push(&mut self, rung: Rung, pieces: Vec<Solid>, fallback: Option<String>) {
        let error = self.reference.measure(&pieces);
        self.push_measured(rung, pieces, error, fallback);
    }

    fn push_measured(
        &mut self,
        rung: Rung,
        pieces: Vec<Solid>,
        error: ColliderError,
        fallback: Option<String>,
    ) {
        if !pieces.is_empty() {
            self.ladder.push(candidate(self.reference.mesh, rung, &pieces, error, fallback));
        }
    }

    /// Says on the last rung why there is no further one.
    fn note(&mut self, note: String) {
        if let Some(last) = self.ladder.last_mut() {
            last.fallback = Some(last.fallback.take().map_or(note.clone(), |had| format!("{had}; {note}")));
        }
    }
}

/// The pieces with what is known of them.
pub(super) fn candidate(
    mesh: &Prepared,
    rung: Rung,
    pieces: &[Solid],
    error: ColliderError,
    fallback: Option<String>,
) -> Candidate {
    Candidate {
        rung,
        error,
        vertices: pieces.iter().map(|piece| piece.corners() as u64).sum(),
        cost: pieces.iter().map(Solid::cost).sum(),
        shapes: pieces.iter().map(|piece| piece.shape(mesh)).collect(),
        fallback,
    }
}

fn primitives(rungs: &mut Rungs<'_>, coarse: Option<&Hull>) {
    let mesh = rungs.reference.mesh;
    let checks: Vec<Vec3> = rungs.reference.samples.seen_points().collect();
    // What holds the hull's corners holds the mesh; where the hull was cut down, all points are needed.
    let points: &[Vec3] = match coarse {
        Some(hull) if hull.residual < 1e-6 => &hull.vertices,
        _ => &mesh.positions,
    };
    let corners: Vec<Vec3> =
        points.iter().step_by(points.len().div_ceil(4000)).chain(&checks).copied().collect();

    if let Some((centre, radius)) = fit_sphere::fit(&corners) {
        rungs.push(Rung::Sphere, vec![Solid::Sphere { centre, radius }], None);
    }
    let mut fitted = fit_box::fit(points, coarse);
    let thickened = thicken(&mut fitted);
    rungs.push(Rung::Box, vec![Solid::Box(fitted)], thickened);

    let axes = fit_round::axes(&fitted);
    let few: Vec<Vec3> = checks.iter().step_by(checks.len().div_ceil(600).max(1)).copied().collect();
    if let Some(capsule) = fit_round::fit_capsule(points, &few, &axes, THIN / 2.0) {
        rungs.push(Rung::Capsule, vec![Solid::Capsule(capsule)], None);
    }
    if let Some(cylinder) = fit_round::fit_cylinder(points, &few, &axes, THIN / 2.0) {
        rungs.push(Rung::Cylinder, vec![Solid::Cylinder(cylinder)], None);
    }
    if let Some(frustum) = fit_frustum::fit(points, &few, &axes, THIN / 2.0) {
        rungs.push(Rung::Frustum, vec![Solid::Frustum(frustum)], None);
    }
}

fn thicken(fitted: &mut FittedBox) -> Option<String> {
    let thin = fitted.half_extents.min() < THIN / 2.0;
    fitted.half_extents.apply(|half| *half = half.max(THIN / 2.0));
    thin.then(|| format!("flat: thickened to {} % of the diagonal", THIN * 100.0))
}

fn hull(rungs: &mut Rungs<'_>, options: &Options) {
    let points = &rungs.reference.mesh.positions;
    if let Some((hull, thickened)) = Hull::of_any(points, options.hull_vertices, 0.0, THIN) {
        let note = thickened.then(|| format!("flat: thickened to {} % of the diagonal", THIN * 100.0));
        rungs.push(Rung::Hull, vec![Solid::Hull(hull.balanced())], note);
    }
}

/// The welded mesh itself: no error at all, and dear.
fn triangle_mesh(rungs: &mut Rungs<'_>, options: &Options) {
    let mesh = rungs.reference.mesh;
    let triangles: Vec<[u32; 3]> =
        mesh.triangles.iter().copied().filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let count = triangles.len() as u64;
    if count > options.max_collider_triangles {
        rungs
            .note(format!("no triangle mesh: {count} triangles, at most {}", options.max_collider_triangles));
        return;
    }
    if count == 0 {
        return;
    }
    rungs.ladder.push(Candidate {
        rung: Rung::TriangleMesh,
        error: ColliderError {
            volume_ratio: rungs.reference.volume.map(|_| 1.0),
            ..ColliderError::default()
        },
        vertices: mesh.positions.len() as u64,
        // A tree over the triangles: a contact visits a few of them, each dear.
        cost: 20.0 + (count as f64).log2() * 4.0,
        shapes: vec![Shape::TriangleMesh {
            positions: mesh.positions.iter().map(|p| mesh.to_file(*p)).collect(),
            triangles,
        }],
        fallback: None,
    });
}
