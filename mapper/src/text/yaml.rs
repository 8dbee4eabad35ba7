//! YAML with a place for every key and value. The only file that names a YAML parser.
//!
//! The tree is built from the parser's events with a stack of its own, so that no nesting can overflow the
//! call stack, and is walked by [`crate::text::reader::Reader`].
//! Plain YAML 1.2 is read: one document, no aliases, no merge keys, no tags.

use std::collections::HashSet;
use std::sync::Arc;

use saphyr_parser::{Event, Parser, ScalarStyle};

use crate::text::error::{Diagnostic, MapError};

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
pub fn parse(file: &str, text: &str) -> Result<Document, MapError> {
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

pub(crate) fn diagnostic(
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
    // As editors count: to YAML a carriage return by itself ends a line as well.
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let counted = |count: usize| u32::try_from(count + 1).unwrap_or(u32::MAX);
    Diagnostic {
        code,
        message,
        file: Arc::clone(file),
        line: counted(text[..start].matches('\n').count()),
        column: counted(text[line_start..start].chars().count()),
        label,
        help,
        source: Arc::clone(text),
        span: start..end,
    }
}

/// Every scalar of a text with its path, in order: for comparing this reader with another.
///
/// # Errors
/// As `parse`.
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
