//! A difference as text, for a terminal and for a comment on a pull request.

use std::fmt::Write as _;

use super::words::{counted, plural, thousands};
use super::{Diff, Group};

impl Diff {
    /// A line a group, then what came and went.
    #[must_use]
    pub fn text(&self) -> String {
        if self.is_empty() {
            return format!("nothing changed: {}\n", counted(self.unchanged, "model"));
        }
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

fn examples(models: &[String]) -> String {
    let mut text = models.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
    if models.len() > 3 {
        let _ = write!(text, " and {} more", thousands((models.len() - 3) as f64));
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
        let _ = write!(listed, " and {} more", thousands((models.len() - 30) as f64));
    }
    listed
}
