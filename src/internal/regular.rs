//! Files that are opened for what they are expected to be.

use rustix::fs::{Mode, OFlags, open};
use std::fs::{self, File, FileType};
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;

/// Opens a regular file, and nothing else: a named pipe would be waited for that nobody has open, and a device would do
/// what devices do. The file is opened without waiting, and its kind is looked at before anything is read or written.
/// `access` says how, as `OFlags::RDONLY`; new files have the mode that the umask leaves.
///
/// # Errors
/// What the system says, or which kind of file was found where a regular one is expected.
pub fn open_regular(path: &Path, access: OFlags) -> io::Result<File> {
    let flags = access | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    let file = match open(path, flags, Mode::from_raw_mode(0o666)) {
        Ok(file) => File::from(file),
        Err(error) => {
            // Sockets, pipes without another end, and links that are not followed cannot be opened at all, which the
            // system says in words that name none of them.
            let found = match access.contains(OFlags::NOFOLLOW) {
                true => fs::symlink_metadata(path),
                false => fs::metadata(path),
            };
            let kind = found.ok().map(|found| found.file_type());
            return Err(kind.and_then(not_regular).unwrap_or_else(|| error.into()));
        }
    };
    match not_regular(file.metadata()?.file_type()) {
        Some(error) => Err(error),
        None => Ok(file),
    }
}

/// The most bytes of a file that is read whole into memory, 2 GiB: far more than any problem, mesh or structure has. A larger file
/// is a mistake, and reading it would take the memory of the whole machine.
pub const WHOLE_MAX: u64 = 2 << 30;

/// The bytes of a regular file, opened as [`open_regular`] does; at most [`WHOLE_MAX`].
///
/// # Errors
/// As [`open_regular`]; what the system says; or that the file has more bytes.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    read_bounded(path, WHOLE_MAX)
}

/// [`read_regular`] as text.
///
/// # Errors
/// As [`read_regular`]; or that the bytes are no UTF-8.
pub fn read_regular_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_regular(path)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let message = format!("no UTF-8 from byte {at} on; text expected");
        io::Error::new(ErrorKind::InvalidData, message)
    })
}

fn read_bounded(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open_regular(path, OFlags::RDONLY)?;
    let length = file.metadata()?.len();
    let too_long = |found: String| {
        let message = format!("{found} found; at most {most} expected");
        Err(io::Error::new(ErrorKind::FileTooLarge, message))
    };
    if length > most {
        return too_long(format!("{length} bytes"));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0));
    // A file may grow while it is read.
    file.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => too_long(format!("more than {most} bytes")),
        false => Ok(bytes),
    }
}

/// The error of a file of this kind, if it is no regular one.
fn not_regular(kind: FileType) -> Option<io::Error> {
    let found = match kind {
        kind if kind.is_file() => return None,
        kind if kind.is_dir() => "a folder",
        kind if kind.is_symlink() => "a link",
        kind if kind.is_fifo() => "a named pipe",
        kind if kind.is_socket() => "a socket",
        kind if kind.is_char_device() || kind.is_block_device() => "a device",
        _ => "no regular file",
    };
    let message = format!("{found} found; a regular file expected");
    Some(io::Error::new(ErrorKind::InvalidInput, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "text").unwrap();
        rustix::fs::mkfifoat(rustix::fs::CWD, at("pipe"), Mode::RUSR | Mode::WUSR).unwrap();
        std::os::unix::fs::symlink(at("file"), at("link")).unwrap();
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        assert!(open_regular(&at("file"), OFlags::RDONLY).is_ok());
        assert!(open_regular(&at("link"), OFlags::RDONLY).is_ok());
        assert!(open_regular(&at("new"), OFlags::WRONLY | OFlags::CREATE).is_ok());
        let not_followed = OFlags::RDONLY | OFlags::NOFOLLOW;
        for (path, access, found) in [
            (at(""), OFlags::RDONLY, "a folder found; a regular file expected"),
            (at(""), OFlags::WRONLY, "a folder found"),
            (at("pipe"), OFlags::RDONLY, "a named pipe found"),
            // Nobody reads from it.
            (at("pipe"), OFlags::WRONLY, "a named pipe found"),
            (at("socket"), OFlags::RDONLY, "a socket found"),
            (at("link"), not_followed, "a link found"),
            (at("link"), OFlags::WRONLY | OFlags::CREATE | OFlags::NOFOLLOW, "a link found"),
            (Path::new("/dev/zero").to_owned(), OFlags::RDWR, "a device found"),
            (at("lost"), OFlags::RDONLY, "No such file"),
        ] {
            let error = open_regular(&path, access).unwrap_err().to_string();
            assert!(error.starts_with(found), "{}: {error}", path.display());
        }
    }

    #[test]
    fn files_are_read_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "text").unwrap();
        assert_eq!(read_bounded(&file, 4).unwrap(), b"text");
        assert_eq!(read_regular_text(&file).unwrap(), "text");
        let error = read_bounded(&file, 3).unwrap_err().to_string();
        assert_eq!(error, "4 bytes found; at most 3 expected");
        fs::write(&file, b"te\xff").unwrap();
        let error = read_regular_text(&file).unwrap_err().to_string();
        assert_eq!(error, "no UTF-8 from byte 2 on; text expected");
        // It has no blocks on the disk: only its length is looked at.
        File::create(&file).unwrap().set_len(WHOLE_MAX + 1).unwrap();
        let error = read_regular(&file).unwrap_err().to_string();
        assert!(error.starts_with("2147483649 bytes found"), "{error}");
        let error = read_regular(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(error.starts_with("a device found"), "{error}");
    }
}
