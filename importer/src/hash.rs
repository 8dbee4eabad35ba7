//! The content key.

use crate::AssetKey;

/// blake3 of the file's bytes and, in order of reference, of every buffer file it refers to.
pub(crate) fn key_of<'a>(file: &[u8], referred: impl IntoIterator<Item = &'a [u8]>) -> AssetKey {
    let mut hasher = blake3::Hasher::new();
    hasher.update(file);
    for bytes in referred {
        // The length keeps two splits of the same bytes apart.
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    }
    AssetKey(*hasher.finalize().as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_of_a_lone_file_is_its_blake3() {
        assert_eq!(key_of(b"abc", []).0, *blake3::hash(b"abc").as_bytes());
    }

    #[test]
    fn referred_bytes_and_their_split_change_the_key() {
        let alone = key_of(b"abc", []);
        let one = key_of(b"abc", [b"xy".as_slice()]);
        let two = key_of(b"abc", [b"x".as_slice(), b"y"]);
        assert!(alone != one && one != two && alone != two);
    }
}
