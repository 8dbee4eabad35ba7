//! Why a recording could not be made.

use std::path::PathBuf;

use crate::program::{INSTALL_HINT, RERUN_VERSION};

/// Every variant names the file, address or program, and the way out.
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    #[error("nowhere to record to: give a file, a viewer to open, or an address to connect to")]
    NoOutput,
    #[error(
        "{path}: cannot write the recording: {source}; give a file in a folder that exists and may be written to"
    )]
    Unwritable { path: PathBuf, source: std::io::Error },
    #[error("{path}: another run is writing this recording; wait for it or give another file")]
    Busy { path: PathBuf },
    #[error("{path}: the recording is not whole: {reason}; free some space and run again")]
    Write { path: PathBuf, reason: String },
    #[error(
        "`{address}` is no viewer's address ({reason}); expected `HOST:PORT` or `rerun+http://HOST:PORT/proxy`"
    )]
    Address { address: String, reason: String },
    #[error(
        "{address}: no viewer answers ({reason}); start one with `rerun --port PORT`, or record to a file"
    )]
    Unreachable { address: String, reason: String },
    #[error(
        "cannot open a rerun viewer: {reason}; it needs a screen and rerun {RERUN_VERSION} ({INSTALL_HINT})"
    )]
    NoViewer { reason: String },
    #[error("rerun {RERUN_VERSION} refused the data: {0}; this is a fault of the program, not of its input")]
    Encode(String),
    #[error(
        "the thread that writes the recording ended early; this is a fault of the program, not of its input"
    )]
    Worker,
}

impl ViewerError {
    /// From any of rerun's own errors in making a row or a column.
    pub(crate) fn encode(error: impl std::fmt::Display) -> Self {
        Self::Encode(error.to_string())
    }
}
