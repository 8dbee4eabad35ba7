//! The gate as a team uses it: levels, limits, baseline, suppressions, locks, diffs, git, threads.

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

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use faulty::{arguments, faulty};
use util::{Run, run, run_to};
use world::World;

fn codes(run: &Run) -> Vec<String> {
    let findings = run.json()["findings"].as_array().expect("findings").clone();
    findings.iter().map(|finding| finding["code"].as_str().expect("a code").to_owned()).collect()
}

#[test]
fn exit_codes_follow_levels_limits_and_flags() {
    let (folder, _) = faulty();
    let root = folder.path();
    let checked = |codes: &[i32], more: &[&str]| run_to(root, codes, &arguments(more));
    checked(&[0], &["--layer", "static,data"]);
    checked(&[1], &["--layer", "static,data", "--deny", "warnings"]);
    checked(&[1], &["--layer", "static,data", "--fail-on", "warning"]);
    checked(&[0], &["--layer", "static,data", "--deny", "warnings", "--exit-zero"]);
    checked(&[0], &["--layer", "static,data", "--deny", "warnings", "--allow", "MAS,MAP"]);
    checked(&[1], &["--layer", "static,data", "--deny", "MAS002"]);
    checked(&[0], &["--layer", "static,data", "--error-if", "MAS002>20%"]);
    let over =
        checked(&[1], &["--layer", "static,data", "--error-if", "MAS002>10%", "--format", "json"]).json();
    assert_eq!(over["limits_exceeded"][0], "MAS002>10%");
    let one = checked(&[0], &["--layer", "static,data", "--max-issues", "1", "--format", "json"]);
    assert_eq!(codes(&one).len(), 1);
    assert!(one.json()["not_shown"].as_u64().is_some_and(|hidden| hidden > 0));
    let only = checked(&[0], &["--select", "MAS", "--ignore", "MAS011", "--format", "json"]);
    assert!(codes(&only).iter().all(|code| code.starts_with("MAS")), "{:?}", codes(&only));
    assert_eq!(
        only.json()["layers"],
        serde_json::json!(["static", "data"]),
        "no rule of MAS needs a simulation"
    );
    for wrong in [
        &["--deny", "MAS999"][..],
        &["--error-if", "MAS002"],
        &["--profile", "hard"],
        &["--report", "sarif"],
        &["--report", "pdf=x.pdf"],
        &["--changed-since", "main"],
        &["--ignore", "all"],
        &["--config", "nowhere.yaml"],
        &["--db", "catalog.yaml"],
    ] {
        let run = checked(&[2], wrong);
        assert!(!run.stderr.is_empty(), "{wrong:?}");
    }
}

#[test]
fn what_another_command_has_imported_is_not_imported_again() {
    let (folder, _) = faulty();
    let root = folder.path();
    run_to(root, &[0], &["lock", "models", "--db", "catalogue.db", "--catalog", "catalog.yaml", "--quiet"]);
    // A mark in what is stored, which a second import would wipe out.
    let catalogue = importer::Catalogue::open(&root.join("catalogue.db")).expect("the catalogue");
    let record = catalogue.record("storage/crate_a.glb").expect("read").expect("a record");
    let mut asset = catalogue.asset(&record.row.key.expect("a key")).expect("read").expect("an asset");
    asset.measures.inside_out_bodies = 1;
    catalogue.put_model(record, Some(asset)).expect("put");
    catalogue.flush().expect("flushed");
    drop(catalogue);
    let flags = ["--layer", "static,data", "--select", "GEO002", "--format", "json"];
    assert_eq!(codes(&run_to(root, &[0], &arguments(&flags))), ["GEO002"]);
}

#[test]
fn shapes_in_yaml_are_models_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut world = World::clean(11);
    let text =
        "shapes:\n  - { name: body, shape: box, size: [40 cm, 30 cm, 40 cm], position: [0, 0.15, 0] }\n";
    world.put("models/storage/crate_s.shapes.yaml", text);
    world.write(folder.path());
    let flags = ["--layer", "static,data", "--select", "IMP", "--format", "json"];
    let json = run_to(folder.path(), &[0], &arguments(&flags)).json();
    assert_eq!((json["models"].as_u64(), json["errors"].as_u64()), (Some(8), Some(0)), "{json:#}");
    let named = [&["check", "models/storage/crate_s.shapes.yaml", "--db", "one.db"][..], &flags].concat();
    assert_eq!(
        run_to(folder.path(), &[0], &named).json()["models"],
        1,
        "named by itself it is no file of rules"
    );
}

