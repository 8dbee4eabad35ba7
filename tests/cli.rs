//! The command as scripts see it: exit codes, what goes where, bad input.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop at the first surprise"
)]

mod util;

use std::io::Read as _;
use std::process::Stdio;

use util::{physique, run, run_to, workspace};

fn data(name: &str) -> String {
    workspace().join("tests/data").join(name).display().to_string()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn help_and_version_are_results_and_a_wrong_flag_is_a_message() {
    let folder = folder();
    for args in [&["--help"][..], &["help", "run"], &["run", "--help"], &["--version"]] {
        let run = run_to(folder.path(), &[0], args);
        assert!(!run.stdout.is_empty() && run.stderr.is_empty(), "{args:?}: {}", run.stderr);
    }
    for args in [&[][..], &["ran"], &["run", "--fast"], &["run"], &["simulate", "x.yaml", "--time", "soon"]] {
        let run = run_to(folder.path(), &[2], args);
        assert!(run.stdout.is_empty() && !run.stderr.is_empty(), "{args:?}: {}", run.stdout);
    }
}

#[test]
fn what_is_not_there_is_named() {
    let folder = folder();
    let cases = [
        (vec!["run", "nowhere"], "nowhere"),
        (vec!["import", "nowhere"], "nowhere"),
        (vec!["simulate", "no.yaml"], "no.yaml"),
        (vec!["explain", "no.glb"], "no.glb"),
        (vec!["view", "no.rrd"], "no.rrd"),
        (vec!["doctor", "--catalog", "no-rules.yaml"], "no-rules.yaml"),
    ];
    for (args, name) in cases {
        let run = run_to(folder.path(), &[2], &args);
        assert!(run.stderr.contains(name), "{args:?} does not name {name}: {}", run.stderr);
        assert!(run.stdout.is_empty(), "{args:?}: {}", run.stdout);
    }
    let left = std::fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(left, 0, "a command that could not run has written something");
}

#[test]
fn a_fault_in_yaml_is_shown_at_its_place_with_a_way_out() {
    let folder = folder();
    let run = run_to(folder.path(), &[2], &["simulate", &data("wrong.yaml")]);
    for expected in ["wrong.yaml:5", "spehre", "sphere"] {
        assert!(run.stderr.contains(expected), "no {expected:?} in: {}", run.stderr);
    }
    assert!(!run.stderr.contains('\u{1b}'), "colour on a pipe");
}

#[test]
fn a_broken_pipe_is_no_error() {
    let folder = folder();
    // The schema is longer than any pipe's buffer is sure to take, and the reader stops after one byte.
    let mut child = physique(folder.path(), &["schema", "catalog"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut stdout = child.stdout.take().expect("a pipe");
    let mut first = [0];
    stdout.read_exact(&mut first).expect("a byte");
    drop(stdout);
    let mut messages = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut messages).expect("text");
    let status = child.wait().expect("it ends");
    assert_eq!((status.code(), messages.as_str()), (Some(0), ""));
}

#[test]
fn free_fall_is_exact_and_every_pose_is_written() {
    let folder = folder();
    let args = ["simulate", &data("fall.yaml"), "--poses", "poses.csv", "--format", "json"];
    let told = run_to(folder.path(), &[0], &args).json();
    assert_eq!(told["steps"], 120);
    for field in ["median", "mean", "p99", "max"] {
        assert!(told["ms_per_step"][field].as_f64().is_some_and(|ms| ms > 0.0), "no {field}");
    }
    assert_eq!(told["max_penetration_m"], 0.0);

    let poses = std::fs::read_to_string(folder.path().join("poses.csv")).expect("the poses");
    let mut lines = poses.lines();
    assert_eq!(lines.next(), Some("step,time,entity,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,sleeping"));
    let ball: Vec<Vec<&str>> =
        lines.map(|line| line.split(',').collect::<Vec<_>>()).filter(|row| row[2] == "ball").collect();
    assert_eq!(ball.len(), 121);
    let number = |row: &[&str], field: usize| row[field].parse::<f64>().expect("a number");
    for row in &ball {
        let time = number(row, 1);
        let height = 100.0 - 0.5 * 9.81 * time * time;
        assert!((number(row, 4) - height).abs() < 1e-5, "{row:?}");
        assert!((number(row, 11) + 9.81 * time).abs() < 1e-5, "{row:?}");
    }
}

#[test]
fn the_plan_says_what_a_scene_needs_and_what_was_done() {
    let folder = folder();
    let args = ["simulate", &data("fall.yaml"), "--explain"];
    let text = run_to(folder.path(), &[0], &args).stdout;
    for expected in
        ["flight", "parabola from the launch state", "constant spin", "leaves out", "phase", "broad phase"]
    {
        assert!(text.contains(expected), "no {expected:?} in:\n{text}");
    }
    let told = run_to(folder.path(), &[0], &[&args[..], &["--format", "json"]].concat()).json();
    let explained = &told["explained"];
    let count = |what: &str| {
        let rows = explained["work"].as_array().expect("counts");
        rows.iter().find(|row| row["what"] == what).expect(what)["count"].as_u64().expect("a number")
    };
    assert_eq!((count("flights"), count("bodies through small steps")), (120, 0), "{explained:#}");
    let shares =
        explained["phases"].as_array().expect("phases").iter().filter_map(|row| row["share"].as_f64());
    assert!((shares.sum::<f64>() - 1.0).abs() < 1e-9, "{explained:#}");
}

#[test]
fn a_model_is_dropped_and_compared_with_rapier() {
    let folder = folder();
    let args = ["simulate", &data("cube.obj"), "--time", "3s", "--validate", "--format", "json"];
    let told = run_to(folder.path(), &[0], &args).json();
    assert_eq!((&told["entities"], &told["rapier"]["agree"]), (&2.into(), &1.into()), "{told:#}");
    let rest = &told["bodies"]["bodies"][0];
    assert!((rest["height_m"].as_f64().expect("a height") - 0.25).abs() < 1e-3, "{rest:#}");
    assert!(told["rapier"]["parameters"].as_array().is_some_and(|rows| rows.len() > 10));
    assert!(!folder.path().join("physique-out").exists(), "nothing was to be written");
}

#[test]
fn explain_shows_every_value_with_its_line_and_what_it_overrode() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("storage")).expect("a folder");
    std::fs::copy(data("cube.obj"), folder.path().join("storage/crate.obj")).expect("a model");
    std::fs::write(folder.path().join("storage/crate.physics.yaml"), "mass: 4.25 kg\n").expect("a sidecar");
    let run = run_to(folder.path(), &[0], &["explain", "storage/crate.obj"]);
    for expected in ["4.25 kg", "crate.physics.yaml:1", "density", "catalog.yaml:", "over ", "colliders"] {
        assert!(run.stdout.contains(expected), "no {expected:?} in:\n{}", run.stdout);
    }
    let set = run_to(folder.path(), &[0], &["explain", "storage/crate.obj", "--set", "mass=9 kg"]);
    assert!(set.stdout.contains("9 kg") && set.stdout.contains("--set"), "{}", set.stdout);
}

#[test]
fn doctor_and_view_say_how_things_stand() {
    let folder = folder();
    let doctor = run_to(folder.path(), &[0], &["doctor", "--format", "json"]).json();
    assert_eq!(doctor["physique"], env!("CARGO_PKG_VERSION"));
    assert!(doctor["rules"]["categories"].as_u64().is_some_and(|categories| categories >= 30), "{doctor:#}");
    std::fs::write(folder.path().join("a b.rrd"), b"RRF2").expect("a file");
    let view = run_to(folder.path(), &[0], &["view", "a b.rrd", "--print"]);
    assert!(view.stdout.starts_with("rerun ") && view.stdout.contains("a b.rrd"), "{}", view.stdout);
}

#[test]
fn schemas_are_json() {
    let folder = folder();
    for of in ["catalog", "overrides", "scene"] {
        let schema = run_to(folder.path(), &[0], &["schema", of]).json();
        assert!(schema["$schema"].is_string(), "{of}");
    }
}

#[test]
fn quiet_is_quiet() {
    let folder = folder();
    let run = run(folder.path(), &["import", &data("cube.obj"), "--quiet"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
}
