//! What changed between two mappings, in words of the domain, grouped by what caused it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde::Serialize;

use super::lock::{Entry, Held, Lock};
use super::rule::written;

/// A change of a mass, size or other number that is told as a ratio from here on; below it in percent.
const TIMES: f64 = 1.5;

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

    /// A line a group, then what came and went.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        for group in &self.groups {
            let _ = writeln!(text, "{}", group.sentence());
            let _ = writeln!(text, "    {}", examples(&group.models));
        }
        for (models, what) in [(&self.added, "new"), (&self.removed, "gone")] {
            if !models.is_empty() {
                let _ = writeln!(text, "{} {what}\n    {}", counted(models.len(), "model"), examples(models));
            }
        }
        let _ = writeln!(
            text,
            "{} changed for {}; {} unchanged, {} new, {} gone",
            counted(self.changed(), "model"),
            counted(self.groups.len(), "reason"),
            thousands(self.unchanged as f64),
            self.added.len(),
            self.removed.len()
        );
        text
    }

    /// For a comment on a pull request.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut text = String::from("## What the change does to the models\n\n");
        if self.is_empty() {
            text.push_str("Nothing.\n");
            return text;
        }
        for group in &self.groups {
            let _ = writeln!(
                text,
                "- {}\n  <details><summary>models</summary>\n\n  {}\n\n  </details>",
                group.sentence(),
                code_list(&group.models)
            );
        }
        for (models, what) in [(&self.added, "new"), (&self.removed, "gone")] {
            if !models.is_empty() {
                let _ =
                    writeln!(text, "- **{}** {what}: {}", counted(models.len(), "model"), code_list(models));
            }
        }
        let _ = writeln!(text, "\n{} unchanged.", counted(self.unchanged, "model"));
        text
    }
}

impl Group {
    /// `128 mugs: density 700 to 2,180 kg/m3 by rule ceramic-mug (catalog.yaml:812); mass up 3.1 times; 4 now fail SIM003`
    #[must_use]
    pub fn sentence(&self) -> String {
        let noun = if self.models.len() == 1 { self.noun.clone() } else { plural(&self.noun) };
        let mut changes = self.changes.iter();
        let mut text = format!(
            "{} {noun}: {}",
            thousands(self.models.len() as f64),
            changes.next().map_or("", String::as_str)
        );
        let cause = match self.cause.split_once(':') {
            Some((kind, name)) => format!("by {kind} {name}"),
            None => format!("by {}", self.cause),
        };
        let _ = write!(text, " {cause}");
        if !self.place.is_empty() {
            let _ = write!(text, " ({})", self.place);
        }
        for change in changes {
            let _ = write!(text, "; {change}");
        }
        for (code, count) in &self.fails {
            let _ = write!(text, "; {count} now {} {code}", if *count == 1 { "fails" } else { "fail" });
        }
        for (code, count) in &self.passes {
            let _ = write!(text, "; {count} no longer {} {code}", if *count == 1 { "fails" } else { "fail" });
        }
        text
    }
}

/// Two entries that say the same of the model, whatever line it stands on.
fn same(was: &Entry, now: &Entry) -> bool {
    let of = |entry: &Entry| {
        (
            entry.input.clone(),
            entry.rule.clone(),
            entry.category.clone(),
            entry.preset.clone(),
            entry.attributes.clone(),
        )
    };
    of(was) == of(now)
}

/// What most likely caused the change: the strongest of what differs.
fn cause(was: &Entry, now: &Entry) -> String {
    if was.category != now.category || was.preset != now.preset {
        return now.rule.clone();
    }
    let by_or_preset =
        |held: &Held| if held.by.is_empty() { format!("preset:{}", now.preset) } else { held.by.clone() };
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
        return "changed file".to_owned();
    }
    if changed.iter().any(|held| held.name == "scale") {
        return "another unit".to_owned();
    }
    now.rule.clone()
}

/// Models are told together where the same things changed in the same direction.
fn kind_of_change(was: &Entry, now: &Entry) -> String {
    let mut key = String::new();
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
        cause,
        noun: noun.to_owned(),
        models: pairs.iter().map(|(model, ..)| (*model).to_owned()).collect(),
        changes: changes(pairs),
        fails: count(before, after),
        passes: count(after, before),
    }
}

fn changes(pairs: &Pairs<'_>) -> Vec<String> {
    let mut told = Vec::new();
    let Some((_, first_was, first_now)) = pairs.first() else { return told };
    if first_was.category != first_now.category {
        told.push(format!("{} becomes {}", words(&first_was.category), words(&first_now.category)));
    }
    if first_was.preset != first_now.preset {
        told.push(format!("of {} instead of {}", first_now.preset, first_was.preset));
    }
    let mut names: Vec<&str> = Vec::new();
    for (_, was, now) in pairs {
        for held in now.values.iter().chain(&was.values) {
            if !names.contains(&held.name.as_str()) {
                names.push(&held.name);
            }
        }
    }
    // What else follows from: density before mass, as it stands in the lock.
    for name in names {
        told.extend(change(name, pairs));
    }
    if told.is_empty() && pairs.iter().any(|(_, was, now)| was.input != now.input) {
        told.push("other bytes, the same physics".to_owned());
    }
    if told.is_empty() {
        told.push(if first_was.rule == first_now.rule {
            "digits beyond the sixth".to_owned()
        } else {
            format!("decided anew (before by {}), the same physics", first_was.rule)
        });
    }
    told
}

