//! How files that others wrote are read.

use crate::internal::regular::open_regular;
use rustix::fs::OFlags;
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a regular file.
///
/// # Errors
/// What the system says, or which kind of file was found where a regular one is expected.
pub(crate) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = open_regular(path, OFlags::RDONLY)?;
    let length = file.metadata()?.len();
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0).min(1 << 30));
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}
