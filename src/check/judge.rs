//! From observations to findings: policy, suppressions, baseline, limits.

use std::collections::BTreeMap;
use std::fs;

use super::baseline::Baseline;
use super::case::Case;
use super::finding::Finding;
use super::gate::{Request, Seen};
use super::layer_set::Layers;
use super::observation::Observation;
use super::place::{Place, slashed};
use super::policy::Subject;
use super::report::{Looked, Report};
use super::rule::Rule;
use super::suppression;

/// Puts the findings and their counts into `report`, in the order of this file's first line.
pub(super) fn judge(request: &Request<'_>, layers: Layers, seen: Seen, report: &mut Report) {
    let Seen { observations, cases, proven, .. } = seen;
    let policy = &request.policy;
    let by_name: BTreeMap<&str, &Case> = cases.iter().map(|case| (case.row.model.as_str(), case)).collect();
    report.models = cases
        .iter()
        .map(|case| Looked {
            model: case.row.model.clone(),
            file: slashed(&case.file),
            category: case.category().to_owned(),
            proven: proven.contains(&case.row.model),
        })
        .collect();
    let judged = |observation: Observation| -> Option<Finding> {
        let case = by_name.get(observation.model.as_str());
        let subject = case.map_or_else(Subject::default, |case| case.subject());
        let mut finding = policy.judge(observation, subject)?;
        if let Some(case) = case {
            finding.model_file = Some(slashed(&case.file));
            case.category().clone_into(&mut finding.category);
        }
        Some(finding)
    };
    for observation in &observations {
        if let (Some(value), Some(rule)) = (observation.value, Rule::find(&observation.code)) {
            report.measured.entry(rule.code).or_default().push(value);
        }
    }
    let mut findings: Vec<Finding> = observations.into_iter().filter_map(&judged).collect();

    let (mut suppressions, faults) = comments(request);
    suppressions.extend(policy.suppressions.iter().cloned());
    let whole = request.changed_since.is_none() && request.job.is_some() && !report.stopped;
    let (suppressed, idle) = suppression::apply(&mut findings, &suppressions, layers, whole);
    report.suppressed = suppressed;
    findings.extend(faults.into_iter().chain(idle).filter_map(&judged));

    if let Some(file) = &request.baseline {
        let read = fs::read_to_string(file).map_err(|error| {
            let observation = Observation::fact("LCK012", format!("cannot be read: {error}"));
            Box::new(observation.at(Some(Place::file(file))))
        });
        match read.and_then(|text| Baseline::parse(file, &text)) {
            Err(fault) => findings.extend(judged(*fault)),
            Ok(baseline) => {
                let whole = whole && layers == Layers::ALL;
                let (accepted, aged) = baseline.apply(&mut findings, whole);
                report.accepted = accepted;
                findings.extend(aged.into_iter().filter_map(&judged));
            }
        }
    }
    policy.apply_limits(&mut findings, cases.len());
    let exceeded = |limit: &&super::Limit| {
        findings.iter().any(|f| {
            limit.selector.matches(f.rule, super::Severity::Warning) && f.severity == super::Severity::Error
        })
    };
    report.exceeded = policy.limits.iter().filter(exceeded).copied().collect();
    findings.sort_by(|a, b| a.order().cmp(&b.order()));
    report.findings = findings;
}

/// Suppressions in the comments of the rules and the override files.
fn comments(request: &Request<'_>) -> (Vec<suppression::Suppression>, Vec<Observation>) {
    let mut found = (Vec::new(), Vec::new());
    for file in request.places.catalog.iter().chain(&request.overrides) {
        let Ok(text) = fs::read_to_string(file) else { continue };
        let (suppressions, faults) = suppression::in_comments(&slashed(file), &text);
        found.0.extend(suppressions);
        found.1.extend(faults);
    }
    found
}
