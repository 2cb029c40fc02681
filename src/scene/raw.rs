//! What the readers of mesh files have in common: the mesh as stored, faces, errors.

use super::polygon;
use crate::internal::plain::plain;
use crate::source::text_of;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The most vertices or triangles a mesh may have.
pub const MESH_ITEMS_MAX: usize = 1 << 26;

/// A mesh that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}{}", prefix(path, place), plain(message))]
pub struct MeshError {
    /// The file; empty for triangles in memory.
    pub path: PathBuf,
    /// `:LINE` of a text file, ` byte N` of a binary one, or nothing for the file as a whole.
    pub place: String,
    /// What was found and what is expected.
    pub message: String,
}

impl MeshError {
    pub(super) fn whole(path: &Path, message: impl Into<String>) -> MeshError {
        MeshError { path: path.to_owned(), place: String::new(), message: message.into() }
    }

    pub(super) fn byte(path: &Path, byte: usize, message: impl Into<String>) -> MeshError {
        MeshError { path: path.to_owned(), place: format!(" byte {byte}"), message: message.into() }
    }

    pub(super) fn line(path: &Path, line: usize, message: impl Into<String>) -> MeshError {
        MeshError { path: path.to_owned(), place: format!(":{line}"), message: message.into() }
    }
}

/// What an error begins with: the file and the place in it, where there is a file.
fn prefix(path: &Path, place: &str) -> String {
    if path.as_os_str().is_empty() {
        String::new()
    } else {
        format!("{}{place}: ", plain(&path.to_string_lossy()))
    }
}

/// Which axis of a file's coordinates points upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    Z,
}

/// Triangles as a file stores them: corners index `vertices`, which the reader has checked. There may
/// be vertices that no triangle uses.
#[derive(Debug, Default)]
pub(super) struct RawMesh {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// Which axis points upwards, where the file says so.
    pub up: Option<UpAxis>,
    /// Metres per unit of length, where the file says so.
    pub unit_metres: Option<f64>,
}

impl RawMesh {
    /// Appends a face, a polygon of vertices in order, as triangles.
    ///
    /// # Errors
    /// Says that the face has too few corners or cannot be cut into triangles, or that the mesh has too many of them.
    pub(super) fn push_face(&mut self, corners: &[u32]) -> Result<(), String> {
        if corners.len() < 3 {
            return Err(format!("a face with {} corners; at least 3 expected", corners.len()));
        }
        polygon::cut(corners, &self.vertices, &mut self.triangles)?;
        if self.triangles.len() > MESH_ITEMS_MAX {
            return Err(format!("more than {MESH_ITEMS_MAX} triangles"));
        }
        Ok(())
    }
}

/// The text of a file; `expected` names the format in the error.
pub(super) fn text<'a>(
    path: &Path,
    bytes: &'a [u8],
    expected: &str,
) -> Result<Cow<'a, str>, MeshError> {
    text_of(bytes).map_err(|error| {
        MeshError::line(
            path,
            error.line,
            format!("{}; {expected}, which is text, expected", error.found),
        )
    })
}
