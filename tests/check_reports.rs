//! The reports of the gate and what the forges do with them: each is read by rules of its own format, and by its public
//! schema or consumer where that can be had.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

#[path = "seeded/faulty.rs"]
mod faulty;
#[allow(dead_code, reason = "the seeded tests use the rest")]
#[path = "seeded/world.rs"]
mod world;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use faulty::{arguments, faulty};
use serde_json::Value;
use util::{run_to, workspace};

#[test]
fn every_report_has_the_structure_of_its_format() {
    let folder = faulty().0;
    let root = folder.path();
    let names =
        ["full", "concise", "json", "jsonl", "junit", "sarif", "github", "gitlab", "markdown", "html"];
    let reports: Vec<String> = names.iter().map(|name| format!("{name}=out/report.{name}")).collect();
    let mut more = vec!["--format", "concise", "--deny", "MAS002"];
    reports.iter().for_each(|report| more.extend(["--report", report]));
    let run = run_to(root, &[1], &arguments(&more));
    let read = |name: &str| fs::read_to_string(root.join(format!("out/report.{name}"))).expect("a report");
    assert_eq!(read("concise"), run.stdout);
    let json: Value = serde_json::from_str(&read("json")).expect("JSON");
    let findings = json["findings"].as_array().expect("findings");
    let heavy = findings.iter().find(|finding| finding["code"] == "MAS002").expect("the heavy crate");
    assert_eq!(
        (&heavy["file"], &heavy["line"], &heavy["severity"]),
        (&"models/storage/crate_b.physics.yaml".into(), &1.into(), &"error".into())
    );
    assert!(heavy["measured"].as_f64() > heavy["bound"].as_f64() && heavy["way_out"].is_string());
    assert_eq!(read("jsonl").lines().count(), findings.len() + 1);
    let sarif: Value = serde_json::from_str(&read("sarif")).expect("JSON");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    assert_eq!(results.len(), findings.len());
    let rules = sarif["runs"][0]["tool"]["driver"]["rules"].as_array().expect("rules");
    for result in results {
        let index = usize::try_from(result["ruleIndex"].as_u64().expect("an index")).expect("small");
        assert_eq!(result["ruleId"], rules[index]["id"]);
    }
    let gitlab: Value = serde_json::from_str(&read("gitlab")).expect("JSON");
    for issue in gitlab.as_array().expect("issues") {
        for field in ["description", "check_name", "fingerprint", "severity"] {
            assert!(issue[field].is_string(), "{issue:#}");
        }
        assert!(
            issue["location"]["path"].is_string() && issue["location"]["lines"]["begin"].as_u64() >= Some(1)
        );
    }
    let github = read("github");
    assert!(
        github.lines().any(|line| line
            .starts_with("::error file=models/storage/crate_b.physics.yaml,line=1,col=7,title=MAS002")),
        "{github}"
    );
    let junit = read("junit");
    let count = |words: &str| junit.matches(words).count();
    assert_eq!(count("<testcase "), count("</testcase>") + count("/>"), "{junit}");
    assert!(count("<failure ") == 1 && junit.contains("failures=\"1\""), "{junit}");
    let full = read("full");
    assert!(full.contains("error[MAS002]") && full.contains("^") && full.contains("help"), "{full}");
    let html = read("html");
    assert!(
        html.contains("data:image/png;base64,") && html.ends_with("</html>\n") && !html.contains("http"),
        "one page that needs nothing else"
    );
    let markdown = read("markdown");
    assert!(markdown.contains("| `MAS002` mass-outside-range | error | 1 |"), "{markdown}");
}

/// Schemas and readers come by npm and PyPI: where they cannot be had the script says so, and so does this test.
#[test]
fn every_report_is_valid_by_its_public_schema_or_consumer() {
    let there =
        |program: &str| Command::new(program).arg("--version").output().is_ok_and(|out| out.status.success());
    if let Some(missing) = ["python3", "node", "npm"].into_iter().find(|program| !there(program)) {
        println!("skipped: {missing} is not here");
        return;
    }
    let Output { status, stdout, stderr } = Command::new("python3")
        .arg(workspace().join("scripts/check_formats.py"))
        .arg(env!("CARGO_BIN_EXE_physique"))
        .output()
        .expect("python3 starts");
    let told = String::from_utf8_lossy(&stdout);
    println!("{told}");
    assert!(status.success(), "{told}\n{}", String::from_utf8_lossy(&stderr));
    assert!(told.contains("are valid") || told.contains("skipped: "), "{told}");
}

/// What the forges run is in the repository: its commands are run here with the program that was built.
#[test]
fn the_script_of_action_and_include_gates_and_leaves_its_reports() {
    let folder = faulty().0;
    let root = folder.path();
    let binary = Path::new(env!("CARGO_BIN_EXE_physique"));
    let path = format!(
        "{}:{}",
        binary.parent().expect("a folder").display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let gate = |arguments: &str, forge: &str| {
        Command::new("bash")
            .arg(workspace().join("integrations/gate.sh"))
            .current_dir(root)
            .env("PATH", &path)
            .env("PHYSIQUE_MODELS", "models")
            .env("PHYSIQUE_ARGS", format!("--catalog catalog.yaml {arguments}"))
            .env("PHYSIQUE_DB", "cache/catalogue.db")
            .env("PHYSIQUE_OUT", "reports")
            .env("PHYSIQUE_FORGE", forge)
            .env("GITHUB_STEP_SUMMARY", root.join("summary.md"))
            .env("GITHUB_OUTPUT", root.join("outputs"))
            .output()
            .expect("bash starts")
    };
    let github = gate("--deny MAS002", "github");
    assert_eq!(github.status.code(), Some(1), "{}", String::from_utf8_lossy(&github.stderr));
    assert!(String::from_utf8_lossy(&github.stdout).contains("::error file="));
    let written = |file: &str| fs::read_to_string(root.join(file)).unwrap_or_default();
    assert!(written("summary.md").contains("physique check"));
    assert!(written("outputs").contains("sarif=reports/physique.sarif"), "{}", written("outputs"));
    assert!(
        written("reports/physique.sarif").contains("2.1.0")
            && written("reports/physique.html").contains("<html")
    );
    let gitlab = gate("", "gitlab");
    assert_eq!(gitlab.status.code(), Some(0));
    assert!(
        written("reports/gl-code-quality-report.json").starts_with('[')
            && written("reports/junit.xml").contains("<testsuites")
    );
    let wrong = gate("--profile hard", "github");
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn the_files_for_the_forges_say_what_they_should() {
    let read = |file: &str| {
        fs::read_to_string(workspace().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    };
    for file in ["action.yml", "integrations/gitlab.yml", ".pre-commit-hooks.yaml"] {
        mapper::parse_yaml(file, &read(file)).unwrap_or_else(|error| panic!("{error}"));
    }
    assert!(
        read("action.yml").contains("integrations/gate.sh")
            && read("action.yml").contains("using: composite")
    );
    assert!(
        read("integrations/gitlab.yml").contains("gate.sh")
            && read("integrations/gitlab.yml").contains("codequality:")
    );
    let hooks = read(".pre-commit-hooks.yaml");
    assert!(hooks.contains("entry: physique check --layer static") && hooks.contains("id: physique-check"));
}
