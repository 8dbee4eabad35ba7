//! `physique.yaml`: what a team has decided about the gate.
//!
//! ```yaml
//! version: 1
//! profile: strict
//! fail_on: warning
//! allow: [GEO009, MAS007]
//! bounds: { MAS002: 2 x }
//! error_if: ["MAP020>1%"]
//! stack: [crate, brick]
//! scopes:
//!   - match: "terrain/**"
//!     allow: [SIM]
//!   - category: [sword]
//!     bounds: { COL002: 4 % }
//! suppress:
//!   - code: MAS002
//!     match: food/giant_apple.glb
//!     reason: it is meant to be that large
//! profiles:
//!   nightly: { deny: [warnings] }
//! ```

use std::path::Path;

use globset::{GlobBuilder, GlobMatcher};
use mapper::{Fields, MapError, Node, Reader, parse_yaml};

use super::place::Place;
use super::policy::{Adjustments, Level, Policy, Scope};
use super::rule::Rule;
use super::selector::Selector;
use super::severity::Severity;
use super::suppression::Suppression;

/// Where it is looked for when nothing is said.
pub const DEFAULT_FILE: &str = "physique.yaml";

const LEVELS: [&str; 4] = ["allow", "warn", "deny", "bounds"];

/// Units that are no plain counts or shares: a bare number would leave open what is meant.
const PHYSICAL: [&str; 6] = ["mm", "m", "deg", "kg/m3", "s", "%"];

/// The policy of a configuration's text. `profile`: the one that the command line asks for.
///
/// # Errors
/// Every fault with its place, or an unknown profile.
pub fn parse(file: &str, text: &str, profile: Option<&str>) -> Result<Policy, MapError> {
    let doc = parse_yaml(file, text)?;
    let mut reader = Reader::new(&doc);
    let mut policy = Policy::default();
    let mut known = vec![
        "version", "profile", "fail_on", "select", "ignore", "error_if", "stack", "scopes", "suppress",
        "profiles",
    ];
    known.extend(LEVELS);
    if let Some(top) = reader.fields(&doc.root, &known) {
        read(&mut reader, top, profile, &mut policy);
    }
    reader.finish(policy)
}

/// The policy without a configuration.
///
/// # Errors
/// The profile is not one that is built in.
pub fn built_in(profile: Option<&str>) -> Result<Policy, String> {
    let mut policy = Policy::default();
    let name = profile.unwrap_or("default");
    if !lay_profile(name, &mut policy) {
        return Err(format!(
            "no profile is called {name:?}; expected default, strict or simready, or one of `profiles:` in {DEFAULT_FILE}"
        ));
    }
    Ok(policy)
}

/// `strict` has no warnings; `simready` looks at what NVIDIA SimReady has a requirement for, and nothing else.
fn lay_profile(name: &str, policy: &mut Policy) -> bool {
    match name {
        "default" => {}
        "strict" => {
            let mut strict = Adjustments::default();
            strict.level(Selector::Warnings, Level::Deny);
            policy.base.push(strict);
        }
        "simready" => {
            let crossed = Rule::all().filter(|rule| !rule.simready.is_empty());
            policy.select = crossed.map(|rule| Selector::Code(rule.code)).collect();
        }
        _ => return false,
    }
    name.clone_into(&mut policy.profile);
    true
}

fn read<'d>(reader: &mut Reader<'d>, top: Fields<'d>, wanted: Option<&str>, policy: &mut Policy) {
    if let Some(version) = top.get("version")
        && version.text() != "1"
    {
        let help = "write `version: 1`".to_owned();
        reader.fault(version, "CAT003", "only version 1 is known".to_owned(), "here", help);
    }
    let own = top.get("profiles").and_then(|node| reader.map(node));
    let node = top.get("profile");
    if let Some(name) = wanted.or_else(|| node.map(Node::text)) {
        let described = own.and_then(|profiles| profiles.get(name));
        match described {
            Some(described) => {
                name.clone_into(&mut policy.profile);
                let mut known = vec!["fail_on", "select", "ignore", "error_if"];
                known.extend(LEVELS);
                if let Some(fields) = reader.fields(described, &known) {
                    common(reader, fields, policy);
                }
            }
            None if lay_profile(name, policy) => {}
            None => {
                let mut known: Vec<&str> =
                    own.iter().flat_map(|own| own.iter()).map(|(key, _)| key.text()).collect();
                known.extend(["default", "strict", "simready"]);
                let at = node.or(top.get("profiles")).unwrap_or(&reader.doc.root);
                let message = format!("no profile is called `{name}`");
                reader.fault(at, "CAT005", message, "not known", format!("known are {}", known.join(", ")));
            }
        }
    }
    common(reader, top, policy);
    if let Some(stack) = top.get("stack") {
        policy.stack = reader.one_or_more(stack).iter().map(|item| item.text().to_owned()).collect();
    }
    for item in top.get("scopes").and_then(|node| reader.list(node)).unwrap_or_default() {
        policy.scopes.extend(scope(reader, item));
    }
    for item in top.get("suppress").and_then(|node| reader.list(node)).unwrap_or_default() {
        policy.suppressions.extend(suppression(reader, item));
    }
}

