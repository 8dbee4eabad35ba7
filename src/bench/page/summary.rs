//! All scenes in one plot: how many times slower than rapier, and how many times more wrong, both as they come.

use std::fmt::Write as _;

use super::escaped;
use super::plot::Axis;
use crate::bench::engine::Engine;
use crate::bench::run::Sheet;

const WIDE: f64 = 1000.0;
const HIGH: f64 = 560.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 50.0;

struct Mark<'a> {
    name: &'a str,
    time: f64,
    error: f64,
}

fn marks(sheets: &[Sheet]) -> Vec<Mark<'_>> {
    let mark = |sheet: &'_ Sheet| {
        let (ours, theirs) = (sheet.default_of(Engine::Physique)?, sheet.rapier()?);
        let least = ours.least_error();
        let time = ours.over_rapier?.mean;
        // What fell out of all bounds is drawn at the edge.
        let of = |row: &crate::bench::run::Row| row.error().unwrap_or(1e6 * least).max(least);
        Some((time, of(ours) / of(theirs)))
    };
    sheets
        .iter()
        .filter_map(|sheet| mark(sheet).map(|(time, error)| Mark { name: &sheet.scene, time, error }))
        .collect()
}

pub(super) fn svg(sheets: &[Sheet]) -> String {
    let marks = marks(sheets);
    if marks.is_empty() {
        return String::new();
    }
    let x = Axis::over(marks.iter().map(|m| m.time).chain([0.3, 3.0]), LEFT, WIDE - RIGHT);
    let y = Axis::over(marks.iter().map(|m| m.error).chain([1e-3, 10.0]), HIGH - BOTTOM, TOP);
    let (one_x, one_y) = (x.at(1.0), y.at(1.0));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100%\" viewBox=\"0 0 {WIDE} {HIGH}\" font-family=\"system-ui, sans-serif\" \
         font-size=\"11\" fill=\"#59636e\"><rect width=\"{WIDE}\" height=\"{HIGH}\" fill=\"#fff\"/>\
         <rect x=\"{LEFT}\" y=\"{one_y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#dafbe1\"/>\
         <rect x=\"{one_x:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#ffebe9\"/>\
         <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#1a7f37\">faster and less wrong</text>\
         <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#cf222e\" text-anchor=\"end\">slower and more wrong</text>",
        one_x - LEFT,
        HIGH - BOTTOM - one_y,
        WIDE - RIGHT - one_x,
        one_y - TOP,
        LEFT + 8.0,
        HIGH - BOTTOM - 8.0,
        WIDE - RIGHT - 8.0,
        TOP + 16.0
    );
    for tick in x.ticks() {
        let at = x.at(tick);
        let _ = write!(
            svg,
            "<line x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{:.1}\" stroke=\"#d0d7de\" stroke-width=\".6\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            HIGH - BOTTOM,
            HIGH - BOTTOM + 16.0,
            super::short(tick)
        );
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        let _ = write!(
            svg,
            "<line x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{:.1}\" y2=\"{at:.1}\" stroke=\"#d0d7de\" stroke-width=\".6\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            WIDE - RIGHT,
            LEFT - 6.0,
            at + 4.0,
            super::short(tick)
        );
    }
    for mark in &marks {
        let (cx, cy) = (x.at(mark.time), y.at(mark.error));
        let _ = write!(
            svg,
            "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"4.5\" fill=\"#0969da\" fill-opacity=\".75\"><title>{0}</title></circle>\
             <text x=\"{1:.1}\" y=\"{2:.1}\" font-size=\"9\" fill=\"#1f2328\">{0}</text>",
            escaped(mark.name),
            cx + 6.0,
            cy + 3.0
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">time of a step over rapier's, both as they come</text>\
         <text x=\"{LEFT}\" y=\"{:.1}\" font-weight=\"600\">error over rapier's</text></svg>",
        0.5 * WIDE,
        HIGH - 12.0,
        TOP - 12.0
    );
    svg
}
