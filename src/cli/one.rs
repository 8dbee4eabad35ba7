//! A single model file, imported and mapped without a catalogue where there is none that knows it.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use anyhow::{Context, Result, anyhow};
use importer::{Asset, Catalogue};
use mapper::{Mapped, Mapper, ModelFacts, SetValue, Sidecar};

/// A model with everything known of it.
pub(super) struct One {
    /// Path relative to the root, as the rules see it.
    pub model: String,
    pub asset: Asset,
    pub mapped: Mapped,
}

/// Imports and maps the model at `path`. `root`: the folder from which the rules see its path.
///
/// # Errors
/// The file is refused, or its sidecar is not right.
pub(super) fn one(
    path: &Path,
    root: Option<&Path>,
    db: &Path,
    mapper: &Mapper,
    sets: &[SetValue],
) -> Result<One> {
    let (model, asset) = match root {
        Some(root) => (relative(path, root)?, importer::import(path, &super::job::import_options())?),
        None => match known(path, db) {
            Some(known) => known,
            None => (with_its_folder(path)?, importer::import(path, &super::job::import_options())?),
        },
    };
    let sidecar = Sidecar::load(path, mapper.rules())?;
    let mapped = mapper.map_with_sidecar(&ModelFacts::new(&model, &asset), sidecar.as_ref(), sets);
    Ok(One { model, asset, mapped })
}

/// The model as the catalogue has it, if its file has not changed since.
fn known(path: &Path, db: &Path) -> Option<(String, Asset)> {
    if !db.is_file() {
        return None;
    }
    let catalogue = Catalogue::open(db).ok()?;
    let there = fs::canonicalize(path).ok()?;
    let row = catalogue.models().ok()?.into_iter().find(|row| {
        // Comparing names first: a catalogue of many thousands would be as many file system calls.
        row.model.rsplit('/').next().map(std::ffi::OsStr::new) == there.file_name()
            && fs::canonicalize(row.path()).is_ok_and(|known| known == there)
    })?;
    let record = catalogue.record(&row.model).ok()??;
    let facts = fs::metadata(&there).ok()?;
    let modified = facts.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
    let same = record.stamp.bytes == facts.len()
        && record.stamp.modified_ns.is_some_and(|known| u128::try_from(known) == Ok(modified));
    let options = super::job::import_options().fingerprint();
    if !same || record.options != options {
        // The path is the catalogue's all the same: rules must see one model one way.
        let asset = importer::import(path, &super::job::import_options()).ok()?;
        return Some((row.model, asset));
    }
    Some((row.model, catalogue.asset(&row.key?).ok()??))
}

fn relative(path: &Path, root: &Path) -> Result<String> {
    let absolute =
        |path: &Path| fs::canonicalize(path).with_context(|| format!("cannot find {}", path.display()));
    let (path, root) = (absolute(path)?, absolute(root)?);
    let below = path.strip_prefix(&root).map_err(|_| {
        anyhow!("{} is not below {}; name a folder above it with --root", path.display(), root.display())
    })?;
    Ok(slashed(below))
}

/// The file's name with that of its folder, which as a rule names a category.
fn with_its_folder(path: &Path) -> Result<String> {
    let absolute = fs::canonicalize(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    let name = absolute.file_name().map(PathBuf::from).unwrap_or_default();
    let folder = absolute.parent().and_then(Path::file_name);
    Ok(slashed(&folder.map_or_else(|| name.clone(), |folder| Path::new(folder).join(&name))))
}

fn slashed(path: &Path) -> String {
    path.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/")
}
