//! What the tests of the command share: run it, look at what it said.

#![allow(dead_code, reason = "every test file uses a part of it")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// The command, with nothing of the user's environment that could change what it says.
pub(crate) fn physique(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_physique"));
    command.args(args).current_dir(folder).stdin(Stdio::null()).env_remove("RUST_BACKTRACE");
    command
}

/// What a run said and how it ended.
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    fn of(output: &Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// stdout as one JSON value.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|error| panic!("stdout is no JSON: {error}\n{}\n{}", self.stdout, self.stderr))
    }
}

/// Runs the command to its end.
pub(crate) fn run(folder: &Path, args: &[&str]) -> Run {
    Run::of(&physique(folder, args).output().expect("the command starts"))
}

/// Runs it and expects one of these exit codes.
pub(crate) fn run_to(folder: &Path, codes: &[i32], args: &[&str]) -> Run {
    let run = run(folder, args);
    assert!(
        run.code.is_some_and(|code| codes.contains(&code)),
        "physique {args:?} ended with {:?} instead of {codes:?}\n{}\n{}",
        run.code,
        run.stdout,
        run.stderr
    );
    run
}

/// A count of a summary.
pub(crate) fn count(summary: &Value, field: &str) -> u64 {
    summary[field].as_u64().unwrap_or_else(|| panic!("no count {field:?} in {summary:#}"))
}

/// The workspace's own folder.
pub(crate) fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The shared models, where this machine has them: `PHYSIQUE_MODELS`, else `../shared/models`.
pub(crate) fn shared_models() -> Option<PathBuf> {
    let folder = std::env::var_os("PHYSIQUE_MODELS")
        .map_or_else(|| workspace().join("../shared/models"), PathBuf::from);
    if folder.is_dir() {
        Some(folder)
    } else {
        println!("skipped: {} is not there; name the folder in PHYSIQUE_MODELS", folder.display());
        None
    }
}

/// Every file below `folder` with its bytes, sorted by path.
pub(crate) fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the test") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push((path.clone(), std::fs::read(&path).expect("a file of the test")));
            }
        }
    }
    found.sort();
    found
}
