//! PCD, the Point Cloud Library's format: text, binary, and binary packed by LZF field after field.

use crate::{ImportError, Options};

use super::reading::{Reading, check_counts};

/// One field of every point.
#[derive(Debug)]
struct Field {
    name: String,
    size: usize,
    /// `I` signed, `U` unsigned, `F` floating.
    kind: u8,
    count: usize,
    /// Bytes of a point before it.
    offset: usize,
}

#[derive(Debug, Default)]
struct Header {
    fields: Vec<Field>,
    points: u64,
    data: String,
    /// Where the points begin.
    length: usize,
}

const X_Y_Z: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["normal_x", "normal_y", "normal_z"];

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let header = Header::parse(bytes)?;
    check_counts(header.points, 0, "POINTS", options)?;
    let Some(axes) = header.three(X_Y_Z) else {
        return Err(ImportError::malformed("FIELDS", "expected fields x, y and z"));
    };
    let normal_axes = header.three(NORMAL);
    let body = &bytes[header.length..];
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    let mut keep = |position: [f64; 3], normal: Option<[f64; 3]>| {
        // A depth camera writes what it did not see as not a number.
        if position.iter().all(|value| value.is_finite()) {
            positions.push(position);
            normals.extend(normal);
        }
    };
    match header.data.as_str() {
        "ascii" => header.text(body, &mut |row| {
            let pick =
                |axes: [usize; 3]| axes.map(|at| row.get(header.column(at)).copied().unwrap_or(f64::NAN));
            keep(pick(axes), normal_axes.map(pick));
        })?,
        "binary" => header.packed(
            body,
            header.stride(),
            |point, field| point * header.stride() + header.fields[field].offset,
            axes,
            normal_axes,
            &mut keep,
        )?,
        "binary_compressed" => {
            let body = decompressed(body, header.points.saturating_mul(header.stride() as u64))?;
            // All values of the first field, then all of the second.
            let points = usize::try_from(header.points).unwrap_or(usize::MAX);
            header.packed(
                &body,
                header.stride(),
                |point, field| {
                    let field = &header.fields[field];
                    points.saturating_mul(field.offset).saturating_add(point * field.size * field.count)
                },
                axes,
                normal_axes,
                &mut keep,
            )?;
        }
        other => {
            let reason = format!("expected ascii, binary or binary_compressed, found {other:?}");
            return Err(ImportError::malformed("DATA", reason));
        }
    }
    if normals.len() != positions.len() || normals.iter().flatten().any(|value| !value.is_finite()) {
        normals.clear();
    }
    reading.add_cloud("part 0", positions, normals);
    Ok(())
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, ImportError> {
        let mut header = Self::default();
        let (mut names, mut sizes, mut kinds, mut counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut at = 0;
        for number in 1..=64 {
            let Some(end) = bytes[at..].iter().position(|&byte| byte == b'\n') else { break };
            let line = String::from_utf8_lossy(&bytes[at..at + end]).into_owned();
            at += end + 1;
            let mut words = line.split_ascii_whitespace();
            let refuse = |what: &str| {
                let found = line.chars().take(60).collect::<String>();
                Err(ImportError::malformed(
                    format!("line {number}"),
                    format!("expected {what}, found {found:?}"),
                ))
            };
            match words.next() {
                Some("FIELDS" | "COLUMNS") => names = words.map(str::to_owned).collect(),
                Some("SIZE") => match words.map(str::parse).collect::<Result<Vec<usize>, _>>() {
                    Ok(all) if all.iter().all(|size| matches!(size, 1 | 2 | 4 | 8)) => sizes = all,
                    _ => return refuse("sizes of 1, 2, 4 or 8 bytes"),
                },
                Some("TYPE") => kinds = words.map(|word| word.as_bytes()[0]).collect(),
                Some("COUNT") => match words.map(str::parse).collect::<Result<Vec<u16>, _>>() {
                    Ok(all) => counts = all.into_iter().map(usize::from).collect(),
                    Err(_) => return refuse("counts"),
                },
                Some("POINTS") => match words.next().map(str::parse) {
                    Some(Ok(points)) => header.points = points,
                    _ => return refuse("a count"),
                },
                Some("DATA") => {
                    header.data = words.next().unwrap_or_default().to_owned();
                    header.length = at;
                    break;
                }
                _ => {}
            }
        }
        if header.length == 0 {
            return Err(ImportError::malformed("header", "expected a line \"DATA\", found none"));
        }
        if names.len() != sizes.len() || names.len() != kinds.len() {
            let reason = format!(
                "{} FIELDS, {} SIZE and {} TYPE: expected as many of each",
                names.len(),
                sizes.len(),
                kinds.len()
            );
            return Err(ImportError::malformed("header", reason));
        }
        let mut offset = 0;
        for (index, name) in names.into_iter().enumerate() {
            let (size, count) = (sizes[index], counts.get(index).copied().unwrap_or(1));
            header.fields.push(Field { name, size, kind: kinds[index], count, offset });
            offset += size * count;
        }
        Ok(header)
    }

    fn stride(&self) -> usize {
        self.fields.iter().map(|field| field.size * field.count).sum()
    }

    fn three(&self, names: [&str; 3]) -> Option<[usize; 3]> {
        let find = |name: &str| self.fields.iter().position(|field| field.name == name && field.count > 0);
        let [a, b, c] = names.map(find);
        Some([a?, b?, c?])
    }

    /// Place of a field's first number in a row of text.
    fn column(&self, field: usize) -> usize {
        self.fields[..field].iter().map(|field| field.count).sum()
    }

    fn text(&self, body: &[u8], each: &mut dyn FnMut(&[f64])) -> Result<(), ImportError> {
        let columns: usize = self.fields.iter().map(|field| field.count).sum();
        let mut row = Vec::new();
        let mut found = 0;
        for line in body.split(|&byte| byte == b'\n') {
            row.clear();
            row.extend(
                line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).take(columns).map(
                    |word| {
                        std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)
                    },
                ),
            );
            if !row.is_empty() && found < self.points {
                each(&row);
                found += 1;
            }
        }
        if found < self.points {
            let reason = format!("expected {} points, found {found}", self.points);
            return Err(ImportError::malformed(format!("point {found}"), reason));
        }
        Ok(())
    }

    fn packed(
        &self,
        body: &[u8],
        stride: usize,
        place: impl Fn(usize, usize) -> usize,
        axes: [usize; 3],
        normal_axes: Option<[usize; 3]>,
        keep: &mut dyn FnMut([f64; 3], Option<[f64; 3]>),
    ) -> Result<(), ImportError> {
        let there = (body.len() / stride.max(1)) as u64;
        if there < self.points {
            let reason = format!("expected {} points of {stride} bytes, found {there}", self.points);
            return Err(ImportError::malformed(format!("point {there}"), reason));
        }
        for point in 0..usize::try_from(self.points).unwrap_or(0) {
            let value = |field: usize| number(&self.fields[field], body, place(point, field));
            keep(axes.map(value), normal_axes.map(|axes| axes.map(value)));
        }
        Ok(())
    }
}

