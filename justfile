# `just check` is what CI runs.

check:
    bash .ci/run

test:
    cargo test --release --workspace

demo:
    cargo run --release -- demo

fmt:
    cargo fmt --all

# The README's picture, from a recording of the demo.
picture:
    cargo run --release -- demo --out target/picture
    python3 scripts/screenshot.py target/picture/recording.rrd docs/demo.png --time last
