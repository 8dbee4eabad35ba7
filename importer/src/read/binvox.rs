//! `.binvox`: one grid of filled cells, in runs. P. Min, binvox voxel file format specification.

use crate::asset::{Geometry, SourcePart};
use crate::{ImportError, Options};

use super::reading::Reading;
use super::voxels::Grid;

pub(super) const MAGIC: &[u8] = b"#binvox";

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let header = Header::parse(bytes)?;
    let [depth, height, width] = header.size;
    let mut grid = Grid::new([width, height, depth], "dim", options)?;
    // A cell's number is (x · depth + z) · width + y in the file's words, where x runs along what is called depth.
    let cells = width * height * depth;
    let mut at = 0;
    for (number, run) in bytes[header.length..].chunks(2).enumerate() {
        let &[value, count] = run else {
            return Err(ImportError::malformed(
                format!("run {number}"),
                "expected value and count, found one byte",
            ));
        };
        let end = at + u64::from(count);
        if end > cells {
            let reason = format!("the runs come to more than the {cells} cells");
            return Err(ImportError::malformed(format!("run {number}"), reason));
        }
        if value != 0 {
            for cell in at..end {
                let (y, z, x) = (cell % width, cell / width % height, cell / (width * height));
                // Cells are fewer than `Options::max_voxels`.
                grid.fill([x, y, z].map(|value| usize::try_from(value).unwrap_or(usize::MAX)));
            }
        }
        at = end;
    }
    if at < cells {
        let reason = format!("expected {cells} cells, found {at}");
        return Err(ImportError::malformed("data", reason));
    }
    let mut mesh = grid.surface(options)?;
    let side = header.scale / [width, height, depth].into_iter().max().unwrap_or(1) as f64;
    for position in &mut mesh.positions {
        *position = std::array::from_fn(|axis| position[axis] * side + header.translate[axis]);
    }
    reading.geometry = Geometry::Voxels;
    reading.parts.push(SourcePart::new("part 0", mesh));
    Ok(())
}

struct Header {
    /// Depth, height, width, as the file names them.
    size: [u64; 3],
    translate: [f64; 3],
    /// Of the longest side.
    scale: f64,
    length: usize,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Self, ImportError> {
        let (mut size, mut translate, mut scale) = (None, [0.0; 3], 1.0);
        let mut at = 0;
        for number in 1..=32 {
            let Some(end) = bytes[at..].iter().position(|&byte| byte == b'\n') else { break };
            let line = String::from_utf8_lossy(&bytes[at..at + end]).into_owned();
            at += end + 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            let refuse = |what: &str| {
                let found = line.chars().take(60).collect::<String>();
                ImportError::malformed(format!("line {number}"), format!("expected {what}, found {found:?}"))
            };
            match words.as_slice() {
                ["dim", rest @ ..] => {
                    let sides: Option<Vec<u64>> = rest.iter().map(|word| word.parse().ok()).collect();
                    let sides = sides.and_then(|sides| <[u64; 3]>::try_from(sides).ok());
                    size = Some(
                        sides
                            .filter(|sides| sides.iter().all(|&side| side > 0))
                            .ok_or_else(|| refuse("three sides"))?,
                    );
                }
                ["translate", rest @ ..] => {
                    let numbers: Option<Vec<f64>> = rest.iter().map(|word| word.parse().ok()).collect();
                    let numbers = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
                    translate = numbers.ok_or_else(|| refuse("three numbers"))?;
                }
                ["scale", number] => scale = number.parse().map_err(|_| refuse("a number"))?,
                ["data"] => {
                    let size =
                        size.ok_or_else(|| ImportError::malformed("header", "expected a line \"dim\""))?;
                    if !(scale > 0.0 && scale < 1e12) {
                        return Err(refuse("a scale over 0"));
                    }
                    return Ok(Self { size, translate, scale, length: at });
                }
                _ => {}
            }
        }
        Err(ImportError::malformed("header", "expected a line \"data\", found none"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{measure, weld};

    #[test]
    fn runs_are_cells_in_their_place_and_size() {
        let mut bytes = b"#binvox 1\ndim 2 2 2\ntranslate 1 2 3\nscale 4\ndata\n".to_vec();
        // x = 0: both z, y = 0 filled; x = 1: nothing.
        bytes.extend([1, 1, 0, 1, 1, 1, 0, 5]);
        let mut reading = Reading::default();
        read(&bytes, &Options::default(), &mut reading).unwrap();
        let measures = measure(&weld(&reading.parts[0].mesh));
        assert_eq!((measures.min, measures.max), ([1.0, 2.0, 3.0], [3.0, 4.0, 7.0]));
        assert!((measures.solid.unwrap().measure - 16.0).abs() < 1e-9);
        for (cut, place) in [(bytes.len() - 2, "data"), (bytes.len() - 1, "run 3"), (20, "header")] {
            let error = read(&bytes[..cut], &Options::default(), &mut Reading::default()).unwrap_err();
            assert_eq!(error.place(), place);
        }
        bytes.extend([1, 1]);
        assert_eq!(read(&bytes, &Options::default(), &mut Reading::default()).unwrap_err().place(), "run 4");
    }

    #[test]
    fn a_grid_over_the_limit_is_refused() {
        let bytes = b"#binvox 1\ndim 4000 4000 4000\ndata\n";
        assert_eq!(
            read(bytes, &Options::default(), &mut Reading::default()).unwrap_err().code(),
            "too-large"
        );
    }
}
