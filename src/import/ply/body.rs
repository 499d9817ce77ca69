//! Values of a PLY body, ascii or binary, with the place of each.

use std::path::Path;

use super::super::shown;
use super::header::{Element, Format, Header, Kind, Scalar};
use crate::error::{Error, Place};

const INCOMPLETE: &str = "is the file complete?";

/// Reads the entries of one element after another.
pub(super) struct Body<'a> {
    file: &'a Path,
    header: &'a Header,
    bytes: &'a [u8],
    /// Offset of the next byte.
    at: usize,
    /// Ascii: the rest of the entry's line, and that line's number.
    line: &'a [u8],
    line_number: usize,
    /// Binary: offset of the last value.
    value_at: usize,
    element: &'a str,
    entry: u64,
    /// Ascii: the first line that holds more than was declared.
    pub surplus_line: Option<usize>,
}

impl<'a> Body<'a> {
    pub fn new(file: &'a Path, header: &'a Header, bytes: &'a [u8]) -> Self {
        Self {
            file,
            header,
            bytes,
            at: header.body,
            line: &[],
            line_number: header.lines,
            value_at: header.body,
            element: "",
            entry: 0,
            surplus_line: None,
        }
    }

    /// Begins an element. Fails at once when the rest of the file cannot hold
    /// its entries, so that memory can be set aside for them.
    pub fn begin_element(&mut self, element: &'a Element) -> Result<(), Error> {
        self.element = &element.name;
        let rest = (self.bytes.len() - self.at) as u128;
        let entry: usize = match self.header.format {
            // A digit and a separator each; the very last may lack the latter.
            Format::Ascii => element.properties.len() * 2,
            _ => element
                .properties
                .iter()
                .map(|property| smallest(property.kind))
                .sum(),
        };
        let least = u128::from(element.count) * entry as u128;
        if least > rest + u128::from(self.header.format == Format::Ascii) {
            let what = format!(
                "element `{}` declares {} entries, {least} bytes or more, but {rest} bytes are left",
                shown(&element.name),
                element.count
            );
            return Err(Error::at(
                self.file,
                Place::Line(element.line),
                what,
                INCOMPLETE,
            ));
        }
        Ok(())
    }

    /// Begins an entry.
    pub fn begin_entry(&mut self, entry: u64) -> Result<(), Error> {
        self.entry = entry;
        if self.header.format != Format::Ascii {
            return Ok(());
        }
        loop {
            if self.at >= self.bytes.len() {
                return Err(self.ends());
            }
            let rest = &self.bytes[self.at..];
            let length = rest.iter().position(|&byte| byte == self.header.line_end);
            self.line = rest[..length.unwrap_or(rest.len())].trim_ascii();
            self.at += length.map_or(rest.len(), |length| length + 1);
            self.line_number += 1;
            if !self.line.is_empty() {
                return Ok(());
            }
        }
    }

    /// Ends an entry.
    pub fn end_entry(&mut self) {
        if !self.line.is_empty() {
            self.surplus_line.get_or_insert(self.line_number);
        }
    }

    /// The next value.
    pub fn value(&mut self, scalar: Scalar) -> Result<f64, Error> {
        if self.header.format == Format::Ascii {
            return self.word();
        }
        let Some(bytes) = self.bytes.get(self.at..self.at + scalar.bytes()) else {
            return Err(self.ends());
        };
        self.value_at = self.at;
        self.at += bytes.len();
        // Little-endian in eight bytes.
        let mut buffer = [0; 8];
        buffer[..bytes.len()].copy_from_slice(bytes);
        if self.header.format == Format::BigEndian {
            buffer[..bytes.len()].reverse();
        }
        let [a, b, c, d, ..] = buffer;
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes([a])),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(buffer),
        })
    }

    /// The next word of the line as a number.
    fn word(&mut self) -> Result<f64, Error> {
        if self.line.is_empty() {
            let what = format!("the line ends within {}", self.entry_name());
            return Err(self.error(what, "write every entry on one line of its own"));
        }
        let length = self
            .line
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(self.line.len());
        let (word, rest) = self.line.split_at(length);
        self.line = rest.trim_ascii_start();
        let number = std::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse().ok());
        number.ok_or_else(|| {
            let word = shown(&String::from_utf8_lossy(word));
            self.error(format!("`{word}` is not a number"), "write plain numbers")
        })
    }

    /// The number of items of a list, which the file is long enough for.
    pub fn list_count(&mut self, count: Scalar, item: Scalar) -> Result<usize, Error> {
        let value = self.value(count)?;
        let Some(count) = whole(value) else {
            return Err(self.error(
                format!("a list of {value} items"),
                "counts are whole numbers",
            ));
        };
        let (bytes, rest) = match self.header.format {
            Format::Ascii => (1, self.line.len()),
            _ => (item.bytes(), self.bytes.len() - self.at),
        };
        if count.saturating_mul(bytes) > rest {
            let what = format!(
                "a list of {count} items ends early, in {}",
                self.entry_name()
            );
            return Err(self.error(what, INCOMPLETE));
        }
        Ok(count)
    }

    /// Reads over a property.
    pub fn skip(&mut self, kind: Kind) -> Result<(), Error> {
        match kind {
            Kind::Scalar(scalar) => self.value(scalar).map(drop),
            Kind::List { count, item } => {
                let count = self.list_count(count, item)?;
                (0..count).try_for_each(|_| self.value(item).map(drop))
            }
        }
    }

    /// Place of the last value.
    pub fn place(&self) -> Place {
        match self.header.format {
            Format::Ascii => Place::Line(self.line_number),
            _ => Place::Byte(self.value_at as u64),
        }
    }

    /// An error about the last value.
    pub fn error(&self, what: impl Into<String>, remedy: &str) -> Error {
        Error::at(self.file, self.place(), what, remedy)
    }

    /// Bytes behind the last element, blanks of ascii files apart.
    pub fn left(&self) -> usize {
        let rest = &self.bytes[self.at..];
        if self.header.format == Format::Ascii {
            rest.trim_ascii().len()
        } else {
            rest.len()
        }
    }

    fn entry_name(&self) -> String {
        format!(
            "entry {} of element `{}`",
            self.entry + 1,
            shown(self.element)
        )
    }

    fn ends(&self) -> Error {
        let place = match self.header.format {
            Format::Ascii => Place::Line(self.line_number),
            _ => Place::Byte(self.bytes.len() as u64),
        };
        let what = format!("the file ends before the end of {}", self.entry_name());
        Error::at(self.file, place, what, INCOMPLETE)
    }
}

