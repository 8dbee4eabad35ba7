//! Point clouds as lines of numbers: `.xyz`, `.pts`, `.asc`. The first three of a line are the position; where there
//! are exactly six, and the last three are of unit length, they are the normal. Others (colour, intensity) are passed
//! over, as is a first line that holds their count.

use crate::{ImportError, Options};

use super::reading::{Reading, check_counts};

/// A file whose first lines are not of numbers is of another kind.
const BAD_LINES: u64 = 100;

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    let mut bad = 0;
    for (number, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = line.trim_ascii();
        if line.is_empty() || line.starts_with(b"#") || line.starts_with(b"//") {
            continue;
        }
        let separator = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | b';');
        let mut values = [0.0; 6];
        let mut count = 0_usize;
        let mut sound = true;
        for word in line.split(separator).filter(|word| !word.is_empty()) {
            let value = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f64>().ok());
            match (value, values.get_mut(count)) {
                (Some(value), Some(slot)) => *slot = value,
                (None, Some(_)) => sound = false,
                _ => {}
            }
            count += 1;
        }
        if count == 1 && positions.is_empty() && sound {
            continue;
        }
        let [x, y, z, nx, ny, nz] = values;
        if count < 3 || !sound {
            bad += 1;
            let found = String::from_utf8_lossy(&line[..line.len().min(40)]).into_owned();
            let message = format!("expected three numbers or more, found {found:?}");
            let place = format!("line {}", number + 1);
            if bad > BAD_LINES && bad > positions.len() as u64 {
                return Err(ImportError::malformed(place, message));
            }
            reading.notes.add("bad-number", place, message);
            continue;
        }
        positions.push([x, y, z]);
        if count == 6 && (nx.hypot(ny).hypot(nz) - 1.0).abs() < 0.05 {
            normals.push([nx, ny, nz]);
        }
        check_counts(positions.len() as u64, 0, "points", options)?;
    }
    if normals.len() != positions.len() {
        normals.clear();
    }
    reading.add_cloud("part 0", positions, normals);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clouds(text: &str) -> Reading {
        let mut reading = Reading::default();
        read(text.as_bytes(), &Options::default(), &mut reading).unwrap();
        reading
    }

    #[test]
    fn commas_counts_colours_and_normals() {
        let plain = clouds("3\n# x y z\n1,2,3\n4;5;6\n7 8 9 255 0 0\n");
        assert_eq!(plain.clouds[0].positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
        assert!(plain.clouds[0].normals.is_empty());
        let turned = clouds("0 0 0 0 0 1\n1 0 0 0 1 0\n");
        assert_eq!(turned.clouds[0].normals, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn a_bad_line_costs_itself_and_prose_is_refused() {
        assert_eq!(clouds("0 0 0\nx y z\n1 1 1\n").clouds[0].positions.len(), 2);
        let mut reading = Reading::default();
        let prose = "some words\n".repeat(200);
        let error = read(prose.as_bytes(), &Options::default(), &mut reading).unwrap_err();
        assert_eq!(error.place(), "line 101");
    }
}
