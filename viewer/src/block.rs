//! Frames on their way from the stepping thread to the worker: owned, flat, reused.

use sim::{ContactPoint, Event, Frame, Metrics, SleepState};

use crate::place::Drawn;

/// Contacts a frame above which some frames' are left out, so that they take no more room than so many would: they
/// are most of the data.
const MAX_CONTACTS: usize = 400;
/// At most this many events of a step are kept; the rest is counted.
const MAX_EVENTS_A_STEP: usize = 64;

/// One kept frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) step: u64,
    pub(crate) time_s: f64,
    pub(crate) metrics: Metrics,
    /// End of this row's contacts in [`Block::contacts`].
    pub(crate) contacts_end: usize,
    /// Whether they were kept; if not, the last that were still stand.
    pub(crate) contacts_kept: bool,
}

/// A contact as drawn: where, and the impulse along the normal, N s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    pub(crate) position: [f32; 3],
    pub(crate) impulse: [f32; 3],
}

/// What happened, when.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Happening {
    pub(crate) step: u64,
    pub(crate) time_s: f64,
    pub(crate) what: What,
}

/// An event, or how many of a step were left out.
#[derive(Clone, Copy, Debug)]
pub(crate) enum What {
    Event(Event),
    More(usize),
}

/// Some frames in a row. Row `i` holds bodies `i * bodies..(i + 1) * bodies` of `poses` and `sleep`.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(crate) bodies: usize,
    pub(crate) rows: Vec<Row>,
    pub(crate) poses: Vec<Drawn>,
    pub(crate) sleep: Vec<SleepState>,
    pub(crate) contacts: Vec<Touch>,
    pub(crate) events: Vec<Happening>,
    /// Rows, of earlier blocks too, since the last whose contacts were kept.
    pub(crate) rows_without_contacts: usize,
}

impl Block {
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
        self.poses.clear();
        self.sleep.clear();
        self.contacts.clear();
        self.events.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty() && self.events.is_empty()
    }

    /// Bytes that wait for the worker.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.rows.as_slice())
            + size_of_val(self.poses.as_slice())
            + size_of_val(self.sleep.as_slice())
            + size_of_val(self.contacts.as_slice())
            + size_of_val(self.events.as_slice())
    }

    /// Copies what of a frame is drawn. A frame whose bodies are not `self.bodies` adds no row.
    pub(crate) fn push(&mut self, frame: &Frame<'_>) {
        let Some(rigid) = frame.rigid.filter(|rigid| rigid.poses.len() == self.bodies) else { return };
        self.poses.extend(rigid.poses.iter().map(Drawn::of));
        self.sleep.extend_from_slice(rigid.sleep);
        self.sleep.resize(self.poses.len(), SleepState::Active);
        let points = frame.contacts.map_or(&[][..], |contacts| contacts.points);
        self.rows_without_contacts += 1;
        let contacts_kept = self.rows_without_contacts >= points.len().div_ceil(MAX_CONTACTS);
        if contacts_kept {
            self.rows_without_contacts = 0;
            self.contacts.extend(points.iter().map(touch));
        }
        self.rows.push(Row {
            step: frame.step,
            time_s: frame.time_s,
            metrics: frame.metrics,
            contacts_end: self.contacts.len(),
            contacts_kept,
        });
    }

    /// Copies the events of a frame, also of one that is not drawn.
    pub(crate) fn push_events(&mut self, frame: &Frame<'_>) {
        let at = |what| Happening { step: frame.step, time_s: frame.time_s, what };
        self.events.extend(frame.events.iter().take(MAX_EVENTS_A_STEP).map(|event| at(What::Event(*event))));
        if frame.events.len() > MAX_EVENTS_A_STEP {
            self.events.push(at(What::More(frame.events.len() - MAX_EVENTS_A_STEP)));
        }
    }

    /// Contacts of row `row`.
    pub(crate) fn contacts_of(&self, row: usize) -> &[Touch] {
        let start = if row == 0 { 0 } else { self.rows[row - 1].contacts_end };
        &self.contacts[start..self.rows[row].contacts_end]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "drawing needs no more than single precision")]
fn touch(point: &ContactPoint) -> Touch {
    Touch {
        position: point.position.map(|x| x as f32),
        impulse: point.normal.map(|x| (x * point.normal_impulse_n_s) as f32),
    }
}
