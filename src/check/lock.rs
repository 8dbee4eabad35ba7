//! `physique.lock`: what the mapping says of every model, a line a model, to be committed and reviewed.
//!
//! ```text
//! # physique lock 1
//! # tool 0.1.0
//! # catalogue 3f0c… (2054 subcategories, 199 presets, 180 rules)
//! food/apple.glb  8c1d…  subcategory:apple  fruit/apple  apple-flesh  51f0…  density=840 kg/m3  mass=0.18 kg …
//! ```
//!
//! Fields are parted by tabs: model, input hash, winning rule, category/subcategory, preset, hash of all
//! attributes, then the values themselves, so that two locks can be compared in words. Lines of files are left
//! out on purpose: a comment added to the catalogue changes no lock.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use mapper::Ruleset;

use super::entry::{Entry, Held};
use super::observation::Observation;
use super::place::{Place, slashed};
use crate::pipeline::Key;

/// Name that is taken when nothing is said.
pub const DEFAULT_FILE: &str = "physique.lock";

const HEADER: &str = "# physique lock 1";

/// A whole lock file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lock {
    pub tool: String,
    pub catalogue: String,
    /// By model.
    pub entries: BTreeMap<String, Entry>,
}

impl Lock {
    /// Of no model yet, by these rules.
    #[must_use]
    pub fn new(rules: &Ruleset) -> Self {
        Self {
            tool: env!("CARGO_PKG_VERSION").to_owned(),
            catalogue: version_of(rules),
            entries: BTreeMap::new(),
        }
    }

    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{HEADER}\n# tool {}\n# catalogue {}\n", self.tool, self.catalogue);
        for (model, entry) in &self.entries {
            let Entry { input, rule, category, preset, attributes, values, .. } = entry;
            // Writing to a string cannot fail.
            let _ = write!(text, "{}\t{input}\t{rule}\t{category}\t{preset}\t{attributes}", escaped(model));
            for Held { name, value, by } in values {
                let _ = write!(text, "\t{name}={value}");
                if !by.is_empty() {
                    let _ = write!(text, " by {by}");
                }
            }
            text.push('\n');
        }
        text
    }

    /// # Errors
    /// An [`Observation`] of the first line that makes no sense.
    pub fn parse(path: &Path, text: &str) -> Result<Self, Box<Observation>> {
        let file = slashed(path);
        let wrong = |line: u32, message: String| {
            Box::new(Observation::fact("LCK002", message).at(Some(Place::at(&file, line, 0))))
        };
        let mut lock = Self::default();
        let mut last: Option<String> = None;
        if text.lines().next().is_none_or(|first| first != HEADER) {
            return Err(wrong(1, format!("expected the first line to be {HEADER:?}")));
        }
        for (number, line) in (1_u32..).zip(text.lines()) {
            if let Some(comment) = line.strip_prefix('#') {
                if let Some(tool) = comment.strip_prefix(" tool ") {
                    tool.clone_into(&mut lock.tool);
                } else if let Some(catalogue) = comment.strip_prefix(" catalogue ") {
                    catalogue.clone_into(&mut lock.catalogue);
                }
                continue;
            }
            let mut fields = line.split('\t');
            let mut next = |what: &str| {
                fields
                    .next()
                    .filter(|field| !field.is_empty())
                    .map(str::to_owned)
                    .ok_or_else(|| wrong(number, format!("expected {what}, found the end of the line")))
            };
            let model = unescaped(&next("a model")?);
            let mut entry = Entry {
                line: number,
                input: next("an input hash")?,
                rule: next("the winning rule")?,
                category: next("a category")?,
                preset: next("a preset")?,
                attributes: next("a hash of the attributes")?,
                values: Vec::new(),
            };
            // A field that is lost moves the others to its place: the hashes tell.
            for (what, hash) in
                [("an input hash", &entry.input), ("a hash of the attributes", &entry.attributes)]
            {
                if hash.len() != 16 || !hash.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                    return Err(wrong(number, format!("expected {what} of 16 digits, found {hash:?}")));
                }
            }
            for field in fields {
                let Some((name, value)) = field.split_once('=') else {
                    return Err(wrong(number, format!("expected name=value, found {field:?}")));
                };
                let (value, by) = value.split_once(" by ").unwrap_or((value, ""));
                entry.values.push(Held { name: name.to_owned(), value: value.to_owned(), by: by.to_owned() });
            }
            match &last {
                Some(before) if *before == model => {
                    return Err(wrong(number, format!("{model} stands here a second time")));
                }
                Some(before) if *before > model => {
                    return Err(wrong(
                        number,
                        format!("{model} stands behind {before}: the lines are sorted"),
                    ));
                }
                _ => {}
            }
            last = Some(model.clone());
            lock.entries.insert(model, entry);
        }
        Ok(lock)
    }
}

