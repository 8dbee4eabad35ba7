//! The models to be looked at, with their names and stamps.

use std::io;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use super::stamp::stamp_of;
use crate::catalogue::{CatalogueError, Stamp};
use crate::{ImportError, discover};

/// A model to be looked at.
pub(super) struct Job {
    pub model: String,
    pub path: PathBuf,
    /// Taken before the file is read: a change in between shows next time.
    pub stamp: io::Result<Stamp>,
    pub is_named_by_utf8: bool,
}

impl Job {
    pub fn bytes(&self) -> u64 {
        self.stamp.as_ref().map_or(0, |stamp| stamp.bytes)
    }
}

pub(super) struct Folder {
    pub root: PathBuf,
    pub jobs: Vec<Job>,
    /// False where the root is a single file: its siblings are not gone for not being listed.
    pub is_whole: bool,
}

impl Folder {
    pub fn list(root: &Path) -> Result<Self, CatalogueError> {
        let refuse = |reason: String| CatalogueError::Root { root: root.to_path_buf(), reason };
        let io_refuse =
            |source: io::Error| refuse(ImportError::Io { file: root.to_path_buf(), source }.to_string());
        let is_whole = root.is_dir();
        let (folder, listed) = if is_whole {
            let folder = root.canonicalize().map_err(io_refuse)?;
            (folder.clone(), folder)
        } else {
            let parent = root.parent().filter(|parent| !parent.as_os_str().is_empty());
            let folder = parent.unwrap_or(Path::new(".")).canonicalize().map_err(io_refuse)?;
            let file = folder.join(root.file_name().unwrap_or_default());
            (folder, file)
        };
        if folder.to_str().is_none() {
            return Err(refuse(format!(
                "{}: the folder's name is not UTF-8, which the catalogue needs. Rename it",
                folder.display()
            )));
        }
        let paths = discover(&listed).map_err(|error| refuse(error.to_string()))?;
        let jobs = paths
            .into_iter()
            .map(|path| {
                let (model, is_named_by_utf8) = name_of(&path, &folder);
                Job { model, stamp: stamp_of(&path), path, is_named_by_utf8 }
            })
            .collect();
        Ok(Self { root: folder, jobs, is_whole })
    }
}

/// The model's name, and whether the path can be found again by it.
fn name_of(path: &Path, root: &Path) -> (String, bool) {
    let relative = path.strip_prefix(root).unwrap_or(path);
    let parts: Option<Vec<&str>> = relative.iter().map(|part| part.to_str()).collect();
    match parts {
        Some(parts) => (parts.join("/"), true),
        None => {
            // Two such names may look the same; the hash keeps their rows apart.
            let hash = blake3::hash(relative.as_os_str().as_encoded_bytes()).to_hex();
            let shown = relative.to_string_lossy().replace(MAIN_SEPARATOR, "/");
            (format!("{shown}~{}", &hash[..8]), false)
        }
    }
}
