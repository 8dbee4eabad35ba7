//! A primitive's vectors and corners, wherever they lie: in accessors, or packed by Draco.

use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;

use crate::ImportError;

use super::accessor::Accessors;
use super::draco::{self, Packed};
use super::notes::Notes;

pub(super) struct Attributes<'a> {
    primitive: &'a Primitive,
    accessors: &'a Accessors<'a>,
    packed: Option<Packed<'a>>,
    place: &'a str,
}

impl<'a> Attributes<'a> {
    /// # Errors
    /// As of the packed mesh, where the file does not bring the same primitive unpacked as well.
    pub fn open(
        primitive: &'a Primitive,
        accessors: &'a Accessors<'a>,
        place: &'a str,
        notes: &mut Notes,
    ) -> Result<Self, ImportError> {
        let mut attributes = Self { primitive, accessors, packed: None, place };
        match draco::read(primitive, accessors, place) {
            Ok(packed) => attributes.packed = packed,
            Err(error) if attributes.has_plain() => {
                let message = format!("{}: the uncompressed fallback is read", error.reason());
                notes.add("compression-fallback", error.place(), message);
            }
            Err(error) => return Err(error),
        }
        Ok(attributes)
    }

    /// Positions and corners in buffer views of their own.
    fn has_plain(&self) -> bool {
        let has_view = |index: usize| {
            self.accessors.root.accessors.get(index).is_some_and(|accessor| accessor.buffer_view.is_some())
        };
        self.accessor(&Semantic::Positions).is_some_and(has_view)
            && self.primitive.indices.is_none_or(|indices| has_view(indices.value()))
    }

    fn accessor(&self, wanted: &Semantic) -> Option<usize> {
        self.primitive
            .attributes
            .iter()
            .find(|(semantic, _)| matches!(semantic, Checked::Valid(semantic) if semantic == wanted))
            .map(|(_, accessor)| accessor.value())
    }

    /// `None` where the primitive has no such attribute.
    ///
    /// # Errors
    /// As of [`Accessors::vectors`] and [`Packed::vectors`].
    pub fn vectors<const N: usize>(&self, semantic: &Semantic) -> Result<Option<Vec<[f64; N]>>, ImportError> {
        let Some(index) = self.accessor(semantic) else { return Ok(None) };
        let name = semantic.to_string();
        if let Some(packed) = &self.packed {
            let accessor = self.accessors.root.accessors.get(index);
            let normalized = accessor.is_some_and(|accessor| accessor.normalized);
            if let Some(vectors) = packed.vectors(&name, normalized)? {
                return Ok(Some(vectors));
            }
        }
        self.accessors.vectors(index, &format!("{}.attributes.{name}", self.place)).map(Some)
    }

    /// Triangles where they are packed: whatever the primitive's mode, they are whole.
    pub fn packed_triangles(&self) -> Option<Vec<[u32; 3]>> {
        self.packed.as_ref().map(Packed::triangles)
    }

    /// The corners in the order of the primitive's mode, each vertex once where it does not say.
    ///
    /// # Errors
    /// As of [`Accessors::indices`].
    pub fn corners(&self, vertices: usize) -> Result<Vec<u32>, ImportError> {
        match self.primitive.indices {
            Some(indices) => self.accessors.indices(indices.value(), &format!("{}.indices", self.place)),
            // Fewer than `u32::MAX`: the accessor's count was checked.
            #[allow(clippy::cast_possible_truncation)]
            None => Ok((0..vertices as u32).collect()),
        }
    }
}
