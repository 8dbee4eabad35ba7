//! What a viewer is given of a model: its own mesh in the body's frame, and its attributes as a table.

use std::fmt::Write as _;

use importer::{Source, SourcePart};
use mapper::scene::Placement;
use mapper::{Mapped, Value};
use viewer::VisualMesh;

/// Colours by the words of materials, sRGB with opacity. The importer does not read looks: these are for telling
/// wood from metal.
const COLORS: [(&[&str], [u8; 4]); 16] = [
    (&["glass", "crystal"], [170, 215, 205, 120]),
    (&["water"], [90, 150, 220, 150]),
    (&["honey", "oil", "amber"], [225, 160, 40, 190]),
    (&["milk", "porcelain", "cotton", "linen", "wool", "white", "paper", "snow"], [235, 232, 224, 255]),
    (&["leaf", "leaves", "grass", "plant", "green", "crown"], [86, 140, 66, 255]),
    (&["bark", "trunk", "soil", "dirt", "plush", "leather", "brown"], [110, 78, 52, 255]),
    (&["oak", "wood", "walnut", "teak", "mahogany"], [166, 120, 72, 255]),
    (&["pine", "plywood", "birch", "bamboo", "cardboard", "cork"], [206, 168, 112, 255]),
    (&["brass", "gold", "bronze"], [206, 166, 78, 255]),
    (&["copper"], [190, 112, 74, 255]),
    (&["cast", "iron", "black", "coal"], [72, 74, 80, 255]),
    (&["steel", "metal", "aluminium", "aluminum", "silver", "chrome", "grey", "gray"], [158, 164, 172, 255]),
    (&["ceramic", "clay", "brick", "terracotta", "red"], [190, 92, 70, 255]),
    (&["stone", "rock", "concrete", "marble", "granite"], [150, 148, 142, 255]),
    (&["rubber", "plastic", "vinyl"], [196, 74, 66, 255]),
    (&["foam", "sponge", "yellow"], [228, 196, 84, 255]),
];

/// For what no word tells.
const PLAIN: [u8; 4] = [176, 168, 156, 255];

/// The model's parts in the body's frame, in m. `preset` gives a colour where no material's name does.
#[must_use]
pub fn meshes(source: &Source, preset: Option<&str>, placement: &Placement) -> Vec<VisualMesh> {
    source.parts.iter().map(|part| mesh(part, preset, placement)).collect()
}

fn mesh(part: &SourcePart, preset: Option<&str>, placement: &Placement) -> VisualMesh {
    let positions =
        part.mesh.positions.iter().map(|&position| placement.apply(position).map(|value| value as f32));
    VisualMesh {
        positions: positions.collect(),
        triangles: part.mesh.triangles.clone(),
        color: color(part.materials.iter().map(String::as_str).chain(preset)),
    }
}

/// The colour of the first name that has a known word in it.
fn color<'a>(names: impl Iterator<Item = &'a str>) -> [u8; 4] {
    for name in names {
        let name = name.to_lowercase();
        let known = COLORS.iter().find(|(words, _)| words.iter().any(|word| name.contains(word)));
        if let Some((_, color)) = known {
            return *color;
        }
    }
    PLAIN
}

/// What the model is and every attribute with where it comes from, as Markdown.
#[must_use]
pub fn info(model: &str, mapped: &Mapped) -> String {
    let mut text = format!("# {model}\n\n");
    let category = match (&mapped.category, &mapped.subcategory) {
        (Some(category), Some(subcategory)) => format!("{category} / {subcategory}"),
        (Some(category), None) => category.to_string(),
        _ => "uncategorized".to_owned(),
    };
    let preset = mapped.preset.as_deref().unwrap_or("none");
    let fixed = if mapped.anchored { ", fixed in place" } else { "" };
    let simulated = match mapped.kind {
        mapper::Kind::Rigid => "",
        _ => " (not simulated yet)",
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{category}: **{}**{simulated}{fixed}, preset {preset}, confidence {:.2}\n\n{} m a file unit: {}\n",
        mapped.kind, mapped.confidence, mapped.scale.metres_per_unit, mapped.scale.reason
    );
    text.push_str("| attribute | value | unit | set by | from |\n|---|---|---|---|---|\n");
    for attribute in &mapped.attributes {
        let part = attribute.part.map(|part| format!(" (part {part})")).unwrap_or_default();
        let by = &attribute.provenance;
        let _ = writeln!(
            text,
            "| {}{part} | {} | {} | {} {} | {}:{} |",
            attribute.name,
            value(&attribute.value),
            attribute.unit,
            by.layer,
            by.by,
            by.file,
            by.line
        );
    }
    text
}

fn value(value: &Value) -> String {
    match value {
        Value::Number(number) if number.abs() >= 1e5 || (*number != 0.0 && number.abs() < 1e-3) => {
            format!("{number:.3e}")
        }
        Value::Number(number) => {
            format!("{:.4}", number).trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        Value::Text(text) => text.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_telling_name_gives_the_colour() {
        let names = |names: &[&'static str]| color(names.iter().copied());
        assert_eq!(names(&["Material.001", "Dark Oak"]), names(&["oak"]));
        assert_eq!(names(&["cast iron", "oak"]), names(&["iron"]));
        assert_eq!(names(&["atlas_texture"]), PLAIN);
    }

    #[test]
    fn values_are_written_short() {
        let text = |number| value(&Value::Number(number));
        assert_eq!(
            [text(720.0), text(0.54), text(1.1e10), text(0.0), text(8.9e-4)],
            ["720", "0.54", "1.100e10", "0", "8.900e-4"]
        );
    }
}
