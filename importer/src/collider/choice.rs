//! Which candidate is taken, and why not the others.

use super::error::REACH;
use super::{Candidate, Rung};

/// The cheapest candidate for a moving body that keeps to `tolerance` (a share of the diagonal): 95 % of what
/// is seen of the mesh and of the collider lie within it of the other, and nothing beyond 1.75 times it. The
/// first way is what a contact gets wrong where the mesh is, the second what it invents where the mesh is not.
/// Where none keeps to it, the one that is least beyond. Never a triangle mesh; `None` only where the ladder has
/// nothing else.
#[must_use]
pub fn cheapest(ladder: &[Candidate], tolerance: f64) -> Option<&Candidate> {
    let convex = || ladder.iter().filter(|candidate| candidate.rung != Rung::TriangleMesh);
    convex()
        .filter(|candidate| candidate.error.excess(tolerance) <= 1.0)
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .or_else(|| convex().min_by(|a, b| a.error.excess(tolerance).total_cmp(&b.error.excess(tolerance))))
}

/// Why `candidate` is not what [`cheapest`] takes where `chosen` is; for `chosen` itself why it is.
#[must_use]
pub fn verdict(candidate: &Candidate, chosen: &Candidate, tolerance: f64) -> String {
    let keeps = candidate.error.excess(tolerance) <= 1.0;
    if std::ptr::eq(candidate, chosen) {
        return match (keeps, candidate.rung) {
            (_, Rung::TriangleMesh) => "the surface itself, since it never moves".to_owned(),
            (true, _) => "the cheapest that keeps to the tolerance".to_owned(),
            (false, _) => {
                format!("nearest to the tolerance, none keeps to it: {}", trouble(candidate, tolerance))
            }
        };
    }
    if candidate.rung == Rung::TriangleMesh {
        return "for things that never move".to_owned();
    }
    if keeps {
        format!("dearer: {:.1} against {:.1}", candidate.cost, chosen.cost)
    } else {
        trouble(candidate, tolerance)
    }
}

/// The bound that is broken by most.
fn trouble(candidate: &Candidate, tolerance: f64) -> String {
    let error = &candidate.error;
    let bounds = [
        ("95 % of the mesh within", error.surface_p95, tolerance),
        ("95 % of the collider within", error.growth_p95, tolerance),
        ("mesh as far as", error.surface_max, tolerance * REACH),
        ("collider as far as", error.growth_max, tolerance * REACH),
    ];
    let worst = bounds.iter().max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2)));
    worst.map_or_else(String::new, |(what, value, most)| {
        format!("{what} {:.2} %, allowed {:.2} %", value * 100.0, most * 100.0)
    })
}
