//! STL, binary and text.
//!
//! A binary header may begin with `solid` too, so the size decides: 84 bytes and 50 a triangle.

use crate::asset::{Mesh, SourcePart};
use crate::{ImportError, Options};

use super::reading::{Reading, check_counts};

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let exact = binary_count(bytes);
    if exact.is_none() && looks_like_text(bytes) {
        return read_text(bytes, options, reading);
    }
    read_binary(bytes, options, reading)
}

/// The triangle count of a binary file whose size fits it exactly.
pub(super) fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = stated_count(bytes)?;
    (HEADER as u64 + count as u64 * TRIANGLE as u64 == bytes.len() as u64).then_some(count)
}

fn stated_count(bytes: &[u8]) -> Option<usize> {
    let field: [u8; 4] = bytes.get(80..HEADER)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(field)).ok()
}

/// Begins with `solid` and goes on as the text form does.
pub(super) fn looks_like_text(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    let begins = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    begins && {
        let line_end = text.iter().position(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(text.len());
        let next = text[line_end..].trim_ascii_start();
        ["facet", "endsolid", "outer", "color"].iter().any(|word| {
            next.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
        })
    }
}

fn read_binary(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let Some(count) = stated_count(bytes) else {
        let reason =
            format!("{} bytes, but a binary STL begins with 84: header and triangle count", bytes.len());
        return Err(ImportError::malformed("header", reason));
    };
    let body = &bytes[HEADER..];
    if (body.len() as u64) < count as u64 * TRIANGLE as u64 {
        return Err(ImportError::malformed(
            "byte 80",
            format!(
                "the header counts {count} triangles, which take {} bytes; {} follow",
                count as u64 * TRIANGLE as u64,
                body.len()
            ),
        ));
    }
    if body.len() > count * TRIANGLE {
        let message = format!("{} bytes after the last triangle", body.len() - count * TRIANGLE);
        reading.notes.add("trailing-bytes", format!("byte {}", HEADER + count * TRIANGLE), message);
    }
    check_counts(3 * count as u64, count as u64, "byte 80", options)?;
    let mut mesh = Mesh { positions: Vec::with_capacity(3 * count), triangles: Vec::with_capacity(count) };
    for record in body.chunks_exact(TRIANGLE).take(count) {
        // The stored normal is not read: the winding says the same, and exporters get the normal wrong.
        let corner = |at: usize| -> [f64; 3] {
            std::array::from_fn(|axis| {
                let start = 12 + 12 * at + 4 * axis;
                let bytes = [record[start], record[start + 1], record[start + 2], record[start + 3]];
                f64::from(f32::from_le_bytes(bytes))
            })
        };
        push(&mut mesh, [corner(0), corner(1), corner(2)]);
    }
    if count == 0 {
        reading.notes.add("empty", "byte 80", "the header counts 0 triangles");
    }
    finish(reading, mesh, "");
    Ok(())
}

fn read_text(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let mut mesh = Mesh::default();
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut name = String::new();
    for (number, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_ascii_whitespace();
        let Some(keyword) = words.next() else { continue };
        match keyword.to_ascii_lowercase().as_str() {
            "solid" => {
                let title = words.collect::<Vec<_>>().join(" ");
                reading.names.add(&title);
                if name.is_empty() {
                    name = title;
                }
            }
            "vertex" => corners.push(std::array::from_fn(|_| {
                let word = words.next();
                word.and_then(|word| word.parse().ok()).unwrap_or_else(|| {
                    let found = word.unwrap_or("nothing");
                    reading.notes.add(
                        "bad-number",
                        format!("line {}", number + 1),
                        format!("expected a number, found {found}"),
                    );
                    f64::NAN
                })
            })),
            "endloop" | "endfacet" | "facet" => {
                for at in 2..corners.len() {
                    push(&mut mesh, [corners[0], corners[at - 1], corners[at]]);
                }
                if matches!(corners.len(), 1 | 2) {
                    let place = format!("line {}", number + 1);
                    reading.notes.add("faces-dropped", place, "a facet of fewer than three corners");
                }
                corners.clear();
            }
            _ => {}
        }
    }
    if !corners.is_empty() {
        return Err(ImportError::malformed("end of file", "the last facet is not finished"));
    }
    let count = mesh.triangles.len() as u64;
    check_counts(3 * count, count, "facets", options)?;
    finish(reading, mesh, &name);
    Ok(())
}

fn push(mesh: &mut Mesh, corners: [[f64; 3]; 3]) {
    // `check_counts` refuses a file that leaves `u32`.
    #[allow(clippy::cast_possible_truncation)]
    let base = mesh.positions.len() as u32;
    mesh.positions.extend(corners);
    mesh.triangles.push([base, base + 1, base + 2]);
}

fn finish(reading: &mut Reading, mesh: Mesh, name: &str) {
    let name = if name.is_empty() { "part 0" } else { name };
    reading.parts.push(SourcePart::new(name, mesh));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(header: &[u8], count: u32, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        for corners in triangles {
            bytes.extend([0; 12]);
            bytes.extend(corners.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn read_all(bytes: &[u8]) -> Result<Reading, ImportError> {
        let mut reading = Reading::default();
        read(bytes, &Options::default(), &mut reading).map(|()| reading)
    }

    const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.5, 0.0]];

    #[test]
    fn a_binary_file_may_begin_with_solid() {
        let reading = read_all(&binary(b"solid made by hand\nfacet", 1, &[CORNERS])).unwrap();
        assert_eq!(reading.parts[0].mesh.positions[2], [0.0, 2.5, 0.0]);
        assert_eq!(reading.parts[0].mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn a_count_beyond_the_file_is_refused_with_both_numbers() {
        let error = read_all(&binary(b"x", 3, &[CORNERS])).unwrap_err();
        assert_eq!((error.code(), error.place().as_str()), ("malformed", "byte 80"));
        assert!(error.reason().contains("150 bytes; 50 follow"), "{}", error.reason());
    }

    #[test]
    fn text_with_two_solids_in_mixed_case_is_one_part() {
        let facet = "FACET normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1e0 0\n endloop\nendfacet";
        let text = format!("solid One\n{facet}\nendsolid One\nSOLID two\n{facet}\nendsolid");
        let reading = read_all(text.as_bytes()).unwrap();
        assert_eq!(reading.parts[0].mesh.triangles.len(), 2);
        assert_eq!(reading.parts[0].name, "One");
    }

    #[test]
    fn unfinished_text_is_refused() {
        let error = read_all(b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n").unwrap_err();
        assert_eq!(error.place(), "end of file");
    }
}
