//! Checked reading of glTF accessors: strided, sparse, normalised, quantised, and absent views (all zeros).
//!
//! The `gltf` crate's own reader takes positions for `f32` and trusts every offset; here nothing is trusted.

use std::borrow::Cow;

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Accessor, Root};

use crate::{ImportError, Options};

use super::buffers::Buffers;
use super::meshopt::Unpacked;
use super::reading::check_counts;

pub(super) struct Accessors<'a> {
    pub root: &'a Root,
    pub buffers: &'a Buffers<'a>,
    /// Bytes of buffer views that were packed.
    pub unpacked: &'a Unpacked,
    pub options: &'a Options,
}

/// Elements of one accessor, or of a sparse accessor's indices or values, within bytes that hold them all.
struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    stride: usize,
    component: ComponentType,
    normalized: bool,
}

impl Accessors<'_> {
    /// Vectors of `N` components: 3 for positions, 4 for weights, 16 for matrices.
    pub fn vectors<const N: usize>(&self, index: usize, asked: &str) -> Result<Vec<[f64; N]>, ImportError> {
        let (accessor, component, kind, count) = self.accessor(index, asked)?;
        let place = format!("accessors[{index}]");
        if components(kind) != N {
            let reason = format!("expected {N} components an element for {asked}, found {kind:?}");
            return Err(ImportError::malformed(place, reason));
        }
        let elements = self.elements(
            accessor.buffer_view.map(|view| view.value()),
            accessor.byte_offset,
            Shape { component, components: N, normalized: accessor.normalized, count, place: &place },
        )?;
        let mut values: Vec<[f64; N]> = match &elements {
            Some(elements) => (0..count).map(|at| elements.vector(at)).collect(),
            None => vec![[0.0; N]; count],
        };
        self.overlay(
            accessor,
            &place,
            count,
            Shape { component, components: N, normalized: accessor.normalized, count: 0, place: &place },
            |at, sparse, from| values[at] = sparse.vector(from),
        )?;
        Ok(values)
    }

    /// Unsigned integers: triangle corners, joints.
    pub fn indices(&self, index: usize, asked: &str) -> Result<Vec<u32>, ImportError> {
        let (accessor, component, kind, count) = self.accessor(index, asked)?;
        let place = format!("accessors[{index}]");
        if kind != Type::Scalar
            || !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
        {
            let reason = format!("expected unsigned scalars for {asked}, found {kind:?} of {component:?}");
            return Err(ImportError::malformed(place, reason));
        }
        let shape = Shape { component, components: 1, normalized: false, count, place: &place };
        let view = accessor.buffer_view.map(|view| view.value());
        let elements = self.elements(view, accessor.byte_offset, shape)?;
        let mut values: Vec<u32> = match &elements {
            Some(elements) => (0..count).map(|at| elements.unsigned(at)).collect(),
            None => vec![0; count],
        };
        self.overlay(accessor, &place, count, Shape { count: 0, ..shape }, |at, sparse, from| {
            values[at] = sparse.unsigned(from);
        })?;
        Ok(values)
    }

    fn accessor(
        &self,
        index: usize,
        asked: &str,
    ) -> Result<(&Accessor, ComponentType, Type, usize), ImportError> {
        let Some(accessor) = self.root.accessors.get(index) else {
            let reason = format!("refers to accessors[{index}], there are {}", self.root.accessors.len());
            return Err(ImportError::malformed(asked, reason));
        };
        let place = format!("accessors[{index}]");
        let Checked::Valid(component) = accessor.component_type else {
            let reason = "expected a componentType of 5120 to 5123, 5125 or 5126, found another";
            return Err(ImportError::malformed(place, reason));
        };
        let Checked::Valid(kind) = accessor.type_ else {
            let reason = "expected a type of SCALAR, VEC2 to VEC4 or MAT2 to MAT4, found another";
            return Err(ImportError::malformed(place, reason));
        };
        check_counts(accessor.count.0, 0, &place, self.options)?;
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        Ok((accessor, component.0, kind, count))
    }

    /// The bytes of a buffer view and its stride.
    pub fn view(&self, index: usize, asked: &str) -> Result<(&[u8], Option<usize>), ImportError> {
        let views = &self.root.buffer_views;
        let Some(view) = views.get(index) else {
            let reason = format!("refers to bufferViews[{index}], there are {}", views.len());
            return Err(ImportError::malformed(asked, reason));
        };
        let stride = view.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0);
        if let Some(unpacked) = self.unpacked.get(&index) {
            return unpacked.as_ref().map(|bytes| (bytes.as_slice(), stride)).map_err(ImportError::again);
        }
        let place = format!("bufferViews[{index}]");
        let bytes = self.buffers.bytes(view.buffer.value(), &place)?;
        let start = view.byte_offset.unwrap_or_default().0;
        let end = start.saturating_add(view.byte_length.0);
        let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        range.and_then(|(start, end)| bytes.get(start..end)).map(|bytes| (bytes, stride)).ok_or_else(|| {
            let reason = format!(
                "bytes {start} to {end} of buffers[{}], which has {}",
                view.buffer.value(),
                bytes.len()
            );
            ImportError::malformed(place, reason)
        })
    }

    fn elements(
        &self,
        view: Option<usize>,
        offset: Option<USize64>,
        shape: Shape<'_>,
    ) -> Result<Option<Elements<'_>>, ImportError> {
        let Some(view) = view else { return Ok(None) };
        let (bytes, stride) = self.view(view, shape.place)?;
        let size = shape.components * shape.component.size();
        let stride = stride.unwrap_or(size);
        let offset = offset.unwrap_or_default().0;
        let length = (shape.count as u64)
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride as u64)?.checked_add(size as u64));
        let end = length.and_then(|length| length.checked_add(offset));
        let range = usize::try_from(offset).ok().zip(end.and_then(|end| usize::try_from(end).ok()));
        let bytes = range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| {
            let reason = format!(
                "{} elements of {size} bytes, {stride} apart, from byte {offset}: beyond the {} bytes of \
                 bufferViews[{view}]",
                shape.count,
                bytes.len()
            );
            ImportError::malformed(shape.place, reason)
        })?;
        Ok(Some(Elements {
            bytes: Cow::Borrowed(bytes),
            stride,
            component: shape.component,
            normalized: shape.normalized,
        }))
    }

    /// Puts a sparse accessor's values over what its base gave.
    fn overlay(
        &self,
        accessor: &Accessor,
        place: &str,
        count: usize,
        shape: Shape<'_>,
        mut put: impl FnMut(usize, &Elements<'_>, usize),
    ) -> Result<(), ImportError> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let place = format!("{place}.sparse");
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(ImportError::malformed(
                place,
                "expected indices of 5121, 5123 or 5125, found another",
            ));
        };
        check_counts(sparse.count.0, 0, &place, self.options)?;
        let entries = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        let of_indices =
            Shape { component: component.0, components: 1, normalized: false, count: entries, place: &place };
        let of_values = Shape { count: entries, place: &place, ..shape };
        let indices = self.elements(
            Some(sparse.indices.buffer_view.value()),
            Some(sparse.indices.byte_offset),
            of_indices,
        )?;
        let values = self.elements(
            Some(sparse.values.buffer_view.value()),
            Some(sparse.values.byte_offset),
            of_values,
        )?;
        let (Some(indices), Some(values)) = (indices, values) else { return Ok(()) };
        for entry in 0..entries {
            let at = indices.unsigned(entry) as usize;
            if at >= count {
                let reason = format!("replaces element {at} of {count}");
                return Err(ImportError::malformed(place, reason));
            }
            put(at, &values, entry);
        }
        Ok(())
    }
}

