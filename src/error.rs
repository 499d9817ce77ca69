//! The one error of the host tool: which file, where in it, what is wrong and
//! what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line of text, from 1.
    Line(usize),
    /// An offset in bytes, from 0.
    Byte(u64),
}

/// A failure that names its file, place and remedy. Shown as
/// `file:line: what is wrong; what to do`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The file concerned, if any.
    pub file: Option<PathBuf>,
    /// The place in it.
    pub place: Place,
    /// What is wrong.
    pub what: String,
    /// What to do about it; may be empty where `what` says it.
    pub remedy: String,
}

impl Error {
    /// An error about a whole file.
    pub fn file(file: &Path, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::at(file, Place::Whole, what, remedy)
    }

    /// An error at a place in a file.
    pub fn at(
        file: &Path,
        place: Place,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            file: Some(file.to_path_buf()),
            place,
            what: what.into(),
            remedy: remedy.into(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", file.display())?;
            match self.place {
                Place::Whole => f.write_str(" ")?,
                Place::Line(line) => write!(f, "{line}: ")?,
                Place::Byte(offset) => write!(f, "byte {offset}: ")?,
            }
        }
        f.write_str(&self.what)?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", self.remedy)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
