//! How analytical shapes written in YAML come in: the importer asks whoever reads YAML.
//!
//! YAML, with units on every length and the place of every fault, is the mapper's, and the mapper depends on this
//! crate. A function handed in with the options keeps both the arrow and the one reader; a second YAML parser here
//! would have been the alternative.

use std::fmt;

use crate::Primitive;

/// Reads the text of a `*.shapes.yaml` file.
#[derive(Clone, Copy)]
pub struct ShapesReader(pub fn(&str) -> Result<Vec<NamedShape>, ShapesFault>);

/// One shape of a file, lengths in m, Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedShape {
    pub name: Option<String>,
    pub material: Option<String>,
    pub primitive: Primitive,
}

/// What is wrong with the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapesFault {
    /// `line 3 column 9`.
    pub place: String,
    pub reason: String,
}

impl fmt::Debug for ShapesReader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ShapesReader")
    }
}

/// There is one language of shapes: readers of it do not differ.
impl PartialEq for ShapesReader {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
