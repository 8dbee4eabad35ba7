//! Tags of many models in one file, as databases export them: a table or JSON.
//!
//! CSV: columns `path` and `tags`, tags parted by `;`. JSON: `{ "chairs/a.glb": ["oak", "stool"] }`. Paths are
//! relative to the folder of the models, `/` separated. They count as the tags of a table's `text` do.

use std::collections::BTreeMap;
use std::path::Path;

use crate::table;
use crate::text::error::MapError;
use crate::text::reader::Reader;
use crate::text::yaml;

/// Tags by model path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tags(BTreeMap<String, Vec<String>>);

impl Tags {
    /// # Errors
    /// The file cannot be read, or as [`Tags::parse`].
    pub fn load(path: &Path) -> Result<Self, MapError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| MapError::Read { path: path.to_path_buf(), reason: error.to_string() })?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Reads JSON where the text begins with a brace, else CSV. A path that stands twice has both rows' tags.
    ///
    /// # Errors
    /// A table without the columns `path` and `tags`, JSON that is no map of lists; every fault has its place.
    pub fn parse(file: &str, text: &str) -> Result<Self, MapError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim_start().starts_with('{') { Self::json(file, text) } else { Self::csv(file, text) }
    }

    /// JSON is YAML, whose reader knows the place of every fault.
    fn json(file: &str, text: &str) -> Result<Self, MapError> {
        let doc = yaml::parse(file, text)?;
        let mut reader = Reader::new(&doc);
        let mut tags = Self::default();
        if let Some(top) = reader.map(&doc.root) {
            for (key, value) in top.iter() {
                for item in reader.one_or_more(value) {
                    if let Some(tag) = reader.text(item) {
                        tags.add(key.text(), tag);
                    }
                }
            }
        }
        reader.finish(tags)
    }

    fn csv(file: &str, text: &str) -> Result<Self, MapError> {
        let mut tags = Self::default();
        for [path, list] in table::columns(file, text, ["path", "tags"])? {
            for tag in list.split(';') {
                tags.add(&path, tag);
            }
        }
        Ok(tags)
    }

    fn add(&mut self, path: &str, tag: &str) {
        let path = path.trim().replace('\\', "/");
        let path = path.strip_prefix("./").unwrap_or(&path);
        let tag = tag.trim();
        if !tag.is_empty() {
            self.0.entry(path.to_owned()).or_default().push(tag.to_owned());
        }
    }

    /// The tags of a model, none where the file does not name it.
    #[must_use]
    pub fn of(&self, model: &str) -> &[String] {
        self.0.get(model).map_or(&[], Vec::as_slice)
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_and_json_say_the_same() {
        let csv = Tags::parse("t.csv", "path,tags\r\na/b.glb,oak; stool\n./c.obj,\"a, b\"\n").unwrap();
        let json = Tags::parse("t.json", r#"{ "a/b.glb": ["oak", "stool"], "c.obj": "a, b" }"#).unwrap();
        assert_eq!(csv, json);
        assert_eq!(csv.of("a/b.glb"), ["oak", "stool"]);
        assert!(csv.of("b.glb").is_empty());
    }

    #[test]
    fn faults_have_their_place() {
        let place = |text: &str| Tags::parse("t", text).unwrap_err().place();
        assert_eq!(place("path,tag\n"), "t:1:1");
        assert_eq!(place("path,tags\na\n"), "t:2:1");
        assert_eq!(place("{\n  \"a\": [1, {}]\n}"), "t:2:12");
    }
}
