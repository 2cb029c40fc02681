use crate::internal::plain::plain;
use std::fmt;
use std::path::{Path, PathBuf};

/// What is wrong with a problem: where, what was found, what is expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProblemError {
    path: PathBuf,
    line: Option<usize>,
    message: String,
}

impl ProblemError {
    /// An error whose message says where it is, or one in values that come from no file.
    pub(crate) fn pathless(message: String) -> ProblemError {
        ProblemError { path: PathBuf::new(), line: None, message }
    }

    pub(crate) fn file(path: &Path, message: impl Into<String>) -> ProblemError {
        ProblemError { path: path.to_owned(), line: None, message: message.into() }
    }

    pub(crate) fn line(path: &Path, line: usize, message: impl Into<String>) -> ProblemError {
        ProblemError { path: path.to_owned(), line: Some(line), message: message.into() }
    }
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.path.as_os_str().is_empty() {
            return f.write_str(&plain(&self.message));
        }
        f.write_str(&plain(&self.path.to_string_lossy()))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", plain(&self.message))
    }
}

impl std::error::Error for ProblemError {}
