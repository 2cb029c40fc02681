//! The files that the shared memory of a run is, in a folder that only its user may enter.
//!
//! `/dev/shm` is open to everybody: whoever first creates a name there owns it, and names can be seen by all. So
//! each run makes a folder of its own in it, under a name that nobody can know before, with mode 0700. Files are
//! opened without following links, and looked at through their descriptors before they are mapped or read.

use std::fs::{self, DirBuilder, File, Metadata, Permissions};
use std::io::{self, ErrorKind};
use std::os::fd::{BorrowedFd, RawFd};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
use std::path::Path;

use rustix::fs::{FallocateFlags, Mode, OFlags, fallocate, open};
use rustix::io::{Errno, FdFlags, fcntl_setfd};

use super::error::ChannelError;

/// Where Linux keeps shared memory that has names.
pub(super) const SHARED_MEMORY_FOLDER: &str = "/dev/shm";

/// Makes the folder of a run, which must not exist.
pub(super) fn create_folder(folder: &Path) -> Result<(), ChannelError> {
    DirBuilder::new()
        .mode(0o700)
        .create(folder)
        .map_err(ChannelError::io("could not create", folder))
}

/// Checks that a folder is one, and this user's alone.
pub(super) fn check_folder(folder: &Path) -> Result<(), ChannelError> {
    let metadata =
        fs::symlink_metadata(folder).map_err(ChannelError::io("could not inspect", folder))?;
    let reason = match fault(&metadata) {
        None if metadata.is_dir() => return Ok(()),
        None => "it is not a folder",
        Some(reason) => reason,
    };
    Err(ChannelError::Unsafe { path: folder.into(), reason })
}

/// What is wrong with a file or folder that is to be private.
pub(super) fn fault(metadata: &Metadata) -> Option<&'static str> {
    if !is_ours(metadata) {
        Some("it belongs to another user")
    } else if metadata.mode() & 0o077 != 0 {
        Some("other users have access to it")
    } else {
        None
    }
}

/// Whether a file belongs to the user of this process.
pub(super) fn is_ours(metadata: &Metadata) -> bool {
    metadata.uid() == rustix::process::geteuid().as_raw()
}

/// Opens a private file: a regular one of this user's, to which no other user has access. `access` says how, as
/// `OFlags::RDONLY`; with `OFlags::CREATE` a file that does not exist is made. No link is followed, and a file of
/// another kind is neither waited for nor read.
///
/// # Errors
/// What the system says; `PermissionDenied` where the file is not private.
pub(super) fn open_private(path: &Path, access: OFlags) -> io::Result<File> {
    let flags = access | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let file = File::from(open(path, flags, Mode::RUSR | Mode::WUSR)?);
    let metadata = file.metadata()?;
    let reason = match fault(&metadata) {
        None if metadata.is_file() => return Ok(file),
        None => "it is not a regular file",
        Some(reason) => reason,
    };
    Err(io::Error::new(ErrorKind::PermissionDenied, reason))
}

/// Does `work` to each entry of a folder whose name passes; one that vanishes meanwhile is fine. All entries are
/// visited, whatever befalls one of them; the first failure is returned at the end.
pub(super) fn for_each(
    folder: &Path,
    passes: impl Fn(&str) -> bool,
    action: &'static str,
    work: impl Fn(&Path) -> io::Result<()>,
) -> Result<(), ChannelError> {
    let entries = fs::read_dir(folder).map_err(ChannelError::io("could not list", folder))?;
    let mut failure = None;
    for entry in entries.flatten() {
        if !passes(&entry.file_name().to_string_lossy()) {
            continue;
        }
        match work(&entry.path()) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                failure.get_or_insert(ChannelError::io(action, entry.path())(error));
            }
            _ => {}
        }
    }
    failure.map_or(Ok(()), Err)
}

/// The library lets every user write to one of its files, whatever the umask. Nobody else can reach the file in its
/// folder; this takes the right back as well.
pub(super) fn protect(folder: &Path) -> Result<(), ChannelError> {
    for_each(
        folder,
        |_| true,
        "could not protect",
        |path| {
            let mode = if fs::symlink_metadata(path)?.is_dir() { 0o700 } else { 0o600 };
            fs::set_permissions(path, Permissions::from_mode(mode))
        },
    )
}

/// Takes the memory of the files whose names pass, all of it, now: to write later to a part that the system can
/// no longer provide would end the process by SIGBUS.
pub(super) fn reserve(folder: &Path, passes: impl Fn(&str) -> bool) -> Result<(), ChannelError> {
    for_each(folder, passes, "there is not enough shared memory for", |path| {
        if !fs::symlink_metadata(path)?.is_file() {
            return Ok(());
        }
        let file = File::from(open(
            path,
            OFlags::WRONLY | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC,
            Mode::empty(),
        )?);
        let bytes = file.metadata()?.len();
        if bytes == 0 {
            return Ok(());
        }
        match fallocate(&file, FallocateFlags::KEEP_SIZE, 0, bytes) {
            // Where `/dev/shm` is no memory file system there may be nothing to reserve with.
            Ok(()) | Err(Errno::OPNOTSUPP | Errno::NOSYS) => Ok(()),
            Err(error) => Err(error.into()),
        }
    })
}

