//! How files that others wrote are read.

use crate::internal::regular::read_regular;
use std::io;
use std::path::Path;

/// The bytes of a regular file.
///
/// # Errors
/// What the system says, which kind of file was found where a regular one is expected, or that the file is too long to be read
/// whole.
pub(crate) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    read_regular(path)
}
