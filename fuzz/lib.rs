//! What every target asks: bytes in, a sound model or a refusal that says enough out.

use std::path::Path;

use importer::{Options, measure, read_bytes, weld};

/// Small limits: a target should find faults, not fill memory.
fn options() -> Options {
    Options { max_file_bytes: 1 << 20, max_triangles: 20_000, max_voxels: 1 << 18, ..Options::default() }
}

/// Panics where a reader does, where a model is unsound, or where a refusal says too little.
pub fn check(name: &str, bytes: &[u8]) {
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

/// A GLB of one primitive whose packed bytes are given.
pub fn packed(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data) in [(b"JSON", json.as_slice()), (b"BIN\0", binary)] {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}