/// What stands at the top and in profiles alike.
fn common<'d>(reader: &mut Reader<'d>, fields: Fields<'d>, policy: &mut Policy) {
    if let Some(node) = fields.get("fail_on") {
        match [Severity::Info, Severity::Warning, Severity::Error]
            .into_iter()
            .find(|s| s.name() == node.text())
        {
            Some(severity) => policy.fail_on = severity,
            None => reader.unknown(node, "severity", ["info", "warning", "error"].into_iter()),
        }
    }
    if let Some(node) = fields.get("select") {
        policy.select = selectors(reader, node);
    }
    if let Some(node) = fields.get("ignore") {
        policy.ignore.extend(selectors(reader, node));
    }
    for node in fields.get("error_if").map(|node| reader.one_or_more(node)).unwrap_or_default() {
        match node.text().parse() {
            Ok(limit) => policy.limits.push(limit),
            Err(error) => reader.fault(node, "CAT003", error, "here", String::new()),
        }
    }
    policy.base.push(adjustments(reader, fields));
}

fn adjustments<'d>(reader: &mut Reader<'d>, fields: Fields<'d>) -> Adjustments {
    let mut found = Adjustments::default();
    for (name, level) in [("allow", Level::Allow), ("warn", Level::Warn), ("deny", Level::Deny)] {
        let Some(node) = fields.get(name) else { continue };
        for selector in selectors(reader, node) {
            found.level(selector, level);
        }
    }
    let bounds = fields.get("bounds").and_then(|node| reader.map(node));
    for (key, value) in bounds.iter().flat_map(Fields::iter) {
        let Some(rule) = Rule::find(key.text()) else {
            reader.unknown(key, "rule", Rule::all().map(|rule| rule.code));
            continue;
        };
        match bound(rule, value.text()) {
            Ok(value) => found.bound(rule.code, value),
            Err(error) => {
                let example = rule.bound.map(|bound| rule.quantity(bound.value()));
                let help = example.map_or_else(String::new, |example| format!("the default is {example}"));
                reader.fault(value, "CAT004", error, "here", help);
            }
        }
    }
    found
}

/// A bound as people write it: `2 x`, `0.5 %`, `3 mm`.
fn bound(rule: &Rule, text: &str) -> Result<f64, String> {
    if rule.bound.is_none() {
        return Err(format!("{} has no bound: allow, warn or deny it", rule.code));
    }
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c))).unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let value: f64 = number
        .replace('_', "")
        .parse()
        .map_err(|_| format!("expected a number with a unit, found {text:?}"))?;
    let short = rule.unit.split(' ').next().unwrap_or_default();
    match unit.trim() {
        "" if PHYSICAL.contains(&short) => Err(format!("the bound of {} needs its unit, {short}", rule.code)),
        "" => Ok(value),
        unit if unit == short || unit == rule.unit => Ok(value),
        unit => Err(format!("the bound of {} is in {short}, not in {unit:?}", rule.code)),
    }
}

fn selectors<'d>(reader: &mut Reader<'d>, node: &'d Node) -> Vec<Selector> {
    let mut found = Vec::new();
    for item in reader.one_or_more(node) {
        match item.text().parse() {
            Ok(selector) => found.push(selector),
            Err(error) => reader.fault(item, "CAT005", error, "not known", String::new()),
        }
    }
    found
}

fn globs<'d>(reader: &mut Reader<'d>, node: Option<&'d Node>) -> Vec<GlobMatcher> {
    let mut found = Vec::new();
    for item in node.map(|node| reader.one_or_more(node)).unwrap_or_default() {
        // As overrides have them.
        match GlobBuilder::new(item.text()).case_insensitive(true).literal_separator(true).build() {
            Ok(glob) => found.push(glob.compile_matcher()),
            Err(error) => {
                reader.fault(item, "CAT003", format!("no glob: {}", error.kind()), "here", String::new())
            }
        }
    }
    found
}

