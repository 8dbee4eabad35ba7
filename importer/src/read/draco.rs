//! `KHR_draco_mesh_compression`: a primitive's faces and attributes from one packed mesh.

use draco_core::{
    DataType, DecodeLimits, DecoderBuffer, DracoError, ErrorKind, Mesh, MeshDecoder, PointIndex,
};
use gltf::json::Value;
use gltf::json::mesh::Primitive;

use crate::{ImportError, guard};

use super::accessor::Accessors;
use super::reading::check_counts;

pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// A primitive unpacked.
pub(super) struct Packed<'a> {
    mesh: Mesh,
    /// Numbers of the mesh's attributes by glTF's names.
    attributes: &'a Value,
    place: String,
}

/// The primitive's packed mesh, where it has one.
///
/// # Errors
/// Malformed for what is not Draco data of a triangle mesh, too large beyond the limits, a panic where the decoder
/// panicked.
pub(super) fn read<'a>(
    primitive: &'a Primitive,
    accessors: &Accessors<'_>,
    place: &str,
) -> Result<Option<Packed<'a>>, ImportError> {
    let Some(extension) = primitive.extensions.as_ref().and_then(|all| all.others.get(NAME)) else {
        return Ok(None);
    };
    let place = format!("{place}.extensions.{NAME}");
    let view =
        extension.get("bufferView").and_then(Value::as_u64).and_then(|view| usize::try_from(view).ok());
    let Some(view) = view else {
        return Err(ImportError::malformed(place, "expected bufferView to be a whole number"));
    };
    let (bytes, _) = accessors.view(view, &place)?;
    let options = accessors.options;
    let limits = DecodeLimits::default()
        .with_max_points(options.max_triangles.saturating_mul(3))
        .with_max_faces(options.max_triangles)
        .with_max_decoded_bytes(options.max_file_bytes);
    let mesh = guard::catch(&place, || {
        let mut mesh = Mesh::new();
        MeshDecoder::new()
            .decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh)
            .map_err(|fault| refusal(&fault, &place))?;
        Ok(mesh)
    })?;
    check_counts(mesh.num_points() as u64, mesh.num_faces() as u64, &place, options)?;
    Ok(Some(Packed { mesh, attributes: extension.get("attributes").unwrap_or(&Value::Null), place }))
}

fn refusal(fault: &DracoError, place: &str) -> ImportError {
    let reason = format!("the Draco mesh cannot be unpacked: {}", fault.message());
    match fault.kind() {
        ErrorKind::LimitExceeded => ImportError::too_large(place, reason),
        _ => ImportError::malformed(place, reason),
    }
}

impl Packed<'_> {
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.mesh.faces().iter().map(|face| face.map(|PointIndex(point)| point)).collect()
    }

    /// An attribute's vectors by the file's name for it; `None` where it is not packed.
    ///
    /// # Errors
    /// Malformed for an attribute that the packed mesh does not have, or not of `N` components.
    pub fn vectors<const N: usize>(
        &self,
        name: &str,
        normalized: bool,
    ) -> Result<Option<Vec<[f64; N]>>, ImportError> {
        let Some(number) = self.attributes.get(name) else { return Ok(None) };
        let number = number.as_u64().and_then(|number| u32::try_from(number).ok());
        let attribute = number.and_then(|number| self.mesh.attribute_by_unique_id(number));
        let place = || format!("{}.attributes.{name}", self.place);
        let Some(attribute) = attribute else {
            return Err(ImportError::malformed(place(), "the packed mesh has no such attribute"));
        };
        if usize::from(attribute.num_components()) != N {
            let found = attribute.num_components();
            return Err(ImportError::malformed(place(), format!("expected {N} components, found {found}")));
        }
        let most = if normalized { most(attribute.data_type()) } else { None };
        let values = attribute.read_f32s(self.mesh.num_points(), N);
        let value = |value: f32| match most {
            Some(most) => (f64::from(value) / most).max(-1.0),
            None => f64::from(value),
        };
        Ok(Some(values.as_chunks().0.iter().map(|vector: &[f32; N]| vector.map(value)).collect()))
    }
}

/// What stands for 1 in normalised integers: glTF 2.0, section 3.6.2.2.
fn most(kind: DataType) -> Option<f64> {
    Some(match kind {
        DataType::Int8 => f64::from(i8::MAX),
        DataType::Uint8 => f64::from(u8::MAX),
        DataType::Int16 => f64::from(i16::MAX),
        DataType::Uint16 => f64::from(u16::MAX),
        _ => return None,
    })
}
