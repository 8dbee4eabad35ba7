//! MagicaVoxel `.vox`: models of cells, put in their places by the scene graph, Z up.
//!
//! ephtracy, MagicaVoxel .vox file format and its extension: chunks `SIZE`, `XYZI`, `nTRN`, `nGRP`, `nSHP`.

use std::collections::BTreeMap;

use crate::asset::{Geometry, Mesh, SourcePart};
use crate::{ImportError, Options};

use super::reading::Reading;
use super::transform::Transform;
use super::voxels::Grid;

pub(super) const MAGIC: &[u8] = b"VOX ";

/// More arrivals at nodes than this are taken for a bomb.
const MOST_VISITS: u64 = 100_000;

#[derive(Default)]
struct Model {
    size: [u32; 3],
    cells: Vec<[u8; 4]>,
    /// Made when it is first placed: many nodes may show one model.
    mesh: Option<Mesh>,
}

#[derive(Default)]
struct File {
    models: Vec<Model>,
    nodes: BTreeMap<i32, Node>,
}

enum Node {
    Transform { name: String, child: i32, frame: Transform },
    Group(Vec<i32>),
    Shape(Vec<i32>),
}

pub(super) fn read(bytes: &[u8], options: &Options, reading: &mut Reading) -> Result<(), ImportError> {
    let mut file = File::parse(bytes)?;
    if file.models.is_empty() {
        return Err(ImportError::no_triangles("a .vox file without models"));
    }
    reading.geometry = Geometry::Voxels;
    if !file.nodes.contains_key(&0) {
        for index in 0..file.models.len() {
            file.place(index, &Transform::IDENTITY, &format!("model {index}"), options, reading)?;
        }
        return Ok(());
    }
    let mut open = vec![(0, Transform::IDENTITY, String::new())];
    let mut visits = 0;
    while let Some((id, frame, name)) = open.pop() {
        visits += 1;
        if visits > MOST_VISITS {
            let reason = format!("the scene graph comes to more than {MOST_VISITS} nodes once followed");
            return Err(ImportError::too_large("nTRN", reason));
        }
        match file.nodes.get(&id) {
            Some(Node::Transform { name: own, child, frame: local }) => {
                let name = if own.is_empty() { name } else { own.clone() };
                reading.names.add(&name);
                open.push((*child, frame.after(local), name));
            }
            Some(Node::Group(children)) => {
                open.extend(children.iter().rev().map(|&child| (child, frame, name.clone())));
            }
            Some(Node::Shape(models)) => {
                // Later models of a shape are frames of an animation.
                let first = models.first().copied();
                let Some(model) = first.and_then(|model| usize::try_from(model).ok()) else {
                    continue;
                };
                if model >= file.models.len() {
                    let reason = format!("refers to model {model}, there are {}", file.models.len());
                    return Err(ImportError::malformed(format!("nSHP {id}"), reason));
                }
                let name = if name.is_empty() { format!("model {model}") } else { name };
                file.place(model, &frame, &name, options, reading)?;
            }
            None => {
                let reason = format!("there is no node {id}");
                return Err(ImportError::malformed("scene graph", reason));
            }
        }
    }
    Ok(())
}

