//! What can be said of a catalogue without any model: `physique check --rules`.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use crate::attribute::{ATTRIBUTES, DENSITY, MASS, MassModel, Provenance, round};
use crate::mapped::Finding;
use crate::names::evidence::THRESHOLD;
use crate::names::lexicon::{Claim, Target};
use crate::rules::category::Range;
use crate::rules::rule::{Condition, Rule};
use crate::rules::ruleset::Ruleset;
use crate::rules::settings::{Setting, SubcategoryId, What};

/// Densest thing on earth, kg/m³: more than this in its own bounding box is a slip of the pen.
const OSMIUM: f64 = 22_600.0;

/// Faults of the rules themselves.
///
/// | code | what |
/// |---|---|
/// | RUL001 | two subcategories claim one alias |
/// | RUL002 | a rule whose conditions cannot hold together |
/// | RUL003 | a rule that another shadows: same condition, same things set, later in the file |
/// | RUL004 | a rule whose category can never win: its confidence is below the threshold |
/// | RUL005 | a subcategory that names no preset, nor does its category |
/// | RUL006 | ranges that contradict: size, mass and mass model |
/// | RUL007 | a preset without an attribute of its kind |
/// | RUL008 | a subcategory whose preset has no density: it has no mass |
/// | RUL009 | a pair given twice |
/// | RUL010 | a category without subcategories |
/// | RUL011 | rules that send one subcategory to another and back: a cycle, in which the order of the file decides |
#[must_use]
pub fn check_rules(rules: &Ruleset) -> Vec<Finding> {
    let mut findings = Vec::new();
    aliases(rules, &mut findings);
    conditions(rules, &mut findings);
    taxonomy(rules, &mut findings);
    presets(rules, &mut findings);
    cycles(rules, &mut findings);
    findings
}

fn push(findings: &mut Vec<Finding>, code: &str, message: String, place: &Provenance) {
    findings.push(Finding { code: code.into(), message, place: Some(place.clone()) });
}

/// A fault stands at the alias that can be taken out, where the other claim is the name of a subcategory itself.
fn aliases(rules: &Ruleset, findings: &mut Vec<Finding>) {
    let is_name = |claim: &Claim| {
        let Target::Subcategory(id) = claim.target else { return false };
        rules.subcategories[id].aliases.first().is_some_and(|name| name.place == claim.place)
    };
    for entry in rules.lexicon.iter() {
        let mut claims = entry.claims.iter().filter(|claim| matches!(claim.target, Target::Subcategory(_)));
        let Some(first) = claims.next() else { continue };
        for other in claims {
            let message = format!(
                "\"{}\" is claimed by {} at {} and by {} at {}: size and folders must tell them apart",
                other.alias,
                first.place.by,
                first.place.place(),
                other.place.by,
                other.place.place()
            );
            let at_fault = if is_name(other) && !is_name(first) { first } else { other };
            push(findings, "RUL001", message, &at_fault.place);
        }
    }
}

fn conditions(rules: &Ruleset, findings: &mut Vec<Finding>) {
    let mut seen: BTreeMap<String, &Rule> = BTreeMap::new();
    for rule in &rules.rules {
        if let Some(why) = impossible(&rule.when) {
            push(findings, "RUL002", format!("rule `{}` can never hold: {why}", rule.name), &rule.place);
        }
        let category =
            rule.set.iter().any(|setting| matches!(setting.what, What::Category(_) | What::Subcategory(_)));
        if category && rule.confidence < THRESHOLD {
            let message = format!(
                "rule `{}`: confidence {} is below the threshold of {THRESHOLD}",
                rule.name, rule.confidence
            );
            push(findings, "RUL004", message, &rule.place);
        }
        let mut keys: Vec<String> = rule.set.iter().map(|setting| key_of(&setting.what)).collect();
        keys.sort();
        if let Some(earlier) = seen.insert(format!("{:?} {keys:?}", rule.when), rule) {
            let message =
                format!("rule `{}` is shadowed by `{}` at {}", earlier.name, rule.name, rule.place.place());
            push(findings, "RUL003", message, &earlier.place);
        }
    }
}

