//! What changed between two mappings, in words of the domain, grouped by what caused it.

mod change;
mod text;
mod words;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde::Serialize;

use super::entry::{Entry, Held};
use super::lock::Lock;

/// The cause where nothing but the model's own bytes is another.
const CHANGED_FILE: &str = "changed file";

/// Codes of rules that fail for a model, by model.
pub type Codes = BTreeMap<String, BTreeSet<&'static str>>;

/// Everything that differs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Diff {
    /// The largest first.
    pub groups: Vec<Group>,
    pub added: Vec<String>,
    pub removed: Vec<String>,
    pub unchanged: usize,
}

/// Models that changed for one reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// `rule:ceramic-mug`, `preset:oak`, `override:food/**`, `file`.
    pub cause: String,
    /// Where it is written, if that is known.
    pub place: String,
    /// `mugs`, or `models` where they are of several kinds.
    pub noun: String,
    pub models: Vec<String>,
    /// In words, one an attribute.
    pub changes: Vec<String>,
    /// Codes, and how many models fail them now and did not, or the other way round.
    pub fails: BTreeMap<&'static str, usize>,
    pub passes: BTreeMap<&'static str, usize>,
}

/// Models that changed for one reason, with what they were and are.
type Pairs<'a> = Vec<(&'a str, &'a Entry, &'a Entry)>;

impl Diff {
    /// `place`: where a cause is written. `before` and `after`: what fails on either side, where that is known.
    #[must_use]
    pub fn new(
        old: &Lock,
        new: &Lock,
        place: &dyn Fn(&str) -> Option<String>,
        (before, after): (&Codes, &Codes),
    ) -> Self {
        let mut groups: BTreeMap<(String, String), Pairs<'_>> = BTreeMap::new();
        let mut diff = Self::default();
        for (model, now) in &new.entries {
            match old.entries.get(model) {
                None => diff.added.push(model.clone()),
                Some(was) if same(was, now) => diff.unchanged += 1,
                Some(was) => groups
                    .entry((cause(was, now), kind_of_change(was, now)))
                    .or_default()
                    .push((model, was, now)),
            }
        }
        diff.removed =
            old.entries.keys().filter(|model| !new.entries.contains_key(*model)).cloned().collect();
        diff.groups = groups
            .into_iter()
            .map(|((cause, _), pairs)| group(cause, &pairs, place, before, after))
            .collect();
        diff.groups.sort_by(|a, b| (b.models.len(), &a.cause).cmp(&(a.models.len(), &b.cause)));
        diff
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.added.is_empty() && self.removed.is_empty()
    }

    /// Models that are not as they were.
    #[must_use]
    pub fn changed(&self) -> usize {
        self.groups.iter().map(|group| group.models.len()).sum()
    }
}

/// Two entries that say the same of the model, whatever line it stands on.
fn same(was: &Entry, now: &Entry) -> bool {
    (&was.input, &was.rule, &was.category, &was.preset, &was.attributes)
        == (&now.input, &now.rule, &now.category, &now.preset, &now.attributes)
}

/// What most likely caused the change: the strongest of what differs.
pub(super) fn cause(was: &Entry, now: &Entry) -> String {
    if was.category != now.category || was.preset != now.preset {
        return now.rule.clone();
    }
    // Of a preset's value that changed the preset is the cause, whoever chose that preset.
    let by_or_preset = |held: &Held| match held.by.split_once(" by ").map_or(held.by.as_str(), |(by, _)| by) {
        "" => format!("preset:{}", now.preset),
        by => by.to_owned(),
    };
    let changed: Vec<&Held> = now
        .values
        .iter()
        .filter(|held| was.held(&held.name).is_none_or(|before| before.value != held.value))
        .collect();
    // A mass follows from density, mass model, scale and the file itself, unless somebody set it.
    let own = changed.iter().find(|held| !matches!(held.name.as_str(), "mass" | "scale" | "kind"));
    if let Some(held) = own {
        return match held.name.as_str() {
            "mass_model" => held.by.clone(),
            _ => by_or_preset(held),
        };
    }
    if let Some(mass) = changed.iter().find(|held| held.name == "mass" && !held.by.is_empty()) {
        return mass.by.clone();
    }
    if was.input != now.input {
        return CHANGED_FILE.to_owned();
    }
    if changed.iter().any(|held| held.name == "scale") {
        return "another unit".to_owned();
    }
    now.rule.clone()
}

/// Models are told together where the same things changed in the same direction. One whose file changed besides is
/// told by itself: what its mass does has another cause.
fn kind_of_change(was: &Entry, now: &Entry) -> String {
    let mut key = String::from(if was.input == now.input { "" } else { "file " });
    if was.category != now.category {
        let _ = write!(key, "{} {} ", was.category, now.category);
    }
    if was.preset != now.preset {
        let _ = write!(key, "{} {}", was.preset, now.preset);
    }
    key
}

