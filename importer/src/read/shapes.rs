//! Analytical shapes in YAML, `*.shapes.yaml`: the text is read by whoever owns YAML, see [`crate::ShapesReader`].

use crate::asset::{Geometry, SourcePart};
use crate::{ImportError, Options, Primitive};

use super::reading::Reading;

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let Some(reader) = options.shapes else {
        let way_out = "Import it with the physique command, or set Options::shapes";
        return Err(ImportError::unsupported("", "YAML is not read by the importer alone", way_out));
    };
    let text = std::str::from_utf8(bytes)
        .map_err(|error| ImportError::malformed(format!("byte {}", error.valid_up_to()), "not UTF-8"))?;
    let shapes = (reader.0)(text).map_err(|fault| ImportError::malformed(fault.place, fault.reason))?;
    for (index, shape) in shapes.into_iter().enumerate() {
        let name = shape.name.unwrap_or_else(|| format!("part {index}"));
        reading.names.add(&name);
        shape.material.iter().for_each(|material| reading.names.add(material));
        add(shape.primitive, name, shape.material, reading, options)?;
    }
    Ok(())
}

/// A part of one shape.
pub(super) fn add(
    primitive: Primitive,
    name: String,
    material: Option<String>,
    reading: &mut Reading,
    options: &Options,
) -> Result<(), ImportError> {
    if !primitive.form.is_sound() || primitive.transform.as_flattened().iter().any(|value| !value.is_finite())
    {
        reading.notes.add("shape-ignored", name, format!("a size that cannot be: {:?}", primitive.form));
        return Ok(());
    }
    let mesh = primitive.mesh();
    reading.geometry = Geometry::Shapes;
    let part = SourcePart {
        materials: material.into_iter().collect(),
        primitive: Some(primitive),
        ..SourcePart::new(name, mesh)
    };
    reading.add_part(part, "shapes", options)
}
