//! Today's findings, accepted: only new ones make the gate fail.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::finding::Finding;
use super::observation::Observation;
use super::place::Place;
use super::severity::Severity;

const HEADER: &str = "# physique baseline 1";

/// Accepted findings by fingerprint, with the line that each stands on and its words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Baseline {
    file: String,
    accepted: BTreeMap<String, (u32, String)>,
}

impl Baseline {
    /// Reads a baseline's text.
    ///
    /// # Errors
    /// An [`Observation`] of the first line that makes no sense.
    pub fn parse(path: &Path, text: &str) -> Result<Self, Box<Observation>> {
        let file = super::place::slashed(path);
        let wrong = |line: u32, message: String| {
            Box::new(Observation::fact("LCK012", message).at(Some(Place::at(&file, line, 0))))
        };
        let mut lines = (1_u32..).zip(text.lines());
        if lines.next().is_none_or(|(_, first)| first != HEADER) {
            return Err(wrong(1, format!("expected the first line to be {HEADER:?}")));
        }
        let mut accepted = BTreeMap::new();
        for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#')) {
            let (fingerprint, rest) = line.split_once(' ').unwrap_or((line, ""));
            let well_formed = fingerprint.len() == 16 && fingerprint.bytes().all(|b| b.is_ascii_hexdigit());
            if !well_formed || rest.is_empty() {
                let message =
                    format!("expected a fingerprint of 16 digits, a code and a model, found {line:?}");
                return Err(wrong(number, message));
            }
            accepted.insert(fingerprint.to_owned(), (number, rest.to_owned()));
        }
        Ok(Self { file, accepted })
    }

    /// The text of a baseline that accepts those of these findings that are at least so bad, sorted by model.
    #[must_use]
    pub fn text(findings: &[Finding], least: Severity) -> String {
        let mut lines: Vec<(&str, &str, String)> = findings
            .iter()
            .filter(|found| found.severity >= least)
            .map(|found| {
                let model = if found.model.is_empty() { "-" } else { &found.model };
                (model, found.rule.code, found.fingerprint())
            })
            .collect();
        lines.sort_unstable();
        lines.dedup();
        let mut text = format!(
            "{HEADER}\n# Findings that are accepted for now: fingerprint, code, model. Written by \
             `physique check --update-baseline`.\n"
        );
        for (model, code, fingerprint) in lines {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{fingerprint} {code} {model}");
        }
        text
    }

    /// Takes the accepted out; gives how many, and an observation for every entry that nothing needs any more.
    /// `whole`: everything that the baseline could know of was looked at.
    pub fn apply(&self, findings: &mut Vec<Finding>, whole: bool) -> (usize, Vec<Observation>) {
        let mut idle = self.accepted.clone();
        let before = findings.len();
        findings.retain(|finding| {
            let fingerprint = finding.fingerprint();
            idle.remove(&fingerprint);
            !self.accepted.contains_key(&fingerprint)
        });
        let aged = idle.into_values().filter(|_| whole).map(|(line, words)| {
            Observation::fact("LCK011", format!("{words}: is accepted and not found any more"))
                .at(Some(Place::at(&self.file, line, 0)))
        });
        (before - findings.len(), aged.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::rule::Rule;

    fn finding(model: &str) -> Finding {
        let rule = Rule::find("MAP020").expect("a rule");
        Finding::new(Observation::fact("MAP020", "told").of(model), rule, Severity::Warning, None)
    }

    #[test]
    fn what_is_accepted_is_left_out_and_what_has_gone_is_told() {
        let text =
            Baseline::text(&[finding("b.glb"), finding("a b.glb"), finding("b.glb")], Severity::Warning);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert_eq!(
            Baseline::text(&[finding("b.glb")], Severity::Error).lines().count(),
            2,
            "what cannot fail"
        );
        let baseline = Baseline::parse(Path::new("base"), &text).expect("read");
        let mut findings = vec![finding("a b.glb"), finding("c.glb")];
        let (accepted, aged) = baseline.apply(&mut findings, true);
        assert_eq!((accepted, findings.len(), aged.len()), (1, 1, 1));
        assert!(aged[0].message.contains("MAP020 b.glb"), "{aged:?}");
        assert!(baseline.apply(&mut Vec::new(), false).1.is_empty());
    }

    #[test]
    fn a_broken_baseline_is_a_finding_at_its_line() {
        for (text, line) in [("", 1), ("findings\n", 1), ("# physique baseline 1\n\nxyz MAP020 a\n", 3)] {
            let fault = Baseline::parse(Path::new("base"), text).expect_err("refused");
            assert_eq!((fault.code.as_str(), fault.place.map(|place| place.line)), ("LCK012", Some(line)));
        }
    }
}
