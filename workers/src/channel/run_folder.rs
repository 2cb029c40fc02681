//! The private folder of a run, and everything that is named after it.

use std::fs::{self, DirBuilder, File};
use std::hash::{BuildHasher, RandomState};
use std::io::ErrorKind;
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use rustix::fs::FlockOperation;

use super::WorkerId;
use super::bell::SOCKET_PATH_BYTES_MAX;
use super::error::ChannelError;
use super::run_lock::{LockedParent, try_lock};
use super::shared_files::{self, SHARED_MEMORY_FOLDER, is_ours};
use crate::reserve::Reserve;

const PREFIX: &str = "roadmill-";
/// locked by the hub as long as it lives
const OWNER: &str = "owner";
/// locked, shared, by each link as long as it lives
const MEMBERS: &str = "members";
const UNIQUE_DIGITS: usize = 12;
/// Files that are open at a time while a run is removed: the folder of all runs, and folders of shared memory, which
/// are three deep.
const OPEN_TO_REMOVE: usize = 4;
/// process id, dash, unique digits
const RUN_NAME_BYTES_MAX: usize = 10 + 1 + UNIQUE_DIGITS;

/// The folder of a run that this process owns. Dropping it removes the run.
#[derive(Debug)]
pub(super) struct RunFolder {
    path: PathBuf,
    /// The lock that this process holds as long as the run lives; `None` while the folder is being made.
    owner: Option<File>,
    /// What it takes to remove the run, however many files this process has come to open.
    reserve: Option<Reserve>,
    is_removed: bool,
}

impl RunFolder {
    /// Removes the runs whose processes have all died, then makes a new one, locked.
    pub fn create() -> Result<RunFolder, ChannelError> {
        let path = parent_path()?;
        // Before anything is made that is to be removed.
        let reserve =
            Reserve::take(OPEN_TO_REMOVE).map_err(ChannelError::io("could not open", &path))?;
        let parent = match LockedParent::lock(&path) {
            Ok(parent) => parent,
            Err(error) => {
                // It may have been made, and then not opened.
                drop(reserve);
                if let Some(parent) = LockedParent::lock_if_free(&path) {
                    parent.remove_if_empty();
                }
                return Err(error);
            }
        };
        reap(&parent);
        let folder = RunFolder::create_in(&parent, reserve);
        if folder.is_err() {
            parent.remove_if_empty();
        }
        folder
    }

    /// Makes a run, locked. Nothing of it is left if anything fails.
    fn create_in(parent: &LockedParent, reserve: Reserve) -> Result<RunFolder, ChannelError> {
        let path = parent.path().join(new_run_name());
        let io = |action| ChannelError::io(action, &path);
        DirBuilder::new().mode(0o700).create(&path).map_err(io("could not create"))?;
        // From here on the run is removed if anything fails.
        let reserve = Some(reserve);
        let mut folder = RunFolder { path: path.clone(), owner: None, reserve, is_removed: false };
        if let Some(memory) = memory_folder(&path) {
            shared_files::create_folder(&memory)?;
        }
        let create = |name| {
            File::options()
                .write(true)
                .create_new(true)
                .mode(0o600)
                .open(path.join(name))
                .map_err(io("could not create the lock files in"))
        };
        create(MEMBERS)?;
        create(OWNER)?;
        let owner = try_lock(&path.join(OWNER), FlockOperation::NonBlockingLockExclusive)
            .map_err(io("could not lock"))?
            .ok_or_else(|| ChannelError::Busy { path: path.clone() })?;
        folder.owner = Some(owner);
        Ok(folder)
    }

    /// Where the folder is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the folder and the shared memory of this run.
    pub fn remove(mut self) -> Result<(), ChannelError> {
        self.remove_once()
    }

    fn remove_once(&mut self) -> Result<(), ChannelError> {
        if std::mem::replace(&mut self.is_removed, true) {
            return Ok(());
        }
        // without this file no worker can join any more, and leave files behind
        let _ = fs::remove_file(self.path.join(MEMBERS));
        drop(self.reserve.take());
        // While the folder is made its parent is locked already.
        let parent = self.owner.as_ref().and(self.path.parent()).map(LockedParent::lock);
        remove_run(&self.path)?;
        if let Some(parent) = parent {
            parent?.remove_if_empty();
        }
        Ok(())
    }
}

impl Drop for RunFolder {
    fn drop(&mut self) {
        // the next hub tries again
        let _ = self.remove_once();
    }
}

/// Joins the run in `folder` as a worker; the run is not reaped while the result lives.
pub(super) fn join(folder: &Path) -> Result<File, ChannelError> {
    match try_lock(&folder.join(MEMBERS), FlockOperation::NonBlockingLockShared) {
        Ok(Some(file)) => Ok(file),
        Ok(None) => Err(ChannelError::HubGone),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(ChannelError::HubGone),
        Err(error) => Err(ChannelError::io("could not join the run in", folder)(error)),
    }
}

