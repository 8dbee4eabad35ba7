//! YAML with a place for every key and value. The only file that names a YAML parser.
//!
//! The tree is built from the parser's events with a stack of its own, so that no nesting can overflow the
//! call stack, and is walked by [`Reader`], which collects every fault instead of stopping at the first.
//! Plain YAML 1.2 is read: one document, no aliases, no merge keys, no tags.

use std::collections::HashSet;
use std::sync::Arc;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::error::{Diagnostic, MapError};
use crate::units::{self, Dimension, UnitError};

/// Largest file, bytes.
const MAX_BYTES: usize = 64 << 20;
/// Deepest nesting.
const MAX_DEPTH: usize = 64;
/// Most keys and values.
const MAX_NODES: usize = 4_000_000;

/// Where a node stands. Offsets are in characters, as the parser counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    pub start: u32,
    pub end: u32,
    /// 1-based.
    pub line: u32,
    /// 1-based, in characters.
    pub column: u32,
}

/// A key or a value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    pub span: Span,
    pub data: Data,
}

/// What a node holds. Scalars stay text: what they must be is known by who asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    Scalar {
        text: String,
        quoted: bool,
    },
    List(Vec<Node>),
    /// In the order of the file; keys are scalars and unique.
    Map(Vec<(Node, Node)>),
}

/// One parsed file.
#[derive(Clone, Debug)]
pub struct Document {
    pub file: Arc<str>,
    pub text: Arc<str>,
    pub root: Node,
}

/// Parses one YAML document.
///
/// # Errors
/// The first place where the text is no YAML, has a key twice, or is beyond the limits of size and depth.
pub(crate) fn parse(file: &str, text: &str) -> Result<Document, MapError> {
    let file: Arc<str> = file.into();
    let text: Arc<str> = text.into();
    let fail = |span: Span, code, message: &str, help: &str| {
        MapError::Invalid(vec![diagnostic(
            &file,
            &text,
            span,
            code,
            message.to_owned(),
            String::new(),
            help.to_owned(),
        )])
    };
    if text.len() > MAX_BYTES {
        return Err(fail(Span::default(), "CAT009", "the file is larger than 64 MiB", "split it"));
    }
    let mut builder = Builder::default();
    let mut parser = Parser::new_from_str(&text);
    while let Some(event) = parser.next_event() {
        let (event, place) = event.map_err(|error| {
            let marker = error.marker();
            fail(
                at(marker, marker),
                "CAT001",
                &format!("not YAML: {}", error.info()),
                "check indentation, colons and quotes here",
            )
        })?;
        let span = at(&place.start, &place.end);
        builder.take(event, span).map_err(|(span, code, message)| fail(span, code, &message, ""))?;
        if builder.done {
            break;
        }
    }
    let root = builder.root.unwrap_or(Node {
        span: Span { line: 1, column: 1, ..Span::default() },
        data: Data::Map(Vec::new()),
    });
    Ok(Document { file, text, root })
}

fn at(start: &saphyr_parser::Marker, end: &saphyr_parser::Marker) -> Span {
    let short = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    Span {
        start: short(start.index()),
        end: short(end.index()),
        line: short(start.line()),
        column: short(start.col() + 1),
    }
}

