//! Files: opened for what they are expected to be, and written whole.

use crate::exit::{Code, Failure};
use crate::output;
pub(crate) use roadmill::internal::regular::{open_regular, read_regular_text};
use rustix::fs::{CWD, OFlags, RenameFlags, fcntl_getfl, fcntl_setfl, renameat_with};
use rustix::io::Errno;
use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// Opens a file of a run folder, as [`open_regular`] does. No link is followed: it could lead anywhere.
///
/// # Errors
/// As [`open_regular`].
pub(crate) fn open_in_run(path: &Path, access: OFlags) -> io::Result<File> {
    open_regular(path, access | OFlags::NOFOLLOW)
}

/// A failure to write a file: the user's where the path is to blame, the system's where it has no room, say.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    let code = match error.kind() {
        ErrorKind::NotFound
        | ErrorKind::PermissionDenied
        | ErrorKind::AlreadyExists
        | ErrorKind::NotADirectory
        | ErrorKind::IsADirectory
        | ErrorKind::DirectoryNotEmpty
        | ErrorKind::InvalidInput
        | ErrorKind::InvalidFilename
        | ErrorKind::ReadOnlyFilesystem => Code::Usage,
        _ => Code::System,
    };
    Failure::new(code, format!("{}: cannot write: {error}", path.display()))
}

/// The folder that a file is in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        // A path of one name has an empty parent.
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// What ends the names of files that are to be given another name once they are whole, and how many letters and digits stand before it.
const UNFINISHED: &str = ".tmp";
const MARK: usize = 6;

/// A new file beside `path`, to be given its name once it is whole; removed if it never is, unless the process is killed
/// ([`remove_unfinished`]). Its mode follows the umask, as that of any file which others may be meant to read.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".");
    let mode = Permissions::from_mode(0o666);
    let mut builder = Builder::new();
    builder.prefix(&name).rand_bytes(MARK).suffix(UNFINISHED).permissions(mode);
    builder.tempfile_in(folder_of(path))
}

/// Whether `found` is the name of an unfinished file that was to be given the name `name`.
fn is_unfinished(found: &str, name: &str) -> bool {
    let rest = found.strip_prefix(name).and_then(|rest| rest.strip_prefix('.'));
    let mark = rest.and_then(|rest| rest.strip_suffix(UNFINISHED));
    mark.is_some_and(|mark| {
        mark.len() == MARK && mark.bytes().all(|byte| byte.is_ascii_alphanumeric())
    })
}

/// Whether an entry of a folder is what a process that was killed left of one of these files.
pub(crate) fn is_unfinished_of(entry: &fs::DirEntry, names: &[&str]) -> bool {
    let found = entry.file_name();
    let found = found.to_str().filter(|_| entry.file_type().is_ok_and(|kind| kind.is_file()));
    found.is_some_and(|found| names.iter().any(|name| is_unfinished(found, name)))
}

/// Removes what processes that were killed have left of these files in a folder. To be called by whoever alone writes them. What cannot be
/// removed stays: it is in nobody's way.
pub(crate) fn remove_unfinished(folder: &Path, names: &[&str]) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_unfinished_of(&entry, names) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Gives the folder `new` a name that nothing has.
pub(crate) fn rename_to_free(new: &Path, path: &Path) -> io::Result<()> {
    match renameat_with(CWD, new, CWD, path, RenameFlags::NOREPLACE) {
        Ok(()) => Ok(()),
        // Takes the place of an empty folder at most.
        Err(Errno::INVAL | Errno::NOSYS | Errno::NOTSUP) => fs::rename(new, path),
        Err(error) => Err(error.into()),
    }
}

/// Writes a file so that it is there whole or not at all. What is written to a FIFO or a device, as `/dev/stdout`,
/// goes there; a FIFO that nobody reads is not waited for.
///
/// # Errors
/// Exit code 2: the path cannot be used, or is a FIFO that nobody reads; 1: there is no room, or the system fails otherwise.
pub(crate) fn write_whole(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
    let cannot = |error: io::Error| cannot_write(path, &error);
    let takes_all = |file: fs::Metadata| !file.is_file() && !file.is_dir();
    if fs::metadata(path).is_ok_and(takes_all) {
        let mut file = open_with_reader(path).map_err(cannot)?;
        return match file.write_all(contents.as_ref()) {
            // Whoever reads it has read enough.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            written => written.map_err(cannot),
        };
    }
    let mut file = beside(path).map_err(cannot)?;
    file.write_all(contents.as_ref()).map_err(cannot)?;
    file.persist(path).map_err(|error| cannot(error.error))?;
    Ok(())
}

/// Whether a path that the command line gives as `--out` stands for standard output, as in other programs.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Writes what a command makes: to standard output where the path is `-`, and otherwise as [`write_whole`].
///
/// # Errors
/// As [`write_whole`]; standard output that is lost is told at the end of the program.
pub(crate) fn write_out(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), Failure> {
    if is_standard_output(path) {
        output::bytes(contents.as_ref());
        return Ok(());
    }
    write_whole(path, contents)
}