/// The fewest bytes of a property in a binary body.
fn smallest(kind: Kind) -> usize {
    match kind {
        Kind::Scalar(scalar) => scalar.bytes(),
        Kind::List { count, .. } => count.bytes(),
    }
}

/// A value that is a whole number of 32 bits.
pub(super) fn whole(value: f64) -> Option<usize> {
    let is_whole = value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0;
    is_whole.then_some(value as usize)
}

#[cfg(test)]
mod tests {
    use super::super::header;
    use super::*;

    fn with_body<T>(format: &str, body: &[u8], read: impl FnOnce(&mut Body) -> T) -> T {
        let text = format!("ply\nformat {format} 1.0\nelement a 1\nproperty int x\nend_header\n");
        let bytes = [text.as_bytes(), body].concat();
        let header = header::read("a.ply".as_ref(), &bytes).unwrap();
        let mut body = Body::new("a.ply".as_ref(), &header, &bytes);
        body.begin_element(&header.elements[0]).unwrap();
        body.begin_entry(0).unwrap();
        read(&mut body)
    }

    #[test]
    fn every_scalar_is_read_in_both_orders() {
        let cases: [(Scalar, &[u8], f64); 8] = [
            (Scalar::I8, &[0xfe], -2.0),
            (Scalar::U8, &[0xfe], 254.0),
            (Scalar::I16, &[0xff, 0x01], -255.0),
            (Scalar::U16, &[0xff, 0x01], 65281.0),
            (Scalar::I32, &[0xff, 0xff, 0xff, 0x01], -255.0),
            (Scalar::U32, &[0xff, 0xff, 0xff, 0x01], 4294967041.0),
            (Scalar::F32, &[0xc0, 0x20, 0, 0], -2.5),
            (Scalar::F64, &[0xc0, 0x04, 0, 0, 0, 0, 0, 0], -2.5),
        ];
        for (scalar, big, expected) in cases {
            // Padding: the declared element needs four bytes.
            let little: Vec<u8> = big.iter().rev().copied().chain([0; 4]).collect();
            let big = [big, &[0; 4]].concat();
            let read = |body: &mut Body| body.value(scalar).unwrap();
            assert_eq!(
                with_body("binary_big_endian", &big, read),
                expected,
                "{scalar:?}"
            );
            assert_eq!(
                with_body("binary_little_endian", &little, read),
                expected,
                "{scalar:?}"
            );
        }
    }

    #[test]
    fn blank_lines_are_skipped_and_surplus_noticed() {
        with_body("ascii", b"\n \r\n 7\t 8 \r\n9", |body| {
            assert_eq!(body.value(Scalar::I32).unwrap(), 7.0);
            body.end_entry();
            assert_eq!(body.surplus_line, Some(8));
            assert_eq!(body.left(), 1);
            assert_eq!(body.value(Scalar::I32).unwrap(), 8.0);
            let error = body.value(Scalar::I32).unwrap_err().to_string();
            assert!(
                error.starts_with("a.ply:8: the line ends within entry 1 of element `a`;"),
                "{error}"
            );
        });
    }
}
