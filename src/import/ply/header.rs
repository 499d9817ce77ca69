//! The header of a PLY file.

use std::path::Path;

use super::super::shown;
use crate::error::{Error, Place};

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A scalar type.
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

impl Scalar {
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

    /// Size in a binary body.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// One value or list of every entry of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
}

/// A table of entries.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    /// Line of its declaration.
    pub line: usize,
    pub properties: Vec<Property>,
}

impl Element {
    /// The place of a property.
    pub fn find(&self, names: &[&str]) -> Option<usize> {
        self.properties
            .iter()
            .position(|property| names.contains(&property.name.as_str()))
    }
}

/// A parsed header.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Number of lines of the header.
    pub lines: usize,
    /// Offset of the body.
    pub body: usize,
    /// What ends a line: `\r` alone in files of old Macs.
    pub line_end: u8,
}

impl Header {
    /// An element by name.
    pub fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }
}

/// Elements of a header; real files have a handful.
const MAX_ELEMENTS: usize = 256;

const FORMATS: &str =
    "`format ascii 1.0`, `binary_little_endian 1.0` and `binary_big_endian 1.0` can be read";
const PROPERTY: &str = "write `property TYPE NAME` or `property list TYPE TYPE NAME`, of types \
    char uchar short ushort int uint float double";
const ELEMENT: &str = "write `element NAME COUNT`";

/// Reads a header. Lines may end in `\n`, `\r\n`, any mix of them, or all
/// in `\r`.
pub(super) fn read(file: &Path, bytes: &[u8]) -> Result<Header, Error> {
    let mut header = Header {
        format: Format::Ascii,
        elements: Vec::new(),
        lines: 0,
        body: 0,
        line_end: line_end(bytes),
    };
    let mut format = None;
    while header.body < bytes.len() {
        let rest = &bytes[header.body..];
        let length = rest.iter().position(|&byte| byte == header.line_end);
        let text = String::from_utf8_lossy(&rest[..length.unwrap_or(rest.len())]);
        header.body += length.map_or(rest.len(), |length| length + 1);
        header.lines += 1;
        let words: Vec<&str> = text.split_whitespace().collect();
        let end = read_line(&words, &mut header, &mut format)
            .map_err(|(what, remedy)| Error::at(file, Place::Line(header.lines), what, remedy))?;
        if end {
            let missing = || Error::file(file, "the header has no `format` line", FORMATS);
            header.format = format.ok_or_else(missing)?;
            return Ok(header);
        }
    }
    let what = "the header has no `end_header` line";
    Err(Error::at(
        file,
        Place::Line(header.lines),
        what,
        "is the file complete?",
    ))
}

fn line_end(bytes: &[u8]) -> u8 {
    let first = bytes.iter().position(|byte| matches!(byte, b'\r' | b'\n'));
    match first {
        Some(at) if bytes[at] == b'\r' && bytes.get(at + 1) != Some(&b'\n') => b'\r',
        _ => b'\n',
    }
}

/// Reads one line; true at the end of the header.
fn read_line(
    words: &[&str],
    header: &mut Header,
    format: &mut Option<Format>,
) -> Result<bool, (String, &'static str)> {
    let is_first = header.lines == 1;
    match words {
        ["ply"] if is_first => {}
        _ if is_first => {
            return Err((
                "the first line is not `ply`".to_owned(),
                "is this a PLY file?",
            ));
        }
        [] | ["comment" | "obj_info", ..] => {}
        ["format", name, "1.0"] => {
            *format = Some(match *name {
                "ascii" => Format::Ascii,
                "binary_little_endian" => Format::LittleEndian,
                "binary_big_endian" => Format::BigEndian,
                _ => return Err((format!("unknown format `{}`", shown(name)), FORMATS)),
            });
        }
        ["format", ..] => return Err((format!("unknown `{}`", shown(&words.join(" "))), FORMATS)),
        ["element", name, count] => header.add_element(name, count)?,
        ["element", ..] => return Err(("an element needs a name and a count".to_owned(), ELEMENT)),
        ["property", words @ ..] => {
            let Some(element) = header.elements.last_mut() else {
                return Err(("a property before the first element".to_owned(), ELEMENT));
            };
            element.properties.push(property(words)?);
        }
        ["end_header"] => return Ok(true),
        [word, ..] => {
            let remedy = "headers hold format, element, property, comment and obj_info lines";
            return Err((format!("unknown header line `{}`", shown(word)), remedy));
        }
    }
    Ok(false)
}

impl Header {
    fn add_element(&mut self, name: &str, count: &str) -> Result<(), (String, &'static str)> {
        if self.elements.len() == MAX_ELEMENTS {
            return Err((
                format!("more than {MAX_ELEMENTS} elements"),
                "remove those not needed",
            ));
        }
        if self.element(name).is_some() {
            return Err((
                format!("element `{}` declared twice", shown(name)),
                "merge the two",
            ));
        }
        let Ok(count) = count.parse() else {
            return Err((
                format!("the count `{}` is not a whole number", shown(count)),
                ELEMENT,
            ));
        };
        let (name, line) = (name.to_owned(), self.lines);
        self.elements.push(Element {
            name,
            count,
            line,
            properties: Vec::new(),
        });
        Ok(())
    }
}

fn property(words: &[&str]) -> Result<Property, (String, &'static str)> {
    let scalar = |name: &str| {
        Scalar::named(name).ok_or_else(|| (format!("unknown type `{}`", shown(name)), PROPERTY))
    };
    let (kind, name) = match words {
        ["list", count, item, name] => (
            Kind::List {
                count: scalar(count)?,
                item: scalar(item)?,
            },
            name,
        ),
        [kind, name] => (Kind::Scalar(scalar(kind)?), name),
        _ => return Err(("a property needs a type and a name".to_owned(), PROPERTY)),
    };
    Ok(Property {
        name: (*name).to_owned(),
        kind,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Header, String> {
        super::read("a.ply".as_ref(), text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn line_ends_may_be_mixed() {
        let text = "ply\ncomment \u{e9}\nformat ascii 1.0\r\nobj_info x\nelement face 2\n\
            property list uchar int32 vertex_index\nend_header\r\n1";
        let header = read(text).unwrap();
        assert_eq!(
            (header.body, header.lines, header.line_end),
            (text.len() - 1, 7, b'\n')
        );
        let kind = Kind::List {
            count: Scalar::U8,
            item: Scalar::I32,
        };
        assert_eq!(header.elements[0].properties[0].kind, kind);
        let text = "ply\rformat binary_big_endian 1.0\rend_header\r\n";
        let header = read(text).unwrap();
        assert_eq!(
            (header.body, header.format),
            (text.len() - 1, Format::BigEndian)
        );
    }

    #[test]
    fn bad_lines_are_named() {
        for (text, start) in [
            ("plyx\n", "a.ply:1: the first line"),
            (
                "ply\nformat ascii 1.0\n",
                "a.ply:2: the header has no `end_header`",
            ),
            ("ply\nend_header\n", "a.ply: the header has no `format`"),
            (
                "ply\nformat ascii 2.0",
                "a.ply:2: unknown `format ascii 2.0`",
            ),
            ("ply\nelement vertex -1", "a.ply:2: the count `-1`"),
            ("ply\nproperty float x", "a.ply:2: a property before"),
            (
                "ply\nelement a 1\nproperty half x",
                "a.ply:3: unknown type `half`",
            ),
            (
                "ply\nelement a 1\nelement a 1",
                "a.ply:3: element `a` declared twice",
            ),
            ("ply\nvertex 1", "a.ply:2: unknown header line `vertex`"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.starts_with(start), "{error}");
        }
    }
}
