//! Which models are in work, on disk: so that after a crash the next run knows whom to suspect.
//!
//! Every run has a file of its own beside the catalogue and holds a lock on it. A file that can be locked is of a run
//! that is gone; models that it began and did not end are imported alone, in a process of their own.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

pub(super) struct Journal {
    /// `None` where none can be kept: a catalogue in memory, a folder that cannot be written.
    file: Option<(PathBuf, Mutex<File>)>,
    suspects: BTreeSet<String>,
}

impl Journal {
    /// Takes over what runs that are gone have left, and begins one's own.
    pub fn open(catalogue: &Path) -> Self {
        let folder = PathBuf::from(format!("{}-work", catalogue.display()));
        if !catalogue.is_file() || fs::create_dir_all(&folder).is_err() {
            return Self { file: None, suspects: BTreeSet::new() };
        }
        let suspects = left_behind(&folder);
        let since = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
        let path = folder.join(format!("{}-{since}", std::process::id()));
        let file = File::create(&path).ok().filter(|file| file.try_lock().is_ok());
        let journal = Self { file: file.map(|file| (path, Mutex::new(file))), suspects };
        // Killed before its turn comes, a suspect is one still.
        journal.suspects.iter().for_each(|model| journal.write('+', model));
        journal
    }

    /// Was in work when a run ended without a word.
    pub fn suspects(&self, model: &str) -> bool {
        self.suspects.contains(model)
    }

    pub fn begin(&self, model: &str) {
        if !self.suspects(model) {
            self.write('+', model);
        }
    }

    pub fn end(&self, model: &str) {
        self.write('-', model);
    }

    /// A line cannot be lost by a crash of this process once it is written, only by one of the machine.
    fn write(&self, sign: char, model: &str) {
        if let Some((_, file)) = &self.file {
            let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
            // A journal that cannot be written costs no model.
            let _ = file.write_all(format!("{sign}{}\n", model.escape_default()).as_bytes());
        }
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        if let Some((path, file)) = self.file.take() {
            drop(file);
            let _ = fs::remove_file(&path);
            // Only where it is empty.
            let _ = path.parent().map(fs::remove_dir);
        }
    }
}

fn left_behind(folder: &Path) -> BTreeSet<String> {
    let mut suspects = BTreeSet::new();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let Ok(mut file) = File::options().read(true).write(true).open(&path) else { continue };
        if file.try_lock().is_err() {
            continue;
        }
        let mut text = String::new();
        let _ = file.read_to_string(&mut text);
        let mut open = BTreeSet::new();
        for line in text.lines() {
            match line.split_at_checked(1) {
                Some(("+", model)) => drop(open.insert(unescaped(model))),
                Some(("-", model)) => drop(open.remove(&unescaped(model))),
                _ => {}
            }
        }
        suspects.extend(open);
        let _ = fs::remove_file(&path);
    }
    suspects
}

/// The inverse of `str::escape_default`.
fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        if letter != '\\' {
            plain.push(letter);
            continue;
        }
        match letters.next() {
            Some('n') => plain.push('\n'),
            Some('r') => plain.push('\r'),
            Some('t') => plain.push('\t'),
            Some('u') => {
                let digits: String = letters.by_ref().skip(1).take_while(|&letter| letter != '}').collect();
                plain.extend(u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32));
            }
            Some(other) => plain.push(other),
            None => {}
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_dead_run_began_and_did_not_end_is_suspect() {
        let folder = tempfile::tempdir().unwrap();
        let catalogue = folder.path().join("c.db");
        fs::write(&catalogue, "").unwrap();
        let work = folder.path().join("c.db-work");
        fs::create_dir(&work).unwrap();
        fs::write(work.join("1-1"), "+a.stl\n+b \\n\\u{fc}.stl\n-a.stl\n+c.stl").unwrap();
        let living = Journal::open(&catalogue);
        assert!(!living.suspects("a.stl") && living.suspects("b \nü.stl") && living.suspects("c.stl"));
        living.begin("d.stl");
        // A run beside it leaves the living one's journal alone.
        let other = Journal::open(&catalogue);
        assert!(!other.suspects("d.stl") && !other.suspects("c.stl"));
        living.end("c.stl");
        drop((living, other));
        assert!(!work.exists(), "nothing is left of runs that ended well");
    }
}
