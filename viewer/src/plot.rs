//! Numbers of the whole scene over time.

use rerun::{RecordingStream, Scalars, SeriesLines};

use crate::block::{Block, Row};
use crate::body::times;
use crate::error::ViewerError;
use crate::palette;

/// A line of a plot: where it lives, its name and colour.
#[derive(Clone, Copy)]
pub(crate) struct Line {
    pub(crate) path: &'static str,
    pub(crate) name: &'static str,
    pub(crate) color: [u8; 4],
}

type Value = fn(&Row) -> f64;

/// What a scene's rows hold. Units are in the names, as the plots have no axis titles.
const LINES: [(Line, Value); 6] = [
    (Line { path: "metrics/energy/total", name: "total, J", color: palette::TOTAL }, |row| {
        row.metrics.kinetic_j + row.metrics.potential_j
    }),
    (Line { path: "metrics/energy/potential", name: "potential, J", color: palette::POTENTIAL }, |row| {
        row.metrics.potential_j
    }),
    (Line { path: "metrics/energy/kinetic", name: "kinetic, J", color: palette::KINETIC }, |row| {
        row.metrics.kinetic_j
    }),
    (Line { path: "metrics/penetration/deepest", name: "deepest, mm", color: palette::PENETRATION }, |row| {
        1e3 * row.metrics.max_penetration_m
    }),
    (Line { path: "metrics/counts/contacts", name: "contact points", color: palette::CONTACT }, |row| {
        f64::from(row.metrics.contacts)
    }),
    (Line { path: "metrics/counts/awake", name: "awake bodies", color: palette::COUNT }, |row| {
        f64::from(row.metrics.awake)
    }),
];

/// Logs how a line looks.
pub(crate) fn style(stream: &RecordingStream, line: &Line) -> Result<(), ViewerError> {
    let style = SeriesLines::new()
        .with_names([line.name])
        .with_colors([palette::color(line.color)])
        .with_widths([1.75]);
    stream.log_static(line.path, &style).map_err(ViewerError::encode)
}

pub(crate) fn begin(stream: &RecordingStream) -> Result<(), ViewerError> {
    LINES.iter().try_for_each(|(line, _)| style(stream, line))
}

pub(crate) fn block(stream: &RecordingStream, block: &Block) -> Result<(), ViewerError> {
    let rows: Vec<usize> = (0..block.rows.len()).collect();
    for (line, value) in &LINES {
        let columns = Scalars::new(block.rows.iter().map(value))
            .columns_of_unit_batches()
            .map_err(ViewerError::encode)?;
        stream.send_columns(line.path, times(block, &rows), columns).map_err(ViewerError::encode)?;
    }
    Ok(())
}
