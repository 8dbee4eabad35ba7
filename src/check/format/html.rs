//! One page that needs nothing else: the counts, the rules, and a card with a picture for every offender.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use rayon::prelude::*;

use super::xml::escaped;
use super::{Style, picture, shown};
use crate::check::finding::Finding;
use crate::check::report::Report;
use crate::check::severity::Severity;

/// Offenders with a picture; a page of more is slow to open, and nobody looks at it to the end.
const PICTURES: usize = 200;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

pub(super) fn write(out: &mut dyn Write, report: &Report, style: Style) -> io::Result<()> {
    let (findings, hidden) = shown(report, Style { show: Severity::Info, ..style });
    let verdict = if report.failing() > 0 { "fails" } else { "passes" };
    write!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>physique check: {}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header class=\"{verdict}\"><h1>physique check {verdict}</h1><p>{}</p><p class=\"scope\">{}</p></header>\n",
        escaped(&report.counts()),
        escaped(&report.counts()),
        escaped(&report.scope())
    )?;
    notes(out, report, hidden)?;
    rules(out, report)?;
    let mut models: BTreeMap<&str, Vec<&Finding>> = BTreeMap::new();
    for finding in &findings {
        models.entry(&finding.model).or_default().push(finding);
    }
    let of_none = models.remove("").unwrap_or_default();
    if !of_none.is_empty() {
        writeln!(out, "<h2>Rules, overrides and the whole database</h2>\n<section class=\"card wide\">")?;
        list(out, &of_none)?;
        writeln!(out, "</section>")?;
    }
    let mut offenders: Vec<(&str, Vec<&Finding>)> = models.into_iter().collect();
    offenders.sort_by_cached_key(|(model, found)| {
        let count = |severity: Severity| found.iter().filter(|finding| finding.severity == severity).count();
        let [errors, warnings] = [Severity::Error, Severity::Warning].map(count);
        (std::cmp::Reverse((errors, warnings)), *model)
    });
    writeln!(
        out,
        "<h2>Models</h2>\n<div class=\"filters\"><input id=\"search\" type=\"search\" placeholder=\"model, category or code\">\
         <label><input type=\"checkbox\" value=\"error\" checked> errors</label>\
         <label><input type=\"checkbox\" value=\"warning\" checked> warnings</label>\
         <label><input type=\"checkbox\" value=\"info\"> infos</label><span id=\"count\"></span></div>\n<main>"
    )?;
    let pictures = pictures(&offenders);
    for ((model, found), picture) in offenders.iter().zip(pictures) {
        card(out, model, found, picture.as_deref())?;
    }
    writeln!(out, "</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>")
}

/// Of the first offenders, which are the worst.
fn pictures(offenders: &[(&str, Vec<&Finding>)]) -> Vec<Option<String>> {
    offenders
        .par_iter()
        .enumerate()
        .map(|(index, (_, found))| {
            let worth = index < PICTURES && found.iter().any(|finding| finding.severity > Severity::Info);
            let file = found.first().and_then(|finding| finding.model_file.as_deref()).filter(|_| worth)?;
            picture::data_uri(Path::new(file))
        })
        .collect()
}

fn notes(out: &mut dyn Write, report: &Report, hidden: usize) -> io::Result<()> {
    let mut notes = report.notes();
    if hidden > 0 {
        notes.push(format!("{hidden} not shown"));
    }
    if notes.is_empty() {
        Ok(())
    } else {
        writeln!(out, "<p class=\"notes\">{}</p>", escaped(&notes.join("; ")))
    }
}

fn rules(out: &mut dyn Write, report: &Report) -> io::Result<()> {
    let rows = report.by_code();
    if rows.is_empty() {
        return writeln!(out, "<p>Nothing was found.</p>");
    }
    writeln!(
        out,
        "<h2>Rules</h2>\n<table><thead><tr><th>rule</th><th>severity</th><th>findings</th><th>what, why, and the way out</th></tr></thead><tbody>"
    )?;
    for (rule, severity, count) in rows {
        writeln!(
            out,
            "<tr class=\"{severity}\"><td><a href=\"#\" data-code=\"{0}\">{0}</a><br><small>{1}</small></td><td><span class=\"tag {severity}\">{severity}</span></td>\
             <td class=\"number\">{count}</td><td>{2} <small>{3} {4}</small></td></tr>",
            rule.code,
            rule.name,
            prose(rule.says),
            prose(rule.why),
            prose(rule.way_out)
        )?;
    }
    writeln!(out, "</tbody></table>")
}

fn card(out: &mut dyn Write, model: &str, found: &[&Finding], picture: Option<&str>) -> io::Result<()> {
    let category = found.first().map_or("", |finding| finding.category.as_str());
    let worst = found.iter().map(|finding| finding.severity).max().unwrap_or(Severity::Info);
    let words: Vec<&str> = found.iter().map(|finding| finding.rule.code).collect();
    writeln!(
        out,
        "<section class=\"card\" data-worst=\"{worst}\" data-words=\"{}\">",
        escaped(&format!("{model} {category} {}", words.join(" ")).to_lowercase())
    )?;
    match picture {
        Some(uri) => writeln!(out, "<img src=\"{uri}\" alt=\"{}\" loading=\"lazy\">", escaped(model))?,
        None => writeln!(out, "<div class=\"blank\"></div>")?,
    }
    writeln!(out, "<h3>{}</h3><p class=\"category\">{}</p>", breakable(model), escaped(category))?;
    list(out, found)?;
    writeln!(out, "</section>")
}

fn list(out: &mut dyn Write, found: &[&Finding]) -> io::Result<()> {
    let mut found = found.to_vec();
    found.sort_by_key(|finding| (std::cmp::Reverse(finding.severity), finding.rule.code));
    writeln!(out, "<ul>")?;
    for finding in found {
        let place = finding.place.as_ref().map_or_else(String::new, ToString::to_string);
        writeln!(
            out,
            "<li class=\"{0}\"><span class=\"tag {0}\" title=\"{1}\">{2}</span> {3} <small>{4}</small></li>",
            finding.severity,
            escaped(&finding.way_out),
            finding.rule.code,
            prose(&finding.sentence()),
            escaped(&place)
        )?;
    }
    writeln!(out, "</ul>")
}

/// A path that breaks between its words first.
fn breakable(path: &str) -> String {
    escaped(path).replace('/', "/<wbr>").replace('_', "_<wbr>").replace('-', "-<wbr>")
}

/// Text with its `code` set as such.
fn prose(text: &str) -> String {
    let pieces = escaped(text);
    let mut set = String::with_capacity(pieces.len());
    for (index, piece) in pieces.split('`').enumerate() {
        match index {
            0 => {}
            odd if odd % 2 == 1 => set.push_str("<code>"),
            _ => set.push_str("</code>"),
        }
        set.push_str(piece);
    }
    if pieces.matches('`').count() % 2 == 1 { pieces } else { set }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_path_breaks_between_its_words() {
        assert_eq!(super::breakable("a&b/old_mug.glb"), "a&amp;b/<wbr>old_<wbr>mug.glb");
    }

    #[test]
    fn words_in_backticks_are_set_as_code() {
        assert_eq!(super::prose("set `unit` & go"), "set <code>unit</code> &amp; go");
        assert_eq!(super::prose("one ` alone"), "one ` alone");
    }
}
