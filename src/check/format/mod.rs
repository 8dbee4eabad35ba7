//! The report, in the language of who reads it.

mod concise;
mod full;
mod github;
mod gitlab;
mod html;
mod json;
mod junit;
mod markdown;
mod picture;
mod png;
mod sarif;
mod xml;

use std::fmt;
use std::io::{self, Write};
use std::str::FromStr;

use super::finding::Finding;
use super::report::Report;
use super::severity::Severity;

/// A language of reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The place with a caret, the measure, the way out.
    Full,
    /// A line a finding.
    Concise,
    Json,
    /// One JSON object a line: findings, then the summary.
    Jsonl,
    /// JUnit's XML: a test case a model and layer.
    Junit,
    /// SARIF 2.1.0.
    Sarif,
    /// Workflow commands that GitHub turns into annotations.
    Github,
    /// GitLab's code quality report.
    Gitlab,
    /// For a job's summary or a comment.
    Markdown,
    /// One page with pictures of the offenders.
    Html,
}

/// How much is shown and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Findings below are counted and not shown; formats for machines have all.
    pub show: Severity,
    /// Most findings that are shown.
    pub most: Option<usize>,
    pub colour: bool,
}

impl Format {
    pub const ALL: [Self; 10] = [
        Self::Full,
        Self::Concise,
        Self::Json,
        Self::Jsonl,
        Self::Junit,
        Self::Sarif,
        Self::Github,
        Self::Gitlab,
        Self::Markdown,
        Self::Html,
    ];

    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Concise => "concise",
            Self::Json => "json",
            Self::Jsonl => "jsonl",
            Self::Junit => "junit",
            Self::Sarif => "sarif",
            Self::Github => "github",
            Self::Gitlab => "gitlab",
            Self::Markdown => "markdown",
            Self::Html => "html",
        }
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|format| format.name() == text).ok_or_else(|| {
            format!("no format is called {text:?}; expected {}", Self::ALL.map(Self::name).join(", "))
        })
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Writes the report.
///
/// # Errors
/// `out` cannot be written.
pub fn write(out: &mut dyn Write, report: &Report, format: Format, style: Style) -> io::Result<()> {
    match format {
        Format::Full => full::write(out, report, style),
        Format::Concise => concise::write(out, report, style),
        Format::Json => json::write(out, report, style),
        Format::Jsonl => json::write_lines(out, report, style),
        Format::Junit => junit::write(out, report, style),
        Format::Sarif => sarif::write(out, report, style),
        Format::Github => github::write(out, report, style),
        Format::Gitlab => gitlab::write(out, report, style),
        Format::Markdown => markdown::write(out, report, style),
        Format::Html => html::write(out, report, style),
    }
}

/// The findings that are shown, and how many are not: the worst first where there are too many for all.
fn shown(report: &Report, style: Style) -> (Vec<&Finding>, usize) {
    let wanted: Vec<&Finding> =
        report.findings.iter().filter(|finding| finding.severity >= style.show).collect();
    let Some(most) = style.most.filter(|most| *most < wanted.len()) else {
        let hidden = report.findings.len() - wanted.len();
        return (wanted, hidden);
    };
    let mut indices: Vec<usize> = (0..wanted.len()).collect();
    indices.sort_by_key(|&index| (std::cmp::Reverse(wanted[index].severity), index));
    indices.truncate(most);
    indices.sort_unstable();
    let kept: Vec<&Finding> = indices.into_iter().map(|index| wanted[index]).collect();
    let hidden = report.findings.len() - kept.len();
    (kept, hidden)
}
