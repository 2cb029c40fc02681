use crate::digest::SourceFile;
use crate::internal::plain::plain;
use crate::scene::MeshError;
use crate::source::{NoText, read_file, text_of, too_many_attributes, xml_text};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A foreign scene that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{place}: {}", plain(&path.to_string_lossy()), plain(message))]
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

/// The text of a scene file of lines and words, and the file for the list of those read.
pub(super) fn read_text(path: &Path) -> Result<(String, SourceFile), ForeignError> {
    read_with(path, text_of)
}

/// The text of a scene file in XML, and the file for the list of those read.
pub(super) fn read_xml(path: &Path) -> Result<(String, SourceFile), ForeignError> {
    let (text, file) = read_with(path, xml_text)?;
    match too_many_attributes(&text) {
        Some((line, message)) => Err(ForeignError::line(path, line, message)),
        None => Ok((text, file)),
    }
}

fn read_with(
    path: &Path,
    text_of: fn(&[u8]) -> Result<Cow<'_, str>, NoText>,
) -> Result<(String, SourceFile), ForeignError> {
    let bytes = read_file(path)
        .map_err(|error| ForeignError::whole(path, format!("cannot read the scene: {error}")))?;
    let text = text_of(&bytes).map_err(|NoText { line, found }| {
        ForeignError::line(path, line, format!("{found}; a scene file, which is text, expected"))
    })?;
    Ok((text.into_owned(), SourceFile::named(path, &bytes)))
}
