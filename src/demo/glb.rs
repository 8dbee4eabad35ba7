//! Writes binary glTF 2.0: one JSON chunk, one buffer chunk.

use serde_json::{Value, json};

use super::mesh::Mesh;

const MAGIC: u32 = 0x4654_6C67;
const VERSION: u32 = 2;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What a part looks like; its name is what the mapper reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    pub name: &'static str,
    /// Linear red, green, blue, opacity.
    pub color: [f32; 4],
    pub metallic: f32,
    pub roughness: f32,
}

/// One node of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    pub name: &'static str,
    pub material: Material,
    pub mesh: Mesh,
}

/// The bytes of a `.glb`: a root node named `name` with one child a part, in metres, Y up.
#[must_use]
pub fn write(name: &str, parts: &[Part]) -> Vec<u8> {
    let mut binary: Vec<u8> = Vec::new();
    let mut views: Vec<Value> = Vec::new();
    let mut accessors: Vec<Value> = Vec::new();
    let mut meshes: Vec<Value> = Vec::new();
    let mut materials: Vec<Material> = Vec::new();
    let mut nodes = vec![json!({
        "name": name,
        "children": (1..=parts.len()).collect::<Vec<_>>(),
    })];
    for (index, part) in parts.iter().enumerate() {
        let material = materials.iter().position(|known| *known == part.material).unwrap_or_else(|| {
            materials.push(part.material);
            materials.len() - 1
        });
        let positions: Vec<[f32; 3]> =
            part.mesh.positions.iter().map(|position| position.map(|value| value as f32)).collect();
        let bounds = |pick: fn(f32, f32) -> f32, from: f32| {
            positions
                .iter()
                .fold([from; 3], |bound, p| std::array::from_fn(|axis| pick(bound[axis], p[axis])))
        };
        let vertices = bytes_of(positions.iter().flatten().map(|value| value.to_le_bytes()));
        let indices = bytes_of(part.mesh.triangles.iter().flatten().map(|index| index.to_le_bytes()));
        for (bytes, target) in [(&vertices, ARRAY_BUFFER), (&indices, ELEMENT_ARRAY_BUFFER)] {
            views.push(json!({
                "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len(), "target": target,
            }));
            binary.extend_from_slice(bytes);
        }
        accessors.push(json!({
            "bufferView": views.len() - 2, "componentType": FLOAT, "count": positions.len(), "type": "VEC3",
            "min": bounds(f32::min, f32::INFINITY), "max": bounds(f32::max, f32::NEG_INFINITY),
        }));
        accessors.push(json!({
            "bufferView": views.len() - 1, "componentType": UNSIGNED_INT,
            "count": part.mesh.triangles.len() * 3, "type": "SCALAR",
        }));
        meshes.push(json!({
            "name": part.name,
            "primitives": [{
                "attributes": { "POSITION": accessors.len() - 2 },
                "indices": accessors.len() - 1,
                "material": material,
            }],
        }));
        nodes.push(json!({ "name": part.name, "mesh": index }));
    }
    let materials: Vec<Value> = materials.iter().map(describe).collect();
    let document = json!({
        "asset": { "version": "2.0", "generator": concat!("physique ", env!("CARGO_PKG_VERSION"), " demo") },
        "scene": 0,
        "scenes": [{ "name": name, "nodes": [0] }],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    container(document.to_string().into_bytes(), binary)
}

fn describe(material: &Material) -> Value {
    let mut described = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.color,
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
    });
    if material.color[3] < 1.0 {
        described["alphaMode"] = json!("BLEND");
    }
    described
}

fn bytes_of(values: impl Iterator<Item = [u8; 4]>) -> Vec<u8> {
    values.flatten().collect()
}

/// Both chunks padded to four bytes: JSON with spaces, the buffer with zeros.
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut file = Vec::with_capacity(length);
    for word in [MAGIC, VERSION, length as u32, json.len() as u32, JSON_CHUNK] {
        file.extend_from_slice(&word.to_le_bytes());
    }
    file.extend_from_slice(&json);
    for word in [binary.len() as u32, BINARY_CHUNK] {
        file.extend_from_slice(&word.to_le_bytes());
    }
    file.extend_from_slice(&binary);
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_container_is_what_the_standard_says() {
        let part = Part {
            name: "block",
            material: Material { name: "oak", color: [0.5, 0.4, 0.3, 1.0], metallic: 0.0, roughness: 0.8 },
            mesh: Mesh::cuboid([0.5; 3], 0.1),
        };
        let file = write("thing", &[part.clone(), Part { name: "other", ..part }]);
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes"));
        assert_eq!([word(0), word(4), word(8)], [MAGIC, 2, file.len() as u32]);
        let json_length = word(12) as usize;
        assert_eq!([word(16), json_length as u32 % 4], [JSON_CHUNK, 0]);
        let document: Value = serde_json::from_slice(&file[20..20 + json_length]).expect("JSON");
        let binary_length = word(20 + json_length) as usize;
        assert_eq!(word(24 + json_length), BINARY_CHUNK);
        assert_eq!(28 + json_length + binary_length, file.len());
        assert_eq!(document["buffers"][0]["byteLength"].as_u64(), Some(binary_length as u64));
        assert_eq!(document["materials"].as_array().map(Vec::len), Some(1), "one material serves both parts");
        let views = document["bufferViews"].as_array().expect("views");
        let end =
            |view: &Value| view["byteOffset"].as_u64().zip(view["byteLength"].as_u64()).map(|(a, b)| a + b);
        assert_eq!(views.len(), 4);
        assert_eq!(end(&views[3]), Some(binary_length as u64));
        assert_eq!(document["accessors"][0]["max"], json!([0.5, 0.5, 0.5]));
    }
}
