//! What the mapping says of one model, as a line of a lock holds it.

use importer::AssetKey;
use mapper::{Mapped, Value};
use serde::Deserialize;

use super::rule::written;
use crate::pipeline::Key;

/// One model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Line in the lock file, 0 for one that was not read from any.
    pub line: u32,
    /// First 16 digits of the asset's key.
    pub input: String,
    /// `subcategory:mug`, `rule:ceramic-mug`, `override:food/**`: what decided preset and category.
    pub rule: String,
    /// `kitchen/mug`, or `-`.
    pub category: String,
    pub preset: String,
    /// Hash of every attribute with its full digits.
    pub attributes: String,
    pub values: Vec<Held>,
}

/// A value as the lock has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Held {
    pub name: String,
    /// With its unit.
    pub value: String,
    /// Who set it; empty for the preset of the line, and for a mass that follows from it.
    pub by: String,
}

/// The part of a mapping that a lock holds, read without the rest of it.
#[derive(Clone, Debug, Deserialize)]
pub struct Locked {
    category: Option<Box<str>>,
    subcategory: Option<Box<str>>,
    kind: mapper::Kind,
    preset: Option<Box<str>>,
    preset_by: Option<By>,
    mass_model: mapper::MassModel,
    mass_model_by: By,
    anchored: bool,
    scale: Scale,
    attributes: Vec<Attribute>,
    trace: Vec<Trace>,
}

#[derive(Clone, Debug, Deserialize)]
struct By {
    by: Box<str>,
    layer: mapper::Layer,
}

#[derive(Clone, Debug, Deserialize)]
struct Scale {
    metres_per_unit: f64,
}

#[derive(Clone, Debug, Deserialize)]
struct Attribute {
    name: Box<str>,
    value: Value,
    unit: Box<str>,
    part: Option<u32>,
    provenance: By,
}

#[derive(Clone, Debug, Deserialize)]
struct Trace {
    by: By,
    won: bool,
}

impl From<&Mapped> for Locked {
    fn from(mapped: &Mapped) -> Self {
        let by = |by: &mapper::Provenance| By { by: (&*by.by).into(), layer: by.layer };
        Self {
            category: mapped.category.as_deref().map(Into::into),
            subcategory: mapped.subcategory.as_deref().map(Into::into),
            kind: mapped.kind,
            preset: mapped.preset.as_deref().map(Into::into),
            preset_by: mapped.preset_by.as_ref().map(by),
            mass_model: mapped.mass_model,
            mass_model_by: by(&mapped.mass_model_by),
            anchored: mapped.anchored,
            scale: Scale { metres_per_unit: mapped.scale.metres_per_unit },
            attributes: mapped
                .attributes
                .iter()
                .map(|attribute| Attribute {
                    name: (&*attribute.name).into(),
                    value: attribute.value.clone(),
                    unit: (&*attribute.unit).into(),
                    part: attribute.part,
                    provenance: by(&attribute.provenance),
                })
                .collect(),
            trace: mapped.trace.iter().map(|trace| Trace { by: by(&trace.by), won: trace.won }).collect(),
        }
    }
}

impl Entry {
    #[must_use]
    pub fn new(asset: &AssetKey, mapped: &Locked) -> Self {
        let held = |name: &str, value: String, by: &str| Held {
            name: name.to_owned(),
            value,
            by: by.replace('\t', " "),
        };
        let mut values = vec![
            held("kind", mapped.kind.to_string(), ""),
            held("mass_model", mapped.mass_model.to_string().replace(' ', "_"), &mapped.mass_model_by.by),
        ];
        if mapped.anchored {
            values.push(held("anchored", "true".to_owned(), ""));
        }
        values.push(held("scale", format!("{} m", number(mapped.scale.metres_per_unit)), ""));
        let usual = format!("preset:{}", mapped.preset.as_deref().unwrap_or("-"));
        let mut key = Key::new("attributes")
            .with(mapped.kind.to_string())
            .with(format!("{:?}", mapped.mass_model))
            .with([u8::from(mapped.anchored)])
            .with(mapped.scale.metres_per_unit.to_le_bytes());
        for attribute in &mapped.attributes {
            let part = attribute.part.map_or_else(String::new, |part| format!("part{part}."));
            let name = format!("{part}{}", attribute.name);
            let text = match &attribute.value {
                Value::Number(value) => {
                    key = key.with(&name).with(value.to_le_bytes());
                    let unit =
                        if &*attribute.unit == "1" { String::new() } else { format!(" {}", attribute.unit) };
                    format!("{}{unit}", number(*value))
                }
                Value::Text(text) => {
                    key = key.with(&name).with(&**text);
                    text.to_string()
                }
            };
            // Masses by a mass model name a line of the catalogue, and follow from what stands here anyway.
            let by = &*attribute.provenance.by;
            let by = if by == usual || by.starts_with("mass-") { "" } else { by };
            values.push(held(&name, text, by));
        }
        let category = match (&mapped.category, &mapped.subcategory) {
            (Some(category), Some(subcategory)) => format!("{category}/{subcategory}"),
            (Some(category), None) => category.to_string(),
            _ => "-".to_owned(),
        };
        Self {
            line: 0,
            input: asset.to_string()[..16].to_owned(),
            rule: mapped.rule(),
            category,
            preset: mapped.preset.as_deref().unwrap_or("-").to_owned(),
            attributes: key.finish()[..16].to_owned(),
            values,
        }
    }

    /// A value as a number and its unit.
    #[must_use]
    pub fn quantity(&self, name: &str) -> Option<(f64, &str)> {
        let text = &self.held(name)?.value;
        let (value, unit) = text.split_once(' ').unwrap_or((text, ""));
        Some((value.parse().ok()?, unit))
    }

    #[must_use]
    pub fn held(&self, name: &str) -> Option<&Held> {
        self.values.iter().find(|held| held.name == name)
    }
}

impl Locked {
    /// Who decided: the chooser of the preset where that is a rule or an override, else what won the category.
    fn rule(&self) -> String {
        let chooser = self.preset_by.as_ref().filter(|by| by.layer >= mapper::Layer::Rule);
        let winner = self.trace.iter().find(|trace| trace.won).map(|trace| &trace.by);
        chooser.or(winner).map_or_else(|| "-".to_owned(), |by| by.by.replace('\t', " "))
    }
}

fn number(value: f64) -> String {
    let text = written(value);
    // Six digits tell apart what four do not, and are still read by people.
    if text.parse::<f64>().is_ok_and(|short| short == value) {
        text
    } else {
        format!("{value:.5e}").parse::<f64>().map_or(text, |six| six.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_keep_six_digits() {
        assert_eq!(
            [number(0.35), number(0.123_456_789), number(7850.0), number(1.0 / 3.0)],
            ["0.35", "0.123457", "7850", "0.333333"]
        );
    }
}
