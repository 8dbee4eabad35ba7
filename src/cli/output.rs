//! Where words go: results to stdout, messages to stderr.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;

/// Writes a result to stdout and flushes it.
///
/// # Errors
/// stdout cannot be written; a reader that has gone is told apart by the caller.
pub(super) fn result(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    write(&mut out)?;
    out.flush()?;
    Ok(())
}

/// One JSON value, indented, on stdout.
///
/// # Errors
/// As [`result`].
pub(super) fn json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)?;
    result(|out| writeln!(out, "{text}"))
}

/// Why the command could not run, with the chain of causes, on stderr.
pub(super) fn error(error: &anyhow::Error) {
    // A fault of a text brings its own heading: `error[CAT002]: …`.
    let mut text = error.to_string();
    if !text.starts_with("error[") {
        text.insert_str(0, "error: ");
    }
    for cause in error.chain().skip(1) {
        text.push_str(&format!("\n  because: {cause}"));
    }
    // Nothing is left to be told to if stderr is gone.
    drop(writeln!(io::stderr(), "{text}"));
}

/// A message on stderr.
pub(super) fn notice(text: &str) {
    drop(writeln!(io::stderr(), "{text}"));
}

/// Writes a file through a neighbour that takes its place when whole, so that nobody reads half of it.
///
/// # Errors
/// The file or its folder cannot be written.
pub(super) fn file(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let wanted = || format!("cannot write {}", path.display());
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).with_context(wanted)?;
    }
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".part");
    let part = path.with_file_name(name);
    let mut out = BufWriter::new(File::create(&part).with_context(wanted)?);
    write(&mut out).with_context(wanted)?;
    out.flush().with_context(wanted)?;
    drop(out);
    fs::rename(&part, path).with_context(wanted)
}
