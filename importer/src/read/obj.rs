//! Wavefront OBJ: `v`, `f`, `o`, `g`, `usemtl`; everything else is passed over.
//!
//! Read here rather than through `tobj`: what is broken in real files (a corner that is not there, a number that
//! is none) costs one face and a note with its line, not the file; coordinates stay in double precision; and a
//! missing `.mtl` does not matter to geometry. Polygons are fanned from their first corner.

use std::collections::BTreeMap;

use crate::asset::{Mesh, SourcePart};
use crate::{ImportError, Options};

use super::reading::{Reading, check_counts};

/// Stands for a corner that is not there: no file has so many vertices, `check_counts` sees to it.
const ABSENT: u32 = u32::MAX;

struct Group {
    name: String,
    materials: Vec<usize>,
    /// Corners number the file's vertices.
    triangles: Vec<[u32; 3]>,
}

#[derive(Default)]
struct File {
    positions: Vec<[f64; 3]>,
    groups: Vec<Group>,
    group_of: BTreeMap<(String, String), usize>,
    object: String,
    group: String,
    current: Option<usize>,
    materials: Vec<String>,
    material_of: BTreeMap<String, usize>,
    material: Option<usize>,
    has_lines: bool,
}

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let mut file = File::default();
    let mut corners = Vec::new();
    let mut triangles = 0;
    let mut joined: Vec<u8> = Vec::new();
    for (number, raw) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let raw = raw.trim_ascii_end();
        if let Some(start) = raw.strip_suffix(b"\\") {
            joined.extend_from_slice(start);
            joined.push(b' ');
            continue;
        }
        joined.extend_from_slice(raw);
        let line = &joined[..joined.iter().position(|&byte| byte == b'#').unwrap_or(joined.len())];
        let mut words = line.split(|byte| byte.is_ascii_whitespace()).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => {
                let position = std::array::from_fn(|_| coordinate(words.next(), number, reading));
                file.positions.push(position);
            }
            Some(b"f") => {
                corners.clear();
                corners.extend(words.map(|word| corner(word, file.positions.len())));
                if corners.len() < 3 {
                    let message = format!("a face of {} corners", corners.len());
                    reading.notes.add("faces-dropped", place(number), message);
                }
                let group = file.current_group();
                for at in 2..corners.len() {
                    group.triangles.push([corners[0], corners[at - 1], corners[at]]);
                    triangles += 1;
                }
            }
            Some(b"o") => {
                file.object = rest(line);
                file.group = String::new();
                file.current = None;
                reading.names.add(&file.object);
            }
            Some(b"g") => {
                file.group = rest(line);
                file.current = None;
                reading.names.add(&file.group);
            }
            Some(b"usemtl") => {
                let name = rest(line);
                reading.names.add(&name);
                let next = file.materials.len();
                let index = *file.material_of.entry(name.clone()).or_insert(next);
                if index == next {
                    file.materials.push(name);
                }
                file.material = Some(index);
            }
            Some(b"l") => {
                file.has_lines = true;
                reading.notes.add("lines-ignored", place(number), "lines are no surface");
            }
            _ => {}
        }
        joined.clear();
    }
    check_counts(file.positions.len() as u64, triangles, "faces", options)?;
    if triangles == 0 && !file.has_lines && !file.positions.is_empty() {
        reading.add_cloud("part 0", file.positions, Vec::new());
        return Ok(());
    }
    if triangles == 0 && !file.positions.is_empty() {
        reading.notes.add("empty", "", format!("{} vertices and no face", file.positions.len()));
    }
    file.into_parts(reading);
    Ok(())
}

impl File {
    fn current_group(&mut self) -> &mut Group {
        let index = if let Some(index) = self.current {
            index
        } else {
            let next = self.groups.len();
            let key = (self.object.clone(), self.group.clone());
            let index = *self.group_of.entry(key).or_insert(next);
            if index == next {
                let name = if self.group.is_empty() { &self.object } else { &self.group };
                let name = if name.is_empty() { format!("part {next}") } else { name.clone() };
                self.groups.push(Group { name, materials: Vec::new(), triangles: Vec::new() });
            }
            self.current = Some(index);
            index
        };
        let group = &mut self.groups[index];
        if let Some(material) = self.material
            && group.materials.last() != Some(&material)
            && !group.materials.contains(&material)
        {
            group.materials.push(material);
        }
        group
    }

