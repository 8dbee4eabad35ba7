//! The few figures that everything comes down to.

use std::io::{self, Write};

use super::{Row, Tool};

/// Medians and tails a tool, and the piles side by side.
///
/// # Errors
/// The writer fails.
pub fn write_summary(out: &mut dyn Write, rows: &[Row], tolerance: f64) -> io::Result<()> {
    writeln!(
        out,
        "medians; errors in % of the diagonal, 95 % / farthest; tolerance {} %\n{:10}{:>8}{:>8}{:>9}{:>10}{:>15}{:>15}{:>9}{:>8}{:>9}{:>9}",
        tolerance * 100.0,
        "tool",
        "models",
        "within",
        "pieces",
        "vertices",
        "mesh",
        "grown",
        "outside",
        "volume",
        "seconds",
        "p95 s"
    )?;
    for tool in [Tool::Physique, Tool::Parry] {
        let of_tool: Vec<&Row> = rows.iter().filter(|row| row.tool == tool).collect();
        let at =
            |share: f64, value: &dyn Fn(&Row) -> f64| quantile(of_tool.iter().map(|row| value(row)), share);
        let pct = |value: &dyn Fn(&Row) -> f64| at(0.5, value) * 100.0;
        let ratios = of_tool.iter().filter_map(|row| row.error.volume_ratio);
        writeln!(
            out,
            "{:10}{:>8}{:>8}{:>9}{:>10}{:>15}{:>15}{:>9.2}{:>8.2}{:>9.2}{:>9.2}",
            format!("{tool:?}").to_lowercase(),
            of_tool.len(),
            of_tool.iter().filter(|row| row.excess <= 1.0).count(),
            at(0.5, &|row| row.pieces as f64),
            at(0.5, &|row| row.vertices as f64),
            format!("{:.2} / {:.2}", pct(&|row| row.error.surface_p95), pct(&|row| row.error.surface_max)),
            format!("{:.2} / {:.2}", pct(&|row| row.error.growth_p95), pct(&|row| row.error.growth_max)),
            pct(&|row| row.error.outside_share),
            quantile(ratios, 0.5),
            at(0.5, &|row| row.seconds),
            at(0.95, &|row| row.seconds),
        )?;
    }
    let mut shapes: Vec<(&str, usize)> = Vec::new();
    for row in rows.iter().filter(|row| row.tool == Tool::Physique) {
        match shapes.iter_mut().find(|(shape, _)| *shape == row.shape) {
            Some((_, count)) => *count += 1,
            None => shapes.push((row.shape, 1)),
        }
    }
    shapes.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    let chosen: Vec<String> = shapes.iter().map(|(shape, count)| format!("{shape} {count}")).collect();
    writeln!(out, "chosen    {}", chosen.join(", "))?;
    piles(out, rows)
}

fn piles(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    let ours = rows.iter().filter(|row| row.tool == Tool::Physique && row.pile_ms.is_some());
    for (i, row) in ours.enumerate() {
        let Some(other) = rows.iter().find(|other| other.tool == Tool::Parry && other.model == row.model)
        else {
            continue;
        };
        let (Some(ms), Some(other_ms)) = (row.pile_ms, other.pile_ms) else { continue };
        if i == 0 {
            writeln!(
                out,
                "\npiles of twenty, ms a step, and the larger error both ways, 95 % / farthest\n{:40}{:>10}{:>16}{:>10}{:>16}{:>8}",
                "model", "ours", "", "parry", "", "ratio"
            )?;
        }
        let error = |row: &Row| {
            let e = &row.error;
            format!(
                "{:.2} / {:.2}",
                e.surface_p95.max(e.growth_p95) * 100.0,
                e.surface_max.max(e.growth_max) * 100.0
            )
        };
        writeln!(
            out,
            "{:40}{ms:>10.2}{:>16}{other_ms:>10.2}{:>16}{:>8.1}",
            row.model,
            error(row),
            error(other),
            other_ms / ms
        )?;
    }
    Ok(())
}

fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted
        .get(((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1)))
        .copied()
        .unwrap_or(0.0)
}
