//! What every target asks: bytes in, a sound model or a refusal that says enough out.

use std::path::Path;

use importer::{Options, measure, read_bytes, weld};

/// Small limits: a target should find faults, not fill memory.
fn options() -> Options {
    Options { max_file_bytes: 1 << 20, max_triangles: 20_000, max_voxels: 1 << 18, ..Options::default() }
}

/// Panics where a reader does, where a model is unsound, or where a refusal says too little.
fn check(name: &str, bytes: &[u8]) {
    match read_bytes(Path::new(name), bytes, &options()) {
        Ok(source) => {
            for part in &source.parts {
                let count = part.mesh.positions.len();
                assert!(!part.mesh.triangles.is_empty(), "a part of no triangles");
                assert!(part.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
                assert!(part.mesh.positions.as_flattened().iter().all(|value| value.is_finite()));
            }
            if source.parts.iter().map(|part| part.mesh.triangles.len()).sum::<usize>() < 400 {
                let measures = measure(&weld(&source.merged()));
                if let Some(solid) = measures.solid {
                    assert!(solid.measure > 0.0, "{solid:?}");
                }
            }
        }
        Err(error) => {
            assert!(error.code() != "panic", "{error}");
            assert!(!error.reason().is_empty() && !error.way_out().is_empty(), "{error:?}");
        }
    }
}

/// One input of a target. Where a target has several formats the first byte tells which.
pub fn run(target: &str, bytes: &[u8]) {
    let first = bytes.first().copied().unwrap_or_default();
    let rest = bytes.get(1..).unwrap_or_default();
    match target {
        "points" => check(["a.xyz", "a.pcd", "a.off"][usize::from(first % 3)], rest),
        "voxels" => check(["a.vox", "a.binvox"][usize::from(first % 2)], rest),
        "packed" => check("a.glb", &packed(bytes)),
        extension => check(&format!("a.{extension}"), bytes),
    }
}

/// A container that is right, around packed geometry: the first byte tells Draco from meshopt's modes and filters.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let Some((kind, rest)) = bytes.split_first() else { return Vec::new() };
    let length = rest.len();
    let json = if kind % 2 == 0 {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"extensions":
            {{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":0}}}}}}}}]}}],
            "accessors":[{{"componentType":5126,"count":3,"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{length}}}],"buffers":[{{"byteLength":{length}}}]}}"#
        )
    } else {
        let mode = ["ATTRIBUTES", "TRIANGLES", "INDICES"][usize::from(kind >> 1 & 3).min(2)];
        let filter = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"][usize::from(kind >> 3 & 3)];
        let (stride, count) = if mode == "ATTRIBUTES" { (12, 24) } else { (4, 24) };
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"}},
            {{"bufferView":0,"componentType":5125,"count":24,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{},"extensions":{{"EXT_meshopt_compression":
            {{"buffer":1,"byteLength":{length},"byteStride":{stride},"count":{count},"mode":"{mode}",
            "filter":"{filter}"}}}}}}],
            "buffers":[{{"byteLength":{length}}},{{"byteLength":{length}}}]}}"#,
            stride * count
        )
        .replace("\"buffer\":1", "\"buffer\":0")
    };
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data) in [(b"JSON", json.as_slice()), (b"BIN\0", rest)] {
        glb.extend((data.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(data);
    }
    glb
}
