//! The pages of the findings are those that the program prints. `UPDATE_DOCS=1` writes them.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::collections::BTreeSet;
use std::fs;

use physique::check::{Rule, config, page};
use util::{run_to, workspace};

#[test]
fn the_pages_are_current_and_none_is_left_over() {
    let folder = workspace().join(page::FOLDER);
    let documents = page::documents();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::create_dir_all(&folder).expect("a folder");
        for (name, text) in &documents {
            fs::write(folder.join(name), text).expect("written");
        }
    }
    for (name, text) in &documents {
        let there = fs::read_to_string(folder.join(name)).unwrap_or_default();
        let differs = there.lines().zip(text.lines()).find(|(old, new)| old != new);
        assert!(
            there == *text,
            "{}/{name} is not current: run with UPDATE_DOCS=1. Its first other line: {differs:#?}",
            page::FOLDER
        );
    }
    let known: BTreeSet<String> = documents.into_iter().map(|(name, _)| name).collect();
    let there: BTreeSet<String> = fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(there, known);
}

#[test]
fn explain_prints_the_page_of_every_rule() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for code in ["MAS002", "sim004", "no-rest"] {
        let rule = Rule::find(code).or_else(|| Rule::all().find(|rule| rule.name == code)).expect("a rule");
        let told = run_to(folder.path(), &[0], &["explain", code]).stdout;
        assert_eq!(told, page::page(rule));
        assert!(told.contains(rule.way_out) && told.contains(rule.says), "{told}");
    }
    let list = run_to(folder.path(), &[0], &["explain", "rules"]).stdout;
    assert_eq!(list.lines().count(), Rule::all().count());
}

#[test]
fn the_example_of_another_bound_is_one_that_the_configuration_takes() {
    for rule in Rule::all().filter(|rule| rule.bound.is_some()) {
        let page = page::page(rule);
        let example = page
            .split('`')
            .find(|words| words.starts_with("bounds:"))
            .unwrap_or_else(|| panic!("{} shows no other bound", rule.code));
        let text = format!("version: 1\n{example}\n");
        if let Err(error) = config::parse("physique.yaml", &text, None) {
            panic!("{example}: {error}");
        }
    }
}
