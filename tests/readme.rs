//! Every command of the README is run, in order, in one empty folder.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;
use std::process::Command;

use util::{physique, workspace};

/// The lines of the README's `sh` blocks that start with the command, as its arguments.
fn commands(readme: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut in_shell = false;
    for line in readme.lines() {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            in_shell = !in_shell && language.trim() == "sh";
            continue;
        }
        let line = line.split(" #").next().unwrap_or_default().trim();
        let arguments =
            line.strip_prefix("cargo run --release -- ").or_else(|| line.strip_prefix("physique "));
        if let Some(arguments) = arguments.filter(|_| in_shell) {
            found.push(arguments.split_whitespace().map(str::to_owned).collect());
        }
    }
    found
}

#[test]
fn commands_are_found_in_shell_blocks_alone() {
    let readme = "physique no\n```sh\ncargo run --release -- demo   # first\ncargo test --release\n\
                  physique explain a/b.glb\n```\n```yaml\nphysique no\n```\n";
    assert_eq!(commands(readme), [vec!["demo"], vec!["explain", "a/b.glb"]]);
}

#[test]
fn every_command_of_the_readme_runs() {
    let path = workspace().join("README.md");
    let readme = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let commands = commands(&readme);
    assert!(!commands.is_empty(), "the README shows no command");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for arguments in &commands {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let mut command: Command = physique(folder.path(), &arguments);
        let output = command.output().expect("the command starts");
        assert_eq!(
            output.status.code(),
            Some(0),
            "physique {} ended with {:?}\n{}\n{}",
            arguments.join(" "),
            output.status.code(),
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
    }
}
