//! PLY, text and binary in both byte orders: positions, faces and triangle strips; other properties are skipped.

use crate::asset::{Mesh, SourcePart};
use crate::{ImportError, Options};

use super::ply_header::{Element, Encoding, Scalar, parse};
use super::reading::{Reading, check_counts};

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let header = parse(bytes)?;
    let mut body = Body { bytes, at: header.length, encoding: header.encoding };
    let (mut mesh, mut normals) = (Mesh::default(), Vec::new());
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(&mut body, element, (&mut mesh, &mut normals), options)?,
            "face" | "tristrips" => read_faces(&mut body, element, &mut mesh, reading)?,
            _ => skip(&mut body, element)?,
        }
        check_counts(mesh.positions.len() as u64, mesh.triangles.len() as u64, &element.name, options)?;
    }
    if mesh.triangles.is_empty() && !mesh.positions.is_empty() {
        reading.add_cloud("part 0", mesh.positions, normals);
        return Ok(());
    }
    reading.parts.push(SourcePart::new("part 0", mesh));
    Ok(())
}

fn read_vertices(
    body: &mut Body<'_>,
    element: &Element,
    (mesh, normals): (&mut Mesh, &mut Vec<[f64; 3]>),
    options: &Options,
) -> Result<(), ImportError> {
    check_counts(element.count, 0, "element vertex", options)?;
    let column = |name: &str| {
        element
            .properties
            .iter()
            .position(|property| property.name == name && property.list.is_none())
            .ok_or_else(|| {
                ImportError::malformed("element vertex", format!("expected a property {name:?}, found none"))
            })
    };
    let columns = [column("x")?, column("y")?, column("z")?];
    let normal = ["nx", "ny", "nz"].map(|name| column(name).ok());
    let mut row = vec![0.0; element.properties.len()];
    for index in 0..element.count {
        body.row(element, index, |column, _, value| row[column] = value)?;
        mesh.positions.push(columns.map(|column| row[column]));
        if let [Some(x), Some(y), Some(z)] = normal {
            normals.push([row[x], row[y], row[z]]);
        }
    }
    Ok(())
}

fn read_faces(
    body: &mut Body<'_>,
    element: &Element,
    mesh: &mut Mesh,
    reading: &mut Reading,
) -> Result<(), ImportError> {
    let strips = element.name == "tristrips";
    let Some(list) = element.properties.iter().position(|property| {
        property.list.is_some() && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
    }) else {
        reading.notes.add("empty", format!("element {}", element.name), "no list of vertex indices");
        return skip(body, element);
    };
    let mut corners: Vec<f64> = Vec::new();
    for index in 0..element.count {
        corners.clear();
        body.row(element, index, |column, _, value| {
            if column == list {
                corners.push(value);
            }
        })?;
        if strips {
            corners.split(|&corner| corner < 0.0).for_each(|strip| push_strip(strip, mesh));
            continue;
        }
        if corners.len() < 3 {
            let message = format!("a face of {} corners", corners.len());
            reading.notes.add("faces-dropped", format!("face[{index}]"), message);
        }
        for at in 2..corners.len() {
            mesh.triangles.push([corners[0], corners[at - 1], corners[at]].map(corner));
        }
    }
    Ok(())
}

fn push_strip(strip: &[f64], mesh: &mut Mesh) {
    for (at, three) in strip.windows(3).enumerate() {
        let [a, b, c] = [corner(three[0]), corner(three[1]), corner(three[2])];
        mesh.triangles.push(if at % 2 == 0 { [a, b, c] } else { [b, a, c] });
    }
}

/// An index that is none becomes one that no file has; the sieve drops its triangle.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn corner(value: f64) -> u32 {
    if value >= 0.0 && value < f64::from(u32::MAX) { value as u32 } else { u32::MAX }
}

fn skip(body: &mut Body<'_>, element: &Element) -> Result<(), ImportError> {
    if element.properties.is_empty() {
        return Ok(());
    }
    (0..element.count).try_for_each(|index| body.row(element, index, |_, _, _| {}))
}

