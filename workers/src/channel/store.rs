//! What all workers of a run read, written once: a file in shared memory that only grows.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::fs::OFlags;

use super::run_folder::memory_folder;
use super::service::{free_bytes, workers_bytes};
use super::shared_files::open_private;

const NAME: &str = "store";
/// So much is appended between two looks at how much is free.
const GRANT_BYTES: u64 = 1 << 20;

fn path(folder: &Path) -> Option<PathBuf> {
    Some(memory_folder(folder)?.join(NAME))
}

/// The hub's end. It vanishes with the rest of the run's shared memory.
#[derive(Debug)]
pub struct Store {
    /// `None` where no file could be made, or the memory has run short.
    file: Option<File>,
    bytes: Arc<AtomicU64>,
    /// Left to the channel, which would be ended by SIGBUS if the memory ran out.
    spare_bytes: u64,
    /// What may be appended before it is looked again how much is free.
    granted_bytes: u64,
}

impl Store {
    pub(super) fn create(folder: &Path, workers_max: usize) -> Store {
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::EXCL;
        let file = path(folder).and_then(|path| open_private(&path, flags).ok());
        let spare_bytes = workers_bytes(workers_max);
        Store { file, bytes: Arc::default(), spare_bytes, granted_bytes: 0 }
    }

    /// Appends bytes for workers to read; where they begin. `None` where shared memory is short: then
    /// they, and all that follow, have to go by messages.
    pub fn append(&mut self, bytes: &[u8]) -> Option<u64> {
        let file = self.file.as_ref()?;
        let length = bytes.len() as u64;
        if self.granted_bytes < length {
            let free = free_bytes().unwrap_or(0).saturating_sub(self.spare_bytes);
            self.granted_bytes = free.min(length + GRANT_BYTES);
        }
        let offset = self.bytes.load(Ordering::Relaxed);
        if self.granted_bytes < length || file.write_all_at(bytes, offset).is_err() {
            self.file = None;
            return None;
        }
        self.granted_bytes -= length;
        self.bytes.store(offset + length, Ordering::Relaxed);
        Some(offset)
    }

    /// How many bytes of shared memory it takes, now and whenever it is asked.
    pub fn bytes(&self) -> Arc<AtomicU64> {
        self.bytes.clone()
    }
}

/// A worker's end.
#[derive(Debug)]
pub struct StoreReader {
    file: Option<File>,
}

impl StoreReader {
    /// Opens the store of the run in `folder`; one that cannot be opened shows it when it is read.
    pub fn open(folder: &Path) -> StoreReader {
        let open = |path: PathBuf| open_private(&path, OFlags::RDONLY).ok();
        StoreReader { file: path(folder).and_then(open) }
    }

    /// Reads bytes that the hub has appended. What they are is for the caller to check.
    ///
    /// # Errors
    /// When they are not there.
    pub fn read(&self, offset: u64, length: u64) -> io::Result<Vec<u8>> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        let end = offset.checked_add(length).ok_or(io::ErrorKind::InvalidInput)?;
        // No more is allocated than is there, whatever length is claimed.
        if end > file.metadata()?.len() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; length as usize];
        file.read_exact_at(&mut bytes, offset)?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Hub;
    use super::*;

    #[test]
    fn what_is_appended_can_be_read_and_nothing_else() {
        let mut hub = Hub::create(1).expect("the hub opens");
        let reader = StoreReader::open(hub.directory());
        assert!(reader.read(0, 1).is_err());
        let parts: [&[u8]; 3] = [b"first", b"", b"second"];
        let offsets = parts.map(|part| hub.store().append(part).expect("there is room"));
        for (part, offset) in parts.iter().zip(offsets) {
            assert_eq!(reader.read(offset, part.len() as u64).expect("it is there"), *part);
        }
        for (offset, length) in [(0, 12), (12, 1), (5, u64::MAX), (u64::MAX, 2), (0, 1 << 60)] {
            assert!(reader.read(offset, length).is_err(), "{length} bytes from {offset}");
        }
        assert_eq!(hub.store().bytes().load(Ordering::Relaxed), 11);
        let file = path(hub.directory()).expect("it has a name");
        assert!(file.exists());
        hub.close().expect("it can be removed");
        assert!(!file.exists());
        assert!(StoreReader::open(Path::new("/nowhere")).read(0, 0).is_err());
    }

    #[test]
    fn nothing_is_stored_once_memory_was_short() {
        let mut hub = Hub::create(1).expect("the hub opens");
        hub.store.spare_bytes = u64::MAX / 2;
        assert_eq!(hub.store().append(b"too much"), None);
        hub.store.spare_bytes = 0;
        assert_eq!(hub.store().append(b"after it"), None);
    }
}
