use crate::internal::plain::plain;
use std::fmt;
use std::path::{Path, PathBuf};

/// A structure that cannot be used: where, what was found, what is expected.
///
/// It reads `FILE:LINE: what was found; what is expected`, and names residue and atom where there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructureError {
    path: PathBuf,
    line: Option<usize>,
    message: String,
}

impl StructureError {
    /// An error in atoms that may have come from anywhere.
    pub fn pathless(message: impl Into<String>) -> StructureError {
        StructureError { path: PathBuf::new(), line: None, message: message.into() }
    }

    /// An error of a file as a whole.
    pub fn file(path: &Path, message: impl Into<String>) -> StructureError {
        StructureError { path: path.to_owned(), line: None, message: message.into() }
    }

    /// An error in a line, counted from 1, of a file that is still to be named.
    pub(super) fn line(line: usize, message: impl Into<String>) -> StructureError {
        StructureError { path: PathBuf::new(), line: Some(line), message: message.into() }
    }

    /// The same error, of this file if it names none.
    pub fn in_file(mut self, path: &Path) -> StructureError {
        if self.path.as_os_str().is_empty() {
            self.path = path.to_owned();
        }
        self
    }
}

impl fmt::Display for StructureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&plain(&self.path.to_string_lossy()))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if !self.path.as_os_str().is_empty() || self.line.is_some() {
            f.write_str(": ")?;
        }
        f.write_str(&plain(&self.message))
    }
}

impl std::error::Error for StructureError {}
