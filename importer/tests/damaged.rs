//! Every sample file cut short and with bits turned: a clean refusal or a right read, never a panic.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

mod support;

use std::fs;

use importer::{ImportError, Options, Source, read_bytes};
use rayon::prelude::*;

/// Larger files, and more damages of each, with `PHYSIQUE_ALL=1`.
const MOST_BYTES: usize = 150_000;

fn fault(outcome: &Result<Source, ImportError>) -> Option<String> {
    match outcome {
        Ok(source) => {
            let sound = source.parts.iter().all(|part| {
                let count = part.mesh.positions.len();
                !part.mesh.triangles.is_empty()
                    && part.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count)
                    && part.mesh.positions.as_flattened().iter().all(|value| value.is_finite())
            });
            (!sound).then(|| "read unsound".to_owned())
        }
        Err(error) if error.code() == "panic" => Some(error.to_string()),
        Err(error) if error.reason().is_empty() || error.way_out().is_empty() => Some(format!("{error:?}")),
        Err(_) => None,
    }
}

#[test]
fn every_sample_cut_or_bent_is_refused_or_read() {
    let Some(root) = support::models() else { return };
    let all = std::env::var_os("PHYSIQUE_ALL").is_some();
    let (each, most) = if all { (20, usize::MAX) } else { (3, MOST_BYTES) };
    let options = Options { max_file_bytes: 64 << 20, max_triangles: 2_000_000, ..Options::default() };
    let files: Vec<_> =
        support::table(&root.join("FACTS.csv")).iter().map(|row| root.join(&row["path"])).collect();
    let damaged: Vec<(u64, Vec<String>)> = files
        .par_iter()
        .enumerate()
        .map(|(index, path)| {
            let bytes = fs::read(path).unwrap_or_default();
            let mut faults = Vec::new();
            let mut count = 0;
            if bytes.is_empty() || bytes.len() > most {
                return (0, faults);
            }
            let mut state = 0x9E37_79B9_7F4A_7C15_u64 ^ ((index as u64 + 1) << 17);
            let mut chance = |below: usize| {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                (state % below as u64) as usize
            };
            for _ in 0..each {
                let cut = &bytes[..chance(bytes.len())];
                let mut bent = bytes.clone();
                // Half of the time in the head, where the structure is.
                for _ in 0..=chance(4) {
                    let reach = if chance(2) == 0 { bytes.len() } else { bytes.len().min(2_000) };
                    bent[chance(reach)] ^= 1 << chance(8);
                }
                for damaged in [cut, &bent] {
                    count += 1;
                    let found = fault(&read_bytes(path, damaged, &options));
                    faults.extend(found.map(|fault| format!("{}: {fault}", path.display())));
                }
            }
            (count, faults)
        })
        .collect();
    let count: u64 = damaged.iter().map(|(count, _)| count).sum();
    let faults: Vec<String> = damaged.into_iter().flat_map(|(_, faults)| faults).collect();
    println!("{count} damaged files, {} faults", faults.len());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
