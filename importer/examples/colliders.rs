//! Prints the collider ladder of every model under a folder, with errors and milliseconds.
//!
//! `cargo run --release -p importer --example colliders -- MODELS [--pieces DIR] [--tolerance SHARE] [--all] [--parry]`
//!
//! `--pieces` writes the chosen convex pieces of each model as lists of points in file units: what a ruler
//! outside of this project reads. `--all` prints every rung, not only the chosen one. `--parry` prints parry's
//! V-HACD beside it, at its defaults.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::fmt::Write as _;
use std::path::PathBuf;

use importer::collider::{Candidate, Shape, cheapest, ladder, parry_decomposition, surface};
use importer::{Options, discover, read};

fn main() {
    let mut options = Options::default();
    let mut roots: Vec<PathBuf> = Vec::new();
    let mut pieces_dir: Option<PathBuf> = None;
    let mut all = false;
    let mut parry = false;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--pieces" => pieces_dir = arguments.next().map(PathBuf::from),
            "--tolerance" => {
                if let Some(value) = arguments.next().and_then(|text| text.parse().ok()) {
                    options.collider_tolerance = value;
                }
            }
            "--all" => all = true,
            "--parry" => parry = true,
            root => roots.push(PathBuf::from(root)),
        }
    }
    let mut times: Vec<f64> = Vec::new();
    let mut met = 0usize;
    println!(
        "model\ttriangles\trung\tpieces\tvertices\tmax%\tp95%\tgrowth%\tgrowth95%\toutside%\tvolume\tcost\tms\tfallback"
    );
    for root in roots {
        let Ok(paths) = discover(&root) else { continue };
        for path in paths {
            let name = path.strip_prefix(&root).ok().filter(|p| !p.as_os_str().is_empty()).unwrap_or(&path);
            let source = match read(&path, &options) {
                Ok(source) => source,
                Err(error) => {
                    println!("{}\tnot read: {error}", name.display());
                    continue;
                }
            };
            let welded = importer::weld(&source.merged());
            let mesh = &welded.mesh;
            let measures = importer::measure(&welded);
            let start = cpu_ms();
            let rungs = ladder(mesh, &measures, &options);
            let ms = cpu_ms() - start;
            times.push(ms);
            let Some(chosen) = cheapest(&rungs, options.collider_tolerance) else {
                println!("{}\t{}\tnone", name.display(), mesh.triangles.len());
                continue;
            };
            met += usize::from(chosen.error.excess(options.collider_tolerance) <= 1.0);
            for rung in rungs.iter().filter(|rung| all || std::ptr::eq(*rung, chosen)) {
                println!("{}\t{}\t{}", name.display(), mesh.triangles.len(), line(rung, ms));
            }
            if parry {
                let start = cpu_ms();
                let made = parry_decomposition(mesh, &measures, &options, 64, 0.01);
                let ms = cpu_ms() - start;
                let text = made.map_or_else(|| "none".to_owned(), |made| line(&made, ms));
                println!("{}\t{}\tparry {text}", name.display(), mesh.triangles.len());
            }
            if let Some(dir) = &pieces_dir {
                write_pieces(dir, name, chosen);
            }
        }
    }
    times.sort_by(f64::total_cmp);
    let at =
        |share: f64| times.get(((times.len() as f64 * share) as usize).min(times.len().saturating_sub(1)));
    println!(
        "{} models, {met} within tolerance, ms: median {:.0}, p95 {:.0}, max {:.0}, sum {:.0}",
        times.len(),
        at(0.5).copied().unwrap_or(0.0),
        at(0.95).copied().unwrap_or(0.0),
        at(1.0).copied().unwrap_or(0.0),
        times.iter().sum::<f64>(),
    );
}

fn line(rung: &Candidate, ms: f64) -> String {
    let e = &rung.error;
    format!(
        "{:?}\t{}\t{}\t{:.2}\t{:.2}\t{:.2}\t{:.2}\t{:.2}\t{}\t{:.0}\t{ms:.0}\t{}",
        rung.rung,
        rung.shapes.len(),
        rung.vertices,
        e.surface_max * 100.0,
        e.surface_p95 * 100.0,
        e.growth_max * 100.0,
        e.growth_p95 * 100.0,
        e.outside_share * 100.0,
        e.volume_ratio.map_or_else(|| "-".to_owned(), |v| format!("{v:.2}")),
        rung.cost,
        rung.fallback.as_deref().unwrap_or(""),
    )
}

/// The chosen shapes as JSON lists of points.
fn write_pieces(dir: &std::path::Path, name: &std::path::Path, chosen: &Candidate) {
    let mut json = String::from("[");
    for (i, shape) in chosen.shapes.iter().enumerate() {
        let points = match shape {
            Shape::Hull { points } => points.clone(),
            round => surface(round).0,
        };
        let _ = write!(json, "{}{points:?}", if i == 0 { "" } else { ",\n" });
    }
    json.push(']');
    let file = dir.join(name.to_string_lossy().replace('/', "__") + ".json");
    if let Err(error) = std::fs::create_dir_all(dir).and_then(|()| std::fs::write(&file, json)) {
        eprintln!("{}: {error}", file.display());
    }
}

/// CPU time of this thread, ms.
fn cpu_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse::<f64>().unwrap() / 1e6
}
