//! The shared model sample, where it is there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of sample models: `PHYSIQUE_MODELS`, else `shared/models` beside the workspace.
pub fn models() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/models");
    let root = std::env::var_os("PHYSIQUE_MODELS").map_or(beside, PathBuf::from);
    if root.join("FACTS.csv").is_file() {
        return Some(root);
    }
    println!("skipped: no FACTS.csv in {}; set PHYSIQUE_MODELS to the sample models", root.display());
    None
}

/// Rows of a CSV file by column name; fields may be quoted.
pub fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(fields);
    let names = lines.next().unwrap();
    lines.map(|values| names.iter().cloned().zip(values).collect()).collect()
}

fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            _ => fields.last_mut().unwrap().push(letter),
        }
    }
    fields
}