fn group(
    cause: String,
    pairs: &Pairs<'_>,
    place: &dyn Fn(&str) -> Option<String>,
    before: &Codes,
    after: &Codes,
) -> Group {
    let mut nouns: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, _, now) in pairs {
        let noun = now.category.rsplit('/').next().unwrap_or("model");
        *nouns.entry(if noun == "-" { "model" } else { noun }).or_default() += 1;
    }
    let noun = if nouns.len() == 1 { nouns.keys().next().copied().unwrap_or("model") } else { "model" };
    let none = BTreeSet::new();
    let count = |from: &Codes, to: &Codes| {
        let mut counts: BTreeMap<&'static str, usize> = BTreeMap::new();
        for (model, ..) in pairs {
            let (had, has) = (from.get(*model).unwrap_or(&none), to.get(*model).unwrap_or(&none));
            for code in has.difference(had) {
                *counts.entry(code).or_default() += 1;
            }
        }
        counts
    };
    Group {
        place: place(&cause).unwrap_or_default(),
        changes: change::of(&cause, pairs),
        cause,
        noun: noun.to_owned(),
        models: pairs.iter().map(|(model, ..)| (*model).to_owned()).collect(),
        fails: count(before, after),
        passes: count(after, before),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mug(density: &str, mass: &str) -> Entry {
        let held = |name: &str, value: &str| Held {
            name: name.to_owned(),
            value: value.to_owned(),
            by: String::new(),
        };
        Entry {
            line: 0,
            input: "0".repeat(16),
            rule: "rule:ceramic-mug".to_owned(),
            category: "kitchen/mug".to_owned(),
            preset: "ceramic".to_owned(),
            attributes: format!("{density}{mass}"),
            values: vec![held("density", density), held("mass", mass)],
        }
    }

    fn lock(entries: Vec<(&str, Entry)>) -> Lock {
        Lock {
            entries: entries.into_iter().map(|(model, entry)| (model.to_owned(), entry)).collect(),
            ..Lock::default()
        }
    }

    fn none() -> (Codes, Codes) {
        (Codes::new(), Codes::new())
    }

    #[test]
    fn a_changed_density_reads_as_the_team_would_say_it() {
        let old = lock(vec![
            ("a.glb", mug("700 kg/m3", "0.1 kg")),
            ("b.glb", mug("700 kg/m3", "0.2 kg")),
            ("c.glb", mug("700 kg/m3", "0.3 kg")),
        ]);
        let wood = Entry { preset: "oak".to_owned(), ..mug("700 kg/m3", "0.3 kg") };
        let new = lock(vec![
            ("a.glb", mug("2180 kg/m3", "0.311 kg")),
            ("b.glb", mug("2180 kg/m3", "0.623 kg")),
            ("c.glb", wood),
            ("d.glb", mug("2180 kg/m3", "1 kg")),
        ]);
        let place = |cause: &str| (cause == "preset:ceramic").then(|| "catalog.yaml:812".to_owned());
        let after = Codes::from([("b.glb".to_owned(), BTreeSet::from(["SIM003"]))]);
        let diff = Diff::new(&old, &new, &place, (&Codes::new(), &after));
        assert_eq!(
            diff.groups[0].sentence(),
            "2 mugs: density 700 to 2,180 kg/m3 by preset ceramic (catalog.yaml:812); mass up 3.1 times; 1 now fails SIM003"
        );
        assert_eq!(diff.groups[1].sentence(), "1 mug: of oak instead of ceramic by rule ceramic-mug");
        assert_eq!((diff.added.len(), diff.removed.len(), diff.unchanged), (1, 0, 0));
        assert!(
            diff.text().ends_with("3 models changed for 2 reasons; 0 unchanged, 1 new, 0 gone\n"),
            "{}",
            diff.text()
        );
    }

    #[test]
    fn nothing_changed_is_nothing_told() {
        let lock = lock(vec![("a.glb", mug("700 kg/m3", "0.1 kg"))]);
        let (before, after) = none();
        let diff = Diff::new(&lock, &lock, &|_| None, (&before, &after));
        assert!(diff.is_empty() && diff.unchanged == 1);
        assert!(diff.markdown().contains("Nothing."));
    }

    #[test]
    fn a_model_whose_file_changed_as_well_is_told_by_itself() {
        let names = ["a.glb", "b.glb", "c.glb"];
        let old = lock(names.map(|name| (name, mug("700 kg/m3", "0.2 kg"))).into());
        let mut new = lock(names.map(|name| (name, mug("2180 kg/m3", "0.2 kg"))).into());
        new.entries
            .insert("b.glb".to_owned(), Entry { input: "1".repeat(16), ..mug("2180 kg/m3", "0.3 kg") });
        let (before, after) = none();
        let diff = Diff::new(&old, &new, &|_| None, (&before, &after));
        let told: Vec<String> = diff.groups.iter().map(Group::sentence).collect();
        assert_eq!(
            told,
            [
                "2 mugs: density 700 to 2,180 kg/m3 by preset ceramic",
                "1 mug: density 700 to 2,180 kg/m3 by preset ceramic; mass 0.2 to 0.3 kg; the file changed too"
            ]
        );
    }

    #[test]
    fn what_changed_for_most_is_told_first() {
        let names = ["a.glb", "b.glb", "c.glb"];
        let friction = |entry: Entry, value: &str| {
            let mut entry = entry;
            entry.attributes.push_str(value);
            entry.values.push(Held {
                name: "friction".to_owned(),
                value: value.to_owned(),
                by: String::new(),
            });
            entry
        };
        let old = lock(names.map(|name| (name, friction(mug("700 kg/m3", "0.2 kg"), "0.4"))).into());
        let mut new = lock(names.map(|name| (name, friction(mug("700 kg/m3", "0.2 kg"), "0.5"))).into());
        new.entries.insert("c.glb".to_owned(), friction(mug("700 kg/m3", "0.25 kg"), "0.5"));
        let (before, after) = none();
        let diff = Diff::new(&old, &new, &|_| None, (&before, &after));
        assert_eq!(
            diff.groups[0].sentence(),
            "3 mugs: friction 0.4 to 0.5 by preset ceramic; mass of 1 of them 0.2 to 0.25 kg"
        );
    }
}
