//! The first byte tells which format of voxels the rest is.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some((kind, rest)) = bytes.split_first() {
        fuzz::check(["a.vox", "a.binvox"][usize::from(kind % 2)], rest);
    }
});