/// The socket that wakes the hub.
pub(super) fn hub_socket(folder: &Path) -> PathBuf {
    folder.join("h")
}

/// The socket that wakes a worker.
pub(super) fn worker_socket(folder: &Path, worker: WorkerId) -> PathBuf {
    folder.join(format!("w{:016x}", worker.0))
}

/// Where the shared memory of the run in `folder` is; `None` if that is no run's folder. The name follows from the
/// run's, which has digits that nobody can know before the run is there.
pub(super) fn memory_folder(folder: &Path) -> Option<PathBuf> {
    let run = folder.file_name()?.to_str()?;
    is_run_name(run).then(|| Path::new(SHARED_MEMORY_FOLDER).join(format!("{PREFIX}{run}")))
}

/// `<temporary folder>/roadmill-<user>`; `/tmp` stands in for a folder that is too long for sockets.
fn parent_path() -> Result<PathBuf, ChannelError> {
    let user = rustix::process::geteuid().as_raw();
    let below = |base: PathBuf| base.join(format!("{PREFIX}{user}"));
    let temporary = std::env::temp_dir();
    let preferred = std::path::absolute(&temporary)
        .map(below)
        .map_err(ChannelError::io("could not find", temporary))?;
    let worker_socket_bytes = "/w".len() + 16;
    let socket_bytes = preferred.as_os_str().len() + 1 + RUN_NAME_BYTES_MAX + worker_socket_bytes;
    if socket_bytes <= SOCKET_PATH_BYTES_MAX {
        Ok(preferred)
    } else {
        Ok(below(PathBuf::from("/tmp")))
    }
}

/// The process id, for people, and digits that no other run has.
fn new_run_name() -> String {
    let process = std::process::id();
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    // keyed by the system's randomness: other containers may share the memory file system and
    // have the same process ids
    let unique = RandomState::new().hash_one((process, now));
    format!("{process}-{:0UNIQUE_DIGITS$x}", unique >> (64 - 4 * UNIQUE_DIGITS))
}

fn is_run_name(name: &str) -> bool {
    name.split_once('-').is_some_and(|(process, unique)| {
        !process.is_empty()
            && process.bytes().all(|c| c.is_ascii_digit())
            && unique.len() == UNIQUE_DIGITS
            && unique.bytes().all(|c| c.is_ascii_hexdigit())
    })
}

/// Removes what runs of this user have left whose processes have all died, as [`Hub::create`](super::Hub::create)
/// does. What cannot be removed, or may belong to somebody else, stays.
pub fn remove_leftovers() {
    let parent = parent_path().ok().and_then(|path| LockedParent::lock_if_free(&path));
    if let Some(parent) = parent {
        reap(&parent);
        parent.remove_if_empty();
    }
}

/// Removes every run that has neither a living hub nor a living link. What cannot be removed
/// is left for the next time: an old run must not hinder a new one.
fn reap(parent: &LockedParent) {
    let Ok(entries) = fs::read_dir(parent.path()) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        if !name.to_str().is_some_and(is_run_name) {
            continue;
        }
        let path = entry.path();
        let locks = [OWNER, MEMBERS]
            .map(|name| try_lock(&path.join(name), FlockOperation::NonBlockingLockExclusive));
        let is_dead = locks.iter().all(|lock| match lock {
            Ok(file) => file.is_some(),
            // killed while creating or removing the run, as both happen with the parent locked
            Err(error) => error.kind() == ErrorKind::NotFound,
        });
        if is_dead {
            let _ = remove_run(&path);
        }
    }
}

/// Shared memory first: as long as the folder stands, a later reaper finds what is left.
fn remove_run(folder: &Path) -> Result<(), ChannelError> {
    if let Some(memory) = memory_folder(folder) {
        remove_memory(&memory)?;
    }
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(ChannelError::io("could not remove", folder)(error))
        }
        _ => Ok(()),
    }
}

/// Removes a run's shared memory. Another user's folder of that name is not the run's: it is left alone, and keeps
/// nobody from removing the rest.
fn remove_memory(memory: &Path) -> Result<(), ChannelError> {
    let removed = match fs::symlink_metadata(memory) {
        Ok(metadata) if is_ours(&metadata) && metadata.is_dir() => fs::remove_dir_all(memory),
        Ok(_) => Ok(()),
        Err(error) => Err(error),
    };
    match removed {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(ChannelError::io("could not remove", memory)(error))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_names_are_recognised_and_differ() {
        let names = [new_run_name(), new_run_name()];
        assert!(names.iter().all(|name| is_run_name(name)));
        assert!(names.iter().all(|name| name.len() <= RUN_NAME_BYTES_MAX));
        assert_ne!(names[0], names[1]);
        for other in ["", "-", "12-", "12-abc", "x-0123456789ab", "12-0123456789ag", ".."] {
            assert!(!is_run_name(other), "{other}");
        }
    }
}
