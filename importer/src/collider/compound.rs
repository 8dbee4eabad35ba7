//! Several primitives: the pieces of a decomposition that are a box, a ball, a capsule or a cylinder in all but
//! name are made one. A table is five boxes.

use super::ColliderError;
use super::error::{REACH, Reference};
use super::field::Field;
use super::fit_box;
use super::fit_round;
use super::fit_sphere;
use super::hull::Hull;
use super::ladder::THIN;
use super::prepared::Vec3;
use super::solid::Solid;

/// Points of a primitive's surface at which it is held against the mesh.
const CHECKS: usize = 160;
/// Times that pieces which err too much are given back their hulls.
const GIVING_BACK: usize = 4;

/// The pieces with primitives for hulls wherever the whole keeps to `tolerance` with them; `None` where there is
/// no such place.
pub(super) fn compound(
    reference: &Reference<'_>,
    field: &Field,
    hulls: &[Hull],
    tolerance: f64,
) -> Option<(Vec<Solid>, ColliderError)> {
    let mut pieces: Vec<Solid> = (0..hulls.len())
        .map(|i| primitive(field, hulls, i, tolerance).unwrap_or(Solid::Hull(hulls[i].clone())))
        .collect();
    let is_hull = |piece: &Solid| matches!(piece, Solid::Hull(_));
    for _ in 0..GIVING_BACK {
        if pieces.iter().all(is_hull) {
            return None;
        }
        let (errors, whole) = reference.measure_each(&pieces);
        if whole.excess(tolerance) <= 1.0 {
            return Some((pieces, whole));
        }
        // Those to blame for the farthest point, or else the worst half.
        let replaced =
            || errors.iter().zip(&pieces).filter(|(_, piece)| !is_hull(piece)).map(|(e, _)| e.worst());
        let mut worsts: Vec<f64> = replaced().collect();
        worsts.sort_by(f64::total_cmp);
        let bound = worsts.get(worsts.len() / 2).copied().unwrap_or(0.0).min(REACH * tolerance);
        for ((piece, error), hull) in pieces.iter_mut().zip(&errors).zip(hulls) {
            if error.worst() >= bound {
                *piece = Solid::Hull(hull.clone());
            }
        }
    }
    None
}

/// The cheapest primitive that stands for the hull.
fn primitive(field: &Field, hulls: &[Hull], own: usize, tolerance: f64) -> Option<Solid> {
    let hull = &hulls[own];
    let corners = &hull.vertices;
    let checks = Solid::Hull(hull.clone()).surface_points(64);
    let fitted = fit_box::fit(corners, Some(hull));
    let axes = fit_round::axes(&fitted);
    let thinnest = THIN / 2.0;
    let sphere = fit_sphere::fit(&checks).map(|(centre, radius)| Solid::Sphere { centre, radius });
    let mut thick = fitted;
    thick.half_extents.apply(|half| *half = half.max(thinnest));
    let capsule = || fit_round::fit_capsule(corners, &checks, &axes, thinnest).map(Solid::Capsule);
    let cylinder = || fit_round::fit_cylinder(corners, &checks, &axes, thinnest).map(Solid::Cylinder);
    let stands = |solid: &Solid| {
        let holds = checks.iter().all(|p| solid.distance(*p) <= tolerance * 0.5);
        let reaches = |p: &Vec3| {
            field.distance(*p) > tolerance * 1.2
                && !hulls.iter().enumerate().any(|(h, other)| h != own && other.plane_distance(*p) < 0.0)
        };
        // As far from the hull as from the mesh: a hollow that the hull spans is no leave to reach beyond it.
        let strays = checks.iter().any(|p| solid.distance(*p).abs() > tolerance * 1.5);
        holds && !strays && !solid.surface_points(CHECKS).iter().any(reaches)
    };
    sphere
        .filter(&stands)
        .or_else(|| Some(Solid::Box(thick)).filter(&stands))
        .or_else(|| capsule().filter(&stands))
        .or_else(|| cylinder().filter(&stands))
}
