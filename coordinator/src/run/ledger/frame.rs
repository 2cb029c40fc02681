//! Frames: how records stand one after the other in the file, and how each is chained to the one before.

use crate::files::open_in_run;
use bincode::Encode;
use roadmill::internal::wire;
use roadmill::roadmap::Digest;
use rustix::fs::OFlags;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Name and, as the last byte, version of the format.
pub const HEADING: &[u8; 16] = b"roadmill ledger\x02";
/// Whether the file at `path` is a ledger of any version, by its first bytes; not if it cannot be read.
pub fn is_ledger(path: &Path) -> bool {
    let mut heading = [0; HEADING.len()];
    let file = open_in_run(path, OFlags::RDONLY);
    let is_read = file.is_ok_and(|mut file| file.read_exact(&mut heading).is_ok());
    let name = HEADING.len() - 1;
    is_read && heading[..name] == HEADING[..name]
}

/// Bytes of a record before its payload: length, check of the length, hash.
pub const HEAD_BYTES: usize = 8 + 8 + 32;
/// A payload longer than this is damage: what one message can carry.
pub const PAYLOAD_BYTES_MAX: u64 = 1 << 30;

/// A place between two records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// Bytes before it.
    pub offset: u64,
    /// Records before it.
    pub records: u64,
    /// The hash of the last of them, which covers all of them; before the first, that of the heading.
    pub chain: Digest,
}

impl Mark {
    /// The place before the first record.
    pub fn first() -> Mark {
        Mark::behind_heading(HEADING)
    }

    /// The place before the first record of a file with another heading.
    pub fn behind_heading(heading: &[u8; 16]) -> Mark {
        Mark { offset: heading.len() as u64, records: 0, chain: Digest::of(heading) }
    }

    fn behind(&self, length: u64, chain: Digest) -> Mark {
        let offset = self.offset + HEAD_BYTES as u64 + length;
        Mark { offset, records: self.records + 1, chain }
    }
}

/// Appends a record to `bytes`; the place behind it.
pub fn append(bytes: &mut Vec<u8>, before: &Mark, record: &impl Encode) -> Mark {
    let start = bytes.len();
    bytes.resize(start + HEAD_BYTES, 0);
    wire::encode_to(bytes, record);
    let whole = &mut bytes[start..];
    let length = (whole.len() - HEAD_BYTES) as u64;
    // What is hashed stands where the record will: as long as its head, and one piece.
    let head = head_of(length);
    whole[..32].copy_from_slice(&before.chain.0);
    whole[32..HEAD_BYTES].copy_from_slice(&head);
    let hash = Digest::of(whole);
    whole[..16].copy_from_slice(&head);
    whole[16..HEAD_BYTES].copy_from_slice(&hash.0);
    before.behind(length, hash)
}

/// The length and its check. A damaged length would otherwise pass for a record that is cut off.
fn head_of(length: u64) -> [u8; 16] {
    let mut head = [0; 16];
    let length = length.to_le_bytes();
    head[..8].copy_from_slice(&length);
    head[8..].copy_from_slice(&Digest::of(&length).0[..8]);
    head
}

fn link(before: &Digest, head: &[u8], payload: &[u8]) -> Digest {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&before.0).update(head).update(payload);
    Digest(*hasher.finalize().as_bytes())
}

/// Why there is no next record.
#[derive(Debug)]
pub enum Fault {
    /// The file ends where a record could begin.
    End,
    /// The file ends within the record.
    CutOff,
    /// The bytes are not those that were written.
    Damaged(&'static str),
    /// The system refuses to read.
    Unreadable(std::io::Error),
}

/// Records read one after the other.
#[derive(Debug)]
pub struct Frames<R> {
    source: R,
    at: Mark,
    payload: Vec<u8>,
}

impl<R: Read> Frames<R> {
    /// Reads from `source`, which stands at `at`.
    pub fn new(source: R, at: Mark) -> Frames<R> {
        Frames { source, at, payload: Vec::new() }
    }

    /// The place behind the last record that was read.
    pub fn at(&self) -> &Mark {
        &self.at
    }

    /// Reads the next record. Memory grows with the bytes that are there, never with a length
    /// that is only claimed.
    pub fn next(&mut self) -> Result<(), Fault> {
        let mut head = [0; HEAD_BYTES];
        match self.fill(&mut head)? {
            0 => return Err(Fault::End),
            HEAD_BYTES => {}
            _ => return Err(Fault::CutOff),
        }
        let (head, hash) = head.split_at(16);
        let length = u64::from_le_bytes(head[..8].try_into().unwrap_or_default());
        if head != head_of(length) {
            return Err(Fault::Damaged("the check of its length differs"));
        }
        if length > PAYLOAD_BYTES_MAX {
            return Err(Fault::Damaged("a length beyond any record's"));
        }
        self.payload.clear();
        let read = (&mut self.source).take(length).read_to_end(&mut self.payload);
        if read.map_err(Fault::Unreadable)? as u64 != length {
            return Err(Fault::CutOff);
        }
        let linked = link(&self.at.chain, head, &self.payload);
        if linked.0 != hash {
            return Err(Fault::Damaged("its hash differs"));
        }
        self.at = self.at.behind(length, linked);
        Ok(())
    }

    /// The payload of the last record.
    pub fn payload(&self) -> &[u8] {
        &self.payload
    }

    /// Bytes of the last record with its head.
    pub fn last_bytes(&self) -> u64 {
        (HEAD_BYTES + self.payload.len()) as u64
    }

    /// As many bytes as there are, up to the length of `bytes`.
    fn fill(&mut self, bytes: &mut [u8]) -> Result<usize, Fault> {
        let mut filled = 0;
        while filled < bytes.len() {
            match self.source.read(&mut bytes[filled..]) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(Fault::Unreadable(error)),
            }
        }
        Ok(filled)
    }
}