type Fault = (Span, &'static str, String);

#[derive(Default)]
struct Builder {
    open: Vec<Open>,
    root: Option<Node>,
    nodes: usize,
    documents: usize,
    done: bool,
}

struct Open {
    node: Node,
    key: Option<Node>,
    seen: HashSet<String>,
}

impl Builder {
    fn take(&mut self, event: Event<'_>, span: Span) -> Result<(), Fault> {
        match event {
            Event::Nothing | Event::StreamStart | Event::DocumentEnd => Ok(()),
            Event::StreamEnd => {
                self.done = true;
                Ok(())
            }
            Event::DocumentStart(_) => {
                self.documents += 1;
                match self.documents {
                    1 => Ok(()),
                    _ => Err((span, "CAT001", "expected one YAML document, found a second".to_owned())),
                }
            }
            Event::Scalar(text, style, ..) => {
                let quoted = !matches!(style, ScalarStyle::Plain);
                self.close(Node { span, data: Data::Scalar { text: text.into_owned(), quoted } })
            }
            Event::SequenceStart(..) => self.start(span, Data::List(Vec::new())),
            Event::MappingStart(..) => self.start(span, Data::Map(Vec::new())),
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(Open { mut node, .. }) => {
                    node.span.end = span.end.max(node.span.end);
                    self.close(node)
                }
                None => Ok(()),
            },
            // Expanded aliases can be exponentially larger than the file and deeper than any limit on it.
            Event::Alias(_) => Err((span, "CAT001", "aliases are not read: write the value out".to_owned())),
        }
    }

    fn start(&mut self, span: Span, data: Data) -> Result<(), Fault> {
        if self.open.len() >= MAX_DEPTH {
            return Err((span, "CAT009", format!("nested deeper than {MAX_DEPTH} levels")));
        }
        self.open.push(Open { node: Node { span, data }, key: None, seen: HashSet::new() });
        Ok(())
    }

    fn close(&mut self, node: Node) -> Result<(), Fault> {
        self.nodes += 1;
        if self.nodes > MAX_NODES {
            return Err((node.span, "CAT009", format!("more than {MAX_NODES} values")));
        }
        let Some(open) = self.open.last_mut() else {
            self.root = Some(node);
            return Ok(());
        };
        match &mut open.node.data {
            Data::List(items) => items.push(node),
            Data::Map(pairs) => match open.key.take() {
                Some(key) => pairs.push((key, node)),
                None => {
                    let Data::Scalar { text, .. } = &node.data else {
                        return Err((node.span, "CAT003", "expected a plain word as key".to_owned()));
                    };
                    if !open.seen.insert(text.clone()) {
                        return Err((
                            node.span,
                            "CAT006",
                            format!("the key `{text}` stands here a second time"),
                        ));
                    }
                    open.key = Some(node);
                }
            },
            Data::Scalar { .. } => {}
        }
        Ok(())
    }
}

fn diagnostic(
    file: &Arc<str>,
    text: &Arc<str>,
    span: Span,
    code: &'static str,
    message: String,
    label: String,
    help: String,
) -> Diagnostic {
    let byte = |index: u32| text.char_indices().nth(index as usize).map_or(text.len(), |(byte, _)| byte);
    let start = byte(span.start);
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let end = byte(span.end.max(span.start)).clamp(start, line_end.max(start));
    let end = start + text[start..end].trim_end().len();
    Diagnostic {
        code,
        message,
        file: Arc::clone(file),
        line: span.line,
        column: span.column,
        label,
        help,
        source: Arc::clone(text),
        span: start..end,
    }
}

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

/// Every scalar of a text with its path, in order: for comparing this reader with another.
///
/// # Errors
/// As [`parse`].
pub fn scalars(file: &str, text: &str) -> Result<Vec<(String, String)>, MapError> {
    fn walk(node: &Node, path: &str, out: &mut Vec<(String, String)>) {
        match &node.data {
            Data::Scalar { text, .. } => out.push((path.to_owned(), text.clone())),
            Data::List(items) => {
                for (index, item) in items.iter().enumerate() {
                    walk(item, &format!("{path}/{index}"), out);
                }
            }
            Data::Map(pairs) => {
                for (key, value) in pairs {
                    walk(value, &format!("{path}/{}", key.text()), out);
                }
            }
        }
    }
    let mut out = Vec::new();
    walk(&parse(file, text)?.root, "", &mut out);
    Ok(out)
}

/// The most similar of some names, where it is similar enough to be a slip of the hand; the first of equals.
pub(crate) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
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