fn key_of(what: &What) -> String {
    match what {
        What::Category(_) | What::Subcategory(_) => "category".to_owned(),
        What::Kind(_) => "kind".to_owned(),
        What::Preset(_) => "preset".to_owned(),
        What::MassModel(_) => "mass_model".to_owned(),
        What::Anchored(_) => "anchored".to_owned(),
        What::Contents { .. } => "contents".to_owned(),
        What::Unit { .. } => "unit".to_owned(),
        What::ColliderTolerance { .. } => "collider_tolerance".to_owned(),
        What::Attribute(id, _) => ATTRIBUTES[*id].name.to_owned(),
    }
}

/// Why a condition can hold for no model, where that is plain to see.
fn impossible(condition: &Condition) -> Option<String> {
    match condition {
        Condition::All(parts) => {
            if let Some(why) = parts.iter().find_map(impossible) {
                return Some(why);
            }
            for (index, one) in parts.iter().enumerate() {
                for other in &parts[index + 1..] {
                    if excludes(one, other) {
                        return Some("two of its conditions exclude each other".to_owned());
                    }
                }
            }
            None
        }
        Condition::Any(parts) if parts.is_empty() => Some("an empty `any`".to_owned()),
        Condition::Any(parts) => {
            let all: Option<Vec<String>> = parts.iter().map(impossible).collect();
            all.and_then(|reasons| reasons.into_iter().next())
        }
        Condition::Aspect([_, high]) if *high < 1.0 => Some("an aspect is never below 1".to_owned()),
        Condition::Bodies([_, high]) if *high < 1.0 => Some("a mesh has at least one body".to_owned()),
        Condition::HullRatio([_, high]) if *high < 0.999 => {
            Some("a hull is never smaller than its mesh".to_owned())
        }
        _ => None,
    }
}

fn excludes(one: &Condition, other: &Condition) -> bool {
    let apart = |a: &[f64; 2], b: &[f64; 2]| a[1] < b[0] || b[1] < a[0];
    match (one, other) {
        (Condition::Size(a), Condition::Size(b))
        | (Condition::Aspect(a), Condition::Aspect(b))
        | (Condition::Bodies(a), Condition::Bodies(b))
        | (Condition::HullRatio(a), Condition::HullRatio(b)) => apart(a, b),
        (Condition::Closed(a), Condition::Closed(b)) => a != b,
        (Condition::Extension(a), Condition::Extension(b)) => !a.iter().any(|wanted| b.contains(wanted)),
        (Condition::Not(inner), plain) | (plain, Condition::Not(inner)) => {
            format!("{inner:?}") == format!("{plain:?}")
        }
        _ => false,
    }
}

fn taxonomy(rules: &Ruleset, findings: &mut Vec<Finding>) {
    for category in &rules.categories {
        if category.subcategories.is_empty() {
            push(
                findings,
                "RUL010",
                format!("category `{}` has no subcategories", category.name),
                &category.place,
            );
        }
    }
    for subcategory in &rules.subcategories {
        let category = &rules.categories[subcategory.category];
        let name = &subcategory.name;
        let layers = || subcategory.settings.iter().rev().chain(category.settings.iter().rev());
        let preset = layers().find_map(|setting| match setting.what {
            What::Preset(id) => Some((id, &setting.by)),
            _ => None,
        });
        let Some((preset, preset_by)) = preset else {
            let message = format!("`{name}` has no preset: its kind's fallback is used");
            push(findings, "RUL005", message, &subcategory.place);
            continue;
        };
        let preset = &rules.presets[preset];
        if preset.figures[DENSITY].is_none() {
            let message = format!("`{name}` has preset `{}`, which gives no density", preset.name);
            push(findings, "RUL008", message, preset_by);
        }
        let size = subcategory.size.as_ref().or(category.size.as_ref());
        let mass = subcategory.mass.as_ref().or(category.mass.as_ref());
        ranges(name, size, mass, layers(), findings);
    }
}

