//! What is wrong with a file that people write, and where.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// Shown at once; the rest is counted.
const SHOWN: usize = 20;

/// One fault in a catalogue, override, scene or table file.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Stable: `CAT002`.
    pub code: &'static str,
    pub message: String,
    pub file: Arc<str>,
    /// 1-based; 0 where the whole file is meant.
    pub line: u32,
    /// 1-based, in characters.
    pub column: u32,
    /// Stands at the caret.
    pub label: String,
    /// The way out; may be empty.
    pub help: String,
    pub(crate) source: Arc<str>,
    /// In bytes of `source`.
    pub(crate) span: Range<usize>,
}

/// Why a file of the mapper could not be used.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    #[error("{}: cannot be read: {reason}", path.display())]
    Read { path: PathBuf, reason: String },
    /// Never empty, in the order of the file.
    #[error("{}", Listing(.0))]
    Invalid(Vec<Diagnostic>),
}

impl MapError {
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Read { .. } => &[],
            Self::Invalid(list) => list,
        }
    }

    /// Stable, for scripts.
    #[must_use]
    pub fn code(&self) -> &str {
        match self {
            Self::Read { .. } => "CAT000",
            Self::Invalid(list) => list.first().map_or("CAT001", |first| first.code),
        }
    }

    /// `catalog.yaml:12:5`
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Read { path, .. } => path.display().to_string(),
            Self::Invalid(list) => list.first().map_or_else(String::new, Diagnostic::place),
        }
    }

    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Read { reason, .. } => reason.clone(),
            Self::Invalid(list) => list.first().map_or_else(String::new, |first| first.message.clone()),
        }
    }

    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            Self::Read { .. } => "check that the path exists and may be read".to_owned(),
            Self::Invalid(list) => list.first().map_or_else(String::new, |first| first.help.clone()),
        }
    }
}

impl Diagnostic {
    /// `catalog.yaml:12:5`
    #[must_use]
    pub fn place(&self) -> String {
        if self.line == 0 {
            return self.file.to_string();
        }
        format!("{}:{}:{}", self.file, self.line, self.column)
    }

    /// The lines around the fault, cut out so that a caret in a long file costs no more than in a short one.
    fn window(&self) -> (Range<usize>, usize) {
        let text = &self.source;
        let line_start = |at: usize| text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let start = line_start(self.span.start);
        let end = text[self.span.end..].find('\n').map_or(text.len(), |newline| self.span.end + newline);
        (start..end, self.line.max(1) as usize)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (window, first_line) = self.window();
        let span = self.span.start - window.start..self.span.end - window.start;
        let cut = &self.source[window];
        let snippet = Snippet::source(cut)
            .line_start(first_line)
            .path(&*self.file)
            .annotation(AnnotationKind::Primary.span(span).label(self.label.as_str()));
        let mut group = Level::ERROR.primary_title(self.message.as_str()).id(self.code).element(snippet);
        if !self.help.is_empty() {
            group = group.element(Level::HELP.message(self.help.as_str()));
        }
        f.write_str(&Renderer::plain().render(&[group]))
    }
}

struct Listing<'a>(&'a [Diagnostic]);

impl fmt::Display for Listing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.0.iter().take(SHOWN).enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            write!(f, "{diagnostic}")?;
        }
        if self.0.len() > SHOWN {
            write!(f, "\n\nand {} more", self.0.len() - SHOWN)?;
        }
        Ok(())
    }
}
