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

# Speed against error on the whole gallery, and the README's plots of it.
report:
    cargo run --release -- report --build-simd8 --out target/report
    cp target/report/plots/summary.svg docs/report-summary.svg
    cp target/report/plots/stack-20.svg docs/report-stack-20.svg
    cp target/report/plots/seed-9.svg docs/report-seed-9.svg