fn ranges<'r>(
    name: &str,
    size: Option<&Range>,
    mass: Option<&Range>,
    mut layers: impl Iterator<Item = &'r Setting>,
    findings: &mut Vec<Finding>,
) {
    let Some(mass) = mass else { return };
    if let Some(size) = size
        && mass.middle() / size.middle().powi(3) > OSMIUM
    {
        let message = format!(
            "`{name}`: {} kg in a cube of {} m is denser than osmium",
            round(mass.middle()),
            round(size.middle())
        );
        push(findings, "RUL006", message, &mass.place);
    }
    let fixed = layers.find_map(|setting| match setting.what {
        What::MassModel(model) => Some((model, &setting.by)),
        _ => None,
    });
    if let Some((MassModel::Fixed { mass_kg }, by)) = fixed
        && !mass.contains(mass_kg)
    {
        let message =
            format!("`{name}`: fixed at {mass_kg} kg, outside its mass range at {}", mass.place.place());
        push(findings, "RUL006", message, by);
    }
}

fn presets(rules: &Ruleset, findings: &mut Vec<Finding>) {
    for preset in &rules.presets {
        for id in &rules.kind(preset.kind).attributes {
            if *id != MASS && preset.figures[*id].is_none() {
                let message =
                    format!("preset `{}` has no {}: a default is used", preset.name, ATTRIBUTES[*id].name);
                push(findings, "RUL007", message, &preset.place);
            }
        }
    }
    let mut seen = BTreeMap::new();
    for pair in &rules.pairs {
        if let Some(earlier) = seen.insert(pair.between, &pair.place) {
            let [one, other] = pair.between.map(|id| &rules.presets[id].name);
            let message = format!("{one} and {other} stand at {} already", earlier.place());
            push(findings, "RUL009", message, &pair.place);
        }
    }
}

/// A rule that asks for an alias of one subcategory and sets another is an arrow between the two.
fn cycles(rules: &Ruleset, findings: &mut Vec<Finding>) {
    let mut arrows: BTreeMap<SubcategoryId, Vec<(SubcategoryId, &Rule)>> = BTreeMap::new();
    for rule in &rules.rules {
        let to = rule.set.iter().find_map(|setting| match setting.what {
            What::Subcategory(id) => Some(id),
            _ => None,
        });
        let Some(to) = to else { continue };
        let mut from = Vec::new();
        asked(rules, &rule.when, &mut from);
        for from in from.into_iter().filter(|from| *from != to) {
            arrows.entry(from).or_default().push((to, rule));
        }
    }
    let mut done: BTreeSet<SubcategoryId> = BTreeSet::new();
    for start in arrows.keys().copied() {
        if let Some(way) = way_back(&arrows, start, &done) {
            let places: Vec<String> = way
                .iter()
                .map(|(to, rule)| {
                    format!(
                        "`{}` at {} to `{}`",
                        rule.name,
                        rule.place.place(),
                        rules.subcategories[*to].name
                    )
                })
                .collect();
            let message = format!(
                "rules go round in a circle: from `{}` by {}",
                rules.subcategories[start].name,
                places.join(", then by ")
            );
            findings.extend(way.first().map(|(_, rule)| Finding {
                code: "RUL011".into(),
                message,
                place: Some(rule.place.clone()),
            }));
            done.extend(way.iter().map(|(to, _)| *to));
        }
        done.insert(start);
    }
}

/// The subcategories whose alias a condition asks for.
fn asked(rules: &Ruleset, condition: &Condition, found: &mut Vec<SubcategoryId>) {
    match condition {
        Condition::All(parts) | Condition::Any(parts) => {
            parts.iter().for_each(|part| asked(rules, part, found));
        }
        Condition::Alias(id) => found.push(*id),
        Condition::AliasOfCategory(id) => found.extend(&rules.categories[*id].subcategories),
        _ => {}
    }
}

/// The shortest way along arrows from a subcategory back to itself, past none of `done`.
fn way_back<'r>(
    arrows: &BTreeMap<SubcategoryId, Vec<(SubcategoryId, &'r Rule)>>,
    start: SubcategoryId,
    done: &BTreeSet<SubcategoryId>,
) -> Option<Vec<(SubcategoryId, &'r Rule)>> {
    let mut ways: VecDeque<Vec<(SubcategoryId, &'r Rule)>> = VecDeque::from([Vec::new()]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        let here = way.last().map_or(start, |(to, _)| *to);
        for (to, rule) in arrows.get(&here).into_iter().flatten() {
            let further: Vec<_> = way.iter().copied().chain([(*to, *rule)]).collect();
            if *to == start {
                return Some(further);
            }
            if !done.contains(to) && seen.insert(*to) {
                ways.push_back(further);
            }
        }
    }
    None
}
