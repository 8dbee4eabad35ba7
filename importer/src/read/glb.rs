//! The GLB container: a header of 12 bytes, then chunks of length, kind and data.

use crate::ImportError;

use super::notes::Notes;

const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// # Errors
/// Malformed where a chunk is cut, unsupported for a container version other than 2.
pub(super) fn split<'a>(
    bytes: &'a [u8],
    notes: &mut Notes,
) -> Result<(&'a [u8], Option<&'a [u8]>), ImportError> {
    if bytes.get(..4) != Some(b"glTF") {
        let found = bytes.get(..4).unwrap_or(bytes).escape_ascii();
        let reason =
            format!("expected the bytes \"glTF\", found \"{found}\" in a file of {} bytes", bytes.len());
        return Err(ImportError::malformed("byte 0", reason));
    }
    let version = word(bytes, 4).ok_or_else(|| cut(4, "the version"))?;
    if version != 2 {
        return Err(ImportError::unsupported(
            "byte 4",
            format!("binary glTF of version {version}, expected 2"),
            "Convert it to glTF 2.0, with gltf-pipeline or Blender",
        ));
    }
    let length = word(bytes, 8).ok_or_else(|| cut(8, "the length"))?;
    if length as usize != bytes.len() {
        let message = format!("the header says {length} bytes, the file has {}", bytes.len());
        notes.add("length-mismatch", "byte 8", message);
    }
    let (mut json, mut binary) = (None, None);
    let mut at = 12;
    while at < bytes.len() && (json.is_none() || binary.is_none()) {
        let (Some(size), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
            if json.is_some() {
                notes.add("trailing-bytes", format!("byte {at}"), "bytes after the last chunk");
                break;
            }
            return Err(cut(at, "a chunk's length and kind"));
        };
        let data = bytes.get(at + 8..).and_then(|rest| rest.get(..size as usize)).ok_or_else(|| {
            let reason =
                format!("a chunk of {size} bytes is cut: {} follow", bytes.len().saturating_sub(at + 8));
            ImportError::malformed(format!("byte {at}"), reason)
        })?;
        match kind {
            JSON if json.is_none() => json = Some(data),
            BIN if binary.is_none() => binary = Some(data),
            _ if json.is_none() => {
                let reason = "expected a JSON chunk first, found another kind";
                return Err(ImportError::malformed(format!("byte {at}"), reason));
            }
            _ => {}
        }
        // Chunks are padded to four bytes; a size that is not is followed as it stands.
        at += 8 + size as usize;
    }
    let json = json.ok_or_else(|| cut(12, "a JSON chunk"))?;
    Ok((json, binary))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let field: [u8; 4] = bytes.get(at..at + 4)?.try_into().ok()?;
    Some(u32::from_le_bytes(field))
}

fn cut(at: usize, expected: &str) -> ImportError {
    ImportError::malformed(format!("byte {at}"), format!("expected {expected}, found the end of the file"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn container(chunks: &[(u32, &[u8])]) -> Vec<u8> {
        let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        for (kind, data) in chunks {
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(*data);
        }
        bytes
    }

    #[test]
    fn json_and_binary_come_apart() {
        let bytes = container(&[(JSON, b"{}  "), (BIN, b"1234")]);
        assert_eq!(split(&bytes, &mut Notes::default()).unwrap(), (&b"{}  "[..], Some(&b"1234"[..])));
    }

    #[test]
    fn every_cut_is_refused_or_read() {
        let bytes = container(&[(JSON, b"{}  "), (BIN, b"1234")]);
        for length in 0..24 {
            assert!(split(&bytes[..length], &mut Notes::default()).is_err(), "{length}");
        }
        let error = split(&bytes[..bytes.len() - 1], &mut Notes::default()).unwrap_err();
        assert_eq!(error.place(), "byte 24");
    }
}
