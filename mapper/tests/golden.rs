//! Golden tables: every shipped preset, and what a sample of names and sizes is mapped to by the shipped rules.
//! A change to the catalogue changes them on purpose: a mismatch prints the new lines, and with `GOLDEN_WRITE=1`
//! the tests write them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test may stop and say so"
)]

use std::collections::BTreeSet;
use std::path::Path;

use mapper::{Mapper, Overrides, Ruleset, map_table};

fn compare(file: &str, now: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(file);
    if std::env::var_os("GOLDEN_WRITE").is_some() {
        std::fs::write(&path, now.join("\n") + "\n").unwrap();
    }
    let golden = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let golden: Vec<&str> = golden.lines().collect();
    let known: BTreeSet<&str> = golden.iter().copied().collect();
    let new: Vec<&str> = now.iter().map(String::as_str).filter(|line| !known.contains(line)).collect();
    assert!(
        golden.iter().copied().eq(now.iter().map(String::as_str)),
        "{file}, new lines:\n{}",
        new.join("\n")
    );
}

#[test]
fn every_shipped_preset() {
    let rules = Ruleset::embedded().unwrap_or_else(|error| panic!("{error}"));
    let lines: Vec<String> = rules
        .presets
        .iter()
        .map(|preset| {
            let figures: Vec<String> = mapper::ATTRIBUTES
                .iter()
                .filter_map(|spec| preset.number(spec.name).map(|value| format!("{} {value}", spec.name)))
                .collect();
            format!("{} ({}): {}", preset.name, preset.kind, figures.join(", "))
        })
        .collect();
    compare("presets.txt", &lines);
}

/// Head nouns, phrases, materials, units, folders, and names that say nothing.
const SAMPLE: &str = "\
id,path,name,text,dim_x,dim_y,dim_z,solid_volume_m3
plain,,armchair,,0.9,0.8,1,
material,,oak armchair,,0.9,0.8,1,
head,,dog bowl,,0.2,0.2,0.07,
toy,,toy car,,0.1,0.05,0.04,
of,,box of flour,,0.2,0.1,0.05,
reversed,,Lamp_Table_01,,0.5,0.3,0.3,
camel,,steelWrench02,,0.2,0.04,0.01,
plural,,wooden spoons,,0.3,0.06,0.02,
cm,,coffee mug,,9.5,8,10,
mm,,dining chair,,450,500,900,
inches,,dining chair,,18,20,35,
suspect,,dining chair,,20000000,1,1,
small,,car,,0.0001,0.0001,0.0001,
folder,furniture/tables/a7.glb,,,1.2,0.8,0.75,
unknown,,xyzzy 123,,0.3,0.3,0.3,
tag,,model_4,bathtub,1.7,0.7,0.6,
liquid,,olive oil,,,,,
soft,,throw pillow,,0.45,0.45,0.15,
bottle,,wine bottle,,0.08,0.08,0.3,
plant,,rose,,0.3,0.2,0.5,
animal,,cow,,2.4,0.8,1.5,
vehicle,,pickup truck,,5.3,2,1.9,
solid,,golf ball,,0.043,0.043,0.043,0.0000406
inverted,,\"Pears, raw, red\",,0.08,0.07,0.1,
identifier,,Wooden_Train_Set_xK3fPq9LmZa,,0.3,0.1,0.1,
dash,,Medieval Sword - Game Ready,,1,0.2,0.05,
counted,,Gas Stove 4 burners,,0.6,0.6,0.9,
brand,,Forklift Toyota,,3,1.2,2.1,
class,,Mallard duck,,0.55,0.3,0.3,
alloy,,Radiator cast iron,,0.9,0.2,0.7,
";

#[test]
fn a_sample_of_rules() {
    let rules = Ruleset::embedded().unwrap_or_else(|error| panic!("{error}"));
    let mapper = Mapper::new(rules, Overrides::none());
    let answers = map_table(&mapper, "sample", SAMPLE, &[]).unwrap_or_else(|error| panic!("{error}"));
    // The last column names a line, which every edit above it moves.
    let lines: Vec<String> = answers
        .lines()
        .map(|line| {
            line.split("catalog.yaml:").next().unwrap_or_default().trim_end_matches(['"', ',']).to_owned()
        })
        .collect();
    compare("rules.txt", &lines);
}
