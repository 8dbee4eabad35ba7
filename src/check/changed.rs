//! What git knows: which files changed since a reference, and what a file was there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

/// A commit of the repository that a folder belongs to.
#[derive(Clone, Debug)]
pub struct GitTree {
    /// The repository's top folder.
    root: PathBuf,
    reference: String,
}

impl GitTree {
    /// # Errors
    /// There is no git, no repository around `from`, or no such reference.
    pub fn open(from: &Path, reference: &str) -> Result<Self> {
        let from = if from.is_dir() { from } else { from.parent().unwrap_or(from) };
        let from = if from.as_os_str().is_empty() { Path::new(".") } else { from };
        let top = git(from, &["rev-parse", "--show-toplevel"])
            .with_context(|| format!("{} is in no git repository", from.display()))?;
        let root = PathBuf::from(top.trim_end_matches('\n'));
        if reference.starts_with('-') {
            bail!("{reference:?} is no git reference");
        }
        if git(&root, &["rev-parse", "--verify", "--quiet", &format!("{reference}^{{commit}}")]).is_err() {
            bail!("git knows no commit {reference:?}; in CI fetch enough history (fetch-depth: 0)");
        }
        Ok(Self { root, reference: reference.to_owned() })
    }

    /// As it was named.
    #[must_use]
    pub fn reference(&self) -> &str {
        &self.reference
    }

    /// Files that differ from the reference or are new, absolute; those that are ignored are not looked at.
    ///
    /// # Errors
    /// git fails.
    pub fn changed_files(&self) -> Result<BTreeSet<PathBuf>> {
        let changed = git(&self.root, &["diff", "--name-only", "-z", &self.reference, "--"])?;
        let new = git(&self.root, &["ls-files", "--others", "--exclude-standard", "-z"])?;
        let names = changed.split('\0').chain(new.split('\0')).filter(|name| !name.is_empty());
        Ok(names.map(|name| self.root.join(name)).collect())
    }

    /// The text that a file had; `None` where it was not there, or is outside the repository.
    #[must_use]
    pub fn text(&self, path: &Path) -> Option<String> {
        let absolute = std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).ok()?;
        let below = absolute.strip_prefix(std::fs::canonicalize(&self.root).ok()?).ok()?;
        let name = below.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
        git(&self.root, &["show", &format!("{}:{name}", self.reference)]).ok()
    }
}

fn git(folder: &Path, arguments: &[&str]) -> Result<String> {
    let output = Command::new("git")
        .arg("-C")
        .arg(folder)
        .args(arguments)
        .output()
        .context("cannot start git, which is needed for git references")?;
    if !output.status.success() {
        bail!("git {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
