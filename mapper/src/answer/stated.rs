//! Physics that the model file itself carries, as settings of its own layer.

use importer::StatedValue;

use crate::attribute::{ATTRIBUTES, Layer, Provenance, attribute_id};
use crate::facts::ModelFacts;
use crate::rules::settings::{Setting, What};

/// In the order of the file. A value that no thing could have is left out: the importer's notes keep it.
pub(crate) fn settings(facts: &ModelFacts) -> Vec<Setting> {
    let setting = |stated: &importer::Stated| {
        let attribute = |name: &str, value: f64| {
            let id = attribute_id(name)?;
            let spec = &ATTRIBUTES[id];
            (spec.min..=spec.max).contains(&value).then_some(What::Attribute(id, value))
        };
        let what = match stated.value {
            StatedValue::MassKg(mass) => attribute("mass", mass)?,
            StatedValue::FrictionStatic(friction) => attribute("friction_static", friction)?,
            StatedValue::FrictionDynamic(friction) => attribute("friction_dynamic", friction)?,
            StatedValue::Restitution(restitution) => attribute("restitution", restitution)?,
            StatedValue::Anchored(anchored) => What::Anchored(anchored),
        };
        let by = Provenance {
            layer: Layer::File,
            file: facts.model.as_str().into(),
            line: 0,
            column: 0,
            by: stated.place.as_str().into(),
            cites: None,
        };
        Some(Setting { what, by })
    };
    facts.stated.iter().filter_map(setting).collect()
}
