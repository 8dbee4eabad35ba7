//! Words of a text format, with the place of what is wrong with them.

use crate::ImportError;

/// Words parted by white space; a `#` and what follows it on its line is passed over.
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The first word of a line has not been asked for yet.
    fresh: bool,
}

impl<'a> Words<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, fresh: false }
    }

    pub fn rewind(&mut self) {
        self.at = 0;
        self.fresh = false;
    }

    /// The rest of the line, trimmed.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += end;
        rest[..end].trim_ascii()
    }

    /// What is left of the present line is passed over, unless nothing of it was read yet.
    pub fn next_line(&mut self) {
        if !self.fresh {
            self.rest_of_line();
            self.fresh = true;
        }
    }

    pub fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            let rest = &self.bytes[self.at..];
            let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
            self.at += start;
            if rest[start] == b'#' {
                self.rest_of_line();
                continue;
            }
            let rest = &rest[start..];
            let end = rest.iter().position(|byte| byte.is_ascii_whitespace() || *byte == b'#');
            let word = &rest[..end.unwrap_or(rest.len())];
            self.at += word.len();
            self.fresh = false;
            return Some(word);
        }
    }

    fn parsed<T: std::str::FromStr>(
        &mut self,
        expected: &str,
        place: impl FnOnce() -> String,
    ) -> Result<T, ImportError> {
        let Some(word) = self.word() else {
            let reason = format!("expected {expected}, found the end of the file");
            return Err(ImportError::malformed(place(), reason));
        };
        let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        parsed.ok_or_else(|| {
            let found = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
            ImportError::malformed(place(), format!("expected {expected}, found {found:?}"))
        })
    }

    pub fn number(&mut self, place: impl FnOnce() -> String) -> Result<f64, ImportError> {
        self.parsed("a number", place)
    }

    pub fn index(&mut self, place: impl FnOnce() -> String) -> Result<u64, ImportError> {
        self.parsed("a whole number", place)
    }

    /// How many of something there are.
    pub fn count(&mut self, of: &str) -> Result<u64, ImportError> {
        self.parsed(&format!("the number of {of}"), || "counts".to_owned())
    }
}