/// Opens what is no regular file to write to it: at once, even a FIFO; writing then waits for the reader.
fn open_with_reader(path: &Path) -> io::Result<File> {
    let file = match File::options()
        .write(true)
        .custom_flags(OFlags::NONBLOCK.bits() as i32)
        .open(path)
    {
        Err(error) if error.raw_os_error() == Some(Errno::NXIO.raw_os_error()) => {
            let message = "a named pipe that nobody reads, or a socket, found; a regular file expected, or a pipe with a reader";
            return Err(io::Error::new(ErrorKind::InvalidInput, message));
        }
        opened => opened?,
    };
    let flags = fcntl_getfl(&file)?;
    fcntl_setfl(&file, flags - OFlags::NONBLOCK)?;
    Ok(file)
}

/// What is said of `-` where a folder is asked for.
pub(crate) const FOLDER_EXPECTED: &str = "standard output takes one document; a folder expected, since several files are written (./- is a folder of that name)";

/// Refuses `-` where a folder is asked for.
///
/// # Errors
/// Exit code 2: the path is `-`.
pub(crate) fn expect_folder(option: &str, path: &Path) -> Result<(), Failure> {
    match is_standard_output(path) {
        true => Err(Failure::usage(format!("{option}: - found; {FOLDER_EXPECTED}"))),
        false => Ok(()),
    }
}

/// Makes a folder, or takes one that is empty.
///
/// # Errors
/// Exit code 2: the path cannot be used, or something is in the folder; 1: the system fails otherwise.
pub(crate) fn make_empty(folder: &Path) -> Result<(), Failure> {
    let cannot = |error: std::io::Error| {
        let Failure { code, .. } = cannot_write(folder, &error);
        Failure::new(code, format!("{}: cannot make the folder: {error}", folder.display()))
    };
    match fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) => Err(Failure::usage(format!(
                "{}: holds something; a new or an empty folder expected",
                folder.display()
            ))),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => {
            fs::create_dir_all(folder).map_err(cannot)
        }
        Err(error) => Err(cannot(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::Mode;
    use std::io::Read;
    use std::os::unix::fs::symlink;

    #[test]
    fn no_links_are_followed_in_run_folders() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("file"), "x").unwrap();
        symlink(path("file"), path("link")).unwrap();
        for access in [OFlags::RDONLY, OFlags::WRONLY | OFlags::CREATE] {
            let error = open_in_run(&path("link"), access).unwrap_err();
            assert!(error.to_string().starts_with("a link"), "{error}");
        }
        open_in_run(&path("new"), OFlags::WRONLY | OFlags::CREATE).unwrap();
    }

    #[test]
    fn a_file_is_written_whole_and_nothing_is_left_of_one_that_cannot_be() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        write_whole(&path, "first").unwrap();
        write_whole(&path, "second").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
        let refused = write_whole(&folder.path().join("none/out"), "x").unwrap_err();
        assert_eq!(refused.code, Code::Usage);
        fs::create_dir(folder.path().join("folder")).unwrap();
        let refused = write_whole(&folder.path().join("folder"), "x").unwrap_err();
        assert_eq!(refused.code, Code::Usage, "{refused}");
        assert_eq!(write_whole(Path::new("/dev/full"), "x").unwrap_err().code, Code::System);
        let pipe = folder.path().join("pipe");
        rustix::fs::mkfifoat(CWD, &pipe, Mode::RUSR | Mode::WUSR).unwrap();
        let refused = write_whole(&pipe, "x").unwrap_err();
        assert_eq!(refused.code, Code::Usage, "{refused}");
        assert!(refused.to_string().contains("nobody reads"), "{refused}");
        // More than a pipe holds, so that the writer has to wait for the reader.
        let (text, of_pipe) = ("x".repeat(1 << 20), pipe.clone());
        let reader = File::options().read(true).write(true).open(&pipe).unwrap();
        let writer = std::thread::spawn(move || write_whole(&of_pipe, text).is_ok());
        let mut read = vec![0; 1 << 20];
        (&reader).read_exact(&mut read).unwrap();
        assert!(writer.join().unwrap() && read.iter().all(|byte| *byte == b'x'));
        fs::remove_file(&pipe).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn what_the_killed_leave_of_a_file_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        // As it is left: a file that is never given its name.
        beside(&at("out.csv")).unwrap().keep().unwrap();
        let others = [
            "out.csv",
            "out.csv.backup",
            "out.csv.a.tmp",
            "out.csv.ab-def.tmp",
            "my.csv.abcdef.tmp",
        ];
        others.iter().for_each(|name| fs::write(at(name), "mine").unwrap());
        fs::create_dir(at("out.csv.abcdef.tmp")).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 7);
        remove_unfinished(folder.path(), &["out.csv", "in.csv"]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 6);
        assert!(others.iter().all(|name| at(name).is_file()));
        remove_unfinished(&at("none"), &["out.csv"]);
    }
}