/// Hash and size of a catalogue.
fn version_of(rules: &Ruleset) -> String {
    let stats = rules.stats();
    let presets = stats.presets_rigid + stats.presets_soft + stats.presets_fluid;
    let hash = Key::new("catalogue").with(rules.text()).finish();
    format!(
        "{} ({} subcategories, {presets} presets, {} rules)",
        &hash[..16],
        stats.subcategories,
        stats.rules
    )
}

fn escaped(model: &str) -> String {
    model.replace('\\', "\\\\").replace('\t', "\\t").replace('\n', "\\n")
}

fn unescaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        match (letter, letter == '\\').1 {
            false => plain.push(letter),
            true => match letters.next() {
                Some('t') => plain.push('\t'),
                Some('n') => plain.push('\n'),
                Some(other) => plain.push(other),
                None => {}
            },
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lock() -> Lock {
        let entry = |mass: &str| Entry {
            input: "0123456789abcdef".to_owned(),
            rule: "subcategory:mug".to_owned(),
            category: "kitchen/mug".to_owned(),
            preset: "ceramic".to_owned(),
            attributes: "fedcba9876543210".to_owned(),
            values: vec![
                Held {
                    name: "density".to_owned(),
                    value: "2180 kg/m3".to_owned(),
                    by: "override:a b/**".to_owned(),
                },
                Held { name: "mass".to_owned(), value: mass.to_owned(), by: String::new() },
            ],
            line: 0,
        };
        let entries = [("a\tb.glb", "0.3 kg"), ("kitchen/mug 1.glb", "0.4 kg")];
        Lock {
            tool: "0.1.0".to_owned(),
            catalogue: "abc (1 subcategories)".to_owned(),
            entries: entries.map(|(model, mass)| (model.to_owned(), entry(mass))).into(),
        }
    }

    #[test]
    fn a_lock_is_read_as_it_was_written() {
        let text = lock().text();
        let mut read = Lock::parse(Path::new("physique.lock"), &text).expect("read");
        assert_eq!(read.entries["kitchen/mug 1.glb"].line, 5);
        assert_eq!(read.entries["kitchen/mug 1.glb"].quantity("mass"), Some((0.4, "kg")));
        read.entries.values_mut().for_each(|entry| entry.line = 0);
        assert_eq!(read, lock());
    }

    #[test]
    fn what_a_merge_left_behind_is_found_at_its_line() {
        let text = lock().text();
        let line = text.lines().nth(3).expect("a line").to_owned();
        let cases = [
            (text.replace(HEADER, "<<<<<<< ours"), 1),
            (text.replace("\tceramic\tfed", "\t"), 4),
            (format!("{text}{line}\n"), 6),
            (format!("{text}=======\n"), 6),
            (text.replace("mass=0.4 kg", "mass 0.4 kg"), 5),
        ];
        for (text, line) in cases {
            let fault = Lock::parse(Path::new("physique.lock"), &text).expect_err("refused");
            assert_eq!(fault.place.map(|place| place.line), Some(line), "{}", fault.message);
        }
    }
}
