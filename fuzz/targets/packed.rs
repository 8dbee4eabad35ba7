//! Packed geometry: the first byte tells Draco from meshopt's modes and filters, the rest is the packed bytes, in a
//! container that is right.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((kind, rest)) = bytes.split_first() else { return };
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
    fuzz::check("a.glb", &fuzz::packed(&json, rest));
});
