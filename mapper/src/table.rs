//! Models without meshes: a table of names, text and sizes in, a table of answers out.
//!
//! Columns read, by header, all but `id` optional: `id`, `path`, `name`, `text`, `dim_x`, `dim_y`, `dim_z` (m),
//! `solid_volume_m3`. Every other column is ignored. Columns written: see [`HEADER`].

use std::borrow::Cow;
use std::fmt::Write;
use std::ops::Range;
use std::sync::Arc;

use crate::answer::scale::gross;
use crate::facts::{ModelFacts, ShapeFacts};
use crate::mapped::Mapped;
use crate::mapper::Mapper;
use crate::rules::overrides::SetValue;
use crate::text::error::{Diagnostic, MapError};

/// What comes out. `scale_suspect` is 1 where the size is off by more than about five times from what such things
/// have, whether or not another unit explains it; `unit` is the unit that does, or `fitted`.
pub const HEADER: &str =
    "id,category,subcategory,synset,group,kind,mass_kg,confidence,unit,scale_suspect,rule";

/// Maps every row of a CSV text; the answers come in the same order. `file` is what messages call it.
///
/// # Errors
/// No `id` column, an unclosed quote, or a row with another number of fields than the header.
pub fn map_table(mapper: &Mapper, file: &str, csv: &str, cli: &[SetValue]) -> Result<String, MapError> {
    let mut out = format!("{HEADER}\n");
    for record in read(file, csv)? {
        let mapped = mapper.map(&record.facts, cli);
        let (group, size) = group_and_size(mapper, &mapped);
        let suspect = record.facts.longest().is_some_and(|longest| gross(longest, size));
        row(&mut out, &record.id, &mapped, group, suspect);
    }
    Ok(out)
}

/// One row of the table as facts.
#[derive(Clone, Debug)]
pub struct Record {
    pub id: String,
    pub facts: ModelFacts,
}

/// Reads a table.
///
/// # Errors
/// As [`map_table`].
pub fn read(file: &str, csv: &str) -> Result<Vec<Record>, MapError> {
    let csv = csv.strip_prefix('\u{feff}').unwrap_or(csv);
    let (header, rows) = open(file, csv)?;
    let column = |name: &str| header.fields.iter().position(|field| field == name);
    let id = needed(file, csv, &header, "id")?;
    let [path, name, text, x, y, z, volume] =
        ["path", "name", "text", "dim_x", "dim_y", "dim_z", "solid_volume_m3"].map(column);
    let mut records = Vec::new();
    for row in rows {
        let row = as_wide(file, csv, &header, row?)?;
        let get = |column: Option<usize>| {
            column.and_then(|column| row.fields.get(column)).map_or("", |field| &**field)
        };
        let number =
            |column| get(column).parse::<f64>().ok().filter(|value| value.is_finite() && *value > 0.0);
        let volume = number(volume);
        let shape = ShapeFacts {
            volume,
            volume_is_hull: false,
            area: None,
            hull_volume: None,
            closed: volume.is_some(),
            bodies: 1,
            spread: None,
        };
        let facts = ModelFacts {
            model: get(path).to_owned(),
            title: Some(get(name).to_owned()).filter(|title| !title.is_empty()),
            tags: get(text).split(';').filter(|tag| !tag.trim().is_empty()).map(str::to_owned).collect(),
            names: Vec::new(),
            materials: Vec::new(),
            extents: [number(x), number(y), number(z)],
            metres_per_unit: 1.0,
            unit_stated: true,
            shape: volume.map(|_| shape),
            parts: Vec::new(),
            stated: Vec::new(),
        };
        records.push(Record { id: get(Some(id)).to_owned(), facts });
    }
    Ok(records)
}

/// Two columns of a table by name.
///
/// # Errors
/// A column is not there, a quote stays open, or a row has another number of fields than the header.
pub(crate) fn columns(file: &str, csv: &str, names: [&str; 2]) -> Result<Vec<[String; 2]>, MapError> {
    let (header, rows) = open(file, csv)?;
    let [one, other] = names.map(|name| needed(file, csv, &header, name));
    let wanted = [one?, other?];
    let mut read = Vec::new();
    for row in rows {
        let row = as_wide(file, csv, &header, row?)?;
        read.push(wanted.map(|column| row.fields.get(column).map_or("", |field| &**field).to_owned()));
    }
    Ok(read)
}

