//! The places where a model's names stand, strongest first, and the names in them.

use crate::facts::ModelFacts;

/// Where a name was found, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Signal {
    /// The file's name, or the display name.
    Name,
    /// The n-th folder above the file.
    Folder(u8),
    Tag,
    /// A node, mesh or object.
    Node,
    Material,
}

impl Signal {
    /// How sure a clean match here makes.
    pub fn weight(self) -> f64 {
        match self {
            Self::Name => 0.92,
            Self::Folder(0) => 0.72,
            Self::Folder(1) => 0.58,
            Self::Folder(_) => 0.50,
            Self::Tag => 0.74,
            Self::Node => 0.62,
            Self::Material => 0.22,
        }
    }

    pub fn place(self) -> &'static str {
        match self {
            Self::Name => "name",
            Self::Folder(0) => "folder",
            Self::Folder(_) => "folder above",
            Self::Tag => "tags",
            Self::Node => "node name",
            Self::Material => "material name",
        }
    }
}

/// Every name of a model with the place where it stands.
#[must_use]
pub(crate) fn signals(facts: &ModelFacts) -> Vec<(Signal, &str)> {
    let mut signals = Vec::with_capacity(8);
    let (stem, _) = facts.stem();
    // An inverted title ("Pears, raw, red") loses its commas on the way to a file name, and with them its head.
    if !facts.title.as_ref().is_some_and(|title| title.contains(',')) {
        signals.push((Signal::Name, stem));
    }
    if let Some(title) = &facts.title
        && title != stem
    {
        signals.push((Signal::Name, title.as_str()));
    }
    for (level, folder) in facts.model.rsplit('/').skip(1).take(6).enumerate() {
        if !folder.is_empty() && folder != "." {
            signals.push((Signal::Folder(u8::try_from(level).unwrap_or(u8::MAX)), folder));
        }
    }
    // A scene with hundreds of nodes says little by each of them.
    signals.extend(facts.tags.iter().take(16).map(|tag| (Signal::Tag, tag.as_str())));
    signals.extend(facts.names.iter().take(24).map(|name| (Signal::Node, name.as_str())));
    signals.extend(facts.materials.iter().take(16).map(|name| (Signal::Material, name.as_str())));
    signals
}
