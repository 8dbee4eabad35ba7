//! Has a file changed since it was read, as far as can be told without reading it?

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::Deserialize;

use crate::catalogue::{Dependency, Stamp};

/// File systems keep times as coarse as this: a file changed so recently may change again and not show it.
const COARSEST_TIME: Duration = Duration::from_secs(2);

/// The stamp of the file as it is now; without a time where that cannot be relied on.
pub(super) fn stamp_of(path: &Path) -> io::Result<Stamp> {
    let metadata = fs::metadata(path)?;
    let settled = |time: &SystemTime| {
        SystemTime::now().checked_sub(COARSEST_TIME).is_some_and(|recently| *time < recently)
    };
    let modified_ns = metadata.modified().ok().filter(settled).and_then(nanoseconds);
    Ok(Stamp { bytes: metadata.len(), modified_ns })
}

fn nanoseconds(time: SystemTime) -> Option<i64> {
    match time.duration_since(UNIX_EPOCH) {
        Ok(after) => i64::try_from(after.as_nanos()).ok(),
        Err(before) => i64::try_from(before.duration().as_nanos()).ok().map(|ns| -ns),
    }
}

/// The buffer files that a glTF refers to, with their stamps; none for other formats. `None` where they
/// cannot be told or are not there: then only reading the model tells whether it has changed.
pub(super) fn dependencies_of(path: &Path, max_bytes: u64) -> Option<Vec<Dependency>> {
    let Some(json) = gltf_json(path, max_bytes).ok()? else {
        return Some(Vec::new());
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut dependencies = Vec::new();
    for uri in
        serde_json::from_slice::<Buffers>(&json).ok()?.buffers.into_iter().filter_map(|buffer| buffer.uri)
    {
        if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
            continue;
        }
        let path = percent_decoded(&uri)?;
        let stamp = stamp_of(&folder.join(&path)).ok()?;
        dependencies.push(Dependency { path, stamp });
    }
    dependencies.sort_by(|a, b| a.path.cmp(&b.path));
    dependencies.dedup();
    Some(dependencies)
}

/// Whether every file is as it was when its stamp was taken.
pub(super) fn are_unchanged(dependencies: &[Dependency], model: &Path) -> bool {
    let folder = model.parent().unwrap_or(Path::new(""));
    dependencies.iter().all(|dependency| {
        stamp_of(&folder.join(&dependency.path)).is_ok_and(|now| now.is_unchanged_since(&dependency.stamp))
    })
}

/// The one member of a glTF file that names geometry outside it.
#[derive(Deserialize)]
struct Buffers {
    #[serde(default)]
    buffers: Vec<Buffer>,
}

#[derive(Deserialize)]
struct Buffer {
    uri: Option<String>,
}

/// The JSON of a glTF or GLB, told apart by their first bytes; `None` for any other format and for a GLB too
/// short to have any.
fn gltf_json(path: &Path, max_bytes: u64) -> io::Result<Option<Vec<u8>>> {
    let mut file = BufReader::new(File::open(path)?);
    let mut start = Vec::new();
    file.by_ref().take(20).read_to_end(&mut start)?;
    let mut json = Vec::new();
    if start.starts_with(b"glTF") {
        let Some(length) = start.get(12..16).and_then(|field| field.first_chunk().copied()) else {
            return Ok(None);
        };
        file.take(u64::from(u32::from_le_bytes(length)).min(max_bytes)).read_to_end(&mut json)?;
        return Ok((start.len() == 20).then_some(json));
    }
    let text = start.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&start);
    if text.trim_ascii_start().first().is_none_or(|byte| *byte != b'{') {
        return Ok(None);
    }
    json.extend_from_slice(text);
    file.take(max_bytes).read_to_end(&mut json)?;
    Ok(Some(json))
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut pieces = uri.split('%');
    let mut decoded = pieces.next()?.as_bytes().to_vec();
    for piece in pieces {
        let (digits, rest) = piece.split_at_checked(2)?;
        decoded.push(u8::from_str_radix(digits, 16).ok()?);
        decoded.extend_from_slice(rest.as_bytes());
    }
    String::from_utf8(decoded).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(path: &Path, text: &[u8]) {
        fs::write(path, text).unwrap();
        let then = SystemTime::now() - Duration::from_secs(100);
        File::options().write(true).open(path).unwrap().set_modified(then).unwrap();
    }

    #[test]
    fn a_file_just_written_is_not_relied_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        fs::write(&path, "x").unwrap();
        let fresh = stamp_of(&path).unwrap();
        assert_eq!(fresh, Stamp { bytes: 1, modified_ns: None });
        assert!(!fresh.is_unchanged_since(&fresh));
        settled(&path, b"x");
        let old = stamp_of(&path).unwrap();
        assert!(old.is_unchanged_since(&old) && !old.is_unchanged_since(&fresh));
        settled(&path, b"xy");
        assert!(!stamp_of(&path).unwrap().is_unchanged_since(&old));
    }

    #[test]
    fn buffers_outside_are_found_in_both_containers() {
        let folder = tempfile::tempdir().unwrap();
        let json = r#"{"asset":{},"buffers":[{"uri":"a%20b.bin"},{"uri":"DATA:,"},{"byteLength":3},{"uri":"c.bin"}]}"#;
        let gltf = folder.path().join("m.gltf");
        settled(&gltf, json.as_bytes());
        let mut container = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        container.extend((json.len() as u32).to_le_bytes());
        container.extend(b"JSON");
        container.extend(json.as_bytes());
        container.extend(b"\x04\0\0\0BIN\0abcd");
        let glb = folder.path().join("m.glb");
        settled(&glb, &container);
        for model in [&gltf, &glb] {
            assert_eq!(dependencies_of(model, 1 << 20), None, "a buffer is not there");
        }
        settled(&folder.path().join("a b.bin"), b"12");
        settled(&folder.path().join("c.bin"), b"123");
        for model in [&gltf, &glb] {
            let found = dependencies_of(model, 1 << 20).unwrap();
            let sizes: Vec<_> = found.iter().map(|file| (file.path.as_str(), file.stamp.bytes)).collect();
            assert_eq!(sizes, [("a b.bin", 2), ("c.bin", 3)]);
            assert!(are_unchanged(&found, model));
        }
        let found = dependencies_of(&gltf, 1 << 20).unwrap();
        settled(&folder.path().join("c.bin"), b"1234");
        assert!(!are_unchanged(&found, &gltf));
    }

    #[test]
    fn other_formats_refer_to_nothing_that_counts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.obj");
        for text in ["", "mtllib x.mtl\nv 0 0 0\n", "glTF"] {
            settled(&path, text.as_bytes());
            assert_eq!(dependencies_of(&path, 1 << 20), Some(Vec::new()), "{text}");
        }
        settled(&path, b"  {\"buffers\": 3}");
        assert_eq!(dependencies_of(&path, 1 << 20), None);
    }
}
