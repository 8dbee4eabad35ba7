//! What a reader gathers, and the sieve that every format's meshes go through.

use std::collections::BTreeSet;

use crate::asset::{AssetKey, Axis, FileFrame, Format, Geometry, Source, SourcePart, Stated};
use crate::cloud::{self, Cloud};
use crate::{ImportError, Options};

use super::notes::Notes;

/// Coordinates beyond this are taken for garbage, as infinities are: their products leave double precision.
pub(super) const LARGEST_COORDINATE: f64 = 1e50;

/// Codes of notes that explain why a file came to no triangles.
const EXPLAINING: [&str; 9] = [
    "broken-reference",
    "no-position",
    "primitive-ignored",
    "points-ignored",
    "lines-ignored",
    "faces-dropped",
    "bad-number",
    "no-scene",
    "empty",
];

#[derive(Debug, Default)]
pub(super) struct Reading {
    pub geometry: Geometry,
    pub parts: Vec<SourcePart>,
    /// Points, which become parts where there is nothing else.
    pub clouds: Vec<Cloud>,
    pub names: Names,
    pub stated: Vec<Stated>,
    pub notes: Notes,
    /// Bytes of the buffer files it refers to, in order.
    pub referred: Vec<Vec<u8>>,
    /// Vertices and triangles of the parts that came by [`Reading::add_part`].
    pub counts: [u64; 2],
}

/// Names in order, each once.
#[derive(Debug, Default)]
pub(super) struct Names {
    list: Vec<String>,
    seen: BTreeSet<String>,
}

impl Names {
    pub fn add(&mut self, name: &str) {
        let name = name.trim();
        if !name.is_empty() && self.seen.insert(name.to_owned()) {
            self.list.push(name.to_owned());
        }
    }
}

impl Reading {
    /// A part of the reader's own making; one without triangles is passed over.
    ///
    /// # Errors
    /// Too large, at `place`, where all of them together are.
    pub fn add_part(&mut self, part: SourcePart, place: &str, options: &Options) -> Result<(), ImportError> {
        if part.mesh.triangles.is_empty() {
            return Ok(());
        }
        self.counts[0] += part.mesh.positions.len() as u64;
        self.counts[1] += part.mesh.triangles.len() as u64;
        self.parts.push(part);
        check_counts(self.counts[0], self.counts[1], place, options)
    }

    /// Points that may become a part. `normals` are as many, or none.
    pub fn add_cloud(&mut self, name: impl Into<String>, positions: Vec<[f64; 3]>, normals: Vec<[f64; 3]>) {
        if !positions.is_empty() {
            self.clouds.push(Cloud { name: name.into(), positions, normals });
        }
    }

    /// Lays surfaces through the points of a file that has nothing but points.
    fn cover_clouds(&mut self, options: &Options) {
        for cloud in std::mem::take(&mut self.clouds) {
            let count = cloud.positions.len();
            let place = format!("points {:?}", cloud.name);
            let mut cloud = cloud;
            if cloud.normals.is_empty() {
                cloud.positions.retain(|point| point.iter().all(|value| value.abs() <= LARGEST_COORDINATE));
            }
            let sound = |value: &f64| value.abs() <= LARGEST_COORDINATE;
            if !cloud.positions.as_flattened().iter().all(sound) {
                self.notes.add("points-ignored", place, "a coordinate is not finite");
                continue;
            }
            let Some(through) = cloud::surface(&cloud, options.cloud_cells) else {
                let message =
                    format!("{count} points that enclose nothing: too few, in a plane, or an open sheet");
                self.notes.add("points-ignored", place, message);
                continue;
            };
            let message = format!(
                "a surface of {} triangles laid through {count} points; it may lie {:.3} off",
                through.mesh.triangles.len(),
                through.deviation
            );
            self.notes.add("surface-through-points", place, message);
            self.geometry = Geometry::Points;
            self.parts.push(SourcePart {
                deviation: through.deviation,
                ..SourcePart::new(cloud.name, through.mesh)
            });
        }
    }

    /// Drops the faces that cannot stand, and refuses what has none left.
    pub fn finish(mut self, key: AssetKey, format: Format, options: &Options) -> Result<Source, ImportError> {
        if self.parts.iter().all(|part| part.mesh.triangles.is_empty()) {
            self.cover_clouds(options);
        }
        let mut dropped = 0;
        for (index, part) in self.parts.iter_mut().enumerate() {
            let lost = sift(part);
            if lost > 0 {
                let read = part.mesh.triangles.len() as u64 + lost;
                let message = format!(
                    "{lost} of {read} triangles left out: a corner is not among the vertices, or not finite"
                );
                self.notes.add("faces-dropped", format!("part {index} {:?}", part.name), message);
            }
            dropped += lost;
        }
        self.parts.retain(|part| !part.mesh.triangles.is_empty());
        if self.parts.is_empty() {
            return Err(self.nothing(dropped));
        }
        let frame = self.frame(format);
        Ok(Source {
            key,
            format,
            geometry: self.geometry,
            frame,
            parts: self.parts,
            names: self.names.list,
            stated: self.stated,
            notes: self.notes.finish(),
        })
    }

