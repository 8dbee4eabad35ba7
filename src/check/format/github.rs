//! Workflow commands: GitHub shows them at the line in the pull request. It shows ten of each level a step, so
//! findings of one rule at one line are told once, the most frequent first.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::{Style, concise, shown};
use crate::check::finding::Finding;
use crate::check::place::Place;
use crate::check::report::Report;
use crate::check::severity::Severity;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, hidden) = shown(report, style);
    let mut groups: BTreeMap<(Severity, &str, Option<Place>), Vec<&Finding>> = BTreeMap::new();
    for finding in findings {
        groups.entry((finding.severity, finding.rule.code, finding.pointed_at())).or_default().push(finding);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|((severity, ..), found)| {
        (std::cmp::Reverse(*severity), std::cmp::Reverse(found.len()))
    });
    for ((severity, code, place), found) in groups {
        let Some(first) = found.first() else { continue };
        let command = match severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Info => "notice",
        };
        let mut properties = Vec::new();
        if let Some(place) = &place {
            properties.push(format!("file={}", property(&place.file)));
            if place.line > 0 {
                properties.push(format!("line={}", place.line));
            }
            if place.column > 0 {
                properties.push(format!("col={}", place.column));
            }
        }
        properties.push(format!("title={}", property(&format!("{code} {}", first.rule.name))));
        let model = if first.model.is_empty() { String::new() } else { format!("{}: ", first.model) };
        let others = match found.len() {
            1 => String::new(),
            count => format!(" (and {} more here)", count - 1),
        };
        let message = format!("{model}{}{others}. {}", first.sentence(), first.way_out);
        writeln!(out, "::{command} {}::{}", properties.join(","), data(&message))?;
    }
    concise::summary(out, report, hidden)
}

/// As the runner unescapes the message of a command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// As the runner unescapes a property of a command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    #[test]
    fn properties_and_messages_are_escaped_as_the_runner_wants() {
        assert_eq!(super::property("a,b:c%"), "a%2Cb%3Ac%25");
        assert_eq!(super::data("50 %, a:b\nnext"), "50 %25, a:b%0Anext");
    }
}
