//! Why a model file was refused.

use std::io;
use std::path::{Path, PathBuf};

/// A refusal: which file, where in it, what was wrong, and how to get past it.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file system refused.
    #[error("{}: {}. {}", file.display(), self.reason(), self.way_out())]
    Io { file: PathBuf, source: io::Error },
    /// Neither its bytes nor its extension are of a known format.
    #[error("{}: {reason}. {}", file.display(), self.way_out())]
    UnknownFormat { file: PathBuf, reason: String },
    /// The bytes break the rules of their format.
    #[error("{}: {place}: {reason}. {}", file.display(), self.way_out())]
    Malformed { file: PathBuf, place: String, reason: String },
    /// Right by its format, but more than is read here.
    #[error("{}: {place}: {reason}. {way_out}", file.display())]
    Unsupported { file: PathBuf, place: String, reason: String, way_out: String },
    /// A file that this one refers to is not there.
    #[error("{}: {place}: {reason}. {}", file.display(), self.way_out())]
    MissingFile { file: PathBuf, place: String, reason: String },
    /// Read, and there is no surface in it.
    #[error("{}: {reason}. {}", file.display(), self.way_out())]
    NoTriangles { file: PathBuf, reason: String },
    /// Over a limit of [`crate::Options`].
    #[error("{}: {place}: {reason}. {}", file.display(), self.way_out())]
    TooLarge { file: PathBuf, place: String, reason: String },
    /// A library panicked; the panic was caught.
    #[error("{}: {place}: {reason}. {}", file.display(), self.way_out())]
    Panic {
        file: PathBuf,
        /// The stage that was running: `read`, `measure`, `colliders`.
        place: String,
        reason: String,
    },
}

impl ImportError {
    pub(crate) fn malformed(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Malformed { file: PathBuf::new(), place: place.into(), reason: reason.into() }
    }

    pub(crate) fn unsupported(
        place: impl Into<String>,
        reason: impl Into<String>,
        way_out: impl Into<String>,
    ) -> Self {
        Self::Unsupported {
            file: PathBuf::new(),
            place: place.into(),
            reason: reason.into(),
            way_out: way_out.into(),
        }
    }

    pub(crate) fn missing(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::MissingFile { file: PathBuf::new(), place: place.into(), reason: reason.into() }
    }

    pub(crate) fn no_triangles(reason: impl Into<String>) -> Self {
        Self::NoTriangles { file: PathBuf::new(), reason: reason.into() }
    }

    pub(crate) fn too_large(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::TooLarge { file: PathBuf::new(), place: place.into(), reason: reason.into() }
    }

    pub(crate) fn panic(place: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Panic { file: PathBuf::new(), place: place.into(), reason: reason.into() }
    }

    /// The same refusal of the same place once more, for what is asked for again.
    pub(crate) fn again(&self) -> Self {
        let (place, reason) = (self.place(), self.reason());
        match self {
            Self::MissingFile { .. } => Self::missing(place, reason),
            Self::TooLarge { .. } => Self::too_large(place, reason),
            Self::Panic { .. } => Self::panic(place, reason),
            Self::Unsupported { way_out, .. } => Self::unsupported(place, reason, way_out.clone()),
            _ => Self::malformed(place, reason),
        }
    }

    /// Names the file: readers know places only.
    #[must_use]
    pub(crate) fn in_file(mut self, path: &Path) -> Self {
        match &mut self {
            Self::Io { file, .. }
            | Self::UnknownFormat { file, .. }
            | Self::Malformed { file, .. }
            | Self::Unsupported { file, .. }
            | Self::MissingFile { file, .. }
            | Self::NoTriangles { file, .. }
            | Self::TooLarge { file, .. }
            | Self::Panic { file, .. } => path.clone_into(file),
        }
        self
    }

    /// The model file.
    #[must_use]
    pub fn file(&self) -> &Path {
        match self {
            Self::Io { file, .. }
            | Self::UnknownFormat { file, .. }
            | Self::Malformed { file, .. }
            | Self::Unsupported { file, .. }
            | Self::MissingFile { file, .. }
            | Self::NoTriangles { file, .. }
            | Self::TooLarge { file, .. }
            | Self::Panic { file, .. } => file,
        }
    }

    /// Where in the file, in its own terms (`accessors[3]`, `line 12`, `byte 84`); empty for the whole.
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Io { .. } | Self::UnknownFormat { .. } | Self::NoTriangles { .. } => String::new(),
            Self::Malformed { place, .. }
            | Self::Unsupported { place, .. }
            | Self::MissingFile { place, .. }
            | Self::TooLarge { place, .. }
            | Self::Panic { place, .. } => place.clone(),
        }
    }

    /// What was found and what was expected, without file and place.
    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Io { source, .. } => format!("cannot be read: {source}"),
            Self::UnknownFormat { reason, .. }
            | Self::Malformed { reason, .. }
            | Self::Unsupported { reason, .. }
            | Self::MissingFile { reason, .. }
            | Self::NoTriangles { reason, .. }
            | Self::TooLarge { reason, .. }
            | Self::Panic { reason, .. } => reason.clone(),
        }
    }

    /// What the user can do about it.
    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            Self::Io { .. } => "Check that the file exists and may be read",
            Self::UnknownFormat { .. } => "Export the model as glb, gltf, obj, stl or ply",
            Self::Malformed { .. } => {
                "Fetch the file again or re-export it from its source; a glTF validator or a mesh viewer shows \
                 the same fault"
            }
            Self::Unsupported { way_out, .. } => way_out,
            Self::MissingFile { .. } => "Put the file it refers to beside it, or re-export as one glb",
            Self::NoTriangles { .. } => "Leave the file out, or export its faces too",
            Self::TooLarge { .. } => "Raise the limit in the options, or reduce the model",
            Self::Panic { .. } => "Re-export the model; the file shows a fault in a library and is worth a report",
        }
        .to_owned()
    }

    /// Stable name of the kind of refusal, kebab-case.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Io { .. } => "io",
            Self::UnknownFormat { .. } => "unknown-format",
            Self::Malformed { .. } => "malformed",
            Self::Unsupported { .. } => "unsupported",
            Self::MissingFile { .. } => "missing-file",
            Self::NoTriangles { .. } => "no-triangles",
            Self::TooLarge { .. } => "too-large",
            Self::Panic { .. } => "panic",
        }
    }
}
