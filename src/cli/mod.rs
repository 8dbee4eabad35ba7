//! The command line: one file a verb.

mod args;
mod check;
mod demo;
mod diff;
mod doctor;
mod explain;
mod given;
mod import;
mod interrupt;
mod job;
mod lock;
mod map;
mod merge;
mod one;
mod output;
mod progress;
mod report;
mod report_colliders;
mod run;
mod schema;
mod set;
mod simulate;
mod view;

use std::io;
use std::process::ExitCode;

use clap::Parser as _;

use args::{Cli, Format, Verb};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    Clean,
    Findings,
    Interrupted,
}

const COULD_NOT_RUN: u8 = 2;
const INTERRUPTED: u8 = 130;

/// Reads the command line, does what it says and gives the exit code: 0 done and clean, 1 findings, 2 could not
/// run, 130 interrupted.
#[must_use]
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are results, a wrong flag is a message: clap knows which goes where. A reader
            // that has gone is no error.
            drop(error.print());
            return ExitCode::from(if error.use_stderr() { COULD_NOT_RUN } else { 0 });
        }
    };
    match dispatch(&cli) {
        Ok(End::Clean) => ExitCode::SUCCESS,
        Ok(End::Findings) => ExitCode::from(1),
        Ok(End::Interrupted) => ExitCode::from(INTERRUPTED),
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            output::error(&error);
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

fn dispatch(cli: &Cli) -> anyhow::Result<End> {
    let global = &cli.global;
    let speaks = match (&cli.verb, global.format) {
        (Verb::Check(_), _) | (_, Format::Text | Format::Json) => true,
        (Verb::Diff(_), format) => format == Format::Markdown,
        _ => false,
    };
    if !speaks {
        anyhow::bail!(
            "this verb has --format text and json; `check` has the others, `diff` markdown as well"
        );
    }
    match &cli.verb {
        Verb::Run(args) => run::run(global, args),
        Verb::Import(args) => import::import(global, args),
        Verb::ImportAlone(args) => import::import_alone(args),
        Verb::Merge(args) => merge::merge(global, args),
        Verb::Map(args) => map::map(global, args),
        Verb::Simulate(args) => simulate::simulate(global, args),
        Verb::Set(args) => set::set(global, args),
        Verb::Get(args) => set::get(global, args),
        Verb::Check(args) => check::check(global, args),
        Verb::Lock(args) => lock::lock(global, args),
        Verb::Diff(args) => diff::diff(global, args),
        Verb::Explain(args) if check::is_about_rules(&args.model) => check::explain(&args.model),
        Verb::Explain(args) => explain::explain(global, args),
        Verb::Report(args) => report::report(global, args),
        Verb::Demo(args) => demo::demo(global, args),
        Verb::View(args) => view::view(global, args),
        Verb::Doctor => doctor::doctor(global),
        Verb::Schema(args) => schema::schema(global, args),
    }
}

/// Whoever read our output has read enough.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
