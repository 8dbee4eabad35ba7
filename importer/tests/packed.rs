//! Packed geometry: what an encoder packed is read as it was, and bent bytes are refused or read, never a panic.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod support;

use std::fs;
use std::path::Path;

use importer::{ImportError, Options, Source, read};
use meshopt::encoding;

const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [u32; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];

struct Sample {
    name: &'static str,
    vertices: Vec<u8>,
    filter: &'static str,
    corners: Vec<u8>,
    mode: &'static str,
}

fn samples() -> [Sample; 3] {
    let vertices = encoding::encode_vertex_buffer(&CORNERS).unwrap();
    let corners = encoding::encode_index_buffer(&FACES, 4).unwrap();
    let exponents = encoding::encode_filter_exp(&CORNERS, 15, encoding::EncodeExpMode::Separate);
    let filtered = encoding::encode_vertex_buffer(&exponents).unwrap();
    let sequence = encoding::encode_index_sequence(&FACES, 4).unwrap();
    [
        Sample {
            name: "EXT_meshopt_compression",
            vertices: vertices.clone(),
            filter: "NONE",
            corners: corners.clone(),
            mode: "TRIANGLES",
        },
        Sample {
            name: "EXT_meshopt_compression",
            vertices: filtered,
            filter: "EXPONENTIAL",
            corners,
            mode: "TRIANGLES",
        },
        Sample {
            name: "KHR_meshopt_compression",
            vertices,
            filter: "NONE",
            corners: sequence,
            mode: "INDICES",
        },
    ]
}

impl Sample {
    fn packed(&self) -> Vec<u8> {
        [self.vertices.as_slice(), &self.corners].concat()
    }

    /// A folder with the model, its packed bytes and, where `plain`, the fallback's.
    fn written(&self, packed: &[u8], plain: bool, count: u64) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let (name, filter, mode) = (self.name, self.filter, self.mode);
        let (vertices, corners) = (self.vertices.len(), self.corners.len());
        let uri = if plain { r#","uri":"plain.bin""# } else { "" };
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
            {{"bufferView":1,"componentType":5125,"count":12,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":1,"byteLength":48,"byteStride":12,"extensions":{{"{name}":{{"buffer":0,
            "byteLength":{vertices},"byteStride":12,"count":{count},"mode":"ATTRIBUTES","filter":"{filter}"}}}}}},
            {{"buffer":1,"byteOffset":48,"byteLength":48,"extensions":{{"{name}":{{"buffer":0,
            "byteOffset":{vertices},"byteLength":{corners},"byteStride":4,"count":12,"mode":"{mode}"}}}}}}],
            "buffers":[{{"byteLength":{},"uri":"packed.bin"}},
            {{"byteLength":96{uri},"extensions":{{"{name}":{{"fallback":true}}}}}}]}}"#,
            vertices + corners
        );
        fs::write(folder.path().join("a.gltf"), json).unwrap();
        fs::write(folder.path().join("packed.bin"), packed).unwrap();
        if plain {
            let mut bytes: Vec<u8> =
                CORNERS.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
            bytes.extend(FACES.iter().flat_map(|corner| corner.to_le_bytes()));
            fs::write(folder.path().join("plain.bin"), bytes).unwrap();
        }
        folder
    }
}

fn read_in(folder: &tempfile::TempDir) -> Result<Source, ImportError> {
    read(&folder.path().join("a.gltf"), &Options::default())
}

fn volume(source: &Source) -> f64 {
    importer::measure(&importer::weld(&source.merged())).signed_volume.unwrap()
}

#[test]
fn what_was_packed_is_read_as_it_was() {
    for sample in samples() {
        let source = read_in(&sample.written(&sample.packed(), false, 4)).unwrap();
        assert_eq!(source.parts[0].mesh.positions, CORNERS.map(|corner| corner.map(f64::from)));
        // The codec may turn a triangle's corners, not its side.
        assert!((volume(&source) - 1.0 / 6.0).abs() < 1e-12, "{} {}", sample.name, sample.mode);
        assert_eq!(source.notes, []);
    }
}

#[test]
fn a_broken_stream_falls_back_to_the_plain_bytes_that_are_there() {
    let sample = &samples()[0];
    let source = read_in(&sample.written(&[0; 4], true, 4)).unwrap();
    assert_eq!(source.parts[0].mesh.triangles.len(), 4);
    assert!(source.notes.iter().all(|note| note.code == "compression-fallback") && source.notes.len() == 2);
    let error = read_in(&sample.written(&[0; 4], false, 4)).unwrap_err();
    assert_eq!(error.code(), "malformed");
    assert_eq!(error.place(), "bufferViews[0].extensions.EXT_meshopt_compression");
}

