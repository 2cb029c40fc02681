use crate::scene::MeshError;
use std::path::{Path, PathBuf};

/// A foreign scene that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{place}: {message}", path.display())]
pub struct ForeignError {
    /// The file.
    pub path: PathBuf,
    /// `:LINE` of a text file, ` byte N` of a binary one, or nothing for the file as a whole.
    pub place: String,
    /// What was found and what is expected.
    pub message: String,
}

impl ForeignError {
    pub(super) fn whole(path: &Path, message: impl Into<String>) -> ForeignError {
        ForeignError { path: path.to_owned(), place: String::new(), message: message.into() }
    }

    pub(super) fn line(path: &Path, line: usize, message: impl Into<String>) -> ForeignError {
        ForeignError { path: path.to_owned(), place: format!(":{line}"), message: message.into() }
    }

    /// A mesh that cannot be used, and the line that asks for it.
    pub(super) fn mesh(error: MeshError, path: &Path, line: usize) -> ForeignError {
        let MeshError { path: mesh, place, message } = error;
        let message = format!("{message} (named in {}:{line})", path.display());
        ForeignError { path: mesh, place, message }
    }
}

/// The text of a scene file.
pub(super) fn read_text(path: &Path) -> Result<String, ForeignError> {
    let bytes = std::fs::read(path)
        .map_err(|error| ForeignError::whole(path, format!("cannot read the scene: {error}")))?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|byte| **byte == b'\n').count();
        ForeignError::line(path, line, "not UTF-8 text; a scene file expected")
    })
}
