//! What the roadmaps of all workers have in common, once: each block is a file in shared memory.

use std::fs::{self, File};
use std::io;
use std::os::fd::AsRawFd;
use std::path::{Path, PathBuf};

use memmap2::{Mmap, MmapMut};
use roadmill::internal::shelf::{Block, BlockName, Claim, Shelf};
use rustix::fs::{AtFlags, CWD, FallocateFlags, FlockOperation, Mode, OFlags};

use super::run_folder::memory_folder;
use super::service::{free_bytes, workers_bytes};
use super::shared_files::open_private;

/// Locked by the worker that makes what is dear to make.
const CLAIM: &str = "claim";

/// The blocks of a run. A file gets its name once it is complete, and is not changed any more; one that is not
/// complete has no name and vanishes with the worker that fills it. Files that are left vanish with the rest of the
/// run's shared memory.
#[derive(Debug)]
pub struct SharedShelf {
    /// The folder of the run's shared memory.
    folder: Option<PathBuf>,
    /// Left to the channel and to the store, which is written at the same time.
    spare_bytes: u64,
}

impl SharedShelf {
    /// That of the run in `folder`, whose channel was made for so many workers.
    pub fn open(folder: &Path, workers_max: usize) -> SharedShelf {
        let folder = memory_folder(folder);
        SharedShelf { folder, spare_bytes: 2 * workers_bytes(workers_max) }
    }

    fn path(&self, name: impl std::fmt::Display) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(name.to_string()))
    }

    /// A file without a name, filled.
    fn filled(&self, bytes: usize, fill: &mut dyn FnMut(&mut [u8])) -> io::Result<(File, Mmap)> {
        let needed = self.spare_bytes.saturating_add(2 * bytes as u64);
        if free_bytes()? < needed {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let folder = self.folder.as_ref().ok_or(io::ErrorKind::NotFound)?;
        let file = rustix::fs::open(folder, flags, Mode::RUSR | Mode::WUSR)?;
        // Writing to memory that is not there would be a SIGBUS.
        rustix::fs::fallocate(&file, FallocateFlags::empty(), 0, bytes as u64)?;
        let file = File::from(file);
        // SAFETY: nobody else knows the file, and nobody ever shortens one.
        let mut map = unsafe { MmapMut::map_mut(&file) }?;
        fill(&mut map);
        Ok((file, map.make_read_only()?))
    }
}

impl Shelf for SharedShelf {
    fn find(&self, name: BlockName, bytes: usize) -> Option<Block> {
        let file = open_private(&self.path(name)?, OFlags::RDONLY).ok()?;
        if file.metadata().ok()?.len() != bytes as u64 {
            return None;
        }
        // SAFETY: a file that has its name is never written to nor shortened, only removed, and it is private:
        // nobody but processes of this user can do otherwise.
        let map = unsafe { Mmap::map(&file) }.ok()?;
        Some(Block::from_owner(map))
    }

    fn put(&self, name: BlockName, bytes: usize, fill: &mut dyn FnMut(&mut [u8])) -> Option<Block> {
        let path = self.path(name)?;
        let (file, map) = self.filled(bytes, fill).ok()?;
        let opened = format!("/proc/self/fd/{}", file.as_raw_fd());
        let named = rustix::fs::linkat(CWD, opened, CWD, &path, AtFlags::SYMLINK_FOLLOW);
        let other = match named {
            Ok(()) => None,
            // Another was faster, or names cannot be given here.
            Err(_) => self.find(name, bytes),
        };
        Some(other.unwrap_or_else(|| Block::from_owner(map)))
    }

    fn claim(&self) -> Option<Claim> {
        let path = self.path(CLAIM)?;
        let file = open_private(&path, OFlags::RDWR | OFlags::CREATE).ok()?;
        rustix::fs::flock(&file, FlockOperation::NonBlockingLockExclusive).ok()?;
        // The lock ends with the file, and with the process at the latest.
        Some(Box::new(file))
    }