#[test]
fn a_bomb_is_refused_before_it_is_unpacked() {
    let sample = &samples()[0];
    for (count, code) in [(100_000, "malformed"), (1 << 40, "too-large"), (u64::MAX, "too-large")] {
        let error = read_in(&sample.written(&sample.packed(), false, count)).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
    }
}

/// A read that is whole, or a refusal that says enough.
fn fault(path: &Path) -> Option<String> {
    match read(path, &Options::default()) {
        Ok(source) => {
            let sound = source.parts.iter().all(|part| {
                let count = part.mesh.positions.len();
                part.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count)
                    && part.mesh.positions.as_flattened().iter().all(|value| value.is_finite())
            });
            (!sound).then(|| format!("{} was read unsound", path.display()))
        }
        Err(error) if error.code() == "panic" || error.reason().is_empty() || error.way_out().is_empty() => {
            Some(error.to_string())
        }
        Err(_) => None,
    }
}

/// Marsaglia's xorshift: the same bends on every run.
struct Bends(u64);

impl Bends {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit as u64) as usize
    }
}

#[test]
fn generated_streams_cut_and_bent_are_refused_or_read() {
    let mut bends = Bends(0x9E37_79B9_7F4A_7C15);
    for sample in samples() {
        let packed = sample.packed();
        for length in 0..packed.len() {
            let folder = sample.written(&packed[..length], false, 4);
            assert_eq!(fault(&folder.path().join("a.gltf")), None, "cut to {length}");
        }
        for _ in 0..300 {
            let mut bent = packed.clone();
            for _ in 0..=bends.below(3) {
                bent[bends.below(packed.len())] ^= 1 << bends.below(8);
            }
            let folder = sample.written(&bent, false, 4);
            assert_eq!(fault(&folder.path().join("a.gltf")), None);
        }
    }
}

fn base64(text: &str) -> Vec<u8> {
    let (mut bytes, mut bits, mut held) = (Vec::new(), 0_u32, 0);
    for letter in text.bytes().take_while(|&letter| letter != b'=') {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            _ => 63,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held & 0xFF) as u8);
        }
    }
    bytes
}

/// A data URI's bytes put beside the file: bent in base64, most bends would be refused as such.
fn with_data_beside(folder: &Path, name: &str) -> Option<String> {
    let text = fs::read_to_string(folder.join(name)).ok()?;
    let start = text.find("data:application/octet-stream;base64,")?;
    let end = start + text[start..].find('"')?;
    let data = base64(text[start..end].split_once(',')?.1);
    fs::write(folder.join(name), format!("{}beside.bin{}", &text[..start], &text[end..])).unwrap();
    fs::write(folder.join("beside.bin"), data).unwrap();
    Some("beside.bin".to_owned())
}

/// The samples with their companions, each file of the model cut and bent in turn.
#[test]
fn packed_samples_cut_and_bent_are_refused_or_read() {
    let Some(root) = support::models() else { return };
    let mut bends = Bends(0x2545_F491_4F6C_DD1D);
    let mut wrong = Vec::new();
    for row in support::table(&root.join("FACTS.csv")) {
        if !row["flags"].split(' ').any(|flag| flag == "draco" || flag == "meshopt") {
            continue;
        }
        let original = root.join(&row["path"]);
        let folder = tempfile::tempdir().unwrap();
        let name = original.file_name().unwrap().to_str().unwrap();
        let stem = original.file_stem().unwrap().to_str().unwrap();
        let mut bent = vec![name.to_owned()];
        for entry in fs::read_dir(original.parent().unwrap()).unwrap() {
            let entry = entry.unwrap().file_name().into_string().unwrap();
            if entry.starts_with(stem) && entry.ends_with(".bin") {
                bent.push(entry);
            }
        }
        bent.sort();
        for file in &bent {
            let bytes = fs::read(original.with_file_name(file)).unwrap();
            fs::write(folder.path().join(file), bytes).unwrap();
        }
        bent.extend(with_data_beside(folder.path(), name));
        let whole = read(&folder.path().join(name), &Options::default()).unwrap();
        assert!(whole.notes.iter().all(|note| note.code != "compression-fallback"), "{name}");
        let copies: Vec<Vec<u8>> =
            bent.iter().map(|file| fs::read(folder.path().join(file)).unwrap()).collect();
        for (file, bytes) in bent.iter().zip(&copies) {
            for bend in 0..40 {
                let mut copy = bytes.clone();
                if bend < 20 {
                    copy.truncate(bends.below(bytes.len()));
                } else {
                    for _ in 0..=bends.below(4) {
                        copy[bends.below(bytes.len())] ^= 1 << bends.below(8);
                    }
                }
                fs::write(folder.path().join(file), copy).unwrap();
                let found = fault(&folder.path().join(name));
                wrong.extend(found.map(|found| format!("{}, bend {bend} of {file}: {found}", row["path"])));
            }
            fs::write(folder.path().join(file), bytes).unwrap();
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
