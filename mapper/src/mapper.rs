//! From facts to physics: the whole way for one model, without touching a file.

use std::borrow::Cow;

use crate::answer::consult::Consulted;
use crate::facts::ModelFacts;
use crate::mapped::Mapped;
use crate::rules::overrides::{Overrides, SetValue, Sidecar};
use crate::rules::ruleset::Ruleset;
use crate::tags::Tags;

/// Rules and project overrides; maps any number of models, from any number of threads.
#[derive(Clone, Debug)]
pub struct Mapper {
    rules: Ruleset,
    overrides: Overrides,
    tags: Tags,
}

impl Mapper {
    #[must_use]
    pub fn new(rules: Ruleset, overrides: Overrides) -> Self {
        Self { rules, overrides, tags: Tags::default() }
    }

    /// The same with tags of models, which are read beside those that a model brings.
    #[must_use]
    pub fn with_tags(self, tags: Tags) -> Self {
        Self { tags, ..self }
    }

    #[must_use]
    pub fn tags(&self) -> &Tags {
        &self.tags
    }

    #[must_use]
    pub fn rules(&self) -> &Ruleset {
        &self.rules
    }

    #[must_use]
    pub fn overrides(&self) -> &Overrides {
        &self.overrides
    }

    /// Category, kind, scale and every attribute of a model.
    #[must_use]
    pub fn map(&self, facts: &ModelFacts, cli: &[SetValue]) -> Mapped {
        self.map_with_sidecar(facts, None, cli)
    }

    /// The same with the file beside the model.
    #[must_use]
    pub fn map_with_sidecar(
        &self,
        facts: &ModelFacts,
        sidecar: Option<&Sidecar>,
        cli: &[SetValue],
    ) -> Mapped {
        self.consult(facts, sidecar, cli).answer()
    }

    /// What the answer for a model rests on, for whoever wants to know that before or instead of the answer.
    #[must_use]
    pub fn consult<'m>(
        &'m self,
        facts: &'m ModelFacts,
        sidecar: Option<&'m Sidecar>,
        cli: &'m [SetValue],
    ) -> Consulted<'m> {
        Consulted::new(&self.rules, &self.overrides, self.tagged(facts, sidecar), sidecar, cli)
    }

    /// With the words that the manifest and the sidecar have for this model.
    fn tagged<'m>(&self, facts: &'m ModelFacts, sidecar: Option<&Sidecar>) -> Cow<'m, ModelFacts> {
        let tags = self.tags.of(&facts.model);
        let beside = sidecar.map_or(&[][..], |sidecar| &sidecar.tags);
        let title = sidecar.and_then(|sidecar| sidecar.title.as_ref());
        if tags.is_empty() && beside.is_empty() && title.is_none() {
            return Cow::Borrowed(facts);
        }
        let mut facts = facts.clone();
        facts.tags.extend(tags.iter().chain(beside).cloned());
        facts.title = title.cloned().or(facts.title);
        Cow::Owned(facts)
    }
}
