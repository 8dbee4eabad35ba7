//! The shapes that stand for the model.

use importer::collider::{Rung, Shape};
use mapper::Kind;
use mapper::scene::SceneError;

use super::super::observation::Observation;
use super::Look;
use sim::measure;

#[expect(clippy::cast_precision_loss, reason = "counts of pieces and corners")]
pub(super) fn see(look: &Look<'_>, seen: &mut Vec<Observation>) {
    if look.mapped.kind != Kind::Rigid {
        return;
    }
    if let Err(SceneError::NoExtent { .. }) = look.body {
        seen.push(look.fact("GEO017", "its extents are not finite, or all zero"));
        return;
    }
    let Some(collider) = look.collider else {
        seen.push(look.fact("COL001", "the importer found no shape that could stand for it"));
        return;
    };
    let named = match collider.shapes.len() {
        1 => format!("its {}", collider.rung.name()),
        pieces => format!("its {} of {pieces} pieces", collider.rung.name()),
    };
    let error = &collider.error;
    let shares = [
        ("COL002", error.surface_p95, "off the mesh at the 95th percentile"),
        ("COL003", error.surface_max, "off the mesh at the worst point"),
        ("COL004", error.growth_max, "reaches beyond the mesh"),
        ("COL005", error.outside_share, "leaves mesh outside"),
    ];
    for (code, share, what) in shares {
        seen.push(look.measured(code, share * 100.0, format!("{named} {what}")));
    }
    if let Some(ratio) = error.volume_ratio.filter(|_| look.asset.measures.closed) {
        for code in ["COL006", "COL007"] {
            seen.push(look.measured(code, ratio, format!("{named} against the mesh's volume")));
        }
    }
    seen.push(look.measured("COL008", collider.shapes.len() as f64, named.clone()));
    // What never moves may be the surface itself, whose corners cost nothing.
    if collider.rung != Rung::TriangleMesh {
        seen.push(look.measured("COL009", collider.vertices as f64, named.clone()));
    }
    if let Some(detour) = &collider.fallback {
        seen.push(look.fact("COL010", detour.clone()));
    }
    let bare = collider.shapes.iter().any(|shape| matches!(shape, Shape::TriangleMesh { .. }));
    if bare && !look.mapped.anchored {
        seen.push(look.fact("COL011", "it moves, and its collider is a bare surface"));
    }
    if let Ok(body) = look.body
        && !look.mapped.anchored
    {
        let thinnest = measure::extents(&body.shapes).into_iter().fold(f64::INFINITY, f64::min);
        seen.push(look.measured("COL012", thinnest * 1e3, named));
    }
}
