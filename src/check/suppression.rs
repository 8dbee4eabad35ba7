//! Findings that somebody has decided to live with, and why.

use globset::GlobMatcher;

use super::finding::Finding;
use super::layer_set::Layers;
use super::observation::Observation;
use super::place::Place;
use super::selector::Selector;

/// In a comment of a YAML file, on its line or on the one above: `# physique: allow MAS003: reason`.
const MARK: &str = "physique: allow";

/// One decision, in the configuration or in a comment.
#[derive(Clone, Debug)]
pub struct Suppression {
    pub selectors: Vec<Selector>,
    /// Of models, or of files for what belongs to no model; any of them. Empty: everywhere.
    pub models: Vec<GlobMatcher>,
    /// Findings that point at this line alone.
    pub line: Option<(String, u32)>,
    /// Where the decision is written.
    pub place: Place,
}

impl Suppression {
    fn covers(&self, finding: &Finding) -> bool {
        self.selectors.iter().any(|selector| selector.matches(finding.rule, finding.severity))
            && match &self.line {
                Some((file, line)) => {
                    finding.place.as_ref().is_some_and(|place| place.file == *file && place.line == *line)
                }
                None => {
                    let name = match finding.place.as_ref() {
                        Some(place) if finding.model.is_empty() => &place.file,
                        _ => &finding.model,
                    };
                    self.models.is_empty() || self.models.iter().any(|glob| glob.is_match(name))
                }
            }
    }

    fn codes(&self) -> String {
        self.selectors.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }

    /// Whether everything that it could suppress was looked for.
    fn was_tried(&self, layers: Layers) -> bool {
        self.selectors.iter().all(|selector| selector.rules().all(|rule| layers.holds(rule.layer)))
    }
}

/// Takes the suppressed out; gives how many, and an observation for every suppression that was not needed.
/// `whole`: every model was looked at, so that a suppression without a finding is one without need.
pub fn apply(
    findings: &mut Vec<Finding>,
    suppressions: &[Suppression],
    layers: Layers,
    whole: bool,
) -> (usize, Vec<Observation>) {
    let before = findings.len();
    let mut used = vec![false; suppressions.len()];
    findings.retain(|finding| {
        let mut covered = false;
        for (suppression, used) in suppressions.iter().zip(&mut used) {
            if suppression.covers(finding) {
                (covered, *used) = (true, true);
            }
        }
        !covered
    });
    let idle = suppressions
        .iter()
        .zip(&used)
        .filter(|(suppression, used)| !**used && whole && suppression.was_tried(layers))
        .map(|(suppression, _)| {
            Observation::fact(
                "MAP023",
                format!("nothing here is suppressed: no finding of {}", suppression.codes()),
            )
            .at(Some(suppression.place.clone()))
        })
        .collect();
    (before - findings.len(), idle)
}

/// The suppressions that stand in the comments of a file, and what is wrong with them.
#[must_use]
pub fn in_comments(file: &str, text: &str) -> (Vec<Suppression>, Vec<Observation>) {
    let mut found = Vec::new();
    let mut faults = Vec::new();
    for (number, line) in (1_u32..).zip(text.lines()) {
        let Some((before, comment)) = line.split_once('#') else { continue };
        let Some(rest) = comment.trim_start().strip_prefix(MARK) else { continue };
        let column = u32::try_from(before.chars().count() + 1).unwrap_or(0);
        let place = Place::at(file, number, column);
        let (codes, reason) = rest.split_once(':').unwrap_or((rest, ""));
        let selectors: Result<Vec<Selector>, String> = codes.split(',').map(str::parse).collect();
        match selectors {
            Err(error) => faults.push(Observation::fact("MAP005", error).at(Some(place))),
            Ok(_) if reason.trim().is_empty() => faults.push(
                Observation::fact("MAP024", format!("no reason is given for allowing {}", codes.trim()))
                    .at(Some(place))
                    .help(format!("write `# {MARK} {}: why`", codes.trim())),
            ),
            Ok(selectors) => {
                let meant = if before.trim().is_empty() { number + 1 } else { number };
                found.push(Suppression {
                    selectors,
                    models: Vec::new(),
                    line: Some((place.file.clone(), meant)),
                    place,
                });
            }
        }
    }
    (found, faults)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::rule::Rule;
    use crate::check::severity::Severity;

    fn finding(code: &str, line: u32) -> Finding {
        let rule = Rule::find(code).expect("a rule");
        let observation = Observation::fact(code, "told").at(Some(Place::at("catalog.yaml", line, 1)));
        Finding::new(observation, rule, Severity::Warning, None)
    }

    const TEXT: &str = "a: 1\n\
        b: 2  # physique: allow MAP008, MAP010: both are meant\n\
        # physique: allow ATT: a sheet of known friction\n\
        c: 3\n\
        d: 4  # physique: allow MAP008\n\
        e: 5  # physique: allow NIL001: why\n";

    #[test]
    fn a_comment_suppresses_its_own_line_or_the_next() {
        let (suppressions, faults) = in_comments("./catalog.yaml", TEXT);
        let codes: Vec<&str> = faults.iter().map(|fault| fault.code.as_str()).collect();
        assert_eq!(codes, ["MAP024", "MAP005"]);
        let mut findings = vec![finding("MAP008", 2), finding("MAP008", 1), finding("ATT003", 4)];
        let (suppressed, idle) = apply(&mut findings, &suppressions, Layers::ALL, true);
        assert_eq!((suppressed, findings.len()), (2, 1));
        assert!(idle.is_empty(), "{idle:?}");
    }

    #[test]
    fn what_is_not_needed_is_told_where_everything_was_tried() {
        let (suppressions, _) = in_comments("catalog.yaml", TEXT);
        let idle = |layers, whole| apply(&mut Vec::new(), &suppressions, layers, whole).1.len();
        assert_eq!(idle(Layers::ALL, true), 2);
        assert_eq!(idle(Layers::ALL, false), 0);
        let only_static = Layers::only(&[crate::check::Layer::Static]);
        assert_eq!(idle(only_static, true), 1, "ATT has rules of the data layer, which did not run");
    }
}
