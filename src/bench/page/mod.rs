//! The report as files: one HTML page that needs nothing else, its plots, CSV and JSON.

mod plot;
mod summary;
mod table;

use std::fs;
use std::io;
use std::path::Path;

use serde::Serialize;

use super::machine::Machine;
use super::overview::Overview;
use super::run::Sheet;
use crate::validate::Parameter;

/// Everything that was measured, and where.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub machine: Machine,
    /// Settings side by side.
    pub parameters: Vec<Parameter>,
    pub sheets: Vec<Sheet>,
    pub seconds: f64,
}

/// Writes `report.html`, `report.json`, `report.csv` and `plots/*.svg` into `folder`.
///
/// # Errors
/// The folder cannot be written.
pub fn write_report(folder: &Path, report: &Report) -> io::Result<()> {
    let plots = folder.join("plots");
    fs::create_dir_all(&plots)?;
    fs::write(plots.join("summary.svg"), summary::svg(&report.sheets))?;
    for sheet in &report.sheets {
        if let Some(svg) = plot::svg(sheet) {
            fs::write(plots.join(format!("{}.svg", sheet.scene)), svg)?;
        }
    }
    fs::write(folder.join("report.json"), serde_json::to_string_pretty(report)?)?;
    fs::write(folder.join("report.csv"), table::csv(&report.sheets))?;
    fs::write(folder.join("report.html"), html(report))
}

const STYLE: &str = "
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 1400px; padding: 0 1rem; color: #1f2328; background: #fff; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-bottom: 1px solid #d0d7de; }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .2rem; } p { margin: .3rem 0 .6rem; } .quiet { color: #59636e; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; margin: .5rem 0 1rem; }
th, td { padding: 2px 9px; text-align: right; border-bottom: 1px solid #eaeef2; white-space: nowrap; }
th { color: #59636e; font-weight: 600; } td:first-child, th:first-child { text-align: left; }
td.about { white-space: normal; min-width: 16rem; text-align: left; } tr.default td:first-child { font-weight: 600; }
.pass { color: #1a7f37; } .fail { color: #cf222e; } .scene { display: flex; gap: 1.5rem; flex-wrap: wrap; align-items: flex-start; }
.wide { overflow-x: auto; } a { color: #0969da; text-decoration: none; }
";

fn html(report: &Report) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Speed against error</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head><body>\n\
         <h1>Speed against error</h1>\n<p class=\"quiet\">Physique and rapier on {} scenes, by one ruler. {}</p>\n",
        report.sheets.len(),
        Overview::of(&report.sheets)
    );
    page += &summary::svg(&report.sheets);
    page += "<p>Each scene is run once to be judged, from poses and velocities alone and in double precision, and \
             again to be timed: CPU time of the process, round by round, the engines in turn. Both engines are awake \
             and as they come, unless a row says otherwise. <b>x rapier</b> is the time over that of rapier's default, in \
             whichever of its builds is faster on the scene; behind it the 95 % upper bound over the rounds. <b>At equal error</b> \
             it is the time over that of rapier's fastest setup that errs no more than Physique as it comes, among those of \
             the scene's plot. An error of 0 is right; what passes is <span class=\"pass\">green</span>.</p>\n";
    page += &table::overview(&report.sheets);
    let mut group = "";
    for sheet in &report.sheets {
        if sheet.group != group {
            group = sheet.group;
            page += &format!("<h2>{}</h2>\n", escaped(group));
        }
        page += &format!(
            "<h3 id=\"{0}\">{0}</h3>\n<p class=\"quiet\">{1}; {2} moving, {3:.3} s in steps of {4:.3} ms</p>\n<div class=\"scene\">",
            escaped(&sheet.scene),
            escaped(&sheet.about),
            sheet.bodies,
            sheet.duration_s,
            sheet.dt_s * 1e3
        );
        page += &plot::svg(sheet).unwrap_or_default();
        page += &table::figures(sheet);
        page += "</div>\n";
        page += &table::rows(sheet);
    }
    page += "<h2>Machine and settings</h2>\n";
    page += &table::machine(&report.machine, report.seconds);
    page += &table::parameters(&report.parameters);
    page + "</body></html>\n"
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A number in few characters: `0.00123`, `1.2e-7`, `0`.
fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !value.is_finite() {
        "∞".to_owned()
    } else if (1e-3..1e4).contains(&size) {
        let digits = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_text_cannot_end_a_tag() {
        let cases = [
            (0.0, "0"),
            (12.345, "12.3"),
            (0.00123, "0.00123"),
            (1.2e-7, "1.2e-7"),
            (f64::INFINITY, "∞"),
            (1234.5, "1234"),
        ];
        for (value, expected) in cases {
            assert_eq!(short(value), expected);
        }
        assert_eq!(escaped("<a \"b\" & c>"), "&lt;a &quot;b&quot; &amp; c&gt;");
    }
}
