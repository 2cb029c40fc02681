//! How files that others wrote are opened.

use rustix::fs::{Mode, OFlags};
use std::fs::{File, FileType};
use std::io::{self, Read};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;

/// The bytes of a regular file.
///
/// The file is opened without waiting and its kind is looked at before anything is read: a named pipe without a
/// writer would else be waited for, and a device read for ever.
///
/// # Errors
/// What the system says, or which kind of file was found where a regular one is expected.
pub(crate) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let flags = OFlags::RDONLY | OFlags::CLOEXEC | OFlags::NONBLOCK | OFlags::NOCTTY;
    let mut file = match rustix::fs::open(path, flags, Mode::empty()) {
        Ok(file) => File::from(file),
        Err(error) => {
            // A socket cannot be opened at all, which the system says in words that name no socket.
            let kind = std::fs::metadata(path).map(|found| found.file_type());
            return Err(kind.ok().and_then(not_regular).unwrap_or_else(|| error.into()));
        }
    };
    let found = file.metadata()?;
    if let Some(error) = not_regular(found.file_type()) {
        return Err(error);
    }
    let mut bytes = Vec::with_capacity(usize::try_from(found.len()).unwrap_or(0).min(1 << 30));
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The error of a file of this kind, if it is no regular one.
fn not_regular(kind: FileType) -> Option<io::Error> {
    let found = match kind {
        kind if kind.is_file() => return None,
        kind if kind.is_dir() => "a folder",
        kind if kind.is_fifo() => "a named pipe",
        kind if kind.is_socket() => "a socket",
        kind if kind.is_char_device() || kind.is_block_device() => "a device",
        _ => "no regular file",
    };
    Some(io::Error::other(format!("{found} found; a regular file expected")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("file"), "text").unwrap();
        assert_eq!(read_file(&at("file")).unwrap(), b"text");
        rustix::fs::mkfifoat(rustix::fs::CWD, at("pipe"), Mode::RUSR | Mode::WUSR).unwrap();
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        for (path, found) in [
            (at(""), "a folder found"),
            (at("pipe"), "a named pipe found"),
            (at("socket"), "a socket found"),
            (Path::new("/dev/zero").to_owned(), "a device found"),
            (at("lost"), "No such file"),
        ] {
            let error = read_file(&path).unwrap_err().to_string();
            assert!(error.starts_with(found), "{error}");
        }
    }
}
