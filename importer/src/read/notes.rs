//! Notes, held to a readable number.

use std::collections::BTreeMap;

use crate::asset::Note;

/// More notes of one code than this are counted only.
const PER_CODE: u64 = 8;

#[derive(Debug, Default)]
pub(super) struct Notes {
    list: Vec<Note>,
    counts: BTreeMap<&'static str, u64>,
}

impl Notes {
    pub fn add(&mut self, code: &'static str, place: impl Into<String>, message: impl Into<String>) {
        let count = self.counts.entry(code).or_default();
        *count += 1;
        if *count <= PER_CODE {
            self.list.push(Note { code: code.to_owned(), place: place.into(), message: message.into() });
        }
    }

    /// What the file was found to lack, for the refusal of a file without triangles.
    pub fn faults(&self, codes: &[&str]) -> Vec<String> {
        let told = |note: &Note| {
            if note.place.is_empty() {
                note.message.clone()
            } else {
                format!("{}: {}", note.place, note.message)
            }
        };
        self.list.iter().filter(|note| codes.contains(&note.code.as_str())).map(told).collect()
    }

    pub fn finish(mut self) -> Vec<Note> {
        for (code, count) in self.counts {
            if count > PER_CODE {
                self.list.push(Note {
                    code: code.to_owned(),
                    place: String::new(),
                    message: format!("and {} more of the same", count - PER_CODE),
                });
            }
        }
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_notes_of_one_code_are_counted() {
        let mut notes = Notes::default();
        for line in 0..20 {
            notes.add("bad-number", format!("line {line}"), "not a number");
        }
        notes.add("unit-assumed", "", "metres");
        let list = notes.finish();
        assert_eq!(list.len(), 10);
        assert_eq!(list[9].message, "and 12 more of the same");
    }
}
