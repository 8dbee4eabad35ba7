//! `EXT_meshopt_compression` and its successor `KHR_meshopt_compression`: buffer views unpacked before accessors
//! read them.
//!
//! Only views that hold geometry are unpacked: a broken texture coordinate refuses nothing.

use std::collections::{BTreeMap, BTreeSet};

use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;
use gltf::json::{Root, Value, buffer};

use crate::{ImportError, Options};

use super::buffers::Buffers;
use super::instancing;
use super::notes::Notes;

const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Most bytes that one packed byte can stand for. The best packed stream is the vertex codec's second version: for
/// four byte columns of at most 256 vertices it needs one control byte at the least.
const MOST_EXPANSION: u64 = 1024;

/// By the buffer view's number: its bytes, or why they cannot be had, which matters once geometry asks for them.
pub(super) type Unpacked = BTreeMap<usize, Result<Vec<u8>, ImportError>>;

/// Unpacks every packed view that holds geometry. Where that fails and the file brings the view's plain bytes as
/// well, the view is left out here, with a note, and so read plain.
pub(super) fn unpack(root: &Root, buffers: &Buffers<'_>, options: &Options, notes: &mut Notes) -> Unpacked {
    let mut unpacked = Unpacked::new();
    let mut left = options.max_file_bytes;
    for index in geometry_views(root) {
        let Some(view) = root.buffer_views.get(index) else { continue };
        let Some((name, packed)) = packed(view) else { continue };
        let place = format!("bufferViews[{index}].extensions.{name}");
        let bytes = bytes_of(packed, buffers, &place, left, options);
        left -= bytes.as_ref().map_or(0, |bytes| bytes.len() as u64).min(left);
        match bytes {
            Err(error) if has_plain_bytes(root, buffers, view) => {
                let message = format!("{}: the uncompressed fallback is read", error.reason());
                notes.add("compression-fallback", error.place(), message);
            }
            bytes => {
                unpacked.insert(index, bytes);
            }
        }
    }
    unpacked
}

fn packed(view: &buffer::View) -> Option<(&'static str, &Value)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.iter().find_map(|name| Some((*name, others.get(*name)?)))
}

fn geometry_views(root: &Root) -> BTreeSet<usize> {
    let mut accessors = BTreeSet::new();
    for primitive in root.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        accessors.extend(primitive.indices.map(|index| index.value()));
        accessors.extend(primitive.attributes.iter().filter_map(|(semantic, accessor)| {
            let wanted = matches!(
                semantic,
                Checked::Valid(Semantic::Positions | Semantic::Joints(_) | Semantic::Weights(_))
            );
            wanted.then(|| accessor.value())
        }));
        let targets = primitive.targets.iter().flatten();
        accessors.extend(targets.filter_map(|target| target.positions.map(|index| index.value())));
    }
    accessors.extend(root.nodes.iter().flat_map(instancing::accessors));
    accessors.extend(root.skins.iter().filter_map(|skin| Some(skin.inverse_bind_matrices?.value())));
    let mut views = BTreeSet::new();
    for accessor in accessors.into_iter().filter_map(|index| root.accessors.get(index)) {
        views.extend(accessor.buffer_view.map(|view| view.value()));
        if let Some(sparse) = &accessor.sparse {
            views.extend([sparse.indices.buffer_view.value(), sparse.values.buffer_view.value()]);
        }
    }
    views
}

fn has_plain_bytes(root: &Root, buffers: &Buffers<'_>, view: &buffer::View) -> bool {
    let index = view.buffer.value();
    let stated = root.buffers.get(index).is_some_and(|buffer| buffer.uri.is_some());
    let end = view.byte_offset.unwrap_or_default().0.saturating_add(view.byte_length.0);
    stated && buffers.bytes(index, "").is_ok_and(|bytes| end <= bytes.len() as u64)
}