    fn nothing(&self, dropped: u64) -> ImportError {
        if let Some(broken) = self.notes.faults(&["broken-reference"]).first() {
            let (place, reason) = broken.split_once(": ").unwrap_or(("", broken));
            return ImportError::malformed(place, reason);
        }
        let faults = self.notes.faults(&EXPLAINING);
        if dropped > 0 {
            return ImportError::malformed("vertices", format!("no usable triangle: {}", faults.join("; ")));
        }
        let told = if faults.is_empty() { String::new() } else { format!(": {}", faults.join("; ")) };
        ImportError::no_triangles(format!("no triangles{told}"))
    }

    fn frame(&mut self, format: Format) -> FileFrame {
        if matches!(format, Format::Glb | Format::Gltf | Format::Shapes) {
            return FileFrame { metres_per_unit: 1.0, unit_stated: true, up: Axis::Y, up_stated: true };
        }
        let up = match format {
            Format::Stl | Format::Vox | Format::Xyz | Format::Pcd => Axis::Z,
            _ => Axis::Y,
        };
        self.notes.add("unit-assumed", "", "the format states no unit: one unit is taken for one metre");
        self.notes.add("up-assumed", "", format!("the format states no up axis: {up:?} is taken for up"));
        FileFrame { metres_per_unit: 1.0, unit_stated: false, up, up_stated: false }
    }
}

/// Holds the sums of vertices and triangles under the limit, and vertex numbers within `u32`.
///
/// # Errors
/// [`ImportError::TooLarge`] at `place`.
pub(super) fn check_counts(
    vertices: u64,
    triangles: u64,
    place: &str,
    options: &Options,
) -> Result<(), ImportError> {
    let most_vertices = options.max_triangles.saturating_mul(3).min(u64::from(u32::MAX - 1));
    if triangles > options.max_triangles {
        return Err(ImportError::too_large(
            place,
            format!("{triangles} triangles so far, the limit is {}", options.max_triangles),
        ));
    }
    if vertices > most_vertices {
        return Err(ImportError::too_large(
            place,
            format!("{vertices} vertices so far, the limit is {most_vertices}"),
        ));
    }
    Ok(())
}

/// Removes triangles with a corner that is absent or not finite, then the vertices that are not finite.
fn sift(part: &mut SourcePart) -> u64 {
    let mesh = &mut part.mesh;
    let sound: Vec<bool> = mesh
        .positions
        .iter()
        .map(|position| position.iter().all(|value| value.abs() <= LARGEST_COORDINATE))
        .collect();
    let before = mesh.triangles.len();
    mesh.triangles
        .retain(|corners| corners.iter().all(|&corner| sound.get(corner as usize).copied().unwrap_or(false)));
    if sound.contains(&false) {
        let mut place = vec![0_u32; sound.len()];
        let mut next = 0;
        for (slot, &kept) in place.iter_mut().zip(&sound) {
            *slot = next;
            next += u32::from(kept);
        }
        let mut kept = sound.iter();
        mesh.positions.retain(|_| kept.next() == Some(&true));
        for corner in mesh.triangles.iter_mut().flatten() {
            *corner = place[*corner as usize];
        }
    }
    let lost = (before - mesh.triangles.len()) as u64;
    part.dropped += lost;
    lost
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Mesh;

    #[test]
    fn the_sieve_keeps_what_stands_and_counts_the_rest() {
        let positions =
            vec![[0.0; 3], [f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1e60, 0.0, 0.0]];
        let triangles = vec![[0, 2, 3], [0, 1, 2], [0, 2, 9], [4, 2, 3]];
        let mut part = SourcePart::new("p", Mesh { positions, triangles });
        assert_eq!(sift(&mut part), 3);
        assert_eq!(part.mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(part.mesh.triangles, [[0, 1, 2]]);
        assert_eq!(part.dropped, 3);
    }

    #[test]
    fn names_come_once_and_in_order() {
        let mut names = Names::default();
        for name in ["b", " a ", "", "b"] {
            names.add(name);
        }
        assert_eq!(names.list, ["b", "a"]);
    }
}
