//! One model in a process of its own, with limits on time and memory: for a model that was in work when a run died.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::catalogue::Failure;
use crate::{Asset, Options, import};

/// How to import one model elsewhere: a program that is given the model's path as its last argument and prints an
/// [`Answer`] as JSON.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alone {
    pub program: std::path::PathBuf,
    pub arguments: Vec<String>,
    pub seconds: u64,
    /// Of address space; held where there is a `sh` that can.
    pub memory_bytes: u64,
}

/// What the program says.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    Asset(Box<Asset>),
    Failure(Failure),
}

impl Answer {
    /// What the program on the other side does.
    #[must_use]
    pub fn of(path: &Path, options: &Options) -> Self {
        match import(path, options) {
            Ok(asset) => Self::Asset(Box::new(asset)),
            Err(error) => Self::Failure(Failure::from(&error)),
        }
    }
}

impl Alone {
    /// Imports the model; whatever happens to the process becomes a failure.
    pub(super) fn import(&self, path: &Path) -> Answer {
        let failed = |code: &str, reason: String| {
            Answer::Failure(Failure {
                code: code.to_owned(),
                place: String::new(),
                reason,
                way_out: "Re-export the model or leave it out; the file shows a fault in a library and is worth a report"
                    .to_owned(),
            })
        };
        let mut child = match self.command(path).spawn() {
            Ok(child) => child,
            Err(error) => return failed("crashed", format!("no process to import it alone: {error}")),
        };
        // Read beside waiting: a full pipe would keep the child from ending.
        let output = child.stdout.take().map(|mut pipe| {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                pipe.read_to_end(&mut bytes).map(|_| bytes)
            })
        });
        let Some(status) = self.wait(&mut child) else {
            // The reader is left to itself: a child of the child may hold the pipe open for long.
            return failed("runaway", format!("not done after {} s in a process of its own", self.seconds));
        };
        let bytes = output.and_then(|reading| reading.join().ok()).and_then(Result::ok).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_else(|_| {
            let limit = self.memory_bytes >> 20;
            failed(
                "crashed",
                format!("the process that imported it alone, in {limit} MiB, ended with {status}"),
            )
        })
    }

    fn command(&self, path: &Path) -> Command {
        let mut command = if cfg!(unix) {
            // The standard library sets no limits, and this crate has no unsafe code: the shell does it.
            let mut shell = Command::new("sh");
            let script = format!("ulimit -v {} 2>/dev/null; exec \"$@\"", self.memory_bytes >> 10);
            shell.args(["-c", &script, "sh"]).arg(&self.program);
            shell
        } else {
            Command::new(&self.program)
        };
        command
            .args(&self.arguments)
            .arg(path)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        command
    }

    /// `None` where it had to be killed.
    fn wait(&self, child: &mut Child) -> Option<String> {
        let due = Instant::now() + Duration::from_secs(self.seconds);
        loop {
            match child.try_wait() {
                Ok(Some(status)) => return Some(status.to_string()),
                Ok(None) if Instant::now() < due => thread::sleep(Duration::from_millis(20)),
                Ok(None) => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return None;
                }
                Err(error) => return Some(error.to_string()),
            }
        }
    }
}
