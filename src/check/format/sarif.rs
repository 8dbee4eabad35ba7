//! SARIF 2.1.0 (OASIS), as code scanning takes it in: relative paths, rules with their pages, fingerprints that
//! survive moved lines.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::{Style, shown};
use crate::check::finding::Finding;
use crate::check::page;
use crate::check::report::Report;
use crate::check::rule::Rule;
use crate::check::severity::Severity;

const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, _) = shown(report, Style { show: Severity::Info, ..style });
    let mut used: Vec<&'static Rule> = Vec::new();
    for finding in &findings {
        if !used.iter().any(|rule| rule.code == finding.rule.code) {
            used.push(finding.rule);
        }
    }
    used.sort_by_key(|rule| rule.code);
    let index = |rule: &Rule| used.iter().position(|known| known.code == rule.code);
    let results: Vec<Value> = findings.iter().map(|finding| result(finding, index(finding.rule))).collect();
    let log = json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "physique",
                "version": env!("CARGO_PKG_VERSION"),
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "rules": used.iter().map(|rule| descriptor(rule)).collect::<Vec<_>>(),
            } },
            "columnKind": "unicodeCodePoints",
            "invocations": [{ "executionSuccessful": !report.stopped }],
            "results": results,
        }],
    });
    serde_json::to_writer_pretty(&mut *out, &log)?;
    writeln!(out)
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "note",
    }
}

fn descriptor(rule: &Rule) -> Value {
    let name: String = rule.name.split('-').map(|word| word[..1].to_uppercase() + &word[1..]).collect();
    json!({
        "id": rule.code,
        "name": name,
        "shortDescription": { "text": rule.says },
        "fullDescription": { "text": format!("{} {}", rule.says, rule.why) },
        "help": { "text": rule.way_out, "markdown": page::page(rule) },
        "defaultConfiguration": { "level": level(rule.severity) },
        "properties": { "tags": [rule.family().title(), rule.layer.name()] },
    })
}

fn result(finding: &Finding, index: Option<usize>) -> Value {
    let model = if finding.model.is_empty() { String::new() } else { format!("{}: ", finding.model) };
    let mut result = json!({
        "ruleId": finding.rule.code,
        "level": level(finding.severity),
        "message": { "text": format!("{model}{}. {}", finding.sentence(), finding.way_out) },
        "partialFingerprints": { "physique/v1": finding.fingerprint() },
    });
    if let Some(index) = index {
        result["ruleIndex"] = index.into();
    }
    if let Some(place) = finding.pointed_at() {
        let mut location = json!({ "artifactLocation": { "uri": uri(&place.file) } });
        if place.line > 0 {
            location["region"] = json!({ "startLine": place.line });
            if place.column > 0 {
                location["region"]["startColumn"] = place.column.into();
            }
        }
        result["locations"] = json!([{ "physicalLocation": location }]);
    }
    if !finding.model.is_empty() {
        result["properties"] = json!({ "model": finding.model, "category": finding.category });
    }
    result
}

/// A path as a URI reference: RFC 3986 lets letters, digits and few others stand.
fn uri(path: &str) -> String {
    let mut text = if path.starts_with('/') { "file://".to_owned() } else { String::new() };
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                text.push(char::from(byte))
            }
            _ => text.push_str(&format!("%{byte:02X}")),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn paths_become_uri_references() {
        assert_eq!(super::uri("models/a b#1.glb"), "models/a%20b%231.glb");
        assert_eq!(super::uri("/models/ü.glb"), "file:///models/%C3%BC.glb");
    }
}
