//! OFF, text: `OFF`, and its relatives that put colours (`COFF`), normals (`NOFF`) or texture coordinates (`STOFF`)
//! beside each vertex. Polygons are fanned from their first corner.

use crate::asset::{Mesh, SourcePart};
use crate::{ImportError, Options};

use super::reading::{Reading, check_counts};
use super::words::Words;

pub(super) fn looks_like(bytes: &[u8]) -> bool {
    keyword(bytes).is_some()
}

/// The header's keyword and how many bytes it takes.
fn keyword(bytes: &[u8]) -> Option<(&str, usize)> {
    let end = bytes.iter().take(8).position(|byte| !byte.is_ascii_uppercase()).unwrap_or(bytes.len().min(8));
    let word = std::str::from_utf8(&bytes[..end]).ok()?;
    let known = ["OFF", "COFF", "NOFF", "STOFF", "CNOFF", "NCOFF", "STCOFF", "STNOFF"];
    known.contains(&word).then_some((word, end))
}

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let Some((_, length)) = keyword(bytes) else {
        let found = String::from_utf8_lossy(&bytes[..bytes.len().min(20)]).into_owned();
        return Err(ImportError::malformed("line 1", format!("expected \"OFF\", found {found:?}")));
    };
    // Many collections write the counts right behind the keyword: `OFF490 518 0`.
    let mut words = Words::new(&bytes[length..]);
    if words.rest_of_line().eq_ignore_ascii_case(b"binary") {
        let way_out = "Convert it to text OFF or to PLY";
        return Err(ImportError::unsupported("line 1", "binary OFF, which is not read", way_out));
    }
    words.rewind();
    let [vertices, faces, _edges] = [words.count("vertices")?, words.count("faces")?, words.count("edges")?];
    check_counts(vertices, faces, "counts", options)?;
    let mut mesh = Mesh::default();
    for index in 0..vertices {
        words.next_line();
        let place = || format!("vertex {index}");
        mesh.positions.push([words.number(place)?, words.number(place)?, words.number(place)?]);
    }
    for index in 0..faces {
        words.next_line();
        let place = || format!("face {index}");
        let corners = words.index(place)?;
        // A line cannot have more corners than letters: the count is not believed.
        let mut rim = Vec::new();
        for _ in 0..corners {
            rim.push(u32::try_from(words.index(place)?).unwrap_or(u32::MAX));
        }
        if rim.len() < 3 {
            reading.notes.add("faces-dropped", place(), format!("a face of {} corners", rim.len()));
        }
        mesh.triangles.extend((2..rim.len()).map(|at| [rim[0], rim[at - 1], rim[at]]));
        check_counts(vertices, mesh.triangles.len() as u64, "faces", options)?;
    }
    if mesh.triangles.is_empty() {
        reading.add_cloud("part 0", mesh.positions, Vec::new());
        return Ok(());
    }
    reading.parts.push(SourcePart::new("part 0", mesh));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(text: &str) -> Result<Mesh, ImportError> {
        let mut reading = Reading::default();
        read(text.as_bytes(), &Options::default(), &mut reading)?;
        Ok(reading.parts.pop().map(|part| part.mesh).unwrap_or_default())
    }

    const REST: &str = "0 0 0\n1 0 0 # corner\n1 1 0\n\n0 1 0\n4 0 1 2 3 0.5 0.5 0.5\n3 0 1 2\n";

    #[test]
    fn polygons_comments_colours_and_counts_in_one_line() {
        for head in ["OFF\n4 2 0\n", "OFF4 2 0\n", "# no\nOFF\n# note\n4 2 0\n", "COFF 4 2 0\n"] {
            let text = format!("{head}{REST}");
            let text = text.strip_prefix("# no\n").unwrap_or(&text);
            let mesh = read_all(text).unwrap();
            assert_eq!(mesh.positions.len(), 4, "{head}");
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]], "{head}");
        }
    }

    #[test]
    fn what_is_cut_or_claims_too_much_is_refused_by_place() {
        assert_eq!(read_all("OFF\n3 1 0\n0 0 0\n1 0 0\n").unwrap_err().place(), "vertex 2");
        assert_eq!(read_all("OFF\n1 1 0\n0 0 0\n999999999 0 0\n").unwrap_err().place(), "face 0");
        assert_eq!(read_all("OFF\n99999999999 1 0\n").unwrap_err().code(), "too-large");
    }
}