    fn into_parts(self, reading: &mut Reading) {
        let named = |materials: &[usize]| materials.iter().map(|&at| self.materials[at].clone()).collect();
        let with_faces = self.groups.iter().filter(|group| !group.triangles.is_empty()).count();
        if with_faces == 1 {
            let only = self.groups.into_iter().find(|group| !group.triangles.is_empty());
            reading.parts.extend(only.map(|group| SourcePart {
                materials: group.materials.iter().map(|&at| self.materials[at].clone()).collect(),
                ..SourcePart::new(group.name, Mesh { positions: self.positions, triangles: group.triangles })
            }));
            return;
        }
        // Where each vertex went in the part it was last used in.
        let mut moved = vec![(usize::MAX, 0_u32); self.positions.len()];
        for (index, group) in self.groups.iter().enumerate() {
            let mut mesh = Mesh { positions: Vec::new(), triangles: group.triangles.clone() };
            for corner in mesh.triangles.iter_mut().flatten() {
                let Some(slot) = moved.get_mut(*corner as usize) else { continue };
                if slot.0 != index {
                    // Fewer than the file's vertices, which `check_counts` holds within `u32`.
                    #[allow(clippy::cast_possible_truncation)]
                    let next = mesh.positions.len() as u32;
                    *slot = (index, next);
                    mesh.positions.push(self.positions[*corner as usize]);
                }
                *corner = slot.1;
            }
            let materials = named(&group.materials);
            reading.parts.push(SourcePart { materials, ..SourcePart::new(group.name.as_str(), mesh) });
        }
    }
}

/// The vertex number of `7`, `7/1`, `7//3`, `-2/…`: from 1, or backwards from the last vertex so far.
fn corner(word: &[u8], vertices: usize) -> u32 {
    let number = word.split(|&byte| byte == b'/').next().unwrap_or(word);
    let parsed = std::str::from_utf8(number).ok().and_then(|text| text.parse::<i64>().ok());
    let index = match parsed {
        Some(number) if number > 0 => u64::try_from(number).ok().map(|number| number - 1),
        Some(number) if number < 0 => (vertices as u64).checked_sub(number.unsigned_abs()),
        _ => None,
    };
    index.and_then(|index| u32::try_from(index).ok()).unwrap_or(ABSENT)
}

/// A number that is none keeps its vertex, and so the numbering of the others; its faces go.
fn coordinate(word: Option<&[u8]>, line: usize, reading: &mut Reading) -> f64 {
    let parsed = word.and_then(|word| std::str::from_utf8(word).ok()).and_then(|text| text.parse().ok());
    parsed.unwrap_or_else(|| {
        let found = word.map_or("nothing".into(), String::from_utf8_lossy);
        reading.notes.add("bad-number", place(line), format!("expected a number, found {found}"));
        f64::NAN
    })
}

fn rest(line: &[u8]) -> String {
    let line = line.trim_ascii();
    let word = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    String::from_utf8_lossy(line[word..].trim_ascii()).into_owned()
}

fn place(line: usize) -> String {
    format!("line {}", line + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(text: &str) -> Reading {
        let mut reading = Reading::default();
        read(text.as_bytes(), &Options::default(), &mut reading).unwrap();
        reading
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn polygons_are_fanned_and_indices_may_count_back() {
        let reading = read_all(&format!("{SQUARE}f 1/1 2/2/2 3//3 -1\n"));
        assert_eq!(reading.parts[0].mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_part_per_object_and_group_with_its_materials() {
        let text = format!(
            "mtllib absent.mtl\n{SQUARE}o Box\nusemtl Red\nf 1 2 3\ng Lid\nusemtl Blue\nf 1 3 4\no Box\nf 2 3 4\n"
        );
        let reading = read_all(&text);
        let told: Vec<_> =
            reading.parts.iter().map(|part| (part.name.as_str(), part.materials.join(" "))).collect();
        assert_eq!(told, [("Box", "Red Blue".to_owned()), ("Lid", "Blue".to_owned())]);
        assert_eq!(reading.parts[1].mesh.positions, [[0.0; 3], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn a_line_may_go_on_and_comments_end_it() {
        let reading = read_all(&format!("{SQUARE}f 1 2 \\\n 3 # 4\n"));
        assert_eq!(reading.parts[0].mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn a_corner_that_is_not_there_stays_absent() {
        let reading = read_all(&format!("{SQUARE}f 0 2 3\nf 1 2 -9\nf 1 2 x\nf 1 2\n"));
        assert!(reading.parts[0].mesh.triangles.iter().all(|corners| corners.contains(&ABSENT)));
        assert_eq!(reading.parts[0].mesh.triangles.len(), 3);
    }
}
