//! Small files of every format, cut and bent: a clean refusal or a right read, never a panic.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::fs;
use std::path::{Path, PathBuf};

use importer::{Options, read};
use proptest::prelude::*;

const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[u8; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn floats() -> Vec<u8> {
    CORNERS.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn gltf_json(buffer: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"name":"outer","children":[1],"scale":[1,-1,1]}},{{"mesh":0,"translation":[1,2,3]}}],
        "meshes":[{{"name":"tetra","primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{{"count":1,
        "indices":{{"bufferView":1,"componentType":5121}},"values":{{"bufferView":0}}}}}},
        {{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":12}}],
        "buffers":[{{"byteLength":60{buffer}}}]}}"#
    )
}

fn glb() -> Vec<u8> {
    let mut json = gltf_json("").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary = [floats(), FACES.concat()].concat();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(((28 + json.len() + binary.len()) as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}

fn stl(text: bool) -> Vec<u8> {
    let mut binary = vec![b' '; 80];
    binary.extend(4_u32.to_le_bytes());
    let mut lines = "solid tetra\n".to_owned();
    for face in FACES {
        binary.extend([0; 12]);
        lines += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in face.map(|corner| CORNERS[usize::from(corner)]) {
            binary.extend([x, y, z].iter().flat_map(|value| value.to_le_bytes()));
            lines += &format!("vertex {x} {y} {z}\n");
        }
        binary.extend([0; 2]);
        lines += "endloop\nendfacet\n";
    }
    if text { (lines + "endsolid tetra\n").into_bytes() } else { binary }
}

fn ply(encoding: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uchar uchar vertex_indices\nend_header\n"
    )
    .into_bytes();
    match encoding {
        "ascii" => {
            bytes.extend(CORNERS.iter().flat_map(|[x, y, z]| format!("{x} {y} {z}\n").into_bytes()));
            bytes.extend(FACES.iter().flat_map(|[a, b, c]| format!("3 {a} {b} {c}\n").into_bytes()));
        }
        _ => {
            let big = encoding == "binary_big_endian";
            let value = |value: &f32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
            bytes.extend(CORNERS.as_flattened().iter().flat_map(value));
            bytes.extend(FACES.iter().flat_map(|&[a, b, c]| [3, a, b, c]));
        }
    }
    bytes
}

fn obj() -> Vec<u8> {
    let mut text = "mtllib none.mtl\no tetra\nusemtl Red\n".to_owned();
    text.extend(CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n")));
    text.extend(FACES.map(|face| format!("f {}/1 {} -{}\n", face[0] + 1, face[1] + 1, 4 - face[2])));
    text.into_bytes()
}

/// Every format, each with the same tetrahedron.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    // 60 bytes of the buffer in base64 would hide behind one bent letter: the external file is bent instead.
    let external = gltf_json(r#","uri":"beside.bin""#).into_bytes();
    vec![
        ("a.glb", glb()),
        ("a.gltf", external),
        ("a.obj", obj()),
        ("binary.stl", stl(false)),
        ("text.stl", stl(true)),
        ("text.ply", ply("ascii")),
        ("little.ply", ply("binary_little_endian")),
        ("big.ply", ply("binary_big_endian")),
    ]
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("beside.bin"), [floats(), FACES.concat()].concat()).unwrap();
    folder
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// A read that is whole, or a refusal that is.
fn check(path: &Path) -> Result<(), String> {
    match read(path, &Options::default()) {
        Ok(source) => {
            for part in &source.parts {
                let count = part.mesh.positions.len();
                let sound = part.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count)
                    && part.mesh.positions.as_flattened().iter().all(|value| value.is_finite());
                if part.mesh.triangles.is_empty() || !sound {
                    return Err(format!("{} was read unsound", path.display()));
                }
            }
            Ok(())
        }
        Err(error) if error.code() == "panic" => Err(format!("{error}")),
        Err(error) if error.reason().is_empty() || error.way_out().is_empty() || error.file() != path => {
            Err(format!("a refusal that does not say enough: {error:?}"))
        }
        Err(_) => Ok(()),
    }
}

#[test]
fn every_sample_is_read_whole() {
    let folder = folder();
    for (name, bytes) in samples() {
        let source = read(&written(folder.path(), name, &bytes), &Options::default()).unwrap();
        assert_eq!(source.parts[0].mesh.triangles.len(), 4, "{name}");
        let measures = importer::measure(&importer::weld(&source.merged()));
        assert!((measures.signed_volume.unwrap() - 1.0 / 6.0).abs() < 1e-12, "{name}");
    }
}

#[test]
fn every_cut_is_refused_or_read() {
    let folder = folder();
    for (name, bytes) in samples() {
        for length in 0..bytes.len() {
            check(&written(folder.path(), name, &bytes[..length])).unwrap();
        }
    }
}

#[test]
fn the_key_follows_the_file_and_what_it_refers_to() {
    let folder = folder();
    let path = written(folder.path(), "a.gltf", &samples()[1].1);
    let before = read(&path, &Options::default()).unwrap().key;
    let mut beside = fs::read(folder.path().join("beside.bin")).unwrap();
    beside[4] ^= 1;
    fs::write(folder.path().join("beside.bin"), beside).unwrap();
    let after = read(&path, &Options::default()).unwrap().key;
    assert_ne!(before, after);
}

#[test]
fn limits_refuse_by_name() {
    let folder = folder();
    let path = written(folder.path(), "a.glb", &glb());
    for options in [
        Options { max_file_bytes: 100, ..Options::default() },
        Options { max_triangles: 3, ..Options::default() },
    ] {
        assert_eq!(read(&path, &options).unwrap_err().code(), "too-large");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn bent_files_are_refused_or_read(
        sample in 0..8_usize,
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u32), 1..8),
    ) {
        let folder = folder();
        let (name, mut bytes) = samples().swap_remove(sample);
        for (at, bit) in flips {
            *at.get_mut(&mut bytes) ^= 1 << bit;
        }
        prop_assert_eq!(check(&written(folder.path(), name, &bytes)), Ok(()));
    }

    #[test]
    fn noise_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), sample in 0..8_usize) {
        let folder = folder();
        let name = samples()[sample].0;
        prop_assert_eq!(check(&written(folder.path(), name, &bytes)), Ok(()));
    }
}
