//! An asset as rows, and back, without losing a bit.
//!
//! What SQL may want to read is JSON; the long lists of numbers (hull corners, triangle meshes) are
//! little-endian bytes.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::collider::{Candidate, Shape};
use crate::{Asset, Part};

/// The whole asset's ladder stands under this part number.
pub(super) const WHOLE: i64 = -1;

/// An asset ready to be written.
pub(super) struct EncodedAsset {
    /// Without parts and ladder.
    pub asset: Asset,
    pub facts: String,
    pub parts: Vec<EncodedPart>,
    pub colliders: Vec<EncodedCollider>,
}

pub(super) struct EncodedPart {
    /// Without ladder.
    pub part: Part,
    pub facts: String,
}

pub(super) struct EncodedCollider {
    pub part: i64,
    pub step: i64,
    /// Without shapes.
    pub candidate: Candidate,
    pub pieces: usize,
    pub facts: String,
    pub shapes: String,
    pub geometry: Vec<u8>,
}

impl EncodedAsset {
    /// Takes the asset apart.
    ///
    /// # Errors
    /// Says what could not be stored: a number that is not finite has no place in JSON.
    pub fn new(mut asset: Asset) -> Result<Self, String> {
        let mut colliders = Vec::new();
        encode_ladder(WHOLE, std::mem::take(&mut asset.ladder), &mut colliders)?;
        let mut parts = Vec::with_capacity(asset.parts.len());
        for (index, mut part) in (0_i64..).zip(std::mem::take(&mut asset.parts)) {
            encode_ladder(index, std::mem::take(&mut part.ladder), &mut colliders)?;
            let facts = to_json(&part, "a part")?;
            parts.push(EncodedPart { part, facts });
        }
        let facts = to_json(&asset, "its facts")?;
        Ok(Self { asset, facts, parts, colliders })
    }

    /// Room it takes while it waits to be written, about.
    pub fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(|part| 2 * part.facts.len()).sum();
        let colliders: usize = self
            .colliders
            .iter()
            .map(|collider| 2 * collider.facts.len() + collider.shapes.len() + collider.geometry.len())
            .sum();
        2 * self.facts.len() + parts + colliders
    }
}

fn encode_ladder(part: i64, ladder: Vec<Candidate>, into: &mut Vec<EncodedCollider>) -> Result<(), String> {
    for (step, mut candidate) in (0_i64..).zip(ladder) {
        let shapes = std::mem::take(&mut candidate.shapes);
        let facts = to_json(&candidate, "a collider")?;
        let pieces = shapes.len();
        let (shapes, geometry) = encode_shapes(shapes)?;
        into.push(EncodedCollider { part, step, candidate, pieces, facts, shapes, geometry });
    }
    Ok(())
}

/// JSON that is known to read back as the same value.
fn to_json<T: Serialize + DeserializeOwned + PartialEq>(value: &T, what: &str) -> Result<String, String> {
    let text = serde_json::to_string(value).map_err(|error| format!("{what}: {error}"))?;
    // A number that is not finite becomes null: better refused here than found out by every reader.
    match serde_json::from_str::<T>(&text) {
        Ok(back) if back == *value => Ok(text),
        _ => Err(format!("{what}: a number in it is not finite")),
    }
}

/// A shape as JSON keeps it.
#[derive(PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum StoredShape {
    Long(LongShape),
    Short(Shape),
}

/// Counts of what follows in the geometry.
#[derive(PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LongShape {
    Hull { points: usize },
    TriangleMesh { positions: usize, triangles: usize },
}

fn encode_shapes(shapes: Vec<Shape>) -> Result<(String, Vec<u8>), String> {
    let mut geometry = Vec::new();
    let stored: Vec<StoredShape> = shapes
        .into_iter()
        .map(|shape| match shape {
            Shape::Hull { points } => {
                extend_points(&mut geometry, &points);
                StoredShape::Long(LongShape::Hull { points: points.len() })
            }
            Shape::TriangleMesh { positions, triangles } => {
                extend_points(&mut geometry, &positions);
                geometry.extend(triangles.iter().flatten().flat_map(|index| index.to_le_bytes()));
                StoredShape::Long(LongShape::TriangleMesh {
                    positions: positions.len(),
                    triangles: triangles.len(),
                })
            }
            short => StoredShape::Short(short),
        })
        .collect();
    Ok((to_json(&stored, "a shape")?, geometry))
}

fn extend_points(geometry: &mut Vec<u8>, points: &[[f64; 3]]) {
    geometry.extend(points.iter().flatten().flat_map(|number| number.to_le_bytes()));
}

/// Puts a candidate together again.
///
/// # Errors
/// Says what is wrong with the row.
pub(super) fn decode_candidate(facts: &str, shapes: &str, geometry: &[u8]) -> Result<Candidate, String> {
    let mut candidate: Candidate = serde_json::from_str(facts).map_err(|error| error.to_string())?;
    let stored: Vec<StoredShape> = serde_json::from_str(shapes).map_err(|error| error.to_string())?;
    let mut rest = geometry;
    candidate.shapes = stored
        .into_iter()
        .map(|shape| match shape {
            StoredShape::Short(shape) => Some(shape),
            StoredShape::Long(LongShape::Hull { points }) => {
                Some(Shape::Hull { points: take_triples(&mut rest, points, f64::from_le_bytes)? })
            }
            StoredShape::Long(LongShape::TriangleMesh { positions, triangles }) => {
                Some(Shape::TriangleMesh {
                    positions: take_triples(&mut rest, positions, f64::from_le_bytes)?,
                    triangles: take_triples(&mut rest, triangles, u32::from_le_bytes)?,
                })
            }
        })
        .collect::<Option<_>>()
        .ok_or_else(|| format!("geometry of {} bytes is shorter than its shapes say", geometry.len()))?;
    if !rest.is_empty() {
        return Err(format!("geometry of {} bytes is longer than its shapes say", geometry.len()));
    }
    Ok(candidate)
}

/// Takes `count` triples of `N`-byte numbers off the front, or nothing where there are too few.
fn take_triples<T: Copy + Default, const N: usize>(
    rest: &mut &[u8],
    count: usize,
    number: fn([u8; N]) -> T,
) -> Option<Vec<[T; 3]>> {
    let (taken, after) = rest.split_at_checked(count.checked_mul(3 * N)?)?;
    *rest = after;
    let mut numbers = taken.as_chunks::<N>().0.iter().map(|bytes| number(*bytes));
    Some((0..count).map(|_| std::array::from_fn(|_| numbers.next().unwrap_or_default())).collect())
}
