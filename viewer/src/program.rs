//! The `rerun` program: whether it is there, which version, how to open a file with it.

use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use rerun::{SpawnOptions, spawn};

/// Version of the recordings written here; a viewer of another version may refuse or misread them.
pub const RERUN_VERSION: &str = "0.36.3";

/// How to get the viewer.
pub const INSTALL_HINT: &str =
    "`pip install rerun-sdk==0.36.3` or `cargo install rerun-cli --version 0.36.3 --locked`";

/// The exact command that opens a recording, quoted for a POSIX shell where it must be.
#[must_use]
pub fn open_command(path: &Path) -> String {
    let text = path.to_string_lossy();
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%=".contains(c);
    let dashed = if text.starts_with('-') { format!("./{text}") } else { text.into_owned() };
    if !dashed.is_empty() && dashed.chars().all(plain) {
        format!("rerun {dashed}")
    } else {
        format!("rerun '{}'", dashed.replace('\'', r"'\''"))
    }
}

/// Version of the `rerun` on PATH, as `0.36.3`; `None` where there is none or it does not say.
#[must_use]
pub fn viewer_version() -> Option<String> {
    let output =
        Command::new("rerun").arg("--version").stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    version_of(&String::from_utf8_lossy(&output.stdout))
}

/// Finds the version in what `rerun --version` prints; a first run prints a greeting before it.
fn version_of(text: &str) -> Option<String> {
    let mut words = text.split_whitespace().skip_while(|word| !word.starts_with("rerun"));
    words.find(|word| word.starts_with(|c: char| c.is_ascii_digit())).map(str::to_owned)
}

/// What to tell a user whose viewer is of another version.
fn mismatch(found: &str) -> Option<String> {
    (found != RERUN_VERSION).then(|| {
        format!(
            "the rerun viewer on PATH is {found}, the recording is of {RERUN_VERSION}: it may not open; \
             install {RERUN_VERSION} with {INSTALL_HINT}"
        )
    })
}

/// A viewer that was started, or found listening.
pub(crate) struct Spawned {
    pub(crate) url: String,
    /// What the user should know, if anything.
    pub(crate) notice: Option<String>,
}

/// Opens a viewer window that outlives this process, or finds the one that is open.
///
/// # Errors
/// The reason, as text, where there is no screen, no `rerun` on PATH, or it cannot be started.
pub(crate) fn spawn_viewer() -> Result<Spawned, String> {
    let options = SpawnOptions { wait_for_bind: true, hide_welcome_screen: true, ..SpawnOptions::default() };
    let url = |port: u16| format!("rerun+http://127.0.0.1:{port}/proxy");
    let address = options.connect_addr();
    if TcpStream::connect_timeout(&address, Duration::from_millis(500)).is_ok() {
        return Ok(Spawned { url: url(options.port), notice: None });
    }
    let Some(version) = viewer_version() else {
        return Err("there is no `rerun` on PATH".to_owned());
    };
    if cfg!(target_os = "linux")
        && ["DISPLAY", "WAYLAND_DISPLAY"].iter().all(|v| std::env::var_os(v).is_none())
    {
        return Err("there is no screen: neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned());
    }
    let info = spawn(&options).map_err(|error| error.to_string())?;
    TcpStream::connect_timeout(&address, Duration::from_secs(2))
        .map_err(|error| format!("it was started and does not answer at {address}: {error}"))?;
    Ok(Spawned { url: url(info.port), notice: mismatch(&version) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_is_found_behind_a_greeting() {
        let text = "\n Welcome to Rerun!\n 3 things\nrerun-cli 0.36.3 (base) [rustc 1.95.0 (59807616e)]\n";
        assert_eq!(version_of(text).as_deref(), Some("0.36.3"));
        assert_eq!(version_of("command not found"), None);
    }

    #[test]
    fn another_version_is_named_with_ours() {
        assert_eq!(mismatch(RERUN_VERSION), None);
        let text = mismatch("0.41.0").unwrap_or_default();
        assert!(text.contains("0.41.0") && text.contains(RERUN_VERSION), "{text}");
    }
}
