//! The side file that says how much of the ledger is durable.
//!
//! Two slots are overwritten in turn, each with a check of its own: a write that a power failure tears
//! leaves the other slot. Renaming a new file over the old one would take three syncs instead of one,
//! and would need room on a disk that is full.

use super::frame::Mark;
use crate::files::open_in_run;
use roadmill::roadmap::Digest;
use rustix::fs::OFlags;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::Path;

/// The side file in a run folder.
pub const DURABLE: &str = "ledger.durable";

/// Sequence number, offset, records (u64 each) and chain, then the digest of these.
const BODY_BYTES: usize = 8 + 8 + 8 + 32;
const SLOT_BYTES: usize = BODY_BYTES + 32;
/// Slots lie in different blocks of any disk.
const SLOT_DISTANCE: u64 = 4096;

/// The side file, open for writing.
#[derive(Debug)]
pub struct DurableFile {
    file: File,
    sequence: u64,
}

impl DurableFile {
    /// Makes the file, or makes it new.
    pub fn create(folder: &Path) -> io::Result<DurableFile> {
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::TRUNC;
        let file = open_in_run(&folder.join(DURABLE), flags)?;
        // All of its blocks are taken now.
        file.write_all_at(&[0; 2 * SLOT_DISTANCE as usize], 0)?;
        Ok(DurableFile { file, sequence: 0 })
    }

    /// Opens the file, or makes it where there is none.
    pub fn open(folder: &Path) -> io::Result<DurableFile> {
        match newest(folder) {
            None => DurableFile::create(folder),
            Some((sequence, _)) => {
                let file = open_in_run(&folder.join(DURABLE), OFlags::WRONLY)?;
                Ok(DurableFile { file, sequence })
            }
        }
    }

    /// Notes that the ledger is durable up to here. Until the file is synced a failure of the machine may
    /// bring back an earlier mark, which is as true.
    pub fn set(&mut self, mark: &Mark) -> io::Result<()> {
        self.sequence += 1;
        let mut slot = [0; SLOT_BYTES];
        slot[..8].copy_from_slice(&self.sequence.to_le_bytes());
        slot[8..16].copy_from_slice(&mark.offset.to_le_bytes());
        slot[16..24].copy_from_slice(&mark.records.to_le_bytes());
        slot[24..BODY_BYTES].copy_from_slice(&mark.chain.0);
        let digest = Digest::of(&slot[..BODY_BYTES]);
        slot[BODY_BYTES..].copy_from_slice(&digest.0);
        self.file.write_all_at(&slot, self.sequence % 2 * SLOT_DISTANCE)
    }

    /// Makes the mark durable too.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }
}

/// Up to where the ledger of a run folder is durable; `None` where no slot can be read.
pub fn read(folder: &Path) -> Option<Mark> {
    newest(folder).map(|(_, mark)| mark)
}

fn newest(folder: &Path) -> Option<(u64, Mark)> {
    let file = open_in_run(&folder.join(DURABLE), OFlags::RDONLY).ok()?;
    let slot = |index: u64| {
        let mut slot = [0; SLOT_BYTES];
        file.read_exact_at(&mut slot, index * SLOT_DISTANCE).ok()?;
        decode(&slot)
    };
    [slot(0), slot(1)].into_iter().flatten().max_by_key(|(sequence, _)| *sequence)
}

fn decode(slot: &[u8; SLOT_BYTES]) -> Option<(u64, Mark)> {
    let (body, digest) = slot.split_at(BODY_BYTES);
    if Digest::of(body).0 != digest {
        return None;
    }
    let number = |at: usize| body[at..at + 8].try_into().ok().map(u64::from_le_bytes);
    let chain = Digest(body[24..].try_into().ok()?);
    Some((number(0)?, Mark { offset: number(8)?, records: number(16)?, chain }))
}
