//! The mapper's and the importer's own codes in the language of the gate.

use std::path::Path;

use importer::Failure;
use mapper::{Diagnostic, MapError};

use super::observation::Observation;
use super::place::{Place, Places};

/// What the gate says where the mapper says this. `None`: the gate measures it itself.
fn code_of_mapper(code: &str) -> Option<&'static str> {
    Some(match code {
        "CAT000" | "CAT010" | "CAT011" => "MAP002",
        "CAT001" | "CAT009" => "MAP001",
        "CAT002" => "MAP003",
        "CAT003" => "MAP004",
        "CAT004" => "ATT002",
        "CAT005" => "MAP005",
        "CAT006" => "MAP006",
        "CAT007" => "MAP007",
        "CAT008" | "MAP006" => "ATT001",
        "RUL001" => "MAP008",
        "RUL002" => "MAP009",
        "RUL003" => "MAP010",
        "RUL004" => "MAP011",
        "RUL005" => "MAP012",
        "RUL006" => "MAS012",
        "RUL007" => "ATT004",
        "RUL008" => "ATT005",
        "RUL009" => "MAP014",
        "RUL010" => "MAP013",
        "RUL011" => "MAP027",
        "MAP001" => "MAP020",
        "MAP002" => "GEO008",
        // The gate holds the masses against the range itself, with their values.
        "MAP003" => return None,
        "MAP004" => "MAS004",
        "MAP005" => "ATT003",
        "MAP007" => "ATT006",
        "MAP008" => "MAS007",
        "MAP009" => "MAS005",
        "MAP010" => "MAS006",
        "MAP020" => "MAP015",
        _ => "MAP026",
    })
}

/// A file of the mapper that could not be used: every fault in it.
#[must_use]
pub fn map_error(error: &MapError) -> Vec<Observation> {
    match error {
        MapError::Read { path, reason } => {
            vec![
                Observation::fact("MAP002", format!("cannot be read: {reason}"))
                    .at(Some(Place::file(path)))
                    .help(error.way_out()),
            ]
        }
        MapError::Invalid(list) => list.iter().map(|fault| diagnostic(fault, None)).collect(),
    }
}

/// `file`: where the mapper knows the name alone.
#[must_use]
pub fn diagnostic(fault: &Diagnostic, file: Option<&Path>) -> Observation {
    let named = file.map_or_else(|| fault.file.to_string(), |file| file.display().to_string());
    let mut observation =
        Observation::fact(code_of_mapper(fault.code).unwrap_or("MAP026"), fault.message.clone())
            .at(Some(Place::at(&named, fault.line, fault.column)))
            .help(fault.help.clone());
    observation.label.clone_from(&fault.label);
    observation
}

/// A finding of the mapper; `None` where the gate looks itself.
#[must_use]
pub fn finding(
    found: &mapper::Finding,
    places: &Places,
    model: Option<(&str, &Path)>,
) -> Option<Observation> {
    let code = code_of_mapper(&found.code)?;
    // What is not known of is told whole: nothing that the mapper says is lost.
    let message =
        if code == "MAP026" { format!("[{}] {}", found.code, found.message) } else { found.message.clone() };
    let place = found.place.as_ref().and_then(|by| places.of(by, model.map(|(_, file)| file)));
    let observation = Observation::fact(code, message).at(place);
    let observation = match &found.place {
        Some(by) => observation.because(&by.by),
        None => observation,
    };
    Some(match model {
        Some((model, _)) => observation.of(model),
        None => observation,
    })
}

/// A failure of the import, or of a stage after it.
#[must_use]
pub fn failure(model: &str, stage: &str, failure: &Failure) -> Observation {
    let code = match (stage, failure.code.as_str()) {
        ("map", code) => code_of_mapper(code).filter(|code| *code != "MAP026").unwrap_or("IMP012"),
        (_, "io" | "path-not-utf8") => "IMP001",
        (_, "unknown-format") => "IMP002",
        (_, "malformed") => "IMP003",
        (_, "unsupported") => "IMP004",
        (_, "missing-file") => "IMP005",
        (_, "no-triangles") => "IMP006",
        (_, "too-large") => "IMP007",
        ("import", "panic" | "crashed" | "runaway") => "IMP008",
        (_, "not-finite") => "IMP009",
        (_, "no-mass") => "MAS001",
        (_, "no-collider") => "COL001",
        (_, "no-extent") => "GEO017",
        (_, "no-surface" | "scene-refused") => "SIM001",
        _ => "IMP012",
    };
    let place = if failure.place.is_empty() { String::new() } else { format!("{}: ", failure.place) };
    Observation::fact(code, format!("{place}{}", failure.reason)).of(model).help(failure.way_out.clone())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::check::rule::Rule;

    /// Every code that stands in quotes in the mapper's sources.
    fn codes() -> Vec<String> {
        let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("mapper/src")];
        let mut found = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("the mapper") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let text = fs::read_to_string(path).expect("a source");
                found.extend(text.split('"').filter(|word| is_code(word)).map(str::to_owned));
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    fn is_code(word: &str) -> bool {
        word.len() == 6
            && ["CAT", "RUL", "MAP"].iter().any(|family| word.starts_with(family))
            && word[3..].bytes().all(|digit| digit.is_ascii_digit())
    }

    #[test]
    fn a_reader_that_crashed_or_never_ended_is_told_as_such() {
        for code in ["panic", "crashed", "runaway"] {
            let failed = Failure {
                code: code.to_owned(),
                place: String::new(),
                reason: "ended with signal 11".to_owned(),
                way_out: String::new(),
            };
            let seen = failure("a.glb", "import", &failed);
            assert_eq!((seen.code.as_str(), seen.model.as_str()), ("IMP008", "a.glb"), "{code}");
        }
    }

    #[test]
    fn every_code_of_the_mapper_is_known_here() {
        let codes = codes();
        assert!(codes.len() > 20, "{codes:?}");
        for code in codes {
            let ours = code_of_mapper(&code);
            assert_ne!(ours, Some("MAP026"), "{code} of the mapper needs a line in src/check/adopt.rs");
            assert!(ours.is_none_or(|ours| Rule::find(ours).is_some()), "{code}");
        }
    }
}
