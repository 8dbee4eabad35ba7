//! The smaller things of a scene file: materials, shapes, poses and vectors.

use sim::{HeightField, Pose, Shape, Surface};

use crate::rules::ruleset::Ruleset;
use crate::text::reader::{Fields, Reader};
use crate::text::units::Dimension;
use crate::text::yaml::{Data, Node};

/// What a shape is made of.
pub(crate) struct Material {
    pub(crate) surface: Surface,
    /// kg/m³
    pub(crate) density: Option<f64>,
}

pub(crate) fn material<'d>(reader: &mut Reader<'d>, node: &'d Node, rules: &Ruleset) -> Option<Material> {
    let Data::Map(_) = node.data else {
        let id = rules.names.preset(reader, node)?;
        let preset = &rules.presets[id];
        let Some(surface) = rules.surface(&preset.name) else {
            let message = format!("`{}` is {} and has no surface", preset.name, preset.kind);
            reader.fault(node, "CAT005", message, "here", "name a solid".to_owned());
            return None;
        };
        return Some(Material { surface, density: preset.number("density") });
    };
    let fields =
        reader.fields(node, &["preset", "friction", "restitution", "rolling_resistance", "density"])?;
    let base = match fields.get("preset") {
        Some(preset) => Some(material(reader, preset, rules)?),
        None => None,
    };
    let mut number = |name: &str, dimension, max, base: Option<f64>| match fields.get(name) {
        Some(node) => reader.bounded(node, dimension, 0.0, max).map(Some),
        None => Some(base),
    };
    let surface = base.as_ref().map(|base| base.surface);
    let friction = number("friction", Dimension::Pure, 10.0, surface.map(|s| s.friction))?;
    let restitution = number("restitution", Dimension::Pure, 1.0, surface.map(|s| s.restitution))?;
    let rolling_resistance =
        number("rolling_resistance", Dimension::Pure, 1.0, surface.map(|s| s.rolling_resistance))?
            .unwrap_or(0.0);
    let density = number("density", Dimension::Density, 1e5, base.as_ref().and_then(|base| base.density))?;
    let (Some(friction), Some(restitution)) = (friction, restitution) else {
        let help = "give both, or a preset to start from".to_owned();
        reader.fault(node, "CAT007", "a material needs friction and restitution".to_owned(), "here", help);
        return None;
    };
    let own = ["friction", "restitution"].iter().any(|name| fields.get(name).is_some());
    let material = base.filter(|_| !own).and_then(|base| base.surface.material);
    Some(Material { surface: Surface { friction, restitution, rolling_resistance, material }, density })
}

pub(crate) fn shape<'d>(
    reader: &mut Reader<'d>,
    kind: &'d Node,
    item: &'d Node,
    fields: Fields<'d>,
) -> Option<Shape> {
    let mut length = |name: &str| {
        let Some(node) = fields.get(name) else {
            reader.fault(item, "CAT007", format!("a {} needs `{name}`", kind.text()), "here", String::new());
            return None;
        };
        reader.bounded(node, Dimension::Length, 1e-6, 1e6)
    };
    Some(match kind.text() {
        "sphere" => Shape::Sphere { radius: length("radius")? },
        "capsule" => {
            let (radius, height) = (length("radius")?, length("height")?);
            Shape::Capsule { half_height: (height / 2.0 - radius).max(0.0), radius }
        }
        "cylinder" => Shape::Cylinder { radius: length("radius")?, half_height: length("height")? / 2.0 },
        "cone" => Shape::Cone { radius: length("radius")?, half_height: length("height")? / 2.0 },
        "box" => {
            let node = needed(reader, kind, item, fields, "size")?;
            let items = reader.list(node)?;
            let [x, y, z] = items else {
                reader.fault(node, "CAT003", "expected three lengths".to_owned(), "here", String::new());
                return None;
            };
            let mut half = |node| Some(reader.bounded(node, Dimension::Length, 1e-6, 1e6)? / 2.0);
            Shape::Box { half_extents: [half(x)?, half(y)?, half(z)?] }
        }
        "hull" => {
            let node = needed(reader, kind, item, fields, "points")?;
            let points: Option<Vec<[f64; 3]>> =
                reader.list(node)?.iter().map(|point| vector(reader, point)).collect();
            Shape::Hull { points: points? }
        }
        "mesh" => {
            let node = needed(reader, kind, item, fields, "positions")?;
            let positions: Option<Vec<[f64; 3]>> =
                reader.list(node)?.iter().map(|point| vector(reader, point)).collect();
            let positions = positions?;
            let node = needed(reader, kind, item, fields, "triangles")?;
            let triangles: Option<Vec<[u32; 3]>> =
                reader.list(node)?.iter().map(|corners| triangle(reader, corners, positions.len())).collect();
            Shape::TriangleMesh { positions, triangles: triangles? }
        }
        "height-field" => {
            let node = needed(reader, kind, item, fields, "heights")?;
            let mut heights = Vec::new();
            let rows = reader.list(node)?;
            let columns = reader.list(rows.first()?)?.len();
            for row in rows {
                let values = reader.list(row)?;
                if values.len() != columns {
                    let message = format!("a row of {} heights among rows of {columns}", values.len());
                    reader.fault(row, "CAT003", message, "here", String::new());
                    return None;
                }
                for value in values {
                    heights.push(reader.bounded(value, Dimension::Pure, -1e6, 1e6)?);
                }
            }
            let node = needed(reader, kind, item, fields, "spacing")?;
            let spacing = numbers(reader, node)?;
            Shape::HeightField(HeightField { heights, columns: u32::try_from(columns).ok()?, spacing })
        }
        "half-space" => Shape::HalfSpace,
        _ => {
            let known = [
                "sphere",
                "box",
                "capsule",
                "cylinder",
                "cone",
                "hull",
                "mesh",
                "height-field",
                "half-space",
            ];
            reader.unknown(kind, "shape", known.into_iter());
            return None;
        }
    })
}