/// One attribute over all models of a group; `None` where it is as it was.
fn change(name: &str, pairs: &Pairs<'_>) -> Option<String> {
    let differing: Vec<(Option<&str>, Option<&str>)> = pairs
        .iter()
        .map(|(_, was, now)| {
            (was.held(name).map(|held| held.value.as_str()), now.held(name).map(|held| held.value.as_str()))
        })
        .filter(|(was, now)| was != now)
        .collect();
    let first = differing.first()?;
    let of = if differing.len() == pairs.len() {
        String::new()
    } else {
        format!(" of {} of them", thousands(differing.len() as f64))
    };
    let name = name.replace('_', " ");
    if differing.iter().all(|pair| pair == first) {
        let shown = |value: &str| {
            let (number, unit) = value.split_once(' ').unwrap_or((value, ""));
            let number = number.parse().map_or_else(|_| number.replace('_', " "), thousands);
            (number, unit.to_owned())
        };
        return Some(match (first.0.map(shown), first.1.map(shown)) {
            (Some((was, unit)), Some((now, new_unit))) => {
                let unit = if unit == new_unit { String::new() } else { format!(" {unit}") };
                format!("{name}{of} {was}{unit} to {now} {new_unit}").trim_end().to_owned()
            }
            (None, Some((now, unit))) => format!("{name}{of} is new: {now} {unit}").trim_end().to_owned(),
            (Some((was, unit)), None) => {
                format!("{name}{of} is gone: it was {was} {unit}").trim_end().to_owned()
            }
            (None, None) => return None,
        });
    }
    let number =
        |value: Option<&str>| value?.split(' ').next()?.parse::<f64>().ok().filter(|value| *value > 0.0);
    let mut ratios: Vec<f64> =
        differing.iter().filter_map(|(was, now)| Some(number(*now)? / number(*was)?)).collect();
    if ratios.len() < differing.len() {
        return Some(format!("{name}{of} changes"));
    }
    ratios.sort_by(f64::total_cmp);
    let (least, median, most) = (ratios[0], ratios[ratios.len() / 2], ratios[ratios.len() - 1]);
    if least < 1.0 && most > 1.0 {
        return Some(format!("{name}{of} between {} and {}", ratio(least), ratio(most)));
    }
    let spread =
        if most / least > 1.05 { format!(" ({} to {})", ratio(least), ratio(most)) } else { String::new() };
    Some(format!("{name}{of} {}{spread}", ratio(median)))
}

/// `up 3.1 times`, `down 12 %`
fn ratio(value: f64) -> String {
    let (direction, times) = if value >= 1.0 { ("up", value) } else { ("down", 1.0 / value) };
    if times >= TIMES {
        format!("{direction} {} times", short(times))
    } else {
        format!("{direction} {} %", short((value - 1.0).abs() * 100.0))
    }
}

fn short(value: f64) -> String {
    if value >= 100.0 { thousands(value.round()) } else { written((value * 10.0).round() / 10.0) }
}

/// `2,180`
fn thousands(value: f64) -> String {
    let text = written(value);
    let (whole, rest) = text
        .split_once('.')
        .map_or((text.as_str(), String::new()), |(whole, rest)| (whole, format!(".{rest}")));
    if whole.len() <= 4 && !(whole.len() == 4 && whole.bytes().all(|digit| digit.is_ascii_digit()))
        || whole.contains('e')
    {
        return text;
    }
    let mut grouped = String::new();
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && (whole.len() - index) % 3 == 0 && grouped != "-" {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped + &rest
}

fn words(category: &str) -> String {
    if category == "-" {
        "uncategorized".to_owned()
    } else {
        category.rsplit('/').next().unwrap_or(category).to_owned()
    }
}

/// Of a subcategory's name: English plurals as far as such names need them.
fn plural(noun: &str) -> String {
    let ends = |endings: &[&str]| endings.iter().any(|ending| noun.ends_with(ending));
    match noun.strip_suffix('y') {
        Some(stem) if !ends(&["ay", "ey", "oy", "uy"]) => format!("{stem}ies"),
        _ if ends(&["s", "x", "ch", "sh", "z"]) => format!("{noun}es"),
        _ => format!("{noun}s"),
    }
}

fn counted(count: usize, noun: &str) -> String {
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let number = thousands(count as f64);
    if count == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

fn examples(models: &[String]) -> String {
    let mut text = models.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
    if models.len() > 3 {
        let _ = write!(text, " and {} more", models.len() - 3);
    }
    text
}

fn code_list(models: &[String]) -> String {
    let mut listed = models
        .iter()
        .take(30)
        .map(|model| format!("`{}`", model.replace('`', "'")))
        .collect::<Vec<_>>()
        .join(", ");
    if models.len() > 30 {
        let _ = write!(listed, " and {} more", models.len() - 30);
    }
    listed
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
    fn numbers_and_nouns_are_written_as_people_do() {
        assert_eq!(
            [700.0, 2180.0, 12_500.0, 0.25, 1.5e9].map(thousands),
            ["700", "2,180", "12,500", "0.25", "1.500e9"]
        );
        assert_eq!(
            ["mug", "box", "berry", "tray", "dish"].map(plural),
            ["mugs", "boxes", "berries", "trays", "dishes"]
        );
        assert_eq!(
            [3.1, 0.5, 1.12, 0.9].map(ratio),
            ["up 3.1 times", "down 2 times", "up 12 %", "down 10 %"]
        );
    }
}
