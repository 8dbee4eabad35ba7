//! One value written into an override file, everything else kept to the byte: comments, order, layout.

use crate::text::error::MapError;
use crate::text::reader::Reader;
use crate::text::yaml::{self, Data, Node};

/// Sets `name` to `value` and gives the new text. `selector`: the `match` of an entry in a project file, which is
/// added where there is none; `None` for a sidecar, whose keys stand at the top. The value is YAML and is not
/// checked here: parse the result.
///
/// # Errors
/// The text is no YAML, or its `overrides` is no list.
pub fn set(
    file: &str,
    text: &str,
    selector: Option<&str>,
    name: &str,
    value: &str,
) -> Result<String, MapError> {
    let doc = yaml::parse(file, text)?;
    let bytes = Bytes::of(text);
    let Some(selector) = selector else {
        return Ok(put(text, &bytes, &doc.root, name, value, 0));
    };
    let mut reader = Reader::new(&doc);
    let top = reader.map(&doc.root);
    let list = top.and_then(|top| top.get("overrides"));
    let entries = match list {
        Some(node) => reader.list(node).unwrap_or_default(),
        None => &[],
    };
    reader.finish(())?;
    for entry in entries {
        let Data::Map(pairs) = &entry.data else { continue };
        let of = |key: &str| pairs.iter().find(|(known, _)| known.text() == key).map(|(_, value)| value);
        if of("match").is_none_or(|matching| matching.text() != selector) {
            continue;
        }
        if let Some(set) = of("set") {
            return Ok(put(text, &bytes, set, name, value, indent(entry) + 2));
        }
        let at = end_of_line(text, bytes.at(last_offset(entry)));
        let pad = " ".repeat(indent(entry));
        return Ok(insert(text, at, &format!("{pad}set: {{ {name}: {value} }}\n")));
    }
    let entry = format!("match: '{}'\n", selector.replace('\'', "''"));
    let set = format!("set: {{ {name}: {value} }}\n");
    if let Some(last) = entries.last() {
        let at = end_of_line(text, bytes.at(last_offset(last)));
        let pad = " ".repeat(indent(last).saturating_sub(2));
        return Ok(insert(text, at, &format!("{pad}- {entry}{pad}  {set}")));
    }
    let head = if list.is_some() { "" } else { "overrides:\n" };
    let at = list.map_or(text.len(), |node| end_of_line(text, bytes.at(node.span.end)));
    Ok(insert(text, at, &format!("{head}  - {entry}    {set}")))
}

/// Replaces or adds one key of a map.
fn put(text: &str, bytes: &Bytes, node: &Node, name: &str, value: &str, pad: usize) -> String {
    let Data::Map(pairs) = &node.data else { return text.to_owned() };
    if let Some((_, old)) = pairs.iter().find(|(key, _)| key.text() == name) {
        let (start, end) = (bytes.at(old.span.start), bytes.at(last_offset(old)));
        let end = start + text[start..end.max(start)].trim_end().len();
        return format!("{}{value}{}", &text[..start], &text[end..]);
    }
    let start = bytes.at(node.span.start);
    let flow = text[start..].starts_with('{');
    if flow {
        let close = text[..bytes.at(node.span.end).max(start)].rfind('}').unwrap_or(start);
        let inner = text[start + 1..close].trim_end();
        let comma = if inner.trim().is_empty() { " " } else { ", " };
        let kept = start + 1 + inner.len();
        return format!("{}{comma}{name}: {value} {}", &text[..kept], &text[close..]);
    }
    let pad = pairs.first().map_or(pad, |(key, _)| indent(key));
    let at = pairs.last().map_or(text.len(), |(_, last)| end_of_line(text, bytes.at(last_offset(last))));
    insert(text, at, &format!("{}{name}: {value}\n", " ".repeat(pad)))
}

fn indent(node: &Node) -> usize {
    node.span.column.saturating_sub(1) as usize
}

/// Where the last scalar or bracket of a node ends: a block's own end mark may lie beyond comments that follow.
fn last_offset(node: &Node) -> u32 {
    match &node.data {
        Data::Scalar { .. } => node.span.end,
        Data::List(items) => {
            items.last().map_or(node.span.end, |last| last_offset(last).max(flow_end(node, last)))
        }
        Data::Map(pairs) => {
            pairs.last().map_or(node.span.end, |(_, last)| last_offset(last).max(flow_end(node, last)))
        }
    }
}

/// A flow collection ends at its bracket, on the line of its last item as a rule; a block ends with that item.
fn flow_end(node: &Node, last: &Node) -> u32 {
    if node.span.end <= last.span.end + 3 { node.span.end } else { last.span.end }
}

fn end_of_line(text: &str, at: usize) -> usize {
    text[at.min(text.len())..].find('\n').map_or(text.len(), |newline| at + newline + 1)
}

fn insert(text: &str, at: usize, line: &str) -> String {
    let (before, after) = text.split_at(at.min(text.len()));
    let newline = if before.is_empty() || before.ends_with('\n') { "" } else { "\n" };
    format!("{before}{newline}{line}{after}")
}

/// Character offsets to byte offsets.
struct Bytes(Vec<usize>);

impl Bytes {
    fn of(text: &str) -> Self {
        Self(text.char_indices().map(|(byte, _)| byte).chain([text.len()]).collect())
    }

    fn at(&self, index: u32) -> usize {
        let last = self.0.len() - 1;
        self.0[(index as usize).min(last)]
    }
}

#[cfg(test)]
mod tests {
    use super::set;

    #[test]
    fn a_sidecar_keeps_its_comments_and_order() {
        let text = "# weighed by hand\nmass: 2.4 kg   # with lid\n\npreset: oak\n# end\n";
        let new = set("t", text, None, "mass", "3 kg").unwrap();
        assert_eq!(new, text.replace("2.4 kg", "3 kg"));
        let new = set("t", text, None, "unit", "cm").unwrap();
        assert_eq!(new, text.replace("preset: oak\n", "preset: oak\nunit: cm\n"));
        assert_eq!(set("t", "", None, "mass", "1 kg").unwrap(), "mass: 1 kg\n");
    }

    #[test]
    fn a_project_file_gets_its_entry_or_a_new_one() {
        let text = "version: 1\noverrides:\n  # chairs\n  - match: 'a/*.glb'\n    set: { preset: oak }  # ours\n  - match: b.glb\n    set:\n      mass: 1 kg\n";
        let new = set("t", text, Some("a/*.glb"), "mass", "2 kg").unwrap();
        assert_eq!(new, text.replace("{ preset: oak }", "{ preset: oak, mass: 2 kg }"));
        let new = set("t", text, Some("b.glb"), "mass", "2 kg").unwrap();
        assert_eq!(new, text.replace("mass: 1 kg", "mass: 2 kg"));
        let new = set("t", text, Some("b.glb"), "kind", "soft").unwrap();
        assert_eq!(new, text.replace("mass: 1 kg\n", "mass: 1 kg\n      kind: soft\n"));
        let new = set("t", text, Some("c.glb"), "kind", "soft").unwrap();
        assert_eq!(new, format!("{text}  - match: 'c.glb'\n    set: {{ kind: soft }}\n"));
        let new = set("t", "", Some("c.glb"), "kind", "soft").unwrap();
        assert_eq!(new, "overrides:\n  - match: 'c.glb'\n    set: { kind: soft }\n");
    }
}
