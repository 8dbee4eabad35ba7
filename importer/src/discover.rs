//! Model files under a folder.

use std::fs;
use std::path::{Path, PathBuf};

use crate::ImportError;
use crate::read::is_shapes;

/// Extensions of the formats that are read, lower case.
const EXTENSIONS: [&str; 12] =
    ["glb", "gltf", "obj", "stl", "ply", "off", "xyz", "pts", "asc", "pcd", "vox", "binvox"];

/// Every model file under `root`, by extension in any case, sorted by path. A single file is itself, whatever
/// it is called. Links to folders are not followed, so that a loop of them ends.
///
/// # Errors
/// [`ImportError::Io`], naming the folder that cannot be listed.
pub fn discover(root: &Path) -> Result<Vec<PathBuf>, ImportError> {
    let refuse = |file: &Path| {
        let file = file.to_path_buf();
        move |source| ImportError::Io { file, source }
    };
    if !fs::metadata(root).map_err(refuse(root))?.is_dir() {
        return Ok(vec![root.to_path_buf()]);
    }
    let mut found = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(refuse(&folder))? {
            let entry = entry.map_err(refuse(&folder))?;
            let path = entry.path();
            if entry.file_type().map_err(refuse(&path))?.is_dir() {
                folders.push(path);
            } else if is_model(&path) && path.is_file() {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn is_model(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    if name.is_some_and(|name| is_shapes(&name.to_ascii_lowercase())) {
        return true;
    }
    path.extension()
        .and_then(|extension| extension.to_str())
        .is_some_and(|extension| EXTENSIONS.contains(&extension.to_ascii_lowercase().as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_models_in_any_case_sorted_and_leaves_the_rest() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir_all(root.path().join("b/deep")).unwrap();
        for name in ["z.STL", "a.glb", "b/deep/c.Obj", "b/readme.md", "b/x.bin"] {
            fs::write(root.path().join(name), "").unwrap();
        }
        let names: Vec<_> = discover(root.path())
            .unwrap()
            .iter()
            .map(|path| path.strip_prefix(root.path()).unwrap().to_path_buf())
            .collect();
        assert_eq!(names, ["a.glb", "b/deep/c.Obj", "z.STL"].map(PathBuf::from));
    }

    #[test]
    fn a_file_is_itself_and_nothing_is_an_error() {
        let root = tempfile::tempdir().unwrap();
        let file = root.path().join("odd.name");
        fs::write(&file, "").unwrap();
        assert_eq!(discover(&file).unwrap(), [file]);
        assert_eq!(discover(&root.path().join("absent")).unwrap_err().code(), "io");
    }
}
