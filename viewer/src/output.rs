//! Where a recording goes: a file, a viewer that is opened, one that runs already, or several of these.

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use rerun::log::{ChunkBatcherConfig, LogMsg};
use rerun::sink::{FileSink, GrpcSink, LogSink, SinkFlushError};
use rerun::{ApplicationId, RecordingStream, RecordingStreamBuilder};

use crate::error::ViewerError;
use crate::program::{self, open_command};

/// Where to record to. All that are set are served at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Output {
    /// A `.rrd` file; an old one is replaced once the new one is whole.
    pub file: Option<PathBuf>,
    /// Open a viewer window.
    pub view: bool,
    /// `HOST:PORT` or `rerun+http://HOST:PORT/proxy` of a viewer that runs.
    pub connect: Option<String>,
}

/// What a finished recording came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Written {
    pub file: Option<PathBuf>,
    /// Length of the file.
    pub bytes: u64,
    /// Frames kept, of all models.
    pub frames: u64,
}

/// An opened output.
pub(crate) struct Opened {
    pub(crate) stream: RecordingStream,
    pub(crate) file: Option<PathBuf>,
    /// Where the file grows: `NAME.part.rrd` beside it, which a viewer can open while it does.
    part: Option<PathBuf>,
    pub(crate) live: bool,
    pub(crate) notices: Vec<String>,
    /// What a live viewer could not be told at the end.
    pub(crate) live_fault: Arc<Mutex<Option<String>>>,
    /// Held while the file is written, so that a second run does not write into it.
    _lock: Option<File>,
}

/// How long a live viewer may take to accept the rest at the end.
const FLUSH: Duration = Duration::from_secs(20);

impl Output {
    /// Opens all that was asked for. A viewer that cannot be opened is a notice where there is another output.
    pub(crate) fn open(&self, title: &str) -> Result<Opened, ViewerError> {
        let mut sinks: Vec<Box<dyn LogSink>> = Vec::new();
        let mut notices = Vec::new();
        let live_fault = Arc::default();
        // Addresses first: a wrong one must not cost the old file.
        let remote = self.connect.as_deref().map(|address| connect(address, &live_fault)).transpose()?;
        let part = self.file.as_deref().map(growing);
        let place = self.file.as_deref().zip(part.as_deref());
        let lock = place.map(|(path, part)| claim(path, part)).transpose()?;
        if let Some((path, part)) = place {
            let sink = FileSink::new(part).map_err(|error| ViewerError::Unwritable {
                path: path.to_owned(),
                source: std::io::Error::other(error.to_string()),
            })?;
            sinks.push(Box::new(sink));
        }
        let mut live = remote.is_some();
        sinks.extend(remote);
        if self.view {
            match program::spawn_viewer() {
                Ok(spawned) => {
                    sinks.push(connect(&spawned.url, &live_fault)?);
                    notices.extend(spawned.notice);
                    live = true;
                }
                Err(reason) if sinks.is_empty() => return Err(ViewerError::NoViewer { reason }),
                Err(reason) => {
                    let error = ViewerError::NoViewer { reason };
                    let later = self.file.as_deref().map(open_command);
                    let hint = later.map(|command| format!("; the file is written all the same: {command}"));
                    notices.push(format!("{error}{}", hint.unwrap_or_default()));
                }
            }
        }
        if sinks.is_empty() {
            return Err(ViewerError::NoOutput);
        }
        let stream = RecordingStreamBuilder::new(ApplicationId::new_or_unknown("physique".to_owned()))
            .recording_name(title)
            .set_sinks(sinks)
            .map_err(ViewerError::encode)?;
        // Only the run's own timelines: the clock's would differ from run to run.
        stream.set_log_time_enabled(false);
        stream.set_log_tick_enabled(false);
        Ok(Opened { stream, file: self.file.clone(), part, live, notices, live_fault, _lock: lock })
    }
}

impl Opened {
    /// Writes the rest and, in dropping the stream, the file's footer; then the file takes its name.
    pub(crate) fn close(self, frames: u64) -> Result<(Written, Option<String>), ViewerError> {
        let flushed = self.stream.flush_with_timeout(Duration::MAX);
        drop(self.stream);
        let fault = self.live_fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        let bytes = match self.file.as_ref().zip(self.part.as_ref()) {
            None => 0,
            Some((path, part)) => {
                let unwritten = |reason: String| ViewerError::Write { path: path.clone(), reason };
                flushed.map_err(|error| unwritten(error.to_string()))?;
                if part != path {
                    std::fs::rename(part, path).map_err(|error| unwritten(error.to_string()))?;
                }
                std::fs::metadata(path).map_err(|error| unwritten(error.to_string()))?.len()
            }
        };
        Ok((Written { file: self.file, bytes, frames }, fault))
    }
}

/// A run that is killed leaves the old recording whole. What is no plain file, as a pipe, is written to directly.
fn growing(path: &Path) -> PathBuf {
    match std::fs::symlink_metadata(path) {
        Ok(there) if !there.is_file() => path.to_owned(),
        _ => path.with_extension("part.rrd"),
    }
}

/// Opens the growing file without changing it, to learn whether it may be written and whether another run is doing so.
fn claim(path: &Path, part: &Path) -> Result<File, ViewerError> {
    let unwritable = |source| ViewerError::Unwritable { path: path.to_owned(), source };
    let file = OpenOptions::new().create(true).append(true).open(part).map_err(unwritable)?;
    // Elsewhere a lock would keep the writer's own second handle out.
    #[cfg(unix)]
    if let Err(std::fs::TryLockError::WouldBlock) = file.try_lock() {
        return Err(ViewerError::Busy { path: path.to_owned() });
    }
    Ok(file)
}

/// A sink to a viewer that answers.
fn connect(address: &str, fault: &Arc<Mutex<Option<String>>>) -> Result<Box<dyn LogSink>, ViewerError> {
    let url =
        if address.contains("://") { address.to_owned() } else { format!("rerun+http://{address}/proxy") };
    let bad = |reason: String| ViewerError::Address { address: address.to_owned(), reason };
    let sink = GrpcSink::new(url.parse().map_err(|error| bad(format!("{error}")))?);
    let rest = url.split_once("://").map_or(url.as_str(), |(_, rest)| rest);
    reach(rest.split('/').next().unwrap_or(rest))
        .map_err(|reason| ViewerError::Unreachable { address: address.to_owned(), reason })?;
    Ok(Box::new(Live { sink, fault: Arc::clone(fault) }))
}

/// Whether something listens at `HOST:PORT`.
fn reach(host: &str) -> Result<(), String> {
    use std::net::{TcpStream, ToSocketAddrs};
    let addresses = host.to_socket_addrs().map_err(|error| error.to_string())?;
    let mut reason = "the name has no address".to_owned();
    for address in addresses {
        match TcpStream::connect_timeout(&address, Duration::from_secs(2)) {
            Ok(_) => return Ok(()),
            Err(error) => reason = error.to_string(),
        }
    }
    Err(reason)
}

/// A viewer's sink whose faults do not spoil the file: a window that was closed is no error.
struct Live {
    sink: GrpcSink,
    fault: Arc<Mutex<Option<String>>>,
}

impl LogSink for Live {
    fn send(&self, message: LogMsg) {
        self.sink.send(message);
    }

    fn flush_blocking(&self, timeout: Duration) -> Result<(), SinkFlushError> {
        if let Err(error) = self.sink.flush_blocking(timeout.min(FLUSH)) {
            *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
        }
        Ok(())
    }

    fn default_batcher_config(&self) -> ChunkBatcherConfig {
        self.sink.default_batcher_config()
    }
}