fn bytes_of(
    packed: &Value,
    buffers: &Buffers<'_>,
    place: &str,
    left: u64,
    options: &Options,
) -> Result<Vec<u8>, ImportError> {
    let malformed = |reason: String| ImportError::malformed(place, reason);
    let number = |name: &str, default: Option<u64>| {
        let value = packed.get(name).map_or(default, Value::as_u64);
        value.ok_or_else(|| malformed(format!("expected {name} to be a whole number")))
    };
    let buffer = usize::try_from(number("buffer", None)?).unwrap_or(usize::MAX);
    let start = number("byteOffset", Some(0))?;
    let end = start.saturating_add(number("byteLength", None)?);
    let (stride, count) = (number("byteStride", None)?, number("count", None)?);
    let bytes = buffers.bytes(buffer, place)?;
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    let data = range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| {
        malformed(format!("bytes {start} to {end} of buffers[{buffer}], which has {}", bytes.len()))
    })?;
    let size = count.saturating_mul(stride);
    if size > left {
        let reason =
            format!("unpacks to {size} bytes, of {} for a file {left} are left", options.max_file_bytes);
        return Err(ImportError::too_large(place, reason));
    }
    if size > MOST_EXPANSION.saturating_mul(data.len() as u64) {
        return Err(malformed(format!(
            "{} bytes cannot hold {count} elements of {stride} bytes",
            data.len()
        )));
    }
    // Held under the size of what follows.
    let (count, stride) = (usize::try_from(count).unwrap_or(0), usize::try_from(stride).unwrap_or(0));
    let mode = packed.get("mode").and_then(Value::as_str).unwrap_or_default();
    let filter = packed.get("filter").and_then(Value::as_str).unwrap_or("NONE");
    if count == 0 {
        return Ok(Vec::new());
    }
    let refused = |fault: meshopt::Error| malformed(format!("the {mode} stream cannot be unpacked: {fault}"));
    let unpacked = match (mode, stride) {
        ("ATTRIBUTES", 4..=256) if stride % 4 == 0 => vertices(data, count, stride).map_err(refused)?,
        ("TRIANGLES", 2 | 4) if count % 3 == 0 => triangles(data, count, stride).map_err(refused)?,
        ("INDICES", 2 | 4) => sequence(data, count, stride).map_err(refused)?,
        ("ATTRIBUTES" | "TRIANGLES" | "INDICES", _) => {
            return Err(malformed(format!("{mode} of {count} elements of {stride} bytes cannot be")));
        }
        _ => {
            return Err(malformed(format!(
                "expected a mode of ATTRIBUTES, TRIANGLES or INDICES, found {mode:?}"
            )));
        }
    };
    match (filter, stride) {
        ("NONE", _) => Ok(unpacked),
        ("OCTAHEDRAL", 4) => Ok(filtered_bytes(&unpacked, meshopt::encoding::decode_filter_oct::<i8>)),
        ("OCTAHEDRAL", 8) => Ok(filtered_words(&unpacked, meshopt::encoding::decode_filter_oct::<i16>)),
        ("QUATERNION", 8) => Ok(filtered_words(&unpacked, meshopt::encoding::decode_filter_quat)),
        ("EXPONENTIAL", _) if stride % 4 == 0 => Ok(exponential(&unpacked)),
        _ => Err(malformed(format!("the filter {filter} over elements of {stride} bytes is not known"))),
    }
}

/// A vertex of `N` words: the codec takes its stride from a type.
#[derive(Clone)]
struct Vertex<const N: usize>([[u8; 4]; N]);

impl<const N: usize> Default for Vertex<N> {
    fn default() -> Self {
        Self([[0; 4]; N])
    }
}

fn vertices_of<const N: usize>(data: &[u8], count: usize) -> meshopt::Result<Vec<u8>> {
    let vertices = meshopt::encoding::decode_vertex_buffer::<Vertex<N>>(data, count)?;
    let mut bytes = Vec::with_capacity(count * N * 4);
    vertices.iter().for_each(|vertex| bytes.extend_from_slice(vertex.0.as_flattened()));
    Ok(bytes)
}

fn vertices(data: &[u8], count: usize, stride: usize) -> meshopt::Result<Vec<u8>> {
    macro_rules! by_words {
        ($($words:literal)*) => {
            match stride / 4 {
                $($words => vertices_of::<$words>(data, count),)*
                _ => Ok(Vec::new()),
            }
        };
    }
    by_words!(
        1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32
        33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64
    )
}

fn triangles(data: &[u8], count: usize, stride: usize) -> meshopt::Result<Vec<u8>> {
    Ok(if stride == 2 {
        little_endian(meshopt::encoding::decode_index_buffer::<u16>(data, count)?, u16::to_le_bytes)
    } else {
        little_endian(meshopt::encoding::decode_index_buffer::<u32>(data, count)?, u32::to_le_bytes)
    })
}

fn sequence(data: &[u8], count: usize, stride: usize) -> meshopt::Result<Vec<u8>> {
    Ok(if stride == 2 {
        little_endian(meshopt::encoding::decode_index_sequence::<u16>(data, count)?, u16::to_le_bytes)
    } else {
        little_endian(meshopt::encoding::decode_index_sequence::<u32>(data, count)?, u32::to_le_bytes)
    })
}

fn little_endian<T, const N: usize>(values: Vec<T>, bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    values.into_iter().flat_map(bytes).collect()
}

fn filtered_bytes(bytes: &[u8], filter: impl Fn(&mut [[i8; 4]])) -> Vec<u8> {
    let mut vectors: Vec<[i8; 4]> =
        bytes.as_chunks().0.iter().map(|four: &[u8; 4]| four.map(u8::cast_signed)).collect();
    filter(&mut vectors);
    vectors.as_flattened().iter().map(|value| value.cast_unsigned()).collect()
}

fn filtered_words(bytes: &[u8], filter: impl Fn(&mut [[i16; 4]])) -> Vec<u8> {
    let words: Vec<i16> = bytes.as_chunks().0.iter().map(|two| i16::from_le_bytes(*two)).collect();
    let mut vectors: Vec<[i16; 4]> = words.as_chunks().0.to_vec();
    filter(&mut vectors);
    little_endian(vectors.into_flattened(), i16::to_le_bytes)
}

fn exponential(bytes: &[u8]) -> Vec<u8> {
    let mut words: Vec<[u32; 1]> =
        bytes.as_chunks().0.iter().map(|four| [u32::from_le_bytes(*four)]).collect();
    meshopt::encoding::decode_filter_exp(&mut words);
    little_endian(words.into_flattened(), u32::to_le_bytes)
}