#[test]
fn a_baseline_accepts_today_and_fails_on_what_is_new() {
    let (folder, mut world) = faulty();
    let root = folder.path();
    let flags = ["--layer", "static,data", "--deny", "warnings", "--baseline", "baseline.txt"];
    run_to(root, &[1], &arguments(&["--layer", "static,data", "--deny", "warnings"]));
    run_to(root, &[0], &arguments(&[&flags[..], &["--update-baseline"]].concat()));
    let accepted = run_to(root, &[0], &arguments(&[&flags[..], &["--format", "json"]].concat())).json();
    assert!(accepted["accepted"].as_u64().is_some_and(|accepted| accepted >= 2), "{accepted:#}");
    // Lines that move bring nothing back.
    let text = world.text("catalog.yaml");
    world.put("catalog.yaml", &format!("# a comment\n{text}"));
    world.put("models/storage/crate_b.physics.yaml", "# weighed again\n\nmass: 150 kg\n");
    world.write(root);
    run_to(root, &[0], &arguments(&flags));
    world.put_box("misc/q18.glb", [0.21, 0.15, 0.2]);
    world.write(root);
    run_to(root, &[1], &arguments(&flags));
}

#[test]
fn suppressions_and_scopes_of_the_configuration_hold() {
    let (folder, mut world) = faulty();
    let root = folder.path();
    world.put(
        "physique.yaml",
        "version: 1\nscopes:\n  - category: storage\n    bounds: { MAS002: 30 x }\nsuppress:\n  - { code: [MAP020, MAP022], reason: a sample }\n  - { code: MAS004, match: 'storage/**', reason: filled }\n",
    );
    world.write(root);
    let run = run_to(root, &[0], &arguments(&["--deny", "warnings", "--format", "json"]));
    assert!(
        !codes(&run).iter().any(|code| ["MAS002", "MAP020", "MAP023"].contains(&code.as_str())),
        "{:?}",
        codes(&run)
    );
    assert!(run.json()["suppressed"].as_u64() >= Some(1));
}

#[test]
fn a_second_check_simulates_nothing_and_a_changed_preset_only_what_it_reaches() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let mut world = World::clean(12);
    world.write(root);
    let told = |more: &[&str]| run_to(root, &[0], &arguments(&[&["--format", "json"], more].concat())).json();
    let first = told(&[]);
    assert_eq!((&first["simulated"], &first["unchanged"]), (&4.into(), &0.into()), "{first:#}");
    assert_eq!(first["not_simulated"], serde_json::json!({ "fixed in place": 1, "fluid": 1, "soft": 1 }));
    let again = told(&[]);
    assert_eq!((&again["simulated"], &again["unchanged"]), (&0.into(), &4.into()));
    let text = world.text("catalog.yaml");
    let from = text.find("  ceramic:").expect("a preset");
    let (before, after) = text.split_at(from);
    world.put(
        "catalog.yaml",
        &format!("{before}{}", after.replacen("restitution: { value: 0.", "restitution: { value: 0.0", 1)),
    );
    world.write(root);
    let changed = told(&[]);
    assert_eq!(
        (&changed["simulated"], &changed["unchanged"]),
        (&1.into(), &3.into()),
        "the brick alone is ceramic"
    );
}

#[test]
fn verdicts_do_not_flicker_over_runs_and_threads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let mut world = World::clean(13);
    world.put("models/storage/crate_b.physics.yaml", "restitution: 0.9\n");
    world.reshape("storage/crate_a.glb", |mesh| {
        mesh.positions.iter_mut().filter(|p| p[1] > 0.1).for_each(|p| p[0] += 0.55)
    });
    world.write(root);
    let told: BTreeSet<String> = (0..10)
        .map(|index| {
            let (db, threads) = (format!("run{index}.db"), (1 + index % 4).to_string());
            let args = [
                "check",
                "models",
                "--db",
                &db,
                "--catalog",
                "catalog.yaml",
                "--quiet",
                "--format",
                "jsonl",
                "--threads",
                &threads,
            ];
            let run = run(root, &args);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
            run.stdout
        })
        .collect();
    assert_eq!(told.len(), 1, "{told:#?}");
}

