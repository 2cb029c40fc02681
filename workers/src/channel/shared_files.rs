//! The files that shared memory of a run is.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use rustix::fs::{FallocateFlags, fallocate};

use super::error::ChannelError;

/// Where Linux keeps named shared memory.
pub(super) const SHARED_MEMORY_FOLDER: &str = "/dev/shm";

/// Does `work` to each file whose name begins with `prefix`; one that vanishes meanwhile is fine.
pub(super) fn for_each(
    prefix: &str,
    action: &'static str,
    work: impl Fn(&Path) -> io::Result<()>,
) -> Result<(), ChannelError> {
    let entries = fs::read_dir(SHARED_MEMORY_FOLDER)
        .map_err(ChannelError::io("could not list", SHARED_MEMORY_FOLDER))?;
    for entry in entries.flatten() {
        if !entry.file_name().as_bytes().starts_with(prefix.as_bytes()) {
            continue;
        }
        match work(&entry.path()) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(ChannelError::io(action, entry.path())(error));
            }
            _ => {}
        }
    }
    Ok(())
}

/// The library lets every user write to one of its files, whatever the umask: takes that back.
pub(super) fn protect(prefix: &str) -> Result<(), ChannelError> {
    for_each(prefix, "could not protect", |path| {
        fs::set_permissions(path, Permissions::from_mode(0o600))
    })
}

/// Gives files without content one byte.
///
/// A worker killed between creating such a file and setting its length leaves an empty one, and
/// the library (0.10.0), run by root, waits for ever for its length when it cleans up. Not
/// `ftruncate`, which would shorten a file that a living worker has just given its length.
pub(super) fn lengthen_empty(prefix: &str) -> Result<(), ChannelError> {
    for_each(prefix, "could not lengthen", |path| {
        if fs::metadata(path)?.len() > 0 {
            return Ok(());
        }
        let file = File::options().write(true).open(path)?;
        Ok(fallocate(&file, FallocateFlags::empty(), 0, 1)?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_empty_files_are_lengthened() {
        let prefix = format!("roadmill-test-{}_", std::process::id());
        let path = |name| Path::new(SHARED_MEMORY_FOLDER).join(format!("{prefix}{name}"));
        fs::write(path("empty"), []).expect("there is shared memory");
        fs::write(path("full"), [1, 2, 3]).expect("there is shared memory");
        let result = lengthen_empty(&prefix);
        let contents = ["empty", "full"].map(|name| fs::read(path(name)));
        for_each(&prefix, "could not remove", |path| fs::remove_file(path))
            .expect("they can be removed");
        result.expect("they can be lengthened");
        let contents = contents.map(|bytes| bytes.expect("it can be read"));
        assert_eq!(contents, [vec![0], vec![1, 2, 3]]);
    }
}
