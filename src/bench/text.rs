//! A scene's figures for a terminal.

use std::io::{self, Write};

use super::run::{Row, Sheet};

/// Writes one scene's table.
///
/// # Errors
/// `out` cannot be written.
pub fn write_sheet(out: &mut dyn Write, sheet: &Sheet) -> io::Result<()> {
    writeln!(
        out,
        "{}: {}; {} moving, {} s, dt {:.3} ms",
        sheet.scene,
        sheet.about,
        sheet.bodies,
        sheet.duration_s,
        sheet.dt_s * 1e3
    )?;
    writeln!(
        out,
        "  {:<34} {:>9} {:>9} {:>9} {:>16} {:>9} {:>9} {:>9} {:>9} {:>10}",
        "",
        "ms mean",
        "p99",
        "max",
        "x rapier (<95 %)",
        "depth mm",
        "end mm",
        "sink mm",
        "drift mm",
        "E rise J"
    )?;
    for row in &sheet.rows {
        write_row(out, row)?;
    }
    Ok(())
}

fn write_row(out: &mut dyn Write, row: &Row) -> io::Result<()> {
    let name = format!("{} {}{}", row.setup.engine.name(), row.label, if row.is_default { " *" } else { "" });
    if let Some(reason) = &row.refused {
        return writeln!(out, "  {name:<34} {reason}");
    }
    let ms = row.ms.unwrap_or_default();
    let over = row
        .over_rapier
        .map_or_else(String::new, |ratio| format!("{:.2} (<{:.2})", ratio.mean, ratio.upper_95));
    write!(out, "  {name:<34} {:>9.4} {:>9.4} {:>9.4} {over:>16}", ms.mean, ms.p99, ms.max)?;
    let Some(errors) = &row.errors else { return writeln!(out) };
    writeln!(
        out,
        " {:>9.3} {:>9.3} {:>9.2} {:>9.2} {:>10.3e}",
        errors.depth_max_m * 1e3,
        errors.depth_end_m * 1e3,
        errors.sink_m * 1e3,
        errors.drift_m * 1e3,
        errors.energy_rise_j
    )?;
    for figure in errors.figures.iter().filter(|_| row.is_default) {
        let verdict = if figure.passes { "pass" } else { "FAIL" };
        let limit =
            if figure.limit.is_finite() { format!("limit {:.0e}", figure.limit) } else { String::new() };
        writeln!(
            out,
            "      {verdict}  {:<30} {:>12.4e} {:<6} {limit}",
            figure.figure, figure.value, figure.unit
        )?;
    }
    Ok(())
}