fn git(root: &Path, args: &[&str]) {
    let identity = ["-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "init.defaultBranch=main"];
    let output =
        Command::new("git").arg("-C").arg(root).args(identity).args(args).output().expect("git starts");
    assert!(output.status.success(), "git {args:?}: {}", String::from_utf8_lossy(&output.stderr));
}

fn commit(root: &Path, message: &str) {
    git(root, &["add", "-A"]);
    git(root, &["commit", "-qm", message]);
}

#[test]
fn only_what_changed_since_a_commit_is_looked_at_and_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let mut world = World::clean(14);
    world.put("models/storage/crate_b.physics.yaml", "mass: 150 kg\n");
    world.put(".gitignore", "*.db*\n");
    world.write(root);
    git(root, &["init", "-q"]);
    commit(root, "first");
    let told = |more: &[&str]| {
        let run = run_to(
            root,
            &[0],
            &arguments(&[&["--format", "json", "--changed-since", "HEAD"], more].concat()),
        );
        (run.json()["models"].as_u64().expect("a count"), codes(&run))
    };
    assert_eq!(told(&[]), (0, Vec::new()), "nothing changed, whatever was wrong before");
    // A model, its sidecar, and the rules: each touches its own.
    world.put("models/storage/crate_b.physics.yaml", "mass: 160 kg\n");
    world.write(root);
    let (models, found) = told(&["--layer", "static,data"]);
    assert!(models == 1 && found.contains(&"MAS002".to_owned()), "{models} {found:?}");
    commit(root, "second");
    let text = world.text("catalog.yaml").replace("preset: ceramic", "preset: concrete");
    world.put("catalog.yaml", &text);
    world.write(root);
    assert_eq!(told(&["--layer", "data"]).0, 1, "the brick alone is mapped otherwise");
    commit(root, "third");
    world.put("catalog.yaml", &format!("# a comment\n{text}"));
    world.write(root);
    assert_eq!(told(&["--layer", "data"]).0, 0, "a comment maps nothing otherwise");
}

#[test]
fn a_diff_tells_the_change_in_words_for_locks_catalogues_rules_and_commits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let mut world = World::clean(15);
    world.put(".gitignore", "*.db*\n");
    world.write(root);
    let rules = ["--db", "catalogue.db", "--catalog", "catalog.yaml", "--quiet"];
    let lock = |file: &str| run_to(root, &[0], &[&["lock", "models", "--output", file][..], &rules].concat());
    lock("physique.lock");
    git(root, &["init", "-q"]);
    commit(root, "first");
    fs::copy(root.join("catalogue.db"), root.join("before.db")).expect("copied");
    fs::copy(root.join("catalog.yaml"), root.join("before.yaml")).expect("copied");
    let text = world.text("catalog.yaml");
    let oak = text.find("  oak:").expect("a preset");
    let at = oak + text[oak..].find("density: { value: ").expect("a density") + "density: { value: ".len();
    let end = at + text[at..].find(" kg").expect("a unit");
    world.put("catalog.yaml", &format!("{}1400{}", &text[..at], &text[end..]));
    world.write(root);
    lock("after.lock");
    for [before, after] in [
        ["physique.lock", "after.lock"],
        ["before.db", "catalogue.db"],
        ["before.yaml", "catalog.yaml"],
        ["HEAD", "after.lock"],
        ["physique.lock", "models"],
    ] {
        let told = run_to(root, &[1], &[&["diff", before, after][..], &rules].concat()).stdout;
        assert!(told.starts_with("2 crates: density "), "{before} {after}: {told}");
        assert!(told.contains("to 1,400 kg/m3 by preset oak (catalog.yaml:"), "{before} {after}: {told}");
        // One of the two has a mass of its own, which its density does not move.
        assert!(told.contains("; mass of 1 of them "), "{before} {after}: {told}");
    }
    let checked = run_to(
        root,
        &[1],
        &[&["diff", "before.yaml", "catalog.yaml", "--check", "--format", "json"][..], &rules].concat(),
    );
    assert!(checked.json()["groups"][0]["fails"].is_object());
    let markdown = run_to(
        root,
        &[1],
        &[&["diff", "physique.lock", "after.lock", "--format", "markdown"][..], &rules].concat(),
    );
    assert!(markdown.stdout.starts_with("## What the change does"), "{}", markdown.stdout);
    run_to(root, &[0], &[&["diff", "after.lock", "after.lock"][..], &rules].concat());
    run_to(root, &[2], &[&["diff", "nowhere", "after.lock"][..], &rules].concat());
    run_to(root, &[1], &arguments(&["--locked=physique.lock", "--layer", "data"]));
    run_to(root, &[0], &arguments(&["--locked=after.lock", "--layer", "data"]));
}