    fn discard(&self, name: BlockName) {
        if let Some(path) = self.path(name) {
            // Mostly there is none.
            let _ = fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Hub;
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::panic::{AssertUnwindSafe, catch_unwind};

    const NAME: BlockName = BlockName::Segment { level: 1, number: 2 };

    fn put(shelf: &SharedShelf, bytes: &[u8]) -> Option<Block> {
        shelf.put(NAME, bytes.len(), &mut |block| block.copy_from_slice(bytes))
    }

    /// The files of a run, but for those of the channel.
    fn files(shelf: &SharedShelf) -> Vec<String> {
        let folder = shelf.folder.as_ref().expect("it is a run's");
        // There is none any more once the run has ended.
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let kinds = ["segment", "configs", "edges", "claim"];
        names.filter(|name| kinds.iter().any(|kind| name.starts_with(kind))).collect()
    }

    #[test]
    fn a_block_is_the_first_that_was_put_and_vanishes_with_the_run() {
        let hub = Hub::create(1).expect("the hub opens");
        let [ours, theirs] = [0, 1].map(|_| SharedShelf::open(hub.directory(), 1));
        assert!(ours.find(NAME, 3).is_none());
        let block = put(&ours, &[1, 2, 3]).expect("there is room");
        assert_eq!(block, &[1, 2, 3][..]);
        assert_eq!(block.as_ptr().align_offset(roadmill::internal::shelf::ALIGNMENT), 0);
        assert_eq!(theirs.find(NAME, 3).expect("it is there"), block);
        // Who makes it at the same time gets the other's.
        assert_eq!(put(&theirs, &[4, 5, 6]).expect("it is there"), block);
        let path = ours.path(NAME).expect("it has a name");
        let mode = fs::metadata(&path).expect("it is there").permissions().mode();
        assert_eq!(mode & 0o777, 0o600);

        theirs.discard(NAME);
        assert!(ours.find(NAME, 3).is_none());
        assert_eq!(block, &[1, 2, 3][..], "who has it keeps it");
        let again = put(&theirs, &[4, 5, 6]).expect("there is room");
        assert_eq!(ours.find(NAME, 3).expect("it is there"), again);
        hub.close().expect("it can be removed");
        assert_eq!(files(&ours), [""; 0]);
        assert_eq!(again, &[4, 5, 6][..]);
    }

    #[test]
    fn a_block_of_another_length_is_none() {
        let hub = Hub::create(1).expect("the hub opens");
        let shelf = SharedShelf::open(hub.directory(), 1);
        put(&shelf, &[1, 2, 3]).expect("there is room");
        assert!(shelf.find(NAME, 2).is_none() && shelf.find(NAME, 4).is_none());
        fs::write(shelf.path(NAME).expect("it has a name"), []).expect("it can be written");
        // The other's is of no use, so that this one is the maker's own.
        assert_eq!(put(&shelf, &[7]).expect("there is room"), &[7][..]);
    }

    /// Who finds a file that others can have written to makes the block for itself.
    #[test]
    fn a_block_that_others_may_have_made_is_not_believed() {
        let hub = Hub::create(1).expect("the hub opens");
        let shelf = SharedShelf::open(hub.directory(), 1);
        let path = shelf.path(NAME).expect("it has a name");
        fs::write(&path, [9, 9, 9]).expect("it can be written");
        fs::set_permissions(&path, Permissions::from_mode(0o644)).expect("it is ours");
        assert!(shelf.find(NAME, 3).is_none());
        assert_eq!(put(&shelf, &[1, 2, 3]).expect("there is room"), &[1, 2, 3][..]);
        let elsewhere = path.with_file_name("elsewhere");
        fs::rename(&path, &elsewhere).expect("it is there");
        fs::set_permissions(&elsewhere, Permissions::from_mode(0o600)).expect("it is ours");
        symlink(&elsewhere, &path).expect("it can be made");
        assert!(shelf.find(NAME, 3).is_none(), "a link");
    }

    #[test]
    fn a_maker_that_dies_leaves_nothing() {
        let hub = Hub::create(1).expect("the hub opens");
        let shelf = SharedShelf::open(hub.directory(), 1);
        let died = catch_unwind(AssertUnwindSafe(|| {
            let _claim = shelf.claim().expect("nobody has it");
            shelf.put(NAME, 9, &mut |_| {
                assert_eq!(files(&shelf), ["claim"], "what is not complete has no name");
                panic!("on purpose");
            })
        }));
        assert!(died.is_err());
        assert_eq!(files(&shelf), ["claim"]);
        assert!(shelf.claim().is_some(), "the claim is free again");
        assert_eq!(put(&shelf, &[7]).expect("there is room"), &[7][..]);
    }

    #[test]
    fn one_at_a_time_has_the_claim() {
        let hub = Hub::create(1).expect("the hub opens");
        let [ours, theirs] = [0, 1].map(|_| SharedShelf::open(hub.directory(), 1));
        let claim = ours.claim().expect("nobody has it");
        assert!(theirs.claim().is_none() && ours.claim().is_none());
        drop(claim);
        assert!(theirs.claim().is_some());
    }

    #[test]
    fn nothing_is_put_where_memory_is_short_or_there_is_no_run() {
        let hub = Hub::create(1).expect("the hub opens");
        let mut shelf = SharedShelf::open(hub.directory(), 1);
        shelf.spare_bytes = u64::MAX / 2;
        assert!(put(&shelf, &[1]).is_none());
        assert_eq!(files(&shelf), [""; 0]);
        let none = SharedShelf::open(Path::new("/nowhere"), 1);
        assert!(put(&none, &[1]).is_none() && none.find(NAME, 1).is_none());
        assert!(none.claim().is_none());
    }
}