fn scope<'d>(reader: &mut Reader<'d>, item: &'d Node) -> Option<Scope> {
    let mut known = vec!["match", "category", "note"];
    known.extend(LEVELS);
    let fields = reader.fields(item, &known)?;
    let models = globs(reader, fields.get("match"));
    let categories = fields.get("category").map(|node| reader.one_or_more(node)).unwrap_or_default();
    let categories: Vec<String> = categories.iter().map(|node| node.text().to_owned()).collect();
    if models.is_empty() && categories.is_empty() {
        let help = "add `match: \"folder/**\"` or `category: mug`".to_owned();
        reader.fault(item, "CAT007", "a scope of nothing".to_owned(), "here", help);
        return None;
    }
    Some(Scope { models, categories, adjustments: adjustments(reader, fields) })
}

fn suppression<'d>(reader: &mut Reader<'d>, item: &'d Node) -> Option<Suppression> {
    let fields = reader.fields(item, &["code", "match", "reason"])?;
    let Some(code) = fields.get("code") else {
        reader.fault(
            item,
            "CAT007",
            "a suppression without `code`".to_owned(),
            "here",
            "add `code: MAS002`".to_owned(),
        );
        return None;
    };
    if fields.get("reason").is_none_or(|reason| reason.text().trim().is_empty()) {
        let help = "add `reason:` and say why this may stay".to_owned();
        reader.fault(item, "CAT007", "a suppression without a reason".to_owned(), "here", help);
        return None;
    }
    let place = Place::file(Path::new(&*reader.doc.file));
    Some(Suppression {
        selectors: selectors(reader, code),
        models: globs(reader, fields.get("match")),
        line: None,
        place: Place { line: item.span.line, column: item.span.column, ..place },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::policy::Subject;

    fn severity(policy: &Policy, code: &str, subject: Subject<'_>) -> Option<Severity> {
        policy.of(Rule::find(code).expect("a rule"), subject).map(|(severity, _)| severity)
    }

    const TEXT: &str = "
version: 1
profile: nightly
allow: [GEO009]
bounds: { MAS002: 2 x, COL002: 4 % }
error_if: 'MAP020>1%'
stack: [crate]
scopes:
  - match: ['terrain/**']
    allow: [SIM]
  - category: sword
    bounds: { MAS002: 9 x }
suppress:
  - { code: MAS002, match: 'food/apple.glb', reason: meant }
profiles:
  nightly: { deny: [warnings], fail_on: info }
";

    #[test]
    fn a_configuration_is_laid_over_its_profile() {
        let policy = parse("physique.yaml", TEXT, None).unwrap_or_else(|error| panic!("{error}"));
        let plain = Subject::default();
        assert_eq!((policy.profile.as_str(), policy.fail_on), ("nightly", Severity::Info));
        assert_eq!(severity(&policy, "MAP008", plain), Some(Severity::Error));
        assert_eq!(severity(&policy, "GEO009", plain), None);
        let hill = Subject { model: "terrain/hill.glb", ..plain };
        assert_eq!(severity(&policy, "SIM002", hill), None);
        let bound = |subject| policy.of(Rule::find("MAS002").expect("a rule"), subject).and_then(|(_, b)| b);
        assert_eq!(bound(plain).map(super::super::Bound::value), Some(2.0));
        let sword = Subject { category: "sword", ..plain };
        assert_eq!(bound(sword).map(super::super::Bound::value), Some(9.0));
        assert_eq!((policy.limits.len(), policy.stack.len(), policy.suppressions.len()), (1, 1, 1));
        let strict = parse("physique.yaml", TEXT, Some("strict")).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(strict.fail_on, Severity::Error);
    }

    #[test]
    fn faults_have_their_place_and_a_way_out() {
        let cases = [
            ("allow: [MAS999]\n", "1:9", "MAS999"),
            ("bounds: { MAS002: much }\n", "1:19", "number"),
            ("bounds: { COL002: 4 }\n", "1:19", "needs its unit"),
            ("bounds: { COL002: 4 mm }\n", "1:19", "not in \"mm\""),
            ("bounds: { GEO001: 4 }\n", "1:19", "no bound"),
            ("suppress:\n  - { code: MAS002 }\n", "2:5", "reason"),
            ("scopes:\n  - allow: [SIM]\n", "2:5", "nothing"),
            ("profile: hard\n", "1:10", "hard"),
            ("alow: [SIM]\n", "1:1", "allow"),
            ("error_if: MAS002\n", "1:11", "MAS002>1%"),
        ];
        for (text, place, word) in cases {
            let error = parse("physique.yaml", text, None).expect_err(text);
            assert!(error.place().ends_with(place), "{text}: {}", error.place());
            assert!(error.to_string().contains(word), "{text}: {error}");
        }
        assert!(built_in(Some("hard")).is_err() && built_in(Some("simready")).is_ok());
    }
}