fn open<'t>(file: &'t str, csv: &'t str) -> Result<(Row<'t>, Rows<'t>), MapError> {
    let mut rows = Rows { file, text: csv, at: 0, line: 1 };
    match rows.next().transpose()? {
        Some(header) => Ok((header, rows)),
        None => Err(fault(file, csv, 1, 0..0, "an empty table", "the first line names the columns")),
    }
}

fn needed(file: &str, csv: &str, header: &Row<'_>, name: &str) -> Result<usize, MapError> {
    header.fields.iter().position(|field| field == name).ok_or_else(|| {
        let message = format!("no column `{name}`");
        fault(file, csv, header.line, header.start..header.end, &message, "the first line names the columns")
    })
}

fn as_wide<'t>(file: &str, csv: &str, header: &Row<'_>, row: Row<'t>) -> Result<Row<'t>, MapError> {
    if row.fields.len() == header.fields.len() {
        return Ok(row);
    }
    let message = format!("{} fields where the header has {}", row.fields.len(), header.fields.len());
    Err(fault(file, csv, row.line, row.start..row.end, &message, "check commas and quotes in this line"))
}

fn group_and_size<'r>(
    mapper: &'r Mapper,
    mapped: &Mapped,
) -> (Option<&'r str>, Option<&'r crate::rules::category::Range>) {
    let rules = mapper.rules();
    let category = mapped.category.as_ref().and_then(|name| rules.names.categories.get(name));
    let Some(category) = category.map(|id| &rules.categories[*id]) else { return (None, None) };
    let subcategory = mapped.subcategory.as_ref().and_then(|name| {
        let id = rules.names.subcategories.get(&*format!("{}/{name}", category.name)).copied()??;
        Some(&rules.subcategories[id])
    });
    let group = subcategory.and_then(|sub| sub.group.as_deref()).or(category.group.as_deref());
    (group, subcategory.and_then(|sub| sub.size.as_ref()).or(category.size.as_ref()))
}

fn row(out: &mut String, id: &str, mapped: &Mapped, group: Option<&str>, suspect: bool) {
    let text = |text: &Option<Arc<str>>| text.as_deref().unwrap_or_default().to_owned();
    let mass = mapped.number("mass").map_or_else(String::new, |mass| format!("{mass:.6}"));
    let rule = mapped.trace.first().filter(|trace| trace.won).map_or_else(String::new, |trace| {
        format!("{} {} ({})", trace.by.place(), trace.by.by, trace.because)
    });
    let fields = [
        id.to_owned(),
        text(&mapped.category),
        text(&mapped.subcategory),
        text(&mapped.synset),
        group.unwrap_or_default().to_owned(),
        mapped.kind.to_string(),
        mass,
        format!("{:.3}", mapped.confidence),
        mapped.scale.unit.to_string(),
        u8::from(suspect).to_string(),
        rule,
    ];
    for (index, field) in fields.iter().enumerate() {
        let separator = if index + 1 == fields.len() { '\n' } else { ',' };
        // Writing into a String cannot fail.
        let _ = write!(out, "{}{separator}", quoted(field));
    }
}

fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains(['"', ',', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", field.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(field)
    }
}

fn fault(file: &str, csv: &str, line: u32, span: Range<usize>, message: &str, help: &str) -> MapError {
    let end = csv[span.start..span.end].find('\n').map_or(span.end, |newline| span.start + newline);
    MapError::Invalid(vec![Diagnostic {
        code: "CAT011",
        message: message.to_owned(),
        file: file.into(),
        line,
        column: 1,
        label: "this line".to_owned(),
        help: help.to_owned(),
        source: csv.into(),
        span: span.start..end,
    }])
}

/// RFC 4180: fields between commas, quoted where they hold commas, quotes or line breaks.
struct Rows<'t> {
    file: &'t str,
    text: &'t str,
    at: usize,
    line: u32,
}

