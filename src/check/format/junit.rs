//! JUnit: a suite a family and layer, a case a model. Errors and what else fails the gate are failures; what does
//! not is told in the case's output, so that a green build stays green.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::xml::escaped;
use super::{Style, shown};
use crate::check::finding::Finding;
use crate::check::report::Report;
use crate::check::rule::Layer;
use crate::check::severity::Severity;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, _) = shown(report, Style { show: Severity::Info, ..style });
    let suites: Vec<Suite<'_>> = Layer::ALL
        .into_iter()
        .filter(|layer| report.layers.holds(*layer))
        .map(|layer| Suite::new(report, layer, &findings))
        .collect();
    let tests: usize = suites.iter().map(|suite| suite.cases.len()).sum();
    let failures: usize = suites.iter().map(|suite| suite.failures(report)).sum();
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(
        out,
        "<testsuites name=\"physique check\" tests=\"{tests}\" failures=\"{failures}\" errors=\"0\" time=\"{:.3}\">",
        report.seconds
    )?;
    for suite in &suites {
        suite.write(out, report)?;
    }
    writeln!(out, "</testsuites>")
}

struct Suite<'a> {
    layer: Layer,
    seconds: f64,
    /// By model; files of rules for the static layer.
    cases: BTreeMap<&'a str, Vec<&'a Finding>>,
}

impl<'a> Suite<'a> {
    fn new(report: &'a Report, layer: Layer, findings: &[&'a Finding]) -> Self {
        let mut cases: BTreeMap<&str, Vec<&Finding>> = BTreeMap::new();
        match layer {
            Layer::Static => drop(cases.insert("rules and overrides", Vec::new())),
            Layer::Data => {
                cases.extend(report.models.iter().map(|looked| (looked.model.as_str(), Vec::new())))
            }
            Layer::Runtime => {
                let proven = report.models.iter().filter(|looked| looked.proven);
                cases.extend(proven.map(|looked| (looked.model.as_str(), Vec::new())));
            }
        }
        for finding in findings.iter().filter(|finding| finding.rule.layer == layer) {
            let name = match (layer, finding.model.as_str()) {
                (Layer::Static, "") => "rules and overrides",
                (_, "") => "whole database",
                (_, model) => model,
            };
            cases.entry(name).or_default().push(finding);
        }
        let seconds = report.seconds_a_layer.iter().find(|(name, _)| *name == layer.name());
        Self { layer, seconds: seconds.map_or(0.0, |(_, seconds)| *seconds), cases }
    }

    fn failures(&self, report: &Report) -> usize {
        let fails =
            |findings: &&Vec<&Finding>| findings.iter().any(|finding| finding.severity >= report.fail_on);
        self.cases.values().filter(fails).count()
    }

    #[expect(clippy::cast_precision_loss, reason = "a count of cases")]
    fn write(&self, out: &mut dyn Write, report: &Report) -> io::Result<()> {
        writeln!(
            out,
            "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\" time=\"{:.3}\">",
            self.layer,
            self.cases.len(),
            self.failures(report),
            self.seconds
        )?;
        let each = self.seconds / self.cases.len().max(1) as f64;
        for (name, findings) in &self.cases {
            write!(
                out,
                "    <testcase name=\"{}\" classname=\"physique.{}\" time=\"{each:.4}\"",
                escaped(name),
                self.layer
            )?;
            if findings.is_empty() {
                writeln!(out, "/>")?;
                continue;
            }
            writeln!(out, ">")?;
            let (failing, told): (Vec<&&Finding>, Vec<&&Finding>) =
                findings.iter().partition(|finding| finding.severity >= report.fail_on);
            // One failure a case: the common schema has no place for a second.
            if let Some(first) = failing.first() {
                let codes: Vec<&str> = failing.iter().map(|finding| finding.rule.code).collect();
                let text: Vec<String> = failing.iter().map(|finding| line(finding)).collect();
                writeln!(
                    out,
                    "      <failure type=\"{}\" message=\"{}\">{}</failure>",
                    codes.join(","),
                    escaped(&first.sentence()),
                    escaped(&text.join("\n"))
                )?;
            }
            if !told.is_empty() {
                let text: Vec<String> = told.iter().map(|finding| line(finding)).collect();
                writeln!(out, "      <system-out>{}</system-out>", escaped(&text.join("\n")))?;
            }
            writeln!(out, "    </testcase>")?;
        }
        writeln!(out, "  </testsuite>")
    }
}

fn line(finding: &Finding) -> String {
    let place = finding.place.as_ref().map_or_else(String::new, |place| format!("{place}: "));
    format!("{place}{} {}: {}. {}", finding.rule.code, finding.severity, finding.sentence(), finding.way_out)
}
