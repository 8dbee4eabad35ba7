//! What does not fit together in one model's answer.

use crate::answer::mass::Geometry;
use crate::answer::resolve::kind_by;
use crate::attribute::{ATTRIBUTES, DENSITY, Kind, Layer, MassModel, Provenance, attribute_id, round};
use crate::facts::ModelFacts;
use crate::mapped::{Finding, Mapped};
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{Setting, What};

/// How far mass and density times volume of a solid may part before it is a contradiction.
const MASS_TOLERANCE: f64 = 0.2;

/// Adds a finding for everything that contradicts something else.
///
/// | code | what |
/// |---|---|
/// | MAP001 | nothing in the names says what it is |
/// | MAP002 | its size fits its category in no plain unit |
/// | MAP003 | the mass model leads outside what such things weigh |
/// | MAP004 | a mass that somebody set contradicts density and volume |
/// | MAP005 | static friction below dynamic |
/// | MAP006 | a value outside its physical range |
/// | MAP007 | a set attribute that its kind does not have |
/// | MAP008 | the volume is that of the hull: an upper bound |
/// | MAP009 | no mass could have the inertia tensor of this mesh: its moments break the triangle inequality |
/// | MAP010 | the centre of mass lies outside the mesh's hull |
pub(crate) fn check(rules: &Ruleset, facts: &ModelFacts, mapped: &mut Mapped) {
    let mut findings = Vec::new();
    if mapped.category.is_none() {
        findings.push(finding(
            "MAP001",
            "uncategorized: no name of it is known well enough".to_owned(),
            None,
        ));
    }
    if mapped.scale.suspect {
        findings.push(finding("MAP002", mapped.scale.reason.clone(), None));
    }
    mass_against_density(facts, mapped, &mut findings);
    friction(mapped, &mut findings);
    ranges(mapped, &mut findings);
    hull_volume(facts, mapped, &mut findings);
    spread(facts, mapped, &mut findings);
    kind(rules, mapped, &mut findings);
    mapped.findings.append(&mut findings);
}

fn finding(code: &str, message: String, place: Option<Provenance>) -> Finding {
    Finding { code: code.into(), message, place }
}

fn mass_against_density(facts: &ModelFacts, mapped: &Mapped, findings: &mut Vec<Finding>) {
    let Some(mass) = mapped.attribute("mass") else { return };
    if mass.provenance.layer < Layer::Rule || &*mass.provenance.by == "mass-range" {
        return;
    }
    let set_by_people = !mass.provenance.by.starts_with("mass-");
    let (Some(mass_kg), Some(density)) = (mass.value.number(), mapped.attribute(ATTRIBUTES[DENSITY].name))
    else {
        return;
    };
    let Some(density_value) = density.value.number() else { return };
    let Some(shape) = facts.shape.filter(|shape| shape.closed && !shape.volume_is_hull) else { return };
    let Some(volume_m3) = Geometry::of_shape(&shape, mapped.scale.metres_per_unit).volume_m3 else { return };
    let solid_kg = density_value * volume_m3;
    let off = (mass_kg / solid_kg - 1.0).abs();
    let too_heavy = mass_kg > solid_kg * (1.0 + MASS_TOLERANCE) && mapped.contents.is_none();
    if set_by_people && (too_heavy || (mapped.mass_model == MassModel::Solid && off > MASS_TOLERANCE)) {
        findings.push(finding(
            "MAP004",
            format!(
                "{} kg (set at {}) against {} kg from {} kg/m3 (set at {}) and {} m3",
                round(mass_kg),
                mass.provenance.place(),
                round(solid_kg),
                round(density_value),
                density.provenance.place(),
                round(volume_m3)
            ),
            Some(mass.provenance.clone()),
        ));
    }
}

fn friction(mapped: &Mapped, findings: &mut Vec<Finding>) {
    let (Some(held), Some(slides)) =
        (mapped.attribute("friction_static"), mapped.attribute("friction_dynamic"))
    else {
        return;
    };
    if let (Some(a), Some(b)) = (held.value.number(), slides.value.number())
        && a < b
    {
        findings.push(finding(
            "MAP005",
            format!(
                "static friction {a} (at {}) is below dynamic friction {b} (at {})",
                held.provenance.place(),
                slides.provenance.place()
            ),
            Some(held.provenance.clone()),
        ));
    }
}

fn ranges(mapped: &Mapped, findings: &mut Vec<Finding>) {
    for attribute in &mapped.attributes {
        let Some(spec) = attribute_id(&attribute.name).map(|id| &ATTRIBUTES[id]) else { continue };
        let Some(value) = attribute.value.number() else { continue };
        if !(spec.min..=spec.max).contains(&value) {
            findings.push(finding(
                "MAP006",
                format!(
                    "{} of {} {} is outside {} to {}",
                    spec.name,
                    round(value),
                    attribute.unit,
                    spec.min,
                    spec.max
                ),
                Some(attribute.provenance.clone()),
            ));
        }
    }
}

fn hull_volume(facts: &ModelFacts, mapped: &Mapped, findings: &mut Vec<Finding>) {
    let by_volume = matches!(mapped.mass_model, MassModel::Solid | MassModel::Fill { .. });
    let computed = mapped.attribute("mass").is_some_and(|mass| mass.provenance.by.starts_with("mass-model"));
    if by_volume && computed && facts.shape.is_some_and(|shape| shape.volume_is_hull) {
        let message = "the surface encloses nothing by itself; its hull's volume, an upper bound, was taken";
        findings.push(finding("MAP008", message.to_owned(), Some(mapped.mass_model_by.clone())));
    }
}

