//! The header of a PLY file: which elements, with which properties, in which encoding.

use crate::ImportError;

/// A header longer than this is no header.
const LONGEST: usize = 1 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    /// The count's type, where the property is a list.
    pub list: Option<Scalar>,
    pub scalar: Scalar,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Where the body begins.
    pub length: usize,
}

impl Scalar {
    pub const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<Header, ImportError> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut offset = 0;
    let mut number = 0;
    while offset < bytes.len().min(LONGEST) {
        let end = bytes[offset..].iter().position(|&byte| byte == b'\n' || byte == b'\r');
        let Some(end) = end.map(|end| offset + end) else { break };
        let line = String::from_utf8_lossy(&bytes[offset..end]);
        offset = end + 1;
        if bytes[end] == b'\r' && bytes.get(offset) == Some(&b'\n') {
            offset += 1;
        }
        number += 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let refuse = |expected: &str| {
            Err(ImportError::malformed(
                format!("line {number}"),
                format!("expected {expected}, found {:?}", line.chars().take(60).collect::<String>()),
            ))
        };
        match words.as_slice() {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return refuse("\"ply\""),
            ["format", name, ..] => {
                encoding = match *name {
                    "ascii" => Some(Encoding::Text),
                    "binary_little_endian" => Some(Encoding::LittleEndian),
                    "binary_big_endian" => Some(Encoding::BigEndian),
                    _ => return refuse("ascii, binary_little_endian or binary_big_endian"),
                };
            }
            ["element", name, count] => {
                let Ok(count) = count.parse() else { return refuse("a count") };
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            ["property", rest @ ..] => {
                let (Some(property), Some(element)) = (property(rest), elements.last_mut()) else {
                    return refuse("property TYPE NAME or property list TYPE TYPE NAME, after an element");
                };
                element.properties.push(property);
            }
            ["end_header"] => {
                let Some(encoding) = encoding else {
                    return Err(ImportError::malformed("header", "expected a line \"format\", found none"));
                };
                return Ok(Header { encoding, elements, length: offset });
            }
            [] | ["comment" | "obj_info", ..] => {}
            _ => return refuse("format, element, property, comment or end_header"),
        }
    }
    Err(ImportError::malformed("header", "expected a line \"end_header\", found the end of the file"))
}

fn property(words: &[&str]) -> Option<Property> {
    Some(match words {
        ["list", count, scalar, name] => Property {
            name: (*name).to_owned(),
            list: Some(Scalar::named(count)?),
            scalar: Scalar::named(scalar)?,
        },
        [scalar, name] => Property { name: (*name).to_owned(), list: None, scalar: Scalar::named(scalar)? },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_with_both_names_of_a_type_and_windows_lines() {
        let text =
            b"ply\r\nformat binary_big_endian 1.0\r\ncomment x\r\nelement vertex 3\r\nproperty float32 x\r\n\
            element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\nBODY";
        let header = parse(text).unwrap();
        assert_eq!(header.encoding, Encoding::BigEndian);
        assert_eq!(header.elements[0].properties[0].scalar, Scalar::F32);
        assert_eq!(header.elements[1].properties[0].list, Some(Scalar::U8));
        assert_eq!(&text[header.length..], b"BODY");
    }

    #[test]
    fn a_bad_line_is_named() {
        let error = parse(b"ply\nformat ascii 1.0\nproperty float x\nend_header\n").unwrap_err();
        assert_eq!(error.place(), "line 3");
        assert_eq!(parse(b"ply\nformat ascii 1.0\n").unwrap_err().place(), "header");
    }
}
