//! For people: the line with a caret under it, what was measured, what to do.

use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::{Style, concise, shown};
use crate::check::finding::Finding;
use crate::check::place::Place;
use crate::check::report::Report;
use crate::check::severity::Severity;

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let mut texts = Texts { built_in: report.built_in.as_deref(), files: HashMap::new() };
    let renderer = if style.colour { Renderer::styled() } else { Renderer::plain() };
    let (findings, hidden) = shown(report, style);
    for finding in findings {
        let snippet = finding.place.as_ref().and_then(|place| texts.around(place));
        writeln!(out, "{}\n", told(finding, snippet.as_ref(), &renderer))?;
    }
    concise::summary(out, report, hidden)
}

/// A line of a file with the words that are meant.
struct Around {
    line: String,
    number: usize,
    /// In bytes of the line.
    span: std::ops::Range<usize>,
    path: String,
}

fn told(finding: &Finding, around: Option<&Around>, renderer: &Renderer) -> String {
    let level = match finding.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Info => Level::INFO,
    };
    let title = if finding.model.is_empty() {
        finding.message.clone()
    } else {
        format!("{}: {}", finding.model, finding.message)
    };
    let mut group = level
        .primary_title(title.as_str())
        .id(finding.rule.code)
        .elements(Vec::<Snippet<'_, annotate_snippets::Annotation<'_>>>::new());
    let measure = finding.measure();
    if let Some(around) = around {
        let label = if finding.label.is_empty() { measure.as_str() } else { finding.label.as_str() };
        let snippet = Snippet::source(around.line.as_str())
            .line_start(around.number)
            .path(around.path.as_str())
            .annotation(AnnotationKind::Primary.span(around.span.clone()).label(label));
        group = group.element(snippet);
    } else {
        if let Some(place) = finding.place.clone().or_else(|| finding.pointed_at()) {
            group = group.element(annotate_snippets::Origin::path(place.to_string()));
        }
        if !measure.is_empty() {
            group = group.element(Level::NOTE.message(measure));
        }
    }
    group = group.element(Level::HELP.message(finding.way_out.as_str()));
    renderer.render(&[group])
}

/// Files that findings point into, read once.
struct Texts<'a> {
    built_in: Option<&'a str>,
    files: HashMap<String, Option<String>>,
}

impl Texts<'_> {
    fn around(&mut self, place: &Place) -> Option<Around> {
        let number = usize::try_from(place.line).ok().filter(|number| *number > 0)?;
        let text = if place.built_in {
            self.built_in
        } else {
            let read = || fs::read_to_string(&place.file).ok();
            self.files.entry(place.file.clone()).or_insert_with(read).as_deref()
        }?;
        let line = text.lines().nth(number - 1)?;
        let column = usize::try_from(place.column.max(1)).ok()? - 1;
        let start = line.char_indices().nth(column).map_or(line.len(), |(byte, _)| byte);
        let word = line[start..].find([',', '}', ']', '#']).map_or(line.len(), |end| start + end);
        let end = start + line[start..word].trim_end().len();
        let path = if place.built_in { format!("{} (built in)", place.file) } else { place.file.clone() };
        Some(Around { line: line.to_owned(), number, span: start..end.max(start), path })
    }
}
