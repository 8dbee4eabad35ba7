//! Walking a parsed file: typed getters that note what does not fit, with its place and the way out.

use crate::text::error::{Diagnostic, MapError};
use crate::text::units::{self, Dimension, UnitError};
use crate::text::yaml::{Data, Document, Node, diagnostic};

/// A map whose keys have been checked.
#[derive(Clone, Copy)]
pub struct Fields<'d>(&'d [(Node, Node)]);

impl<'d> Fields<'d> {
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&'d Node> {
        self.pair(name).map(|(_, value)| value)
    }

    #[must_use]
    pub fn pair(&self, name: &str) -> Option<(&'d Node, &'d Node)> {
        self.0.iter().find(|(key, _)| key.text() == name).map(|(key, value)| (key, value))
    }

    pub fn iter(&self) -> impl Iterator<Item = (&'d Node, &'d Node)> + use<'d> {
        self.0.iter().map(|(key, value)| (key, value))
    }
}

impl Node {
    /// The text of a scalar, empty for anything else.
    #[must_use]
    pub fn text(&self) -> &str {
        match &self.data {
            Data::Scalar { text, .. } => text,
            _ => "",
        }
    }

    fn what(&self) -> String {
        match &self.data {
            Data::Scalar { text, .. } if text.is_empty() => "nothing".to_owned(),
            Data::Scalar { text, .. } => format!("`{}`", text.chars().take(40).collect::<String>()),
            Data::List(_) => "a list".to_owned(),
            Data::Map(_) => "a map".to_owned(),
        }
    }
}

/// Walks a document and collects what does not fit. Every getter says `None` after it has noted a fault.
pub struct Reader<'d> {
    pub doc: &'d Document,
    faults: Vec<Diagnostic>,
}

impl<'d> Reader<'d> {
    #[must_use]
    pub fn new(doc: &'d Document) -> Self {
        Self { doc, faults: Vec::new() }
    }

    /// The value, or every fault that was noted on the way to it.
    ///
    /// # Errors
    /// [`MapError::Invalid`] where anything was noted.
    pub fn finish<T>(self, value: T) -> Result<T, MapError> {
        if self.faults.is_empty() { Ok(value) } else { Err(MapError::Invalid(self.faults)) }
    }

    pub fn fault(&mut self, node: &Node, code: &'static str, message: String, label: &str, help: String) {
        // A file with thousands of faults is one fault; each costs a walk over the text.
        if self.faults.len() < 200 {
            let made =
                diagnostic(&self.doc.file, &self.doc.text, node.span, code, message, label.to_owned(), help);
            self.faults.push(made);
        }
    }