/// A little-endian number; not a number where the bytes are not there.
fn number(field: &Field, body: &[u8], at: usize) -> f64 {
    let Some(bytes) = body.get(at..at.saturating_add(field.size)) else { return f64::NAN };
    let mut wide = [0; 8];
    wide[..field.size].copy_from_slice(bytes);
    let [a, b, c, d, ..] = wide;
    // Signed numbers keep their sign in the upper half.
    let shift = 64 - 8 * field.size as u32;
    match (field.kind, field.size) {
        (b'F', 4) => f64::from(f32::from_le_bytes([a, b, c, d])),
        (b'F', 8) => f64::from_le_bytes(wide),
        (b'I', _) => ((i64::from_le_bytes(wide) << shift) >> shift) as f64,
        _ => u64::from_le_bytes(wide) as f64,
    }
}

/// Two sizes of four bytes, then LZF data. `expected` bytes must come out, and no more are made.
fn decompressed(body: &[u8], expected: u64) -> Result<Vec<u8>, ImportError> {
    let refuse = |reason: String| Err(ImportError::malformed("DATA", reason));
    let word = |at: usize| {
        body.get(at..at + 4).and_then(|field| field.first_chunk()).map(|b| u32::from_le_bytes(*b))
    };
    let (Some(packed), Some(unpacked)) = (word(0), word(4)) else {
        return refuse("expected two sizes, found the end of the file".to_owned());
    };
    if u64::from(unpacked) != expected {
        return refuse(format!("{unpacked} bytes unpacked, the header makes it {expected}"));
    }
    let Some(data) = body.get(8..8_usize.saturating_add(packed as usize)) else {
        return refuse(format!("{packed} packed bytes are cut: {} follow", body.len() - 8));
    };
    lzf(data, unpacked as usize)
        .map_or_else(|| refuse("the packed bytes are not LZF, or of another length".to_owned()), Ok)
}

