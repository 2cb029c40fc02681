//! What readers of mesh files have in common.

use std::path::{Path, PathBuf};

/// The most vertices or triangles a mesh may have.
pub const MESH_ITEMS_MAX: usize = 1 << 26;

/// A mesh file that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}{place}: {message}", path.display())]
pub struct MeshError {
    /// The file.
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
    /// Where the file says it.
    pub up: Option<UpAxis>,
    /// Metres per unit of length, where the file says it.
    pub unit_metres: Option<f64>,
}
