//! The engine around the targets: `TARGET=ply reader CORPUS…`, see ./run.
#![no_main]

use std::sync::LazyLock;

static TARGET: LazyLock<String> = LazyLock::new(|| {
    let target = std::env::var("TARGET").unwrap_or_default();
    assert!(fuzz::TARGETS.contains(&target.as_str()), "TARGET is one of {:?}", fuzz::TARGETS);
    target
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::run(&TARGET, bytes));
