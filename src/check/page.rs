//! The page of every rule, from the one source: on the terminal and in the documentation.

use std::fmt::Write as _;

use super::distribution;
use super::rule::{Bound, Family, Rule};

/// Where the pages stand in the repository.
pub const FOLDER: &str = "docs/findings";

/// The page of one rule, Markdown that also reads on a terminal.
#[must_use]
pub fn page(rule: &Rule) -> String {
    let mut text = format!("## {}: {}\n\n{}\n\n", rule.code, rule.name, rule.says);
    let bound = match rule.bound {
        Some(Bound::Most(most)) => format!("found above {}", rule.quantity(most)),
        Some(Bound::Least(least)) => format!("found below {}", rule.quantity(least)),
        None => "none, whatever is so is found".to_owned(),
    };
    // Writing to a string cannot fail.
    let _ =
        writeln!(text, "- **Layer**: {}. **Severity**: {}. **Bound**: {bound}.", rule.layer, rule.severity);
    let _ = writeln!(text, "- **Why it matters**: {}", rule.why);
    let _ = writeln!(text, "- **Way out**: {}", rule.way_out);
    if !rule.simready.is_empty() {
        let _ = writeln!(text, "- **NVIDIA SimReady**: {}.", rule.simready.join(", "));
    }
    if rule.bound.is_some() {
        let short = rule.unit.split(' ').next().unwrap_or_default();
        let looser = match rule.bound {
            Some(Bound::Least(least)) => 0.5 * least,
            bound => 2.0 * bound.map_or(0.5, Bound::value),
        };
        let _ = writeln!(
            text,
            "- **Another bound**: `bounds: {{ {}: {} {short} }}` in `physique.yaml`, for all, a path or a category.",
            rule.code,
            super::rule::written(looser)
        );
    }
    if let Some(table) = distribution::table(rule) {
        let _ = writeln!(text, "\nMeasured on real models, in {}:\n\n{}", rule.unit, table.trim_end());
    }
    text
}

/// A line a rule.
#[must_use]
pub fn list() -> String {
    let mut text = String::new();
    for rule in Rule::all() {
        let _ = writeln!(
            text,
            "{} {:8} {:8} {:32} {}",
            rule.code, rule.layer, rule.severity, rule.name, rule.says
        );
    }
    text
}

/// Every page of the documentation by its file name.
#[must_use]
pub fn documents() -> Vec<(String, String)> {
    let mut found = vec![("README.md".to_owned(), index())];
    for family in Family::ALL {
        let rules = Rule::all().filter(|rule| rule.family() == family);
        let mut text = format!("# {}: {}\n\n{NOTICE}\n", family.code(), family.title());
        for rule in rules {
            let _ = write!(text, "\n{}", page(rule));
        }
        found.push((format!("{}.md", family.code()), text));
    }
    found
}

const NOTICE: &str =
    "<!-- Written from src/check/rules by `UPDATE_DOCS=1 cargo test --release --test check_docs`. -->";

fn index() -> String {
    let mut text = format!(
        "# What `physique check` finds\n\n{NOTICE}\n\nCodes are stable: a code is never given to another rule. \
         `physique explain CODE` prints a rule's page.\n\n\
         Which bounds fit your models is seen from how the measured values are spread over them: `physique check \
         MODELS --distribution FILE` writes the quantiles.\n"
    );
    for family in Family::ALL {
        let _ = writeln!(
            text,
            "\n## [{}]({}.md): {}\n\n| code | name | layer | severity | bound |\n|---|---|---|---|---|",
            family.code(),
            family.code(),
            family.title()
        );
        for rule in Rule::all().filter(|rule| rule.family() == family) {
            let bound = match rule.bound {
                Some(Bound::Most(most)) => format!("> {}", rule.quantity(most)),
                Some(Bound::Least(least)) => format!("< {}", rule.quantity(least)),
                None => String::new(),
            };
            let anchor = format!("{}-{}", rule.code.to_lowercase(), rule.name);
            let _ = writeln!(
                text,
                "| [{}]({}.md#{anchor}) | {} | {} | {} | {bound} |",
                rule.code,
                family.code(),
                rule.name,
                rule.layer,
                rule.severity
            );
        }
    }
    text.push_str(
        "\n## Crosswalk to NVIDIA SimReady\n\nRequirements of SimReady Foundation (2026.08) and of its asset \
         validator that ask for the same thing of a USD asset; FET003 names the runtime tests of SimReady Benchmark. \
         A rule here is measured on the model and its mapping, before any USD is written: it is no substitute for \
         validating the export.\n\n| SimReady | here |\n|---|---|\n",
    );
    let mut codes: Vec<&str> = Rule::all().flat_map(|rule| rule.simready.iter().copied()).collect();
    codes.sort_unstable();
    codes.dedup();
    for code in codes {
        let ours: Vec<&str> =
            Rule::all().filter(|rule| rule.simready.contains(&code)).map(|rule| rule.code).collect();
        let _ = writeln!(text, "| {code} | {} |", ours.join(", "));
    }
    text
}
