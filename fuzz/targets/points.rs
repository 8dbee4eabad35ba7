//! The first byte tells which format of points, or OFF, the rest is.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some((kind, rest)) = bytes.split_first() {
        fuzz::check(["a.xyz", "a.pcd", "a.off"][usize::from(kind % 3)], rest);
    }
});
