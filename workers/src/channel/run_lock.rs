//! Locks on files: they end with the process that holds them, however it ends.

use std::fs::{self, DirBuilder, File};
use std::io::ErrorKind;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use rustix::fs::{FlockOperation, Mode, OFlags, flock, open};
use rustix::io::Errno;

use super::error::ChannelError;
use super::shared_files::{fault, open_private};

const PATIENCE: Duration = Duration::from_secs(10);
const PAUSE: Duration = Duration::from_millis(2);

/// Opens `path`, which must exist, and tries to lock it. `None` if another process holds it.
pub(super) fn try_lock(
    path: &Path,
    operation: FlockOperation,
) -> Result<Option<File>, std::io::Error> {
    let file = open_private(path, OFlags::RDWR)?;
    match flock(&file, operation) {
        Ok(()) => Ok(Some(file)),
        Err(Errno::WOULDBLOCK) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// The folder of all runs of this user, locked: nobody else creates or removes runs meanwhile.
#[derive(Debug)]
pub(super) struct LockedParent {
    path: PathBuf,
    _directory: File,
}

impl LockedParent {
    /// The folder, locked, if it is there, private, and nobody else has locked it. It is not made.
    pub fn lock_if_free(path: &Path) -> Option<LockedParent> {
        let directory = LockedParent::try_lock(path).ok()??;
        Some(LockedParent { path: path.to_path_buf(), _directory: directory })
    }

    /// Creates the folder if it is not there, checks that it is private, and locks it.
    pub fn lock(path: &Path) -> Result<LockedParent, ChannelError> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            match DirBuilder::new().mode(0o700).create(path) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                    return Err(ChannelError::io("could not create", path)(error));
                }
                _ => {}
            }
            if let Some(directory) = LockedParent::try_lock(path)? {
                return Ok(LockedParent { path: path.to_path_buf(), _directory: directory });
            }
            if Instant::now() > deadline {
                return Err(ChannelError::Busy { path: path.into() });
            }
            thread::sleep(PAUSE);
        }
    }

    /// `None` if it is not there, or somebody else has locked it.
    fn try_lock(path: &Path) -> Result<Option<File>, ChannelError> {
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let directory: File = match open(path, flags, Mode::empty()) {
            Ok(directory) => directory.into(),
            // the last run has just removed it
            Err(Errno::NOENT) => return Ok(None),
            Err(Errno::LOOP | Errno::NOTDIR) => {
                return Err(ChannelError::Unsafe {
                    path: path.into(),
                    reason: "it is not a folder",
                });
            }
            Err(error) => return Err(ChannelError::io("could not open", path)(error.into())),
        };
        let opened = directory.metadata().map_err(ChannelError::io("could not inspect", path))?;
        if let Some(reason) = fault(&opened) {
            return Err(ChannelError::Unsafe { path: path.into(), reason });
        }
        match flock(&directory, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) => {}
            Err(Errno::WOULDBLOCK) => return Ok(None),
            Err(error) => return Err(ChannelError::io("could not lock", path)(error.into())),
        }
        // a folder that was removed, and perhaps made anew, in between is not the one locked
        match fs::symlink_metadata(path) {
            Ok(now) if (now.dev(), now.ino()) == (opened.dev(), opened.ino()) => {
                Ok(Some(directory))
            }
            _ => Ok(None),
        }
    }

    /// Where the folder is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the folder if no run is left in it. Whoever has locked the folder and leaves no run in it does so, and
    /// whoever has made it meanwhile, or is about to open it, makes it anew.
    pub fn remove_if_empty(self) {
        // still locked, so nobody can have begun a run that is not seen here; a folder that has
        // other runs is left alone by the system itself
        let _ = fs::remove_dir(&self.path);
    }
}
