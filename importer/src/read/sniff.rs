//! Which format is this? The bytes decide; the extension helps where they cannot.

use std::path::Path;

use crate::ImportError;
use crate::asset::Format;

use super::notes::Notes;

/// # Errors
/// [`ImportError::UnknownFormat`] where neither bytes nor extension tell.
pub(super) fn format_of(path: &Path, bytes: &[u8], notes: &mut Notes) -> Result<Format, ImportError> {
    let extension = path.extension().and_then(|text| text.to_str()).unwrap_or("").to_ascii_lowercase();
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("").to_ascii_lowercase();
    let hinted = if is_shapes(&name) { Some(Format::Shapes) } else { by_extension(&extension) };
    let Some(format) = by_bytes(bytes, hinted) else {
        return hinted.ok_or_else(|| ImportError::UnknownFormat {
            file: path.to_path_buf(),
            reason: format!("neither its bytes nor its extension {extension:?} are of a known format"),
        });
    };
    if hinted.is_some_and(|hinted| hinted != format) {
        let message = format!("named .{extension}, but its bytes are of {format:?}");
        notes.add("extension-misleading", "", message);
    }
    Ok(format)
}

/// `*.shapes.yaml`: other YAML beside models is of rules and overrides.
pub(crate) fn is_shapes(name: &str) -> bool {
    name.ends_with(".shapes.yaml") || name.ends_with(".shapes.yml")
}

fn by_extension(extension: &str) -> Option<Format> {
    Some(match extension {
        "glb" => Format::Glb,
        "gltf" => Format::Gltf,
        "obj" => Format::Obj,
        "stl" => Format::Stl,
        "ply" => Format::Ply,
        "off" => Format::Off,
        "xyz" | "pts" | "asc" => Format::Xyz,
        "pcd" => Format::Pcd,
        "vox" => Format::Vox,
        "binvox" => Format::Binvox,
        _ => return None,
    })
}

fn by_bytes(bytes: &[u8], hinted: Option<Format>) -> Option<Format> {
    if bytes.starts_with(b"glTF") {
        return Some(Format::Glb);
    }
    if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        return Some(Format::Ply);
    }
    if bytes.starts_with(super::vox::MAGIC) {
        return Some(Format::Vox);
    }
    if bytes.starts_with(super::binvox::MAGIC) {
        return Some(Format::Binvox);
    }
    if bytes.starts_with(b"# .PCD") {
        return Some(Format::Pcd);
    }
    if super::off::looks_like(bytes) {
        return Some(Format::Off);
    }
    // The rest have no signature: believe a known extension first.
    let text = bytes.trim_ascii_start();
    let json = text.starts_with(b"{") && bytes.windows(7).take(1 << 20).any(|at| at == b"\"asset\"");
    match hinted {
        Some(Format::Glb) if json => Some(Format::Gltf),
        Some(Format::Obj | Format::Ply) if super::stl::looks_like_text(bytes) => Some(Format::Stl),
        Some(_) => None,
        None if json => Some(Format::Gltf),
        None if super::stl::looks_like_text(bytes) || super::stl::binary_count(bytes).is_some() => {
            Some(Format::Stl)
        }
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str, bytes: &[u8]) -> Result<Format, &'static str> {
        format_of(Path::new(name), bytes, &mut Notes::default()).map_err(|error| error.code())
    }

    #[test]
    fn bytes_beat_the_extension() {
        assert_eq!(told("a.obj", b"glTF\x02\0\0\0"), Ok(Format::Glb));
        assert_eq!(told("a.stl", b"ply\nformat ascii 1.0"), Ok(Format::Ply));
        assert_eq!(told("a.glb", b" {\"asset\":{}}"), Ok(Format::Gltf));
        assert_eq!(told("a.dat", b"solid a\nfacet normal 0 0 1\n"), Ok(Format::Stl));
        assert_eq!(told("a.obj", b"OFF4 4 0\n"), Ok(Format::Off));
    }

    #[test]
    fn the_extension_helps_where_bytes_do_not_tell() {
        assert_eq!(told("a.OBJ", b"v 0 0 0"), Ok(Format::Obj));
        assert_eq!(told("a.gltf", b"{{{"), Ok(Format::Gltf));
        assert_eq!(told("a.txt", b"hello"), Err("unknown-format"));
    }
}