    pub fn map(&mut self, node: &'d Node) -> Option<Fields<'d>> {
        match &node.data {
            Data::Map(pairs) => Some(Fields(pairs)),
            Data::Scalar { text, quoted: false } if text.is_empty() || text == "~" || text == "null" => {
                Some(Fields(&[]))
            }
            _ => {
                self.fault(
                    node,
                    "CAT003",
                    format!("expected a map, found {}", node.what()),
                    "here",
                    String::new(),
                );
                None
            }
        }
    }

    /// A map whose keys are all known; an unknown one is noted with the nearest known name.
    pub fn fields(&mut self, node: &'d Node, known: &[&str]) -> Option<Fields<'d>> {
        let fields = self.map(node)?;
        for (key, _) in fields.iter() {
            if !known.contains(&key.text()) {
                self.unknown(key, "key", known.iter().copied());
            }
        }
        Some(fields)
    }

    pub fn list(&mut self, node: &'d Node) -> Option<&'d [Node]> {
        match &node.data {
            Data::List(items) => Some(items),
            _ => {
                self.fault(
                    node,
                    "CAT003",
                    format!("expected a list, found {}", node.what()),
                    "here",
                    "write `[a, b]`".to_owned(),
                );
                None
            }
        }
    }

    /// A list, or one value standing for a list of one.
    #[must_use]
    pub fn one_or_more(&self, node: &'d Node) -> &'d [Node] {
        match &node.data {
            Data::List(items) => items,
            _ => std::slice::from_ref(node),
        }
    }

    pub fn text(&mut self, node: &'d Node) -> Option<&'d str> {
        match &node.data {
            Data::Scalar { text, .. } if !text.is_empty() => Some(text),
            _ => {
                self.fault(
                    node,
                    "CAT003",
                    format!("expected a word or text, found {}", node.what()),
                    "here",
                    String::new(),
                );
                None
            }
        }
    }

    pub fn boolean(&mut self, node: &'d Node) -> Option<bool> {
        match node.text() {
            "true" => Some(true),
            "false" => Some(false),
            _ => {
                let message = format!("expected true or false, found {}", node.what());
                self.fault(node, "CAT003", message, "here", String::new());
                None
            }
        }
    }

    /// A number with its unit, in SI; bare where the dimension is pure.
    pub fn quantity(&mut self, node: &'d Node, dimension: Dimension) -> Option<f64> {
        let Data::Scalar { text, .. } = &node.data else {
            let message = format!("expected a {dimension}, found {}", node.what());
            self.fault(node, "CAT003", message, "here", String::new());
            return None;
        };
        match units::parse(text, dimension) {
            Ok(value) => Some(value),
            Err(error) => {
                let help = match &error {
                    UnitError::UnitMissing { number, .. } => {
                        format!("write `{number} {}`", dimension.si_unit())
                    }
                    UnitError::UnitOnPure { .. } => "write the number alone".to_owned(),
                    _ if dimension == Dimension::Pure => "write a bare number such as 0.5".to_owned(),
                    _ => format!("units of {dimension}: {}", dimension.unit_list()),
                };
                self.fault(node, "CAT004", error.to_string(), "here", help);
                None
            }
        }
    }

    /// A quantity inside `[min, max]`.
    pub fn bounded(&mut self, node: &'d Node, dimension: Dimension, min: f64, max: f64) -> Option<f64> {
        let value = self.quantity(node, dimension)?;
        if (min..=max).contains(&value) {
            return Some(value);
        }
        let unit =
            if dimension == Dimension::Pure { String::new() } else { format!(" {}", dimension.si_unit()) };
        let message = format!("{value}{unit} is outside {min} to {max}{unit}");
        self.fault(node, "CAT008", message, "out of range", String::new());
        None
    }

    /// `[low, high]`, both of one dimension, low first.
    pub fn range(&mut self, node: &'d Node, dimension: Dimension) -> Option<[f64; 2]> {
        let items = self.list(node)?;
        let [low, high] = items else {
            self.fault(
                node,
                "CAT003",
                "expected two values, lowest and highest".to_owned(),
                "here",
                String::new(),
            );
            return None;
        };
        let range = [self.quantity(low, dimension)?, self.quantity(high, dimension)?];
        if range[0] <= range[1] {
            return Some(range);
        }
        self.fault(
            node,
            "CAT008",
            "the lowest value is above the highest".to_owned(),
            "here",
            "swap them".to_owned(),
        );
        None
    }

    /// Notes a name that is none of the known ones, with the nearest.
    pub fn unknown<'a>(&mut self, node: &Node, what: &str, known: impl Iterator<Item = &'a str>) {
        let name = node.text();
        let help = nearest(name, known).map_or_else(String::new, |near| format!("did you mean `{near}`?"));
        self.fault(
            node,
            if what == "key" { "CAT002" } else { "CAT005" },
            format!("unknown {what} `{name}`"),
            "not known",
            help,
        );
    }
}

/// The most similar of some names, where it is similar enough to be a slip of the hand; the first of equals.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut best: Option<(usize, &str)> = None;
    for candidate in known {
        let edits = strsim::osa_distance(name, candidate);
        let slip = edits <= 1 + name.chars().count() / 4 || strsim::jaro_winkler(name, candidate) >= 0.9;
        if slip && best.is_none_or(|(least, _)| edits < least) {
            best = Some((edits, candidate));
        }
    }
    best.map(|(_, name)| name)
}