fn needed<'d>(
    reader: &mut Reader<'d>,
    kind: &Node,
    item: &Node,
    fields: Fields<'d>,
    name: &str,
) -> Option<&'d Node> {
    let found = fields.get(name);
    if found.is_none() {
        reader.fault(item, "CAT007", format!("a {} needs `{name}`", kind.text()), "here", String::new());
    }
    found
}

fn numbers<'d, const N: usize>(reader: &mut Reader<'d>, node: &'d Node) -> Option<[f64; N]> {
    let items = reader.list(node)?;
    if items.len() != N {
        let message = format!("expected {N} numbers, found {}", items.len());
        reader.fault(node, "CAT003", message, "here", String::new());
        return None;
    }
    let mut values = [0.0; N];
    for (value, item) in values.iter_mut().zip(items) {
        *value = reader.bounded(item, Dimension::Pure, -1e9, 1e9)?;
    }
    Some(values)
}

pub(crate) fn vector<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<[f64; 3]> {
    numbers(reader, node)
}

pub(crate) fn optional_vector<'d>(reader: &mut Reader<'d>, fields: Fields<'d>, name: &str) -> [f64; 3] {
    fields.get(name).and_then(|node| vector(reader, node)).unwrap_or_default()
}

fn triangle<'d>(reader: &mut Reader<'d>, node: &'d Node, corners: usize) -> Option<[u32; 3]> {
    let items = reader.list(node)?;
    let indices: Vec<u32> = items
        .iter()
        .filter_map(|item| item.text().parse().ok())
        .filter(|index| (*index as usize) < corners)
        .collect();
    let found: Option<[u32; 3]> = indices.try_into().ok().filter(|_| items.len() == 3);
    if found.is_none() {
        let message = format!("expected three indices below {corners}");
        reader.fault(node, "CAT003", message, "here", String::new());
    }
    found
}

/// `position` and `rotation` of a map; the identity where they are absent.
pub(crate) fn pose<'d>(reader: &mut Reader<'d>, fields: Fields<'d>) -> Option<Pose> {
    let position = match fields.get("position") {
        Some(node) => vector(reader, node)?,
        None => [0.0; 3],
    };
    let rotation = match fields.get("rotation") {
        Some(node) => rotation(reader, node)?,
        None => Pose::IDENTITY.rotation,
    };
    Some(Pose { position, rotation })
}

/// A quaternion `[x, y, z, w]`, or `{ axis: [0, 0, 1], angle: 20 deg }`; normalised.
fn rotation<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Option<[f64; 4]> {
    let raw = if let Data::List(_) = node.data {
        numbers::<4>(reader, node)?
    } else {
        let fields = reader.fields(node, &["axis", "angle"])?;
        let (Some(axis), Some(angle)) = (fields.get("axis"), fields.get("angle")) else {
            let help = "write `[x, y, z, w]` or `{ axis: [0, 0, 1], angle: 20 deg }`".to_owned();
            reader.fault(node, "CAT007", "a rotation needs axis and angle".to_owned(), "here", help);
            return None;
        };
        let turn = vector(reader, axis)?;
        let (sin, cos) = (reader.quantity(angle, Dimension::Angle)? / 2.0).sin_cos();
        let length = turn.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        let unit = turn.map(|entry| entry / length);
        [unit[0] * sin, unit[1] * sin, unit[2] * sin, cos]
    };
    let length = raw.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    if !(length.is_finite() && length > 1e-6) {
        reader.fault(node, "CAT008", "a rotation of length zero".to_owned(), "here", String::new());
        return None;
    }
    Some(raw.map(|entry| entry / length))
}