/// Both come of surfaces that are wound against one another: volumes that cancel. The mass model that reads them
/// is one place of the contradiction, the mesh the other.
fn spread(facts: &ModelFacts, mapped: &Mapped, findings: &mut Vec<Finding>) {
    let Some(spread) = facts.shape.and_then(|shape| shape.spread) else { return };
    let by = || Some(mapped.mass_model_by.clone());
    let used = format!("used by the mass model set at {}", mapped.mass_model_by.place());
    if !inertia_is_real(spread.inertia) {
        // Broken meshes reach any power of ten.
        let [xx, yy, zz, ..] = spread.inertia;
        let message = format!(
            "no body has moments of inertia {xx:.3e}, {yy:.3e} and {zz:.3e} (density 1, file units), {used}; the \
             collider's are taken"
        );
        findings.push(finding("MAP009", message, by()));
    }
    let slack = 1e-6 * (0..3).map(|axis| spread.high[axis] - spread.low[axis]).fold(0.0, f64::max);
    let inside = (0..3)
        .all(|axis| (spread.low[axis] - slack..=spread.high[axis] + slack).contains(&spread.center[axis]));
    if !inside || spread.outside_hull {
        let message = format!(
            "the centre of mass at {:?}, {used}, is outside the hull of the mesh, which reaches from {:?} to {:?} \
             (file units)",
            spread.center.map(round),
            spread.low.map(round),
            spread.high.map(round)
        );
        findings.push(finding("MAP010", message, by()));
    }
}

/// Values that somebody set above the catalogue and that a thing of this kind does not have: they are not used.
#[must_use]
pub(crate) fn misfits(rules: &Ruleset, kind: Kind, settings: &[&Setting]) -> Vec<Finding> {
    let why = match kind_by(&rules.presets, settings).1 {
        Some(decider) => format!("which {} at {} makes it", decider.by.by, decider.by.place()),
        None => "which things are where nothing says otherwise".to_owned(),
    };
    let misfit = |setting: &&Setting| {
        let What::Attribute(id, _) = setting.what else { return None };
        let own = setting.by.layer < Layer::Rule || rules.kind(kind).attributes.contains(&id);
        let message = || {
            format!(
                "{} (set at {}) is no attribute of a {kind} thing, {why}: it is not used",
                ATTRIBUTES[id].name,
                setting.by.place()
            )
        };
        (!own).then(|| finding("MAP007", message(), Some(setting.by.clone())))
    };
    settings.iter().filter_map(misfit).collect()
}

fn kind(rules: &Ruleset, mapped: &Mapped, findings: &mut Vec<Finding>) {
    let spec = rules.kind(mapped.kind);
    for attribute in &mapped.attributes {
        let own = attribute_id(&attribute.name).is_some_and(|id| spec.attributes.contains(&id));
        if attribute.part.is_some() && !own {
            let message = format!(
                "{} is no attribute of a {} thing{}",
                attribute.name,
                mapped.kind,
                mapped
                    .preset_by
                    .as_ref()
                    .map_or_else(String::new, |by| format!(", which its preset at {} makes it", by.place()))
            );
            findings.push(finding("MAP007", message, Some(attribute.provenance.clone())));
        }
    }
    if mapped.kind == Kind::Fluid && mapped.anchored {
        let by = mapped
            .preset_by
            .as_ref()
            .map_or_else(String::new, |by| format!(" (by the preset at {})", by.place()));
        let message = format!("a fluid{by} cannot be anchored; `anchored: true` is set for what it is, at");
        let place = mapped.trace.first().map(|trace| trace.by.clone());
        let at = place.as_ref().map_or_else(|| "an override".to_owned(), Provenance::place);
        findings.push(finding("MAP007", format!("{message} {at}"), place));
    }
}

/// Do the principal moments of an inertia tensor `[xx, yy, zz, xy, xz, yz]` belong to a real body? Each is at
/// most the sum of the other two, which for the tensor itself reads: half its trace minus it is positive
/// semidefinite.
#[must_use]
pub(crate) fn inertia_is_real(inertia: [f64; 6]) -> bool {
    let [xx, yy, zz, xy, xz, yz] = inertia;
    if !inertia.iter().all(|entry| entry.is_finite()) {
        return false;
    }
    let half = 0.5 * (xx + yy + zz);
    let slack = 1e-6 * half.abs();
    // Second moments of mass: positive semidefinite by Sylvester.
    let (a, b, c) = (half - xx + slack, half - yy + slack, half - zz + slack);
    let (d, e, f) = (-xy, -xz, -yz);
    let minors = [a * b - d * d, a * c - e * e, b * c - f * f];
    let determinant = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    half > 0.0
        && [a, b, c].iter().all(|entry| *entry >= 0.0)
        && minors.iter().all(|minor| *minor >= 0.0)
        && determinant >= -slack.powi(3)
}

#[cfg(test)]
mod tests {
    use super::inertia_is_real;

    #[test]
    fn only_inertia_that_mass_can_have_is_real() {
        assert!(inertia_is_real([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
        // A flat plate: one moment is the sum of the others.
        assert!(inertia_is_real([1.0, 1.0, 2.0, 0.0, 0.0, 0.0]));
        assert!(!inertia_is_real([1.0, 1.0, 2.1, 0.0, 0.0, 0.0]));
        assert!(!inertia_is_real([0.0; 6]));
        assert!(!inertia_is_real([1.0, 1.0, 1.0, 0.9, 0.0, 0.0]));
        assert!(!inertia_is_real([f64::NAN, 1.0, 1.0, 0.0, 0.0, 0.0]));
    }
}
