//! What happened, as lines of text.

use rerun::{RecordingStream, TextLog, TextLogLevel, TimeCell, TimePoint};
use sim::Event;

use crate::block::{Block, What};
use crate::error::ViewerError;

/// A line and how loud it is.
fn text(what: &What, names: &[String]) -> (String, &'static str) {
    let name = |index: u32| names.get(index as usize).map_or("?", String::as_str);
    match what {
        What::Event(Event::FellAsleep { entity }) => {
            (format!("{} fell asleep", name(*entity)), TextLogLevel::DEBUG)
        }
        What::Event(Event::WokeUp { entity }) => (format!("{} woke up", name(*entity)), TextLogLevel::DEBUG),
        What::Event(Event::Impact { a, b, speed_m_s }) => {
            (format!("{} hit {} at {speed_m_s:.3} m/s", name(*a), name(*b)), TextLogLevel::INFO)
        }
        What::Event(Event::Overlap { a, b, depth_m }) => {
            (format!("{} and {} overlap by {:.1} mm", name(*a), name(*b), depth_m * 1e3), TextLogLevel::WARN)
        }
        What::Event(Event::Quarantined { entity }) => {
            (format!("{} left the numbers and was stopped", name(*entity)), TextLogLevel::ERROR)
        }
        What::Event(Event::Acted { index }) => (format!("action {index} took effect"), TextLogLevel::WARN),
        What::More(count) => (format!("and {count} more in this step"), TextLogLevel::TRACE),
    }
}

/// Logs the events of a block by rows: they are few.
pub(crate) fn block(stream: &RecordingStream, block: &Block, names: &[String]) -> Result<(), ViewerError> {
    for event in &block.events {
        let (line, level) = text(&event.what, names);
        stream.set_timepoint(
            TimePoint::default()
                .with(rerun::Timeline::new_sequence("step"), i64::try_from(event.step).unwrap_or(i64::MAX))
                .with(
                    rerun::Timeline::new_duration("sim_time"),
                    TimeCell::from_duration_nanos(nanoseconds(event.time_s)),
                ),
        );
        stream.log("events", &TextLog::new(line).with_level(level)).map_err(ViewerError::encode)?;
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "a run of 292 years would not fit")]
fn nanoseconds(time_s: f64) -> i64 {
    (time_s * 1e9).round() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_name_their_bodies() {
        let names = ["cup".to_owned(), "floor".to_owned()];
        let hit = What::Event(Event::Impact { a: 0, b: 1, speed_m_s: 1.25 });
        assert_eq!(text(&hit, &names).0, "cup hit floor at 1.250 m/s");
        assert_eq!(text(&What::Event(Event::WokeUp { entity: 7 }), &names).0, "? woke up");
    }
}