/// The values after the header, read in order.
struct Body<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl Body<'_> {
    /// One row of an element: `each(column, place in the list, value)`.
    fn row(
        &mut self,
        element: &Element,
        row: u64,
        mut each: impl FnMut(usize, usize, f64),
    ) -> Result<(), ImportError> {
        let place = || format!("{}[{row}]", element.name);
        for (column, property) in element.properties.iter().enumerate() {
            let Some(count) = property.list else {
                each(column, 0, self.value(property.scalar).map_err(|fault| fault.at(place()))?);
                continue;
            };
            let count = self.value(count).map_err(|fault| fault.at(place()))?;
            if !(count >= 0.0 && count <= f64::from(u32::MAX)) {
                let reason = format!("expected the length of {:?}, found {count}", property.name);
                return Err(ImportError::malformed(place(), reason));
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            for item in 0..count as usize {
                each(column, item, self.value(property.scalar).map_err(|fault| fault.at(place()))?);
            }
        }
        if self.encoding == Encoding::Text {
            self.end_line();
        }
        Ok(())
    }

    /// Text has a row a line: what a writer put there beyond what its header says is passed over.
    fn end_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        let size = scalar.size();
        let bytes = self.bytes.get(self.at..self.at + size).ok_or(Fault::End)?;
        self.at += size;
        let mut wide = [0; 8];
        for (place, &byte) in bytes.iter().enumerate() {
            wide[if self.encoding == Encoding::LittleEndian { place } else { size - 1 - place }] = byte;
        }
        let [a, b, c, d, ..] = wide;
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes([a])),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(wide),
        })
    }

    fn word(&mut self) -> Result<f64, Fault> {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(Fault::End)?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        let word = &rest[start..start + length];
        self.at += start + length;
        std::str::from_utf8(word)
            .ok()
            .and_then(|text| text.parse().ok())
            .ok_or_else(|| Fault::NoNumber(String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned()))
    }
}

enum Fault {
    End,
    NoNumber(String),
}

impl Fault {
    fn at(self, place: String) -> ImportError {
        let reason = match self {
            Self::End => "expected a value, found the end of the file".to_owned(),
            Self::NoNumber(found) => format!("expected a number, found {found:?}"),
        };
        ImportError::malformed(place, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(bytes: &[u8]) -> Result<Mesh, ImportError> {
        let mut reading = Reading::default();
        read(bytes, &Options::default(), &mut reading).map(|()| reading.parts.remove(0).mesh)
    }

    fn header(encoding: &str, faces: &str) -> Vec<u8> {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex 4\nproperty float x\nproperty uchar red\n\
             property float y\nproperty double z\n{faces}\nend_header\n"
        )
        .into_bytes()
    }

    const QUAD: &str =
        "element face 1\nproperty list uchar ushort vertex_indices\nproperty list uchar float uv";
    const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, -1.5], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn the_three_encodings_read_the_same() {
        let mut text = header("ascii", QUAD);
        let mut little = header("binary_little_endian", QUAD);
        let mut big = header("binary_big_endian", QUAD);
        for [x, y, z] in CORNERS {
            text.extend(format!("{x} 200 {y} {z}\n").bytes());
            let (x, y) = (x as f32, y as f32);
            little.extend([&x.to_le_bytes()[..], &[200], &y.to_le_bytes(), &z.to_le_bytes()].concat());
            big.extend([&x.to_be_bytes()[..], &[200], &y.to_be_bytes(), &z.to_be_bytes()].concat());
        }
        text.extend(b"4 0 1 2 3 1 0.5\n");
        let face = |bytes: fn(u16) -> [u8; 2]| (0..4).flat_map(bytes).collect::<Vec<_>>();
        little.extend([&[4], &face(u16::to_le_bytes)[..], &[1], &0.5_f32.to_le_bytes()].concat());
        big.extend([&[4], &face(u16::to_be_bytes)[..], &[1], &0.5_f32.to_be_bytes()].concat());
        for bytes in [text, little, big] {
            let mesh = read_all(&bytes).unwrap();
            assert_eq!(mesh.positions, CORNERS);
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        }
    }

    #[test]
    fn strips_alternate_and_restart() {
        let mut text = header("ascii", "element tristrips 1\nproperty list int int vertex_indices");
        text.extend(CORNERS.iter().flat_map(|[x, y, z]| format!("{x} 0 {y} {z}\n").into_bytes()));
        text.extend(b"8 0 1 2 3 -1 3 2 1\n");
        assert_eq!(read_all(&text).unwrap().triangles, [[0, 1, 2], [2, 1, 3], [3, 2, 1]]);
    }

    #[test]
    fn a_text_row_may_hold_more_than_its_header_says() {
        let mut text = header("ascii", "element face 2\nproperty list uchar int vertex_index");
        text.extend(CORNERS.iter().flat_map(|[x, y, z]| format!("{x} 0 {y} {z} 7 7\n").into_bytes()));
        text.extend(b"3 0 1 2 9 9 9\n3\n0 2 3\n");
        assert_eq!(read_all(&text).unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_cut_body_and_a_bomb_are_refused_by_row() {
        let error = read_all(&header("binary_little_endian", QUAD)).unwrap_err();
        assert_eq!(error.place(), "vertex[0]");
        let bomb = b"ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n";
        assert_eq!(read_all(bomb).unwrap_err().code(), "too-large");
    }
}
