//! What every target asks: bytes in, a sound model or a refusal that says enough out.

use std::path::Path;

use importer::{Options, measure, read_bytes, weld};

/// Small limits: a target should find faults, not fill memory.
fn options() -> Options {
    Options {
        max_file_bytes: 1 << 20,
        max_triangles: 20_000,
        max_voxels: 1 << 18,
        cloud_cells: 12,
        shapes: Some(mapper::shapes_file::READER),
        ..Options::default()
    }
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

/// One a reader, by the extension that leads to it; the two packings stand in a GLB of their own.
pub const TARGETS: [&str; 12] =
    ["gltf", "draco", "meshopt", "obj", "stl", "ply", "off", "xyz", "pcd", "vox", "binvox", "shapes.yaml"];

/// One input of a target.
pub fn run(target: &str, bytes: &[u8]) {
    match target {
        "draco" => check("a.glb", &draco(bytes)),
        "meshopt" => check("a.glb", &meshopt(bytes)),
        extension => check(&format!("a.{extension}"), bytes),
    }
}

/// A container that is right, around a Draco stream.
fn draco(stream: &[u8]) -> Vec<u8> {
    let length = stream.len();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"extensions":
        {{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":0}}}}}}}}]}}],
        "accessors":[{{"componentType":5126,"count":3,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{length}}}],"buffers":[{{"byteLength":{length}}}]}}"#
    );
    glb(json, stream)
}

/// A container that is right, around a meshopt stream; the first byte tells its mode and filter.
fn meshopt(bytes: &[u8]) -> Vec<u8> {
    let Some((kind, stream)) = bytes.split_first() else { return Vec::new() };
    let mode = ["ATTRIBUTES", "TRIANGLES", "INDICES"][usize::from(kind & 3).min(2)];
    let filter = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"][usize::from(kind >> 2 & 3)];
    let (stride, count) = if mode == "ATTRIBUTES" { (12, 24) } else { (4, 24) };
    let (length, plain) = (stream.len(), stride * count);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"}},
        {{"bufferView":0,"componentType":5125,"count":24,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{plain},"extensions":{{"EXT_meshopt_compression":
        {{"buffer":0,"byteLength":{length},"byteStride":{stride},"count":{count},"mode":"{mode}",
        "filter":"{filter}"}}}}}}],"buffers":[{{"byteLength":{length}}}]}}"#
    );
    glb(json, stream)
}

fn glb(json: String, data: &[u8]) -> Vec<u8> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data) in [(b"JSON", json.as_slice()), (b"BIN\0", data)] {
        glb.extend(u32::try_from(data.len()).unwrap_or(u32::MAX).to_le_bytes());
        glb.extend(kind);
        glb.extend(data);
    }
    glb
}
