//! Why the catalogue could not do it.

use std::path::{Path, PathBuf};

use rusqlite::ErrorCode;

/// A refusal of the catalogue. Cloned, since the writer's fault is told to every later caller.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CatalogueError {
    #[error("{}: cannot be opened: {reason}. Check that its folder exists and may be written", path.display())]
    Open { path: PathBuf, reason: String },
    #[error(
        "{}: not a catalogue: the file is not an SQLite database. Name another file, or delete this one",
        path.display()
    )]
    NotADatabase { path: PathBuf },
    #[error(
        "{}: an SQLite database of another program (application id {found:#x}). Name another file",
        path.display()
    )]
    Foreign { path: PathBuf, found: i32 },
    #[error(
        "{}: catalogue version {found} was written by a newer release; this one reads up to {supported}. Update, \
         or delete the catalogue: it is derived from the models and is made again",
        path.display()
    )]
    Newer { path: PathBuf, found: i32, supported: i32 },
    #[error(
        "{}: the disk is full; what was stored before is intact. Free some room and run again: it resumes",
        path.display()
    )]
    Full { path: PathBuf },
    #[error(
        "{}: another process held the catalogue for too long while {doing}. Run again when it is done",
        path.display()
    )]
    Busy { path: PathBuf, doing: &'static str },
    #[error(
        "{}: {doing}: the disk refused it ({reason}): a quota or a limit on a file's size may be used up; what was \
         stored before is intact. Make room and run again: it resumes",
        path.display()
    )]
    Refused { path: PathBuf, doing: &'static str, reason: String },
    #[error("{}: {doing}: {reason}", path.display())]
    Sqlite { path: PathBuf, doing: &'static str, reason: String },
    #[error(
        "{}: {what} cannot be read back: {reason}. Delete the catalogue: it is derived from the models and is \
         made again",
        path.display()
    )]
    Corrupt { path: PathBuf, what: String, reason: String },
    #[error("asset {key} cannot be stored: {reason}")]
    Unstorable { key: String, reason: String },
    #[error("{}: the catalogue's writer stopped early. Run again: what was stored is intact", path.display())]
    WriterGone { path: PathBuf },
    #[error("{} cannot be merged into itself", path.display())]
    MergeItself { path: PathBuf },
    /// The folder of models could not be listed.
    #[error("{reason}")]
    Root { root: PathBuf, reason: String },
}

impl CatalogueError {
    /// Turns an SQLite error, met while `doing` something to the catalogue at `path`, into ours.
    pub(super) fn from_sqlite(path: &Path, doing: &'static str, error: &rusqlite::Error) -> Self {
        let path = path.to_path_buf();
        match error.sqlite_error_code() {
            Some(ErrorCode::DiskFull) => Self::Full { path },
            Some(ErrorCode::SystemIoFailure) => Self::Refused { path, doing, reason: error.to_string() },
            Some(ErrorCode::NotADatabase) => Self::NotADatabase { path },
            Some(ErrorCode::CannotOpen) => Self::Open { path, reason: error.to_string() },
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => Self::Busy { path, doing },
            Some(ErrorCode::DatabaseCorrupt) => {
                Self::Corrupt { path, what: "the file".to_owned(), reason: error.to_string() }
            }
            _ => Self::Sqlite { path, doing, reason: error.to_string() },
        }
    }
}
