//! Where something is written: a file, a line and a column that an editor can jump to.

use std::fmt;
use std::path::{Path, PathBuf};

use mapper::{Layer, Provenance, sidecar_path};
use serde::{Deserialize, Serialize};

/// A place in a file that people write, or a whole file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Place {
    /// As given on the command line, `/` between folders.
    pub file: String,
    /// 1-based; 0 for the whole file.
    pub line: u32,
    /// 1-based, in characters; 0 for the whole line.
    pub column: u32,
    /// In the catalogue that is built in, which is no file of the user's.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub built_in: bool,
}

impl Place {
    /// A whole file.
    #[must_use]
    pub fn file(path: &Path) -> Self {
        Self { file: slashed(path), line: 0, column: 0, built_in: false }
    }

    #[must_use]
    pub fn at(path: &str, line: u32, column: u32) -> Self {
        Self { file: slashed(Path::new(path)), line, column, built_in: false }
    }

    /// `file`, `file:line` or `file:line:column`.
    #[must_use]
    pub fn written(&self) -> String {
        match (self.line, self.column) {
            (0, _) => self.file.clone(),
            (line, 0) => format!("{}:{line}", self.file),
            (line, column) => format!("{}:{line}:{column}", self.file),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written())?;
        if self.built_in { f.write_str(" (built in)") } else { Ok(()) }
    }
}

/// From the mapper's word of where a value was written to a place that can be opened.
#[derive(Clone, Debug)]
pub struct Places {
    /// `None` where the catalogue is the built-in one.
    pub catalog: Option<PathBuf>,
}

impl Places {
    /// `model`: the file of the model that the value belongs to; its sidecar is named without its folder.
    #[must_use]
    pub fn of(&self, by: &Provenance, model: Option<&Path>) -> Option<Place> {
        match (by.layer, model) {
            (Layer::CommandLine, _) => None,
            (Layer::Sidecar, Some(model)) => {
                Some(Place { line: by.line, column: by.column, ..Place::file(&sidecar_path(model)) })
            }
            (Layer::Sidecar | Layer::Proposal | Layer::Project, _) => {
                Some(Place::at(&by.file, by.line, by.column))
            }
            _ => Some(match &self.catalog {
                Some(_) => Place::at(&by.file, by.line, by.column),
                None => Place { built_in: true, ..Place::at(&by.file, by.line, by.column) },
            }),
        }
    }
}

/// A path as reports write it.
#[must_use]
pub fn slashed(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    text.strip_prefix("./").map_or_else(|| text.clone(), str::to_owned)
}
