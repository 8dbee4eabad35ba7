//! `docs/ci.md` is followed to the letter, in a new repository of two models.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::fs;
use std::path::Path;
use std::process::Command;

use util::workspace;

/// What the page asks its reader to do.
#[derive(Debug, PartialEq)]
enum Step {
    /// A line for the shell.
    Run(String),
    /// To be the text of `physique.yaml`.
    Configure(String),
}

/// Of the blocks before the forges' part.
fn steps(page: &str) -> Vec<Step> {
    let by_hand = page.split("\n## 4.").next().unwrap_or_default();
    let mut found = Vec::new();
    // Every second piece is inside a fence: its language, then its lines.
    for block in by_hand.split("```").skip(1).step_by(2) {
        match block.split_once('\n') {
            Some(("sh", lines)) => found.extend(lines.lines().map(|line| Step::Run(line.to_owned()))),
            Some(("yaml", text)) if text.starts_with("version:") => {
                found.push(Step::Configure(text.to_owned()));
            }
            _ => {}
        }
    }
    found
}

/// Ends as the shell does, with what it said.
fn shell(folder: &Path, line: &str) -> (Option<i32>, String) {
    let program = Path::new(env!("CARGO_BIN_EXE_physique"));
    let own = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::iter::once(program.parent().expect("a folder").to_path_buf());
    let path = std::env::join_paths(paths.chain(std::env::split_paths(&own))).expect("a path");
    let mut command = Command::new("sh");
    command.args(["-c", line]).current_dir(folder).env("PATH", path).env_remove("RUST_BACKTRACE");
    for (name, value) in [("NAME", "A Reader"), ("EMAIL", "reader@example.org")] {
        command.env(format!("GIT_AUTHOR_{name}"), value).env(format!("GIT_COMMITTER_{name}"), value);
    }
    let output = command.env("GIT_CONFIG_GLOBAL", "/dev/null").output().expect("a shell");
    let said = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8_lossy(&said).into_owned())
}

#[test]
fn steps_are_found_in_their_order_and_not_beyond_the_forges() {
    let page =
        "```sh\na b\n```\n```yaml\nversion: 1\n```\n```yaml\nother: 1\n```\n## 4. On\n```sh\nno\n```\n";
    assert_eq!(steps(page), [Step::Run("a b".to_owned()), Step::Configure("version: 1\n".to_owned())]);
}

#[test]
fn who_follows_the_page_has_a_gate() {
    if !matches!(Command::new("git").arg("--version").output(), Ok(output) if output.status.success()) {
        println!("skipped: git is not here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    let cube = fs::read(workspace().join("tests/data/cube.obj")).expect("a cube");
    for model in ["models/storage/crate.obj", "models/furniture/stool.obj"] {
        fs::create_dir_all(folder.join(model).parent().expect("a folder")).expect("made");
        fs::write(folder.join(model), &cube).expect("written");
    }
    shell(folder, "git init -q -b main . && git add . && git commit -q -m models");
    let page = fs::read_to_string(workspace().join("docs/ci.md")).expect("the page");
    let steps = steps(&page);
    assert!(steps.len() >= 8, "{steps:#?}");
    for step in &steps {
        match step {
            Step::Configure(text) => fs::write(folder.join("physique.yaml"), text).expect("written"),
            Step::Run(line) => {
                let (code, said) = shell(folder, line);
                // The two that speak of findings and differences end with 1 where there are any.
                let speaks = ["physique check", "physique diff"].iter().any(|verb| line.starts_with(verb));
                assert!(code == Some(0) || (speaks && code == Some(1)), "{line}: {code:?}\n{said}");
            }
        }
    }

    let locked =
        "physique check models --db .physique/catalogue.db --baseline physique-baseline.txt --locked";
    let (code, said) = shell(folder, locked);
    assert_eq!(code, Some(0), "{said}");
    shell(folder, "git checkout -q -b change");
    fs::write(folder.join("models/storage/crate.physics.yaml"), "friction_dynamic: 0.31\n").expect("written");
    let (code, said) = shell(folder, locked);
    assert!(code == Some(1) && said.contains("LCK008"), "{said}");
    for line in steps.iter().rev().take(2).rev() {
        let Step::Run(line) = line else { panic!("{line:?}") };
        let (code, said) = shell(folder, line);
        if line.starts_with("physique diff") {
            assert!(code == Some(1) && said.contains("dynamic friction"), "{said}");
        }
    }
}