/// Keeps this process's descriptors of files in a folder from the programs that its children run: the library opens
/// files without `O_CLOEXEC`. To be called by the thread that uses them.
pub(super) fn close_on_exec(folder: &Path) {
    for entry in fs::read_dir("/proc/self/fd").into_iter().flatten().flatten() {
        let number = entry.file_name().to_str().and_then(|name| name.parse::<RawFd>().ok());
        let is_in = fs::read_link(entry.path()).is_ok_and(|file| file.starts_with(folder));
        if let Some(number) = number.filter(|_| is_in) {
            // SAFETY: the descriptor is open, and only the thread that has called this closes it.
            let descriptor = unsafe { BorrowedFd::borrow_raw(number) };
            let _ = fcntl_setfd(descriptor, FdFlags::CLOEXEC);
        }
    }
}

/// Gives files without content one byte.
///
/// A worker killed between creating such a file and setting its length leaves an empty one, and the library
/// (0.10.0) waits for its length when it cleans up. Not `ftruncate`, which would shorten a file that a living
/// worker has just given its length.
pub(super) fn lengthen_empty(folder: &Path) -> Result<(), ChannelError> {
    for_each(
        folder,
        |_| true,
        "could not lengthen",
        |path| {
            let metadata = fs::symlink_metadata(path)?;
            if metadata.len() > 0 || !metadata.is_file() {
                return Ok(());
            }
            let flags = OFlags::WRONLY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
            Ok(fallocate(&open(path, flags, Mode::empty())?, FallocateFlags::empty(), 0, 1)?)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::io::fcntl_getfd;
    use std::os::unix::fs::symlink;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir_in(SHARED_MEMORY_FOLDER).expect("there is shared memory")
    }

    #[test]
    fn only_empty_files_are_lengthened() {
        let folder = folder();
        let path = |name| folder.path().join(name);
        fs::write(path("empty"), []).expect("it can be written");
        fs::write(path("full"), [1, 2, 3]).expect("it can be written");
        fs::create_dir(path("folder")).expect("it can be made");
        lengthen_empty(folder.path()).expect("they can be lengthened");
        let contents = ["empty", "full"].map(|name| fs::read(path(name)).expect("it is there"));
        assert_eq!(contents, [vec![0], vec![1, 2, 3]]);
    }

    #[test]
    fn memory_that_is_reserved_is_there_and_holds_what_it_held() {
        let folder = folder();
        let path = |name| folder.path().join(name);
        for name in ["mine", "other"] {
            fs::write(path(name), [7]).expect("it can be written");
            let file = File::options().write(true).open(path(name)).expect("it is there");
            file.set_len(1 << 20).expect("it can grow");
        }
        reserve(folder.path(), |name| name == "mine").expect("there is room");
        let taken = |name| fs::metadata(path(name)).expect("it is there").blocks() * 512;
        assert!(taken("mine") >= 1 << 20 && taken("other") < 1 << 20);
        assert_eq!(fs::read(path("mine")).expect("it is there")[..2], [7, 0]);
    }

    #[test]
    fn programs_of_children_have_no_descriptors_of_the_folder() {
        let folder = folder();
        let flags = OFlags::RDWR | OFlags::CREATE;
        let mode = Mode::RUSR | Mode::WUSR;
        let file = open(folder.path().join("file"), flags, mode).expect("it is made");
        let closes = || fcntl_getfd(&file).expect("it is open").contains(FdFlags::CLOEXEC);
        assert!(!closes());
        close_on_exec(folder.path());
        assert!(closes());
    }

    #[test]
    fn only_private_regular_files_are_opened() {
        let folder = folder();
        let path = |name| folder.path().join(name);
        let made = open_private(&path("made"), OFlags::RDWR | OFlags::CREATE).expect("it is made");
        let mode = made.metadata().expect("it is open").permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        open_private(&path("made"), OFlags::RDONLY).expect("it is private");

        fs::set_permissions(path("made"), Permissions::from_mode(0o644)).expect("it is ours");
        let refused = open_private(&path("made"), OFlags::RDONLY).expect_err("others may read it");
        assert!(refused.to_string().contains("other users have access"), "{refused}");
        symlink(path("made"), path("link")).expect("it can be made");
        assert!(open_private(&path("link"), OFlags::RDONLY).is_err(), "a link");
        let mode = Mode::RUSR | Mode::WUSR;
        rustix::fs::mkfifoat(rustix::fs::CWD, path("fifo"), mode).expect("it can be made");
        // Opened otherwise it would wait for a writer.
        let refused = open_private(&path("fifo"), OFlags::RDONLY).expect_err("a FIFO");
        assert!(refused.to_string().contains("not a regular file"), "{refused}");
    }

    #[test]
    fn a_folder_of_others_or_open_to_others_is_refused() {
        let folder = folder();
        let run = folder.path().join("run");
        create_folder(&run).expect("it is new");
        check_folder(&run).expect("it is private");
        assert!(create_folder(&run).is_err(), "it is there");
        fs::set_permissions(&run, Permissions::from_mode(0o755)).expect("it is ours");
        assert!(check_folder(&run).is_err());
        symlink("/", folder.path().join("link")).expect("it can be made");
        assert!(check_folder(&folder.path().join("link")).is_err());
    }
}
