//! Runs one scene in this build of rapier: a request on stdin, its answer on stdout (see `baseline::wire`).

#![forbid(unsafe_code)]

use std::io::{self, Read as _, Write};
use std::process::ExitCode;
use std::time::Duration;

use baseline::Baseline;
use baseline::wire::{Request, Want};

fn main() -> ExitCode {
    let mut out = io::BufWriter::new(io::stdout().lock());
    if std::env::args().any(|argument| argument == "--version") {
        return end(writeln!(out, "{}", baseline::version()).and_then(|()| out.flush()));
    }
    let mut text = String::new();
    let read = io::stdin().read_to_string(&mut text).map_err(|error| error.to_string());
    let answered = read.and_then(|_| Request::parse(&text)).and_then(|request| answer(&request, &mut out));
    match answered {
        Ok(()) => end(out.flush()),
        Err(reason) => {
            drop(writeln!(io::stderr(), "{reason}"));
            ExitCode::from(2)
        }
    }
}

/// A reader that has gone has read enough.
fn end(written: io::Result<()>) -> ExitCode {
    if written.is_ok() { ExitCode::SUCCESS } else { ExitCode::from(2) }
}

fn answer(request: &Request, out: &mut impl Write) -> Result<(), String> {
    let mut baseline = Baseline::stiffer(&request.scene, &request.settings, request.stiffness)?;
    for _ in 0..request.steps {
        let begin = cpu_time();
        let acted = baseline.step();
        let spent = cpu_time().saturating_sub(begin);
        let written = match request.want {
            Want::Times => out.write_all(&(spent.as_secs_f64() * 1e3).to_le_bytes()),
            Want::States => write_state(out, &baseline, request.scene.entities.len(), acted),
        };
        written.map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn write_state(out: &mut impl Write, baseline: &Baseline, entities: usize, acted: bool) -> io::Result<()> {
    out.write_all(&[u8::from(acted)])?;
    for index in 0..entities {
        let (pose, velocity, _) = baseline.state(index);
        let numbers =
            pose.position.iter().chain(&pose.rotation).chain(&velocity.linear).chain(&velocity.angular);
        for number in numbers {
            out.write_all(&number.to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn cpu_time() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

#[cfg(not(unix))]
fn cpu_time() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
