//! `physique view`: opens a recording, or says how.

use anyhow::{Result, bail};

use super::End;
use super::args::{Global, ViewArgs};

/// # Errors
/// There is no such recording, or the viewer that is there cannot be started.
#[cfg(feature = "viewer")]
pub(super) fn view(global: &Global, args: &ViewArgs) -> Result<End> {
    use std::process::{Command, Stdio};

    use anyhow::Context as _;

    use super::output;

    if !args.recording.is_file() {
        bail!("{}: no such recording; `physique run MODELS` writes one", args.recording.display());
    }
    let command = viewer::open_command(&args.recording);
    let version = viewer::viewer_version();
    if args.print || version.is_none() {
        if version.is_none() && !global.quiet {
            output::notice(&format!("no viewer found: {}", viewer::INSTALL_HINT));
        }
        output::result(|out| writeln!(out, "{command}"))?;
        return Ok(End::Clean);
    }
    if version.as_deref() != Some(viewer::RERUN_VERSION) && !global.quiet {
        let found = version.unwrap_or_default();
        output::notice(&format!(
            "the viewer is {found}, the recording {}: if it does not open, {}",
            viewer::RERUN_VERSION,
            viewer::INSTALL_HINT
        ));
    }
    Command::new("rerun")
        .arg(&args.recording)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .with_context(|| format!("cannot start the viewer; the command was: {command}"))?;
    Ok(End::Clean)
}

/// # Errors
/// Always: this build has no viewer.
#[cfg(not(feature = "viewer"))]
pub(crate) fn view(_: &Global, args: &ViewArgs) -> Result<End> {
    bail!("this build has no viewer; with rerun installed: rerun {}", args.recording.display())
}
