//! The bytes behind a glTF file's buffers: the GLB chunk, files beside it, data URIs.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use gltf::json::Root;

use crate::{ImportError, Options};

use super::file_bytes;

/// A buffer's bytes, or why there are none: that matters only once geometry asks for them.
pub(super) enum Buffer<'a> {
    Inside(Cow<'a, [u8]>),
    /// Bytes of [`Buffers::files`].
    File(usize),
    Absent(String),
}

pub(super) struct Buffers<'a> {
    list: Vec<Buffer<'a>>,
    pub files: Vec<Vec<u8>>,
}

impl<'a> Buffers<'a> {
    /// # Errors
    /// Too large where the files come to more than [`Options::max_file_bytes`].
    pub fn load(
        root: &Root,
        chunk: Option<&'a [u8]>,
        folder: &Path,
        options: &Options,
    ) -> Result<Self, ImportError> {
        let mut buffers = Self { list: Vec::with_capacity(root.buffers.len()), files: Vec::new() };
        let mut left = options.max_file_bytes;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let place = format!("buffers[{index}].uri");
            let loaded = match (&buffer.uri, chunk) {
                (Some(uri), _) if is_data(uri) => match data_uri(uri) {
                    Ok(bytes) => Buffer::Inside(Cow::Owned(bytes)),
                    Err(reason) => Buffer::Absent(reason),
                },
                (Some(uri), _) => match beside(uri, folder) {
                    Ok(paths) => match first_readable(&paths, left) {
                        Ok(bytes) => {
                            left -= (bytes.len() as u64).min(left);
                            buffers.files.push(bytes);
                            Buffer::File(buffers.files.len() - 1)
                        }
                        Err(ImportError::TooLarge { reason, .. }) => {
                            return Err(ImportError::too_large(place, reason));
                        }
                        Err(error) => Buffer::Absent(format!("{uri:?} {}", error.reason())),
                    },
                    Err(reason) => Buffer::Absent(reason),
                },
                (None, Some(chunk)) if index == 0 => Buffer::Inside(Cow::Borrowed(chunk)),
                (None, _) => Buffer::Absent("the buffer has neither uri nor bytes".to_owned()),
            };
            buffers.list.push(loaded);
        }
        Ok(buffers)
    }

    /// # Errors
    /// Malformed for a buffer that is not listed, missing for one whose bytes are not there.
    pub fn bytes(&self, index: usize, place: &str) -> Result<&[u8], ImportError> {
        match self.list.get(index) {
            Some(Buffer::Inside(bytes)) => Ok(bytes),
            Some(Buffer::File(file)) => Ok(&self.files[*file]),
            Some(Buffer::Absent(reason)) => {
                Err(ImportError::missing(format!("buffers[{index}].uri"), reason.clone()))
            }
            None => Err(ImportError::malformed(
                place,
                format!("refers to buffers[{index}], there are {}", self.list.len()),
            )),
        }
    }
}

fn first_readable(paths: &[PathBuf], limit: u64) -> Result<Vec<u8>, ImportError> {
    let mut outcome = Err(ImportError::missing("", "names no file"));
    for path in paths {
        outcome = file_bytes(path, limit);
        if !matches!(outcome, Err(ImportError::Io { .. })) {
            break;
        }
    }
    outcome
}

/// Where a relative reference may lie: percent-decoded as the specification says, or as it stands.
fn beside(uri: &str, folder: &Path) -> Result<Vec<PathBuf>, String> {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    if scheme.is_some_and(|scheme| scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))) {
        return Err(format!("{uri:?} is no relative path, and nothing is fetched"));
    }
    let decoded = percent_decoded(uri);
    let mut paths = Vec::new();
    for name in [decoded.as_str(), uri] {
        let path = Path::new(name);
        if name.is_empty()
            || !path
                .components()
                .all(|part| matches!(part, Component::Normal(_) | Component::CurDir | Component::ParentDir))
        {
            return Err(format!("{uri:?} is no relative path"));
        }
        paths.push(folder.join(path));
    }
    paths.dedup();
    Ok(paths)
}

fn percent_decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let escape = (byte == b'%').then(|| text.get(at + 1..at + 3)).flatten();
        if let Some(value) = escape.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            decoded.push(value);
            at += 3;
        } else {
            decoded.push(byte);
            at += 1;
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}

fn is_data(uri: &str) -> bool {
    uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let (head, data) = uri.split_once(',').ok_or("a data URI without a comma")?;
    if !head.to_ascii_lowercase().ends_with(";base64") {
        return Ok(percent_decoded(data).into_bytes());
    }
    base64(data.as_bytes())
}

/// RFC 4648, with or without padding; whitespace is passed over.
fn base64(text: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0_u32, 0);
    for &letter in text {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' => break,
            _ if letter.is_ascii_whitespace() => continue,
            _ => return Err(format!("base64 data holds the byte \"{}\"", letter.escape_ascii())),
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held & 0xFF) as u8);
        }
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_rfc() {
        for (text, plain) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9vYmE", "fooba"), ("Zm9v\nYmFy", "foobar")]
        {
            assert_eq!(base64(text.as_bytes()).unwrap(), plain.as_bytes(), "{text}");
        }
        assert!(base64(b"Zm9v*").is_err());
    }

    #[test]
    fn percent_escapes_and_stray_percents() {
        assert_eq!(percent_decoded("Box%20With%2520.bin"), "Box With%20.bin");
        assert_eq!(percent_decoded("50%,%zz,é%"), "50%,%zz,é%");
    }

    #[test]
    fn nothing_leaves_the_file_system_or_starts_at_its_root() {
        for uri in ["http://x/y.bin", "file:///etc/passwd", "/etc/passwd", "%2Fetc%2Fpasswd", "C:\\x.bin", ""]
        {
            assert!(beside(uri, Path::new("/models")).is_err(), "{uri}");
        }
        assert_eq!(beside("a.bin", Path::new("m")).unwrap(), [Path::new("m/a.bin")]);
    }
}