impl File {
    fn parse(bytes: &[u8]) -> Result<Self, ImportError> {
        if !bytes.starts_with(MAGIC) {
            return Err(ImportError::malformed("byte 0", "expected the bytes \"VOX \""));
        }
        let mut file = Self::default();
        let mut size = [0; 3];
        // The version, then MAIN, whose children are the rest of the file.
        let mut at = 8;
        while at < bytes.len() {
            let mut header = Fields { bytes, at, place: at };
            let (kind, length, _) = (header.take(4)?, header.whole()?, header.whole()?);
            let start = at + 12;
            let end = start.saturating_add(usize::try_from(length).unwrap_or(usize::MAX));
            let Some(content) = bytes.get(start..end) else {
                let reason = format!("a chunk of {length} bytes is cut: {} follow", bytes.len() - start);
                return Err(ImportError::malformed(format!("byte {at}"), reason));
            };
            let mut fields = Fields { bytes: content, at: 0, place: at };
            match kind {
                b"SIZE" => {
                    for side in &mut size {
                        *side = u32::try_from(fields.whole()?).unwrap_or(0);
                    }
                }
                b"XYZI" => {
                    let count = usize::try_from(fields.whole()?).unwrap_or(usize::MAX);
                    let cells = fields.take(count.saturating_mul(4))?;
                    let cells = cells.as_chunks().0.to_vec();
                    file.models.push(Model { size, cells, mesh: None });
                }
                b"nTRN" => {
                    let (id, attributes) = (fields.whole()?, fields.dictionary()?);
                    let child = fields.whole()?;
                    fields.take(12)?;
                    let frame = frame(&fields.dictionary()?);
                    let name = attributes.get("_name").cloned().unwrap_or_default();
                    file.nodes.insert(id, Node::Transform { name, child, frame });
                }
                b"nGRP" => {
                    let (id, _) = (fields.whole()?, fields.dictionary()?);
                    file.nodes.insert(id, Node::Group(fields.list(|fields| fields.whole())?));
                }
                b"nSHP" => {
                    let (id, _) = (fields.whole()?, fields.dictionary()?);
                    let models = fields.list(|fields| {
                        let model = fields.whole()?;
                        fields.dictionary().map(|_| model)
                    })?;
                    file.nodes.insert(id, Node::Shape(models));
                }
                _ => {}
            }
            at = end;
        }
        Ok(file)
    }

    /// A model turns about the middle of its box, rounded down.
    fn place(
        &mut self,
        index: usize,
        frame: &Transform,
        name: &str,
        options: &Options,
        reading: &mut Reading,
    ) -> Result<(), ImportError> {
        let model = &mut self.models[index];
        let place = format!("model {index}");
        let mut mesh = match &model.mesh {
            Some(mesh) => mesh.clone(),
            None => {
                let mut grid = Grid::new(model.size.map(u64::from), &place, options)?;
                model.cells.iter().for_each(|&[x, y, z, _]| grid.fill([x, y, z].map(usize::from)));
                model.mesh.insert(grid.surface(options)?).clone()
            }
        };
        let middle = model.size.map(|side| f64::from(side / 2));
        for position in &mut mesh.positions {
            *position = frame.apply(std::array::from_fn(|axis| position[axis] - middle[axis]));
        }
        if frame.determinant() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        reading.add_part(SourcePart::new(name, mesh), &place, options)
    }
}

/// `_r`: a signed permutation in seven bits, `_t`: three whole numbers.
fn frame(attributes: &BTreeMap<String, String>) -> Transform {
    let mut frame = Transform::IDENTITY;
    let bits = attributes.get("_r").and_then(|text| text.parse::<u8>().ok());
    if let Some(bits) = bits {
        let (first, second) = (usize::from(bits & 3), usize::from(bits >> 2 & 3));
        if first < 3 && second < 3 && first != second {
            let columns = [first, second, 3 - first - second];
            frame.0 = [[0.0; 3]; 4];
            for (row, column) in columns.into_iter().enumerate() {
                frame.0[column][row] = if bits >> (4 + row) & 1 == 1 { -1.0 } else { 1.0 };
            }
        }
    }
    let shift = attributes.get("_t").map(|text| {
        text.split_ascii_whitespace().filter_map(|word| word.parse::<i32>().ok()).collect::<Vec<_>>()
    });
    if let Some([x, y, z]) = shift.as_deref() {
        frame.0[3] = [*x, *y, *z].map(f64::from);
    }
    frame
}

/// Little-endian fields of a chunk.
struct Fields<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Of the chunk in the file.
    place: usize,
}

