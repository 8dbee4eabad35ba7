//! The mesh, its size, its unit.

use super::super::observation::Observation;
use super::super::rule::written;
use super::Look;

#[expect(clippy::cast_precision_loss, reason = "counts of triangles")]
pub(super) fn see(look: &Look<'_>, seen: &mut Vec<Observation>) {
    let measures = &look.asset.measures;
    let metres = look.mapped.scale.metres_per_unit;
    let mut size = measures.size();
    size.sort_by(f64::total_cmp);
    let [shortest, _, longest] = size;
    if !measures.closed {
        let message = format!("{} boundary edges", measures.boundary_edges);
        seen.push(look.fact("GEO001", message));
    }
    if measures.inside_out_bodies > 0 {
        let message = format!("{} of {} bodies are inside out", measures.inside_out_bodies, measures.bodies);
        seen.push(look.fact("GEO002", message));
    }
    if measures.closed && !measures.wound_consistently {
        seen.push(look.fact("GEO003", "neighbouring triangles are wound against each other"));
    }
    let triangles = measures.triangles.max(1) as f64;
    let degenerate = measures.degenerate_triangles;
    let message = format!("{degenerate} of {} triangles have no area", measures.triangles);
    seen.push(look.measured("GEO004", degenerate as f64 * 100.0 / triangles, message));
    let edges = measures.nonmanifold_edges;
    let message = format!("{edges} edges are shared by more than two triangles");
    seen.push(look.measured("GEO005", edges as f64 * 100.0 / triangles, message));
    if longest > 0.0 {
        let message = format!(
            "its shortest side is {} and its longest {} file units",
            written(shortest),
            written(longest)
        );
        seen.push(look.measured("GEO006", shortest * 100.0 / longest, message));
    }
    if let Some(range) = &look.ranges.size {
        let message = format!(
            "{} m long, taking a file unit for {} m ({}); {} is {} to {} m",
            written(longest * metres),
            written(metres),
            look.mapped.scale.reason,
            look.a_thing(),
            range.low,
            range.high
        );
        let observation = look.measured("GEO007", range.excess(longest * metres), message);
        seen.push(look.set_by(observation, &range.place));
    }
    let diagonal = measures.diagonal();
    if diagonal > 0.0 {
        let middle =
            (0..3).map(|axis| (0.5 * (measures.min[axis] + measures.max[axis])).powi(2)).sum::<f64>().sqrt();
        let message = format!("its middle is {} m from the origin", written(middle * metres));
        seen.push(look.measured("GEO011", middle / diagonal, message));
    }
    seen.push(look.measured("GEO012", measures.triangles as f64, "the mesh"));
    seen.push(look.measured("GEO013", measures.bodies as f64, "the mesh"));
    seen.push(look.measured("GEO014", longest * metres * 1e3, "its longest side"));
    seen.push(look.measured("GEO015", longest * metres, "its longest side"));
}
