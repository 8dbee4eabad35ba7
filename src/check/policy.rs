//! What counts as how bad: profile, configuration and command line laid over the rules' own words.

use globset::GlobMatcher;

use super::finding::Finding;
use super::limit::Limit;
use super::observation::Observation;
use super::rule::Rule;
use super::selector::Selector;
use super::severity::Severity;
use super::suppression::Suppression;

/// What shall become of findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Not reported.
    Allow,
    Warn,
    Deny,
}

/// Levels and bounds that hold together.
#[derive(Clone, Debug, Default)]
pub struct Adjustments {
    levels: Vec<(Selector, Level)>,
    /// In the unit of the rule.
    bounds: Vec<(&'static str, f64)>,
}

/// Adjustments for some models alone.
#[derive(Clone, Debug)]
pub struct Scope {
    /// Any of them.
    pub models: Vec<GlobMatcher>,
    /// Category or subcategory, any of them.
    pub categories: Vec<String>,
    pub adjustments: Adjustments,
}

/// Everything that decides what is reported and how.
///
/// Lowest first: the rule's own severity and bound, the profile, the configuration, its scopes in the order of the
/// file, the command line. Within one of them the more specific selector wins, then deny over warn over allow.
#[derive(Clone, Debug)]
pub struct Policy {
    pub profile: String,
    /// Empty: all.
    pub select: Vec<Selector>,
    pub ignore: Vec<Selector>,
    pub base: Vec<Adjustments>,
    pub scopes: Vec<Scope>,
    pub command_line: Adjustments,
    pub limits: Vec<Limit>,
    pub suppressions: Vec<Suppression>,
    /// Findings at or above it make the gate fail.
    pub fail_on: Severity,
    /// Categories and subcategories of which three must stand on each other.
    pub stack: Vec<String>,
}

/// What a model is, for scopes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Subject<'a> {
    pub model: &'a str,
    pub category: &'a str,
    pub subcategory: &'a str,
}

impl Adjustments {
    pub fn level(&mut self, selector: Selector, level: Level) {
        self.levels.push((selector, level));
        self.levels.sort_by_key(|(selector, level)| (selector.specificity(), *level));
    }

    pub fn bound(&mut self, code: &'static str, value: f64) {
        self.bounds.push((code, value));
    }

    fn apply(&self, rule: &Rule, severity: &mut Option<Severity>, bound: &mut Option<super::Bound>) {
        for (selector, level) in &self.levels {
            // What was allowed before is asked for by its own severity: `deny: warnings` is no word for it.
            let standing = severity.unwrap_or(Severity::Info);
            if selector.matches(rule, standing) {
                *severity = match level {
                    Level::Allow => None,
                    Level::Warn => Some(Severity::Warning),
                    Level::Deny => Some(Severity::Error),
                };
            }
        }
        for (code, value) in &self.bounds {
            if *code == rule.code {
                *bound = bound.map(|bound| bound.moved(*value));
            }
        }
    }
}

impl Scope {
    fn holds(&self, subject: Subject<'_>) -> bool {
        self.models.iter().any(|glob| glob.is_match(subject.model))
            || self.categories.iter().any(|name| name == subject.category || name == subject.subcategory)
    }
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            profile: "default".to_owned(),
            select: Vec::new(),
            ignore: Vec::new(),
            base: Vec::new(),
            scopes: Vec::new(),
            command_line: Adjustments::default(),
            limits: Vec::new(),
            suppressions: Vec::new(),
            fail_on: Severity::Error,
            stack: super::STACKS.map(str::to_owned).to_vec(),
        }
    }
}

impl Policy {
    /// Severity and bound in force for a rule and a model; `None` where it is not reported.
    #[must_use]
    pub fn of(&self, rule: &Rule, subject: Subject<'_>) -> Option<(Severity, Option<super::Bound>)> {
        let named = |selectors: &[Selector]| selectors.iter().any(|s| s.matches(rule, rule.severity));
        if (!self.select.is_empty() && !named(&self.select)) || named(&self.ignore) {
            return None;
        }
        let mut severity = Some(rule.severity);
        let mut bound = rule.bound;
        for adjustments in &self.base {
            adjustments.apply(rule, &mut severity, &mut bound);
        }
        for scope in self.scopes.iter().filter(|scope| scope.holds(subject)) {
            scope.adjustments.apply(rule, &mut severity, &mut bound);
        }
        self.command_line.apply(rule, &mut severity, &mut bound);
        severity.map(|severity| (severity, bound))
    }

    /// The finding that an observation is; `None` where it is within its bound, or not reported.
    #[must_use]
    pub fn judge(&self, observation: Observation, subject: Subject<'_>) -> Option<Finding> {
        let rule = observation.rule()?;
        let (severity, bound) = self.of(rule, subject)?;
        if let (Some(value), Some(bound)) = (observation.value, bound)
            && !bound.is_crossed(value)
        {
            return None;
        }
        Some(Finding::new(observation, rule, severity, bound))
    }

    /// Whether three of it must stand on each other.
    #[must_use]
    pub fn stacks(&self, subject: Subject<'_>) -> bool {
        self.stack.iter().any(|name| name == subject.category || name == subject.subcategory)
    }