impl<'a> Fields<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], ImportError> {
        let taken = self.bytes.get(self.at..self.at.saturating_add(count)).ok_or_else(|| {
            let left = self.bytes.len().saturating_sub(self.at);
            let reason = format!("expected {count} bytes more in the chunk, found {left}");
            ImportError::malformed(format!("byte {}", self.place), reason)
        })?;
        self.at += count;
        Ok(taken)
    }

    fn whole(&mut self) -> Result<i32, ImportError> {
        let field = self.take(4)?.first_chunk().copied().unwrap_or_default();
        Ok(i32::from_le_bytes(field))
    }

    fn text(&mut self) -> Result<String, ImportError> {
        let length = usize::try_from(self.whole()?).unwrap_or(usize::MAX);
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }

    fn list<T>(
        &mut self,
        mut item: impl FnMut(&mut Self) -> Result<T, ImportError>,
    ) -> Result<Vec<T>, ImportError> {
        let count = self.whole()?;
        // The count is not believed: every item takes bytes.
        let mut items = Vec::new();
        for _ in 0..count {
            items.push(item(self)?);
        }
        Ok(items)
    }

    fn dictionary(&mut self) -> Result<BTreeMap<String, String>, ImportError> {
        let pairs = self.list(|fields| Ok((fields.text()?, fields.text()?)))?;
        Ok(pairs.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{measure, weld};

    fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
        [&kind[..], &(content.len() as u32).to_le_bytes(), &[0; 4], content].concat()
    }

    fn words(numbers: &[i32]) -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    }

    fn pairs(pairs: &[(&str, &str)]) -> Vec<u8> {
        let text = |text: &str| [&words(&[text.len() as i32]), text.as_bytes()].concat();
        let body = pairs.iter().flat_map(|(key, value)| [text(key), text(value)].concat());
        words(&[pairs.len() as i32]).into_iter().chain(body).collect()
    }

    fn sample() -> Vec<u8> {
        let mut bytes = b"VOX \x96\0\0\0".to_vec();
        bytes.extend(chunk(b"MAIN", &[]));
        bytes.extend(chunk(b"SIZE", &words(&[2, 1, 3])));
        bytes.extend(chunk(b"XYZI", &[&words(&[2])[..], &[0, 0, 0, 1, 0, 0, 2, 1]].concat()));
        let node = |id: i32, name: &str, child: i32, frame: &[(&str, &str)]| {
            [words(&[id]), pairs(&[("_name", name)]), words(&[child, -1, 0, 1]), pairs(frame)].concat()
        };
        bytes.extend(chunk(b"nTRN", &node(0, "", 1, &[])));
        bytes.extend(chunk(b"nGRP", &[words(&[1]), pairs(&[]), words(&[2, 2, 4])].concat()));
        bytes.extend(chunk(b"nTRN", &node(2, "tower", 3, &[("_t", "10 0 0")])));
        bytes.extend(chunk(b"nSHP", &[words(&[3]), pairs(&[]), words(&[1, 0]), pairs(&[])].concat()));
        // Rows: z, x, y; the first is turned round.
        bytes.extend(chunk(b"nTRN", &node(4, "lying", 3, &[("_r", "18")])));
        bytes
    }

    #[test]
    fn models_stand_where_the_scene_puts_them() {
        let mut reading = Reading::default();
        read(&sample(), &Options::default(), &mut reading).unwrap();
        let names: Vec<&str> = reading.parts.iter().map(|part| part.name.as_str()).collect();
        assert_eq!(names, ["tower", "lying"]);
        let tower = measure(&weld(&reading.parts[0].mesh));
        assert_eq!((tower.min, tower.max), ([9.0, 0.0, -1.0], [10.0, 1.0, 2.0]));
        assert!((tower.solid.unwrap().measure - 2.0).abs() < 1e-12);
        // The long side lies along X, from -2 to 1 as the axis is reversed.
        let lying = measure(&weld(&reading.parts[1].mesh));
        assert_eq!((lying.min[0], lying.max[0]), (-2.0, 1.0));
        assert!((lying.signed_volume.unwrap() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn every_cut_is_refused_or_read() {
        let bytes = sample();
        for length in 0..bytes.len() {
            let outcome = read(&bytes[..length], &Options::default(), &mut Reading::default());
            assert!(outcome.is_ok() || !outcome.unwrap_err().reason().is_empty());
        }
    }
}
