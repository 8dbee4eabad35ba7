//! ms a step against error, for one scene.

use std::fmt::Write as _;

use super::{escaped, short};
use crate::bench::engine::Engine;
use crate::bench::run::{Row, Sheet};

const WIDE: f64 = 520.0;
const HIGH: f64 = 320.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;

/// Errors below this are drawn on the lower edge: they are rounding.
const LEAST: f64 = 1e-12;

pub(super) const fn color(engine: Engine) -> &'static str {
    match engine {
        Engine::Physique => "#0969da",
        Engine::Rapier => "#bc4c00",
        Engine::RapierSimd8 => "#8250df",
    }
}

/// A logarithmic axis over whole decades, or halves of one where there is little.
pub(super) struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    pub(super) fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) =
            values.map(f64::log10).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let margin = (0.06 * (high - low)).max(0.1);
        Self { low: low - margin, high: high + margin, from, to }
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        let share = (value.log10() - self.low) / (self.high - self.low);
        self.from + share.clamp(0.0, 1.0) * (self.to - self.from)
    }

    /// Powers of ten, with 2 and 5 between where there are few.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let decades = self.high - self.low;
        let steps: &[f64] = if decades < 1.2 {
            &[1.0, 2.0, 3.0, 5.0, 7.0]
        } else if decades < 3.0 {
            &[1.0, 3.0]
        } else {
            &[1.0]
        };
        let every = (decades / 8.0).ceil().max(1.0) as i32;
        let (low, high) = (self.low.floor() as i32, self.high.ceil() as i32);
        (low..=high)
            .filter(|decade| decade.rem_euclid(every) == 0)
            .flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)))
            .filter(|tick| (self.low..=self.high).contains(&tick.log10()))
            .collect()
    }
}

struct Point<'a> {
    row: &'a Row,
    ms: f64,
    error: f64,
}

/// `None` where no setup has both a time and an error.
pub(super) fn svg(sheet: &Sheet) -> Option<String> {
    let points: Vec<Point<'_>> = sheet
        .rows
        .iter()
        .filter_map(|row| {
            let ms = row.ms.map(|ms| ms.mean).filter(|ms| *ms > 0.0)?;
            Some(Point { row, ms, error: row.error()?.max(LEAST) })
        })
        .collect();
    let figure = sheet.rows.iter().find_map(|row| row.errors.as_ref()?.figures.first())?;
    if points.is_empty() {
        return None;
    }
    let x = Axis::over(points.iter().map(|p| p.ms), LEFT, WIDE - RIGHT);
    let limit = Some(figure.limit).filter(|limit| *limit > 0.0 && limit.is_finite());
    let y = Axis::over(points.iter().map(|p| p.error).chain(limit), HIGH - BOTTOM, TOP);
    let unit = if figure.unit.is_empty() { String::new() } else { format!(" ({})", figure.unit) };
    let mut svg = frame(&x, &y, "ms of CPU a step", &format!("{}{unit}", figure.figure));
    if let Some(limit) = limit {
        let at = y.at(limit);
        let _ = write!(
            svg,
            "<line x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{:.1}\" y2=\"{at:.1}\" stroke=\"#1a7f37\" stroke-dasharray=\"2 3\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#1a7f37\" text-anchor=\"end\">passes below</text>",
            WIDE - RIGHT,
            WIDE - RIGHT - 3.0,
            at + 12.0
        );
    }
    svg += &front(&points, &x, &y);
    for engine in [Engine::RapierSimd8, Engine::Rapier, Engine::Physique] {
        for stiff in [false, true] {
            svg += &curve(&points, engine, stiff, &x, &y);
        }
    }
    svg += &legend(&points);
    Some(svg + "</svg>\n")
}