struct Row<'t> {
    fields: Vec<Cow<'t, str>>,
    line: u32,
    start: usize,
    end: usize,
}

impl<'t> Iterator for Rows<'t> {
    type Item = Result<Row<'t>, MapError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.text[self.at..].starts_with(['\n', '\r']) {
            self.line += u32::from(self.text[self.at..].starts_with('\n'));
            self.at += 1;
        }
        if self.at >= self.text.len() {
            return None;
        }
        let (start, line) = (self.at, self.line);
        let mut fields = Vec::with_capacity(26);
        loop {
            match self.field() {
                Some(field) => fields.push(field),
                None => {
                    let message = "a quote is opened here and never closed";
                    return Some(Err(fault(
                        self.file,
                        self.text,
                        line,
                        start..self.text.len(),
                        message,
                        "close it",
                    )));
                }
            }
            let rest = &self.text[self.at..];
            if rest.starts_with(',') {
                self.at += 1;
                continue;
            }
            return Some(Ok(Row { fields, line, start, end: self.at }));
        }
    }
}

impl<'t> Rows<'t> {
    /// The next field, up to its comma or line end; `None` where a quote stays open.
    fn field(&mut self) -> Option<Cow<'t, str>> {
        let text = self.text;
        let rest = &text[self.at..];
        let Some(inner) = rest.strip_prefix('"') else {
            let length = rest.find([',', '\n', '\r']).unwrap_or(rest.len());
            self.at += length;
            return Some(Cow::Borrowed(&rest[..length]));
        };
        let mut from = 0;
        let mut owned = String::new();
        loop {
            let quote = from + inner[from..].find('"')?;
            let piece = &inner[from..quote];
            self.line += u32::try_from(piece.matches('\n').count()).unwrap_or(0);
            if inner[quote + 1..].starts_with('"') {
                owned.push_str(piece);
                owned.push('"');
                from = quote + 2;
                continue;
            }
            self.at += 1 + quote + 1;
            // Letters after the closing quote are kept, as spreadsheets do.
            let tail = text[self.at..].find([',', '\n', '\r']).unwrap_or(text.len() - self.at);
            let tail = &text[self.at..self.at + tail];
            self.at += tail.len();
            if owned.is_empty() && tail.is_empty() {
                return Some(Cow::Borrowed(piece));
            }
            owned.push_str(piece);
            owned.push_str(tail);
            return Some(Cow::Owned(owned));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn fields(csv: &str) -> Vec<Vec<String>> {
        let rows = Rows { file: "t", text: csv, at: 0, line: 1 };
        rows.map(|row| row.unwrap().fields.into_iter().map(Cow::into_owned).collect()).collect()
    }

    #[test]
    fn quotes_commas_and_line_breaks_are_read() {
        assert_eq!(
            fields("a,b\r\n1,\"x, \"\"y\"\"\nz\"\n\n,\n"),
            [vec!["a", "b"], vec!["1", "x, \"y\"\nz"], vec!["", ""]]
        );
    }

    #[test]
    fn faults_have_their_line() {
        let place = |csv: &str| read("table", csv).unwrap_err().place();
        assert_eq!(place("id,name\n1,a\n2\n"), "table:3:1");
        assert_eq!(place("id,name\n1,\"a\n"), "table:2:1");
        assert_eq!(place("name\na\n"), "table:1:1");
        assert!(read("table", "").is_err());
    }

    proptest! {
        #[test]
        fn what_is_quoted_reads_back(texts in prop::collection::vec("[ -~\n\",é]{0,12}", 1..5)) {
            let line = texts.iter().map(|text| quoted(text)).collect::<Vec<_>>().join(",") + ",end\n";
            let mut expected = texts.clone();
            expected.push("end".to_owned());
            // A row that begins with an empty line's character is skipped as one.
            prop_assume!(!line.starts_with(['\n', '\r']));
            prop_assert_eq!(fields(&line), [expected]);
        }

        #[test]
        fn no_table_makes_it_panic(csv in any::<String>()) {
            let _ = read("table", &csv);
        }
    }
}
