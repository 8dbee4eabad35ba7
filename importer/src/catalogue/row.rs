//! The catalogue's rows as the rest of the program sees them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::AssetKey;
use crate::error::ImportError;

/// A path in the database of models, and what came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelRow {
    /// Relative to `root`, '/' between folders. Unique in a catalogue.
    pub model: String,
    pub root: PathBuf,
    /// `None` where the import failed, see `failure`.
    pub key: Option<AssetKey>,
    /// Of the import; failures of later stages are in [`super::Catalogue::failures`].
    pub failure: Option<Failure>,
}

impl ModelRow {
    /// The file itself.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.model.split('/').fold(self.root.clone(), |path, name| path.join(name))
    }
}

/// Why a stage could not do its work on a model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Stable, kebab-case.
    pub code: String,
    /// Inside the file; empty for the whole.
    pub place: String,
    pub reason: String,
    pub way_out: String,
}

impl From<&ImportError> for Failure {
    fn from(error: &ImportError) -> Self {
        Self {
            code: error.code().to_owned(),
            place: error.place(),
            reason: error.reason(),
            way_out: error.way_out(),
        }
    }
}

/// A failure with its model and stage.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureRow {
    pub model: String,
    /// `import`, or the name a later stage gave itself.
    pub stage: String,
    pub failure: Failure,
}

/// What a later stage made of a model. The catalogue does not read it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StageRow {
    pub model: String,
    pub stage: String,
    /// Everything the result depends on, as the stage sees it: unchanged means no need to run again.
    pub input_key: String,
    pub status: String,
    /// JSON.
    pub result: String,
}

/// A file's size and time of change: equal stamps are taken for equal bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    pub bytes: u64,
    /// Nanoseconds since 1970. `None` says: do not rely on the time, compare the content.
    pub modified_ns: Option<i64>,
}

impl Stamp {
    /// Whether the file surely has the bytes it had when `earlier` was taken.
    #[must_use]
    pub fn is_unchanged_since(&self, earlier: &Self) -> bool {
        self.modified_ns.is_some() && self == earlier
    }
}

/// A file that a model refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dependency {
    /// As written in the file: relative to the model's folder.
    pub path: String,
    pub stamp: Stamp,
}

/// Everything the catalogue remembers of a model, so as not to read it again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelRecord {
    pub row: ModelRow,
    pub stamp: Stamp,
    pub dependencies: Vec<Dependency>,
    /// Key of the bytes, known even where they were refused.
    pub content: Option<AssetKey>,
    /// [`crate::Options::fingerprint`] under which it was last tried.
    pub options: String,
}

/// Counts for a summary.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    pub models: u64,
    /// Models that hold an asset.
    pub imported: u64,
    pub assets: u64,
    /// By stage, then by code.
    pub failures: BTreeMap<String, BTreeMap<String, u64>>,
    /// Assets by the code of what was assumed, left out or repaired in them.
    pub notes: BTreeMap<String, u64>,
    /// By stage, then by status.
    pub stages: BTreeMap<String, BTreeMap<String, u64>>,
}