    /// Whether any layer of this kind can report anything at all: what cannot need not run.
    #[must_use]
    pub fn asks_for(&self, layer: super::Layer) -> bool {
        Rule::all().filter(|rule| rule.layer == layer).any(|rule| {
            let named = |selectors: &[Selector]| selectors.iter().any(|s| s.matches(rule, rule.severity));
            (self.select.is_empty() || named(&self.select)) && !named(&self.ignore)
        })
    }

    /// Findings under a limit: errors where there are too many, warnings where there are not.
    pub fn apply_limits(&self, findings: &mut [Finding], models: usize) {
        for limit in &self.limits {
            let meant: Vec<usize> = (0..findings.len())
                .filter(|&index| limit.selector.matches(findings[index].rule, findings[index].severity))
                .collect();
            let mut names: Vec<(&str, String)> = meant
                .iter()
                .map(|&index| &findings[index])
                .map(|found| {
                    let own = if found.model.is_empty() { found.fingerprint() } else { String::new() };
                    (found.model.as_str(), own)
                })
                .collect();
            names.sort_unstable();
            names.dedup();
            let exceeded = limit.is_exceeded(names.len(), models);
            for index in meant {
                findings[index].severity = match (exceeded, findings[index].severity) {
                    (true, _) => Severity::Error,
                    (false, severity) => severity.min(Severity::Warning),
                };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use globset::Glob;

    use super::*;

    fn found(code: &str, value: Option<f64>) -> Observation {
        Observation { value, ..Observation::fact(code, "told") }.of("food/apple.glb")
    }

    fn level(policy: &mut Policy, selector: &str, level: Level) {
        policy.command_line.level(selector.parse().expect("a selector"), level);
    }

    #[test]
    fn a_value_within_its_bound_is_no_finding() {
        let policy = Policy::default();
        assert!(policy.judge(found("MAS002", Some(1.0)), Subject::default()).is_none());
        assert!(policy.judge(found("MAS002", Some(2.0)), Subject::default()).is_some());
        assert!(policy.judge(found("MAP020", None), Subject::default()).is_some());
    }

    #[test]
    fn the_more_specific_selector_has_the_last_word() {
        let mut policy = Policy::default();
        level(&mut policy, "MAS002", Level::Warn);
        level(&mut policy, "MAS", Level::Allow);
        level(&mut policy, "warnings", Level::Deny);
        let severity = |code: &str| {
            policy.of(Rule::find(code).expect("a rule"), Subject::default()).map(|(severity, _)| severity)
        };
        assert_eq!(severity("MAS002"), Some(Severity::Warning));
        assert_eq!(severity("MAS004"), None);
        assert_eq!(severity("MAP008"), Some(Severity::Error));
        assert_eq!(severity("MAP021"), Some(Severity::Info));
    }

    #[test]
    fn scopes_hold_for_their_models_and_the_command_line_beats_them() {
        let mut adjustments = Adjustments::default();
        adjustments.bound("MAS002", 5.0);
        adjustments.level(Selector::Code("COL002"), Level::Allow);
        let glob = Glob::new("food/**").expect("a glob").compile_matcher();
        let scope = Scope { models: vec![glob], categories: vec!["mug".to_owned()], adjustments };
        let mut policy = Policy { scopes: vec![scope], ..Policy::default() };
        let apple = Subject { model: "food/apple.glb", ..Subject::default() };
        let mug = Subject { model: "x.glb", subcategory: "mug", ..Subject::default() };
        let other = Subject { model: "x.glb", ..Subject::default() };
        assert!(policy.judge(found("MAS002", Some(4.0)), apple).is_none());
        assert!(policy.judge(found("MAS002", Some(4.0)), mug).is_none());
        assert!(policy.judge(found("MAS002", Some(4.0)), other).is_some());
        assert!(policy.judge(found("COL002", Some(9.0)), apple).is_none());
        level(&mut policy, "COL", Level::Deny);
        let severity = policy.judge(found("COL002", Some(9.0)), apple).map(|finding| finding.severity);
        assert_eq!(severity, Some(Severity::Error));
    }

    #[test]
    fn select_and_ignore_leave_rules_out() {
        let policy = Policy {
            select: vec!["MAS".parse().expect("a selector"), "COL002".parse().expect("a selector")],
            ignore: vec!["MAS011".parse().expect("a selector")],
            ..Policy::default()
        };
        let reported =
            |code: &str| policy.of(Rule::find(code).expect("a rule"), Subject::default()).is_some();
        assert!(reported("MAS002") && reported("COL002"));
        assert!(!reported("MAS011") && !reported("COL003") && !reported("SIM002"));
        assert!(policy.asks_for(super::super::Layer::Data) && !policy.asks_for(super::super::Layer::Runtime));
    }

    #[test]
    fn a_limit_decides_between_warnings_and_errors_by_models() {
        let policy = Policy { limits: vec!["SIM002>1".parse().expect("a limit")], ..Policy::default() };
        let finding = |model: &str| {
            let observation = Observation::measured("SIM002", 9.0, "told").of(model);
            policy.judge(observation, Subject::default()).expect("a finding")
        };
        let mut few = vec![finding("a"), finding("a")];
        policy.apply_limits(&mut few, 10);
        assert!(few.iter().all(|finding| finding.severity == Severity::Warning));
        let mut many = vec![finding("a"), finding("b")];
        policy.apply_limits(&mut many, 10);
        assert!(many.iter().all(|finding| finding.severity == Severity::Error));
    }
}