/// LibLZF: a byte under 32 begins a run of literals, any other a copy of what came out before.
fn lzf(data: &[u8], expected: usize) -> Option<Vec<u8>> {
    // A copy makes 264 bytes of 3 at most: what could not be is refused before there is room for it.
    if expected > data.len().saturating_mul(264) {
        return None;
    }
    let mut out: Vec<u8> = Vec::with_capacity(expected);
    let mut bytes = data.iter().copied();
    while let Some(control) = bytes.next() {
        if control < 32 {
            for _ in 0..=control {
                out.push(bytes.next()?);
            }
        } else {
            let mut length = usize::from(control >> 5);
            if length == 7 {
                length += usize::from(bytes.next()?);
            }
            let back = (usize::from(control & 31) << 8) + usize::from(bytes.next()?) + 1;
            let start = out.len().checked_sub(back)?;
            for at in start..start + length + 2 {
                out.push(out[at]);
            }
        }
        if out.len() > expected {
            return None;
        }
    }
    (out.len() == expected).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(data: &str) -> Vec<u8> {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x rgb y z\nSIZE 4 4 4 8\nTYPE F U F F\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA {data}\n"
        )
        .into_bytes()
    }

    fn points(bytes: &[u8]) -> Result<Vec<[f64; 3]>, ImportError> {
        let mut reading = Reading::default();
        read(bytes, &Options::default(), &mut reading)?;
        Ok(reading.clouds.remove(0).positions)
    }

    const POINTS: [[f64; 3]; 3] = [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0], [7.0, 8.0, -9.25]];

    fn rows() -> Vec<u8> {
        let row = |[x, y, z]: [f64; 3]| {
            [&(x as f32).to_le_bytes()[..], &[9; 4], &(y as f32).to_le_bytes(), &z.to_le_bytes()].concat()
        };
        POINTS.into_iter().flat_map(row).collect()
    }

    #[test]
    fn the_three_encodings_read_the_same() {
        let mut text = header("ascii");
        text.extend(POINTS.iter().flat_map(|[x, y, z]| format!("{x} 255 {y} {z}\n").into_bytes()));
        let binary = [header("binary"), rows()].concat();
        // Field after field, as literals of 32 bytes at most.
        let rows = rows();
        let mut columns = Vec::new();
        for (offset, size) in [(0, 4), (4, 4), (8, 4), (12, 8)] {
            columns.extend(rows.chunks(20).flat_map(|row| row[offset..offset + size].to_vec()));
        }
        let mut packed = Vec::new();
        for run in columns.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        let mut compressed = header("binary_compressed");
        compressed.extend((packed.len() as u32).to_le_bytes());
        compressed.extend((columns.len() as u32).to_le_bytes());
        compressed.extend(packed);
        for bytes in [&text, &binary, &compressed] {
            assert_eq!(points(bytes).unwrap(), POINTS);
        }
        assert_eq!(points(&binary[..binary.len() - 1]).unwrap_err().place(), "point 2");
        assert!(points(&compressed[..compressed.len() - 1]).is_err());
    }

    #[test]
    fn copies_of_lzf_may_overlap_themselves() {
        assert_eq!(lzf(&[0, b'a', 0xA0, 0], 8).unwrap(), b"aaaaaaaa");
        assert_eq!(lzf(&[0x20, 5], 3), None);
        assert_eq!(lzf(&[0, b'a'], usize::MAX), None);
    }

    #[test]
    fn a_bomb_is_refused_before_there_is_room_for_it() {
        let text =
            String::from_utf8(header("binary_compressed")).unwrap().replace("POINTS 3", "POINTS 50000000");
        let mut bytes = text.into_bytes();
        bytes.extend(2_u32.to_le_bytes());
        bytes.extend(1_000_000_000_u32.to_le_bytes());
        bytes.extend([0, 0]);
        assert_eq!(points(&bytes).unwrap_err().place(), "DATA");
    }
}
