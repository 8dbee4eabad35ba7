//! Mass, its centre and its spread, against what is real.

use importer::VolumeMethod;
use mapper::{Kind, MassModel, Provenance};
use sim::{ChildShape, Mass, Motion, Pose, measure};

use super::super::observation::Observation;
use super::super::rule::written;
use super::Look;

/// Directions in which the hull of a collider is asked for; evenly spread over the sphere.
const DIRECTIONS: u32 = 96;

pub(super) fn see(look: &Look<'_>, seen: &mut Vec<Observation>) {
    if look.mapped.kind != Kind::Rigid {
        return;
    }
    let Some(mass) = look.mapped.attribute("mass") else {
        if !look.mapped.anchored {
            let by = &look.mapped.mass_model_by;
            seen.push(look.set_by(look.fact("MAS001", "no mass is known"), by));
        }
        return;
    };
    let Some(mass_kg) = mass.value.number() else { return };
    let by = &mass.provenance;
    if let Some(range) = &look.ranges.mass {
        let message = format!(
            "{} kg set by {}; {} weighs {} to {} kg",
            written(mass_kg),
            by.by,
            look.a_thing(),
            written(range.low),
            written(range.high)
        );
        seen.push(look.set_by(look.measured("MAS002", range.excess(mass_kg), message), by));
        if let Some((computed, model)) = computed(look) {
            let message = format!(
                "{} gives {} kg; {} weighs {} to {} kg",
                look.mapped.mass_model,
                written(computed),
                look.a_thing(),
                written(range.low),
                written(range.high)
            );
            seen.push(look.set_by(look.measured("MAS003", range.excess(computed), message), &model));
        }
    }
    if by.by.starts_with("mass-range") {
        seen.push(look.set_by(look.fact("MAS011", format!("{} kg by {}", written(mass_kg), by.by)), by));
    }
    volume(look, by, seen);
    // What is fixed in place has a mass that nothing uses.
    if !look.mapped.anchored {
        density(look, mass_kg, by, seen);
    }
    if let Ok(body) = look.body
        && let Motion::Dynamic(mass) = body.motion
    {
        inertia_box(look, &mass, &body.shapes, seen);
        center(look, &body.shapes, seen);
    }
}

/// What mass model and geometry gave, whether or not it had the last word.
fn computed(look: &Look<'_>) -> Option<(f64, Provenance)> {
    let mass = look.mapped.attribute("mass")?;
    let own = std::iter::once((&mass.value, &mass.provenance));
    let beaten = mass.overrode.iter().map(|(value, by)| (value, by));
    own.chain(beaten)
        .find(|(_, by)| by.by.starts_with("mass-model:"))
        .and_then(|(value, by)| Some((value.number()?, by.clone())))
}

/// How far the volume may be off that the mass was computed from. Of a hull the mapper says so itself.
fn volume(look: &Look<'_>, by: &Provenance, seen: &mut Vec<Observation>) {
    let by_volume = matches!(look.mapped.mass_model, MassModel::Solid | MassModel::Fill { .. });
    let measures = &look.asset.measures;
    if !by_volume || !by.by.starts_with("mass-model:") || measures.solid_method == Some(VolumeMethod::Hull) {
        return;
    }
    if let Some(error) = measures.solid_error {
        let confidence = 100.0 * measures.solid_confidence.unwrap_or(1.0);
        let message = format!(
            "{} boundary edges: its volume is known within this with {confidence:.0} % confidence",
            measures.boundary_edges
        );
        seen.push(look.set_by(look.measured("MAS014", 100.0 * error, message), &look.mapped.mass_model_by));
    }
}

fn density(look: &Look<'_>, mass_kg: f64, by: &Provenance, seen: &mut Vec<Observation>) {
    let metres = look.mapped.scale.metres_per_unit;
    let Some(hull_m3) = look.asset.measures.hull_volume.map(|volume| volume * metres.powi(3)) else { return };
    if hull_m3 > 0.0 {
        let message = format!("{} kg in a hull of {}", written(mass_kg), volume_of(hull_m3));
        for code in ["MAS008", "MAS009"] {
            seen.push(look.set_by(look.measured(code, mass_kg / hull_m3, message.clone()), by));
        }
    }
}

/// In m³, or in cm³ where that is easier to picture.
fn volume_of(cubic_metres: f64) -> String {
    if cubic_metres < 1e-3 {
        format!("{} cm3", written(cubic_metres * 1e6))
    } else {
        format!("{} m3", written(cubic_metres))
    }
}

/// The solid box of the same mass and inertia against the body's own extents, along the body's axes.
///
/// From `xx = m (b² + c²) / 12` and its turns: `a² = 6 (yy + zz - xx) / m`.
fn inertia_box(look: &Look<'_>, mass: &Mass, shapes: &[ChildShape], seen: &mut Vec<Observation>) {
    let Some([low, high]) = mapper::scene::bounds(shapes) else { return };
    let [xx, yy, zz, ..] = mass.inertia_kg_m2;
    let sides =
        [yy + zz - xx, zz + xx - yy, xx + yy - zz].map(|twice| (6.0 * twice / mass.mass_kg).max(0.0).sqrt());
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    // A flat side has hardly a spread of its own: it is held against a hundredth of the longest.
    let ratio =
        (0..3).map(|axis| sides[axis] / (high[axis] - low[axis]).max(0.01 * longest)).fold(0.0, f64::max);
    let message = format!("a box of {:.3} x {:.3} x {:.3} m has its inertia", sides[0], sides[1], sides[2]);
    seen.push(look.set_by(look.measured("MAS010", ratio, message), &look.mapped.mass_model_by));
}

/// How far the centre of mass, the body's origin, lies outside the convex hull of its shapes.
fn center(look: &Look<'_>, shapes: &[ChildShape], seen: &mut Vec<Observation>) {
    let size = measure::extents(shapes).into_iter().fold(0.0, f64::max);
    let outside = (0..DIRECTIONS)
        .filter_map(|index| measure::body_support(shapes, &Pose::IDENTITY, direction(index)))
        .map(|reach| -reach)
        .fold(0.0, f64::max);
    if size > 0.0 {
        let message = format!("the centre of mass is {:.2} mm outside the collider's hull", outside * 1e3);
        let observation = look.measured("MAS013", outside * 100.0 / size, message);
        seen.push(look.set_by(observation, &look.mapped.mass_model_by));
    }
}

/// Of a Fibonacci lattice on the sphere.
fn direction(index: u32) -> [f64; 3] {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let y = 1.0 - 2.0 * (f64::from(index) + 0.5) / f64::from(DIRECTIONS);
    let across = (1.0 - y * y).max(0.0).sqrt();
    let around = golden * f64::from(index);
    [across * around.cos(), y, across * around.sin()]
}
