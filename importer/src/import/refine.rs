//! What is known of points, voxels and analytical shapes beyond their triangles.

use crate::asset::{Geometry, Part, Source, SourcePart};
use crate::measure::{MassProperties, Measures, VolumeMethod, sum};

/// Bounds of a surface laid through points hold about as often as those of filled holes.
const CONFIDENCE: f64 = 0.95;

pub(super) fn part(measures: &mut Measures, piece: &SourcePart, geometry: Geometry) {
    if let Some(primitive) = &piece.primitive {
        let (solid, shell) = primitive.mass_properties();
        be_exact(measures, solid, shell);
    }
    loosen(measures, piece.deviation);
    count(measures, geometry);
}

/// `parts` are measured and refined.
pub(super) fn whole(measures: &mut Measures, source: &Source, parts: &[Part]) {
    if source.parts.iter().all(|piece| piece.primitive.is_some()) {
        let solids: Vec<MassProperties> = parts.iter().filter_map(|part| part.measures.solid).collect();
        let shells: Vec<MassProperties> = parts.iter().map(|part| part.measures.shell).collect();
        be_exact(measures, sum(&solids), Some(sum(&shells)));
    }
    loosen(measures, source.parts.iter().map(|piece| piece.deviation).fold(0.0, f64::max));
    count(measures, source.geometry);
}

fn be_exact(measures: &mut Measures, solid: MassProperties, shell: Option<MassProperties>) {
    measures.solid = Some(solid);
    measures.solid_method = Some(VolumeMethod::Exact);
    measures.solid_error = Some(0.0);
    measures.solid_confidence = Some(1.0);
    if let [body] = measures.body_volumes.as_mut_slice() {
        body.volume = solid.measure;
        body.method = Some(VolumeMethod::Exact);
    }
    measures.shell = shell.unwrap_or(measures.shell);
}

/// A surface that lies somewhere within `deviation` has its area times that of volume to spare.
fn loosen(measures: &mut Measures, deviation: f64) {
    if deviation <= 0.0 {
        return;
    }
    measures.solid_method = measures.solid.map(|_| VolumeMethod::Winding);
    measures.solid_error =
        measures.solid.map(|solid| (deviation * measures.shell.measure / solid.measure).min(1.0));
    measures.solid_confidence = measures.solid.map(|_| CONFIDENCE);
}

/// The triangles are not the file's.
fn count(measures: &mut Measures, geometry: Geometry) {
    if geometry != Geometry::Mesh {
        measures.triangles = 0;
    }
}
