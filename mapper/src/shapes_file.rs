//! `*.shapes.yaml`: a model of analytical shapes.
//!
//! ```yaml
//! shapes:
//!   - { name: seat, shape: box, size: [40 cm, 4 cm, 40 cm], position: [0, 0.45, 0], material: oak }
//!   - { name: leg, shape: cylinder, radius: 2 cm, height: 43 cm, position: [0, 0.215, 0], material: steel }
//! ```
//!
//! The shapes of a scene file that enclose something: `sphere` (radius), `box` (size), `capsule` and `cylinder` (radius,
//! height of the whole, along Y), with `position` in m and `rotation`. One part each; `material` is a word for the rules.
//! Shapes that overlap count twice.

use importer::{NamedShape, Primitive, PrimitiveForm, ShapesFault, ShapesReader};
use sim::{Pose, Shape};

use crate::scene::rotate;
use crate::scene_shape::{pose, shape};
use crate::text::error::MapError;
use crate::text::reader::Reader;
use crate::text::yaml::{self, Node};

/// For [`importer::Options::shapes`]: the importer reads no YAML, and asks.
pub const READER: ShapesReader = ShapesReader(parse);

const ENTRY: [&str; 8] = ["name", "shape", "size", "radius", "height", "position", "rotation", "material"];

fn parse(text: &str) -> Result<Vec<NamedShape>, ShapesFault> {
    read(text).map_err(|error| ShapesFault { place: error.place(), reason: error.reason() })
}

fn read(text: &str) -> Result<Vec<NamedShape>, MapError> {
    let doc = yaml::parse("shapes", text)?;
    let mut reader = Reader::new(&doc);
    let mut shapes = Vec::new();
    if let Some(top) = reader.fields(&doc.root, &["shapes"]) {
        for item in top.get("shapes").and_then(|node| reader.list(node)).unwrap_or_default() {
            shapes.extend(entry(&mut reader, item));
        }
        if shapes.is_empty() {
            let help =
                "write `shapes:` and a list, each with `shape: box`, `sphere`, `capsule` or `cylinder`"
                    .to_owned();
            reader.fault(&doc.root, "CAT007", "no shape".to_owned(), "here", help);
        }
    }
    reader.finish(shapes)
}

fn entry<'d>(reader: &mut Reader<'d>, item: &'d Node) -> Option<NamedShape> {
    let fields = reader.fields(item, &ENTRY)?;
    let Some(kind) = fields.get("shape") else {
        reader.fault(item, "CAT007", "an entry needs `shape`".to_owned(), "here", String::new());
        return None;
    };
    let form = match shape(reader, kind, item, fields)? {
        Shape::Sphere { radius } => PrimitiveForm::Sphere { radius },
        Shape::Box { half_extents } => PrimitiveForm::Box { size: half_extents.map(|half| 2.0 * half) },
        Shape::Cylinder { radius, half_height } => {
            PrimitiveForm::Cylinder { height: 2.0 * half_height, bottom: radius, top: radius }
        }
        Shape::Capsule { radius, half_height } => {
            PrimitiveForm::Capsule { height: 2.0 * half_height, bottom: radius, top: radius }
        }
        _ => {
            let help = "write sphere, box, capsule or cylinder; a mesh has formats of its own".to_owned();
            reader.fault(kind, "CAT005", format!("a {} is no solid of its own", kind.text()), "here", help);
            return None;
        }
    };
    let pose = pose(reader, fields)?;
    let mut word = |name: &str| fields.get(name).and_then(|node| reader.text(node)).map(str::to_owned);
    let (name, material) = (word("name"), word("material"));
    Some(NamedShape { name, material, primitive: Primitive { form, transform: transform(&pose) } })
}

fn transform(pose: &Pose) -> [[f64; 3]; 4] {
    let axis = |axis: [f64; 3]| rotate(pose.rotation, axis);
    [axis([1.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0]), axis([0.0, 0.0, 1.0]), pose.position]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_with_units_names_and_poses() {
        let text = "shapes:\n  - { name: seat, shape: box, size: [40 cm, 4 cm, 1 m], position: [0, 0.5, 0], material: oak }\n  \
                    - { shape: capsule, radius: 10 cm, height: 50 cm, rotation: { axis: [0, 0, 1], angle: 90 deg } }\n";
        let shapes = parse(text).unwrap();
        assert_eq!(shapes[0].name.as_deref(), Some("seat"));
        assert_eq!(shapes[0].material.as_deref(), Some("oak"));
        assert_eq!(shapes[0].primitive.form, PrimitiveForm::Box { size: [0.4, 0.04, 1.0] });
        assert_eq!(shapes[0].primitive.transform[3], [0.0, 0.5, 0.0]);
        let PrimitiveForm::Capsule { height, .. } = shapes[1].primitive.form else { panic!("a capsule") };
        assert!((height - 0.3).abs() < 1e-12);
        let [_, up, ..] = shapes[1].primitive.transform;
        assert!((up[0] + 1.0).abs() < 1e-12 && up[1].abs() < 1e-12, "{up:?}");
    }

    #[test]
    fn faults_have_their_line() {
        for (text, place) in [
            ("shapes:\n  - { shape: box, size: [1, 1 m, 1 m] }\n", ":2:"),
            ("shapes:\n  - { shape: half-space }\n", ":2:"),
            ("shapes: []\n", ":1:"),
            ("shapes: ]\n", ":1:"),
        ] {
            let fault = parse(text).unwrap_err();
            assert!(fault.place.contains(place), "{fault:?}");
        }
    }
}