/// The frame with its axes.
pub(super) fn frame(x: &Axis, y: &Axis, across: &str, up: &str) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDE}\" height=\"{HIGH}\" viewBox=\"0 0 {WIDE} {HIGH}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"#59636e\">\
         <rect width=\"{WIDE}\" height=\"{HIGH}\" fill=\"#fff\"/>"
    );
    for tick in x.ticks() {
        let at = x.at(tick);
        let _ = write!(
            svg,
            "<line x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{:.1}\" stroke=\"#eaeef2\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            HIGH - BOTTOM,
            HIGH - BOTTOM + 15.0,
            short(tick)
        );
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        let label = if tick <= 1.001 * LEAST { "≤ 1e-12".to_owned() } else { short(tick) };
        let _ = write!(
            svg,
            "<line x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{:.1}\" y2=\"{at:.1}\" stroke=\"#eaeef2\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            WIDE - RIGHT,
            LEFT - 6.0,
            at + 4.0
        );
    }
    let _ = write!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text><text x=\"{LEFT}\" y=\"{:.1}\" font-weight=\"600\">{}</text>",
        0.5 * (LEFT + WIDE - RIGHT),
        HIGH - 10.0,
        escaped(across),
        TOP - 18.0,
        escaped(up)
    );
    svg
}

/// What no other setup beats in both time and error.
fn front(points: &[Point<'_>], x: &Axis, y: &Axis) -> String {
    let mut best: Vec<&Point<'_>> = points
        .iter()
        .filter(|p| {
            !points.iter().any(|q| q.ms <= p.ms && q.error <= p.error && (q.ms < p.ms || q.error < p.error))
        })
        .collect();
    best.sort_by(|a, b| a.ms.total_cmp(&b.ms));
    let path: Vec<String> = best.iter().map(|p| format!("{:.1},{:.1}", x.at(p.ms), y.at(p.error))).collect();
    let mut svg = format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#1f2328\" stroke-opacity=\".25\" stroke-width=\"7\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
        path.join(" ")
    );
    if let [only] = best[..] {
        let _ = write!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"9\" fill=\"#1f2328\" fill-opacity=\".2\"/>",
            x.at(only.ms),
            y.at(only.error)
        );
    }
    svg
}

fn curve(points: &[Point<'_>], engine: Engine, stiff: bool, x: &Axis, y: &Axis) -> String {
    let mut own: Vec<&Point<'_>> = points
        .iter()
        .filter(|p| p.row.setup.engine == engine && (p.row.setup.stiffness != 1.0) == stiff)
        .collect();
    own.sort_by_key(|p| p.row.setup.substeps);
    let path: Vec<String> = own.iter().map(|p| format!("{:.1},{:.1}", x.at(p.ms), y.at(p.error))).collect();
    let color = color(engine);
    let dash = if stiff { " stroke-dasharray=\"5 3\"" } else { "" };
    let mut svg = format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-opacity=\".6\"{dash}/>",
        path.join(" ")
    );
    for point in own {
        let (cx, cy) = (x.at(point.ms), y.at(point.error));
        let title = escaped(&format!(
            "{} {}: {} ms, {}",
            engine.name(),
            point.row.label,
            short(point.ms),
            short(point.row.error().unwrap_or(0.0))
        ));
        let (r, fill) = if point.row.is_default { (6.0, color) } else { (4.0, "#fff") };
        let _ = write!(
            svg,
            "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"{r}\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.6\"><title>{title}</title></circle>\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"{color}\" font-size=\"9\">{}</text>",
            cx + 7.0,
            cy - 5.0,
            point.row.setup.substeps
        );
    }
    svg
}

fn legend(points: &[Point<'_>]) -> String {
    let mut svg = String::new();
    let mut at = WIDE - RIGHT;
    for engine in [Engine::RapierSimd8, Engine::Rapier, Engine::Physique] {
        if points.iter().any(|p| p.row.setup.engine == engine) {
            let _ = write!(
                svg,
                "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"{}\" font-weight=\"600\">{}</text>",
                TOP - 18.0,
                color(engine),
                engine.name()
            );
            at -= 7.5 * engine.name().len() as f64 + 10.0;
        }
    }
    svg
}
