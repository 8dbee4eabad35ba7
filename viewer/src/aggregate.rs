//! Numbers of a whole gallery over time: how many models still move, how deep the worst sinks.

use std::collections::BTreeMap;

use rerun::{RecordingStream, Scalars, TimeColumn};

use crate::block::Block;
use crate::error::ViewerError;
use crate::palette;
use crate::plot::{Line, style};

/// Bins a second.
const BINS_PER_S: f64 = 30.0;

const MOVING: Line = Line { path: "metrics/moving/models", name: "moving models", color: palette::KINETIC };
const WORST: Line =
    Line { path: "metrics/penetration/worst", name: "worst, mm", color: palette::PENETRATION };
const MEDIAN: Line = Line { path: "metrics/penetration/median", name: "median, mm", color: palette::COUNT };

/// One model's series: moving or not, and penetration in metres, a bin each; the last holds on.
#[derive(Default)]
struct Series(BTreeMap<u64, (bool, f64)>);

/// All models' series, joined at the end since the models run one after another on one timeline.
#[derive(Default)]
pub(crate) struct Aggregate(BTreeMap<usize, Series>);

impl Aggregate {
    pub(crate) fn begin(stream: &RecordingStream) -> Result<Self, ViewerError> {
        [MOVING, WORST, MEDIAN].iter().try_for_each(|line| style(stream, line))?;
        Ok(Self::default())
    }

    pub(crate) fn block(&mut self, track: usize, block: &Block) {
        let series = self.0.entry(track).or_default();
        for row in &block.rows {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "time is not negative"
            )]
            let bin = (row.time_s * BINS_PER_S).round().max(0.0) as u64;
            let value = series.0.entry(bin).or_insert((false, 0.0));
            value.0 |= row.metrics.awake > 0;
            value.1 = value.1.max(row.metrics.max_penetration_m);
        }
    }

    /// Sends the series.
    pub(crate) fn end(&self, stream: &RecordingStream) -> Result<(), ViewerError> {
        let bins = self.0.values().filter_map(|series| series.0.keys().next_back()).max().copied();
        let Some(bins) = bins else { return Ok(()) };
        let mut last = vec![(false, 0.0); self.0.len()];
        let (mut seconds, mut moving, mut worst, mut median) = (vec![], vec![], vec![], vec![]);
        for bin in 0..=bins {
            for (value, series) in last.iter_mut().zip(self.0.values()) {
                if let Some(now) = series.0.get(&bin) {
                    *value = *now;
                }
            }
            let mut depths: Vec<f64> = last.iter().map(|(_, depth)| 1e3 * depth).collect();
            depths.sort_by(f64::total_cmp);
            #[expect(clippy::cast_precision_loss, reason = "a gallery's bins and models are few")]
            {
                seconds.push(bin as f64 / BINS_PER_S);
                moving.push(last.iter().filter(|(awake, _)| *awake).count() as f64);
            }
            worst.push(depths.last().copied().unwrap_or(0.0));
            median.push(depths[depths.len() / 2]);
        }
        for (line, values) in [(MOVING, moving), (WORST, worst), (MEDIAN, median)] {
            let columns = Scalars::new(values).columns_of_unit_batches().map_err(ViewerError::encode)?;
            let times = [TimeColumn::new_duration_secs("sim_time", seconds.clone())];
            stream.send_columns(line.path, times, columns).map_err(ViewerError::encode)?;
        }
        Ok(())
    }
}