#[test]
fn files_that_a_commit_hook_names_are_told_for_what_they_are() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let mut world = World::clean(16);
    world.write(root);
    let files =
        ["catalog.yaml", "models/overrides.yaml", "models/storage/crate_b.physics.yaml", "physique.yaml"];
    let hook = |codes: &[i32]| {
        run_to(root, codes, &[&["check", "--layer", "static", "--format", "concise"][..], &files].concat())
            .stdout
    };
    hook(&[0]);
    world.edit("models/storage/crate_b.physics.yaml", "mass:", "mas:");
    world.write(root);
    assert!(hook(&[1]).starts_with("models/storage/crate_b.physics.yaml:2:1: MAP003 error: "));
    world.edit("models/overrides.yaml", "match:", "matches:");
    world.write(root);
    assert!(hook(&[1]).contains("models/overrides.yaml:3:5: MAP003"));
}

#[test]
fn a_model_that_cannot_be_read_is_a_finding_and_not_the_end() {
    let (folder, mut world) = faulty();
    world.put_model("storage/broken.glb", b"glTF".to_vec());
    world.write(folder.path());
    let run = run_to(folder.path(), &[1], &arguments(&["--format", "json"]));
    assert!(codes(&run).contains(&"IMP003".to_owned()), "{:?}", codes(&run));
    run_to(
        folder.path(),
        &[2],
        &["check", "models", "--catalog", "catalog.yaml", "--floor", "cheese", "--quiet"],
    );
}

#[test]
fn ten_thousand_models_are_compared_in_words() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let lock = |density: f64| {
        let mut text = "# physique lock 1\n# tool 0.1.0\n# catalogue 0\n".to_owned();
        for index in 0..10_000 {
            let mug = index % 80 == 0;
            let (category, preset, density) =
                if mug { ("kitchen/mug", "ceramic", density) } else { ("storage/crate", "oak", 700.0) };
            let mass = density * 1e-3 * (1.0 + f64::from(index % 7));
            text.push_str(&format!(
                "m/{index:05}.glb\t0123456789abcdef\tsubcategory:x\t{category}\t{preset}\t{:016x}\tdensity={density} kg/m3\tmass={mass} kg\n",
                mass.to_bits()
            ));
        }
        text
    };
    fs::write(root.join("a.lock"), lock(700.0)).expect("written");
    fs::write(root.join("b.lock"), lock(2180.0)).expect("written");
    let told = run_to(root, &[1], &["diff", "a.lock", "b.lock", "--quiet"]).stdout;
    assert!(told.starts_with("125 mugs: density 700 to 2,180 kg/m3 by preset ceramic"), "{told}");
    assert!(told.contains("; mass up 3.1 times"), "{told}");
    assert!(told.ends_with("125 models changed for 1 reason; 9,875 unchanged, 0 new, 0 gone\n"), "{told}");
}

#[test]
fn what_is_not_there_is_no_clean_gate() {
    let (folder, _) = faulty();
    let root = folder.path();
    fs::create_dir(root.join("empty")).expect("made");
    for (args, word) in [
        (&["check", "--db", "typo.db"][..], "no such catalogue"),
        (&["check", "empty", "--db", "empty.db"], "no model"),
        (&["lock", "empty", "--db", "empty.db"], "no model"),
        (&["check", "nowhere"], "no such file"),
        (&["check"], "nothing to check"),
        (&["explain", "MAS02"], "MAS002"),
    ] {
        let run = run_to(root, &[2], args);
        assert!(run.stderr.contains(word), "{args:?}: {}", run.stderr);
    }
    assert!(!root.join("typo.db").exists() && !root.join("physique.lock").exists());
    let missing = run_to(root, &[1], &arguments(&["--layer", "static", "--baseline", "typo.txt"]));
    assert!(missing.stdout.contains("LCK012"), "{}", missing.stdout);
}

#[test]
fn a_catalogue_alone_is_mapped_with_the_overrides_of_its_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path();
    let world = World::clean(17);
    let rules = ["--db", "catalogue.db", "--catalog", "catalog.yaml", "--quiet"];
    world.write(root);
    run_to(root, &[0], &[&["lock", "models"][..], &rules].concat());
    let locked = fs::read_to_string(root.join("physique.lock")).expect("the lock");
    assert!(locked.contains(" by override:tools/*.glb"), "{locked}");
    run_to(root, &[0], &[&["lock"][..], &rules].concat());
    assert_eq!(fs::read_to_string(root.join("physique.lock")).expect("the lock"), locked);
    run_to(root, &[0], &[&["diff", "physique.lock", "catalog.yaml"][..], &rules].concat());
    run_to(root, &[0], &[&["check", "--locked", "--layer", "data", "--exit-zero"][..], &rules].concat());
}