#[derive(Clone, Copy)]
struct Shape<'a> {
    component: ComponentType,
    components: usize,
    normalized: bool,
    count: usize,
    place: &'a str,
}

impl Elements<'_> {
    fn vector<const N: usize>(&self, at: usize) -> [f64; N] {
        let start = at * self.stride;
        let size = self.component.size();
        std::array::from_fn(|component| {
            number(&self.bytes[start + component * size..], self.component, self.normalized)
        })
    }

    fn unsigned(&self, at: usize) -> u32 {
        let bytes = &self.bytes[at * self.stride..];
        match self.component {
            ComponentType::U8 => u32::from(bytes[0]),
            ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        }
    }
}

/// A component's value; normalised integers as in glTF 2.0, section 3.6.2.2.
fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> f64 {
    let (value, most) = match component {
        ComponentType::I8 => (f64::from(i8::from_le_bytes([bytes[0]])), f64::from(i8::MAX)),
        ComponentType::U8 => (f64::from(bytes[0]), f64::from(u8::MAX)),
        ComponentType::I16 => (f64::from(i16::from_le_bytes([bytes[0], bytes[1]])), f64::from(i16::MAX)),
        ComponentType::U16 => (f64::from(u16::from_le_bytes([bytes[0], bytes[1]])), f64::from(u16::MAX)),
        ComponentType::U32 => {
            (f64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), f64::from(u32::MAX))
        }
        ComponentType::F32 => {
            return f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
        }
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

const fn components(kind: Type) -> usize {
    match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn with<T>(json: &str, bytes: &[u8], work: impl FnOnce(&Accessors<'_>) -> T) -> T {
        let text = format!(r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":1}}],{json}}}"#);
        let root: Root = gltf::json::deserialize::from_str(&text).unwrap();
        let options = Options::default();
        let buffers = Buffers::load(&root, Some(bytes), Path::new(""), &options).unwrap();
        let unpacked = Unpacked::new();
        work(&Accessors { root: &root, buffers: &buffers, unpacked: &unpacked, options: &options })
    }

    #[test]
    fn strided_normalised_bytes() {
        let json = r#""bufferViews":[{"buffer":0,"byteOffset":1,"byteLength":7,"byteStride":4}],
            "accessors":[{"bufferView":0,"componentType":5120,"count":2,"type":"VEC3","normalized":true}]"#;
        let bytes = [9, 127, 0, 0x80, 9, 0x81, 127, 0];
        let values = with(json, &bytes, |all| all.vectors::<3>(0, "POSITION").unwrap());
        assert_eq!(values, [[1.0, 0.0, -1.0], [-1.0, 1.0, 0.0]]);
    }

    #[test]
    fn sparse_over_nothing() {
        let json = r#""bufferViews":[{"buffer":0,"byteLength":1},{"buffer":0,"byteOffset":1,"byteLength":2}],
            "accessors":[{"componentType":5123,"count":3,"type":"SCALAR","sparse":{"count":1,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}}}]"#;
        assert_eq!(with(json, &[2, 5, 1], |all| all.indices(0, "indices").unwrap()), [0, 0, 261]);
        let error = with(json, &[3, 5, 1], |all| all.indices(0, "indices").unwrap_err());
        assert_eq!(error.place(), "accessors[0].sparse");
    }

    #[test]
    fn nothing_is_read_beyond_a_view_or_a_limit() {
        let json = |count: &str, offset: &str| {
            format!(
                r#""bufferViews":[{{"buffer":0,"byteLength":8}}],"accessors":[{{"bufferView":0,
                "byteOffset":{offset},"componentType":5126,"count":{count},"type":"SCALAR"}}]"#
            )
        };
        let code = |count, offset| {
            with(&json(count, offset), &[0; 8], |all| {
                all.vectors::<1>(0, "x").map(|values| values.len()).map_err(|error| error.code())
            })
        };
        assert_eq!(code("2", "0"), Ok(2));
        assert_eq!(code("0", "0"), Ok(0));
        assert_eq!(code("2", "1"), Err("malformed"));
        assert_eq!(code("2", "18446744073709551615"), Err("malformed"));
        assert_eq!(code("18446744073709551615", "0"), Err("too-large"));
    }
}
