//! What has moved away from the lock file.

use std::path::Path;

use super::diff::cause;
use super::entry::Entry;
use super::lock::Lock;
use super::observation::Observation;
use super::place::Place;

/// Every drift from `locked` to `now`. `file`: the lock file.
#[must_use]
pub fn drift(file: &Path, locked: &Lock, now: &Lock) -> Vec<Observation> {
    let mut seen = Vec::new();
    if (&locked.tool, &locked.catalogue) != (&now.tool, &now.catalogue) {
        let message = format!(
            "written by {} with catalogue {}; this is {} with catalogue {}",
            locked.tool, locked.catalogue, now.tool, now.catalogue
        );
        seen.push(Observation::fact("LCK010", message).at(Some(Place { line: 2, ..Place::file(file) })));
    }
    for (model, entry) in &now.entries {
        match locked.entries.get(model) {
            None => seen.push(
                Observation::fact("LCK003", format!("is {} of {}", entry.category, entry.preset))
                    .of(model)
                    .at(Some(Place::file(file))),
            ),
            Some(before) => seen.extend(of_model(file, model, before, entry)),
        }
    }
    for (model, entry) in locked.entries.iter().filter(|(model, _)| !now.entries.contains_key(*model)) {
        let message = format!("was {} of {}", entry.category, entry.preset);
        seen.push(Observation::fact("LCK004", message).of(model).at(Some(place(file, entry))));
    }
    seen
}

fn place(file: &Path, entry: &Entry) -> Place {
    Place { line: entry.line, ..Place::file(file) }
}

/// The strongest change is told; what follows from it is not told again.
fn of_model(file: &Path, model: &str, before: &Entry, now: &Entry) -> Vec<Observation> {
    let at = |code: &str, message: String| {
        Observation::fact(code, message).of(model).at(Some(place(file, before))).because(&now.rule)
    };
    let mut seen = Vec::new();
    if before.input != now.input {
        seen.push(at("LCK005", format!("its bytes were {} and are {}", before.input, now.input)));
    }
    if before.category != now.category {
        seen.push(at(
            "LCK006",
            format!("was {} by {}, is {} by {}", before.category, before.rule, now.category, now.rule),
        ));
    } else if before.preset != now.preset {
        seen.push(at(
            "LCK007",
            format!("was of {} by {}, is of {} by {}", before.preset, before.rule, now.preset, now.rule),
        ));
    } else if before.attributes != now.attributes {
        let changes = changes(before, now);
        let told =
            if changes.is_empty() { "in digits beyond the sixth".to_owned() } else { changes.join(", ") };
        seen.push(at("LCK008", format!("{told}, by {}", cause(before, now))));
    } else if before.rule != now.rule {
        seen.push(at("LCK009", format!("was decided by {}, is by {}", before.rule, now.rule)));
    }
    seen
}

/// `density 700 to 2180 kg/m3`
fn changes(before: &Entry, now: &Entry) -> Vec<String> {
    let mut told = Vec::new();
    for held in &now.values {
        let (name, value) = (&held.name, &held.value);
        match before.held(name) {
            Some(earlier) if earlier.value == *value => {}
            Some(earlier) => {
                let (old, unit) = earlier.value.split_once(' ').unwrap_or((&earlier.value, ""));
                let same_unit = value.split_once(' ').map_or("", |(_, unit)| unit) == unit;
                told.push(format!("{name} {} to {value}", if same_unit { old } else { &earlier.value }));
            }
            None => told.push(format!("{name} is new: {value}")),
        }
    }
    let gone = before.values.iter().filter(|held| now.held(&held.name).is_none());
    told.extend(gone.map(|held| format!("{} is gone: it was {}", held.name, held.value)));
    told
}
