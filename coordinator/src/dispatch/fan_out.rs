use super::spool::Spool;
use super::staff::Made;
use crate::agent::message::{Entry, Text};
use roadmill::img::{Job, Outcome, Round};
use roadmill::internal::wire;
use roadmill::numbers::SetNumber;
use roadmill::roadmap::{Digest, Increment};
use roadmill_workers::WorkerId;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// The most bytes of entries in one message, so that an agent that is far behind costs little memory.
const PART_BYTES_MAX: u64 = 1 << 20;

/// Everything that agents are to know of the roadmap so far, in order. The bytes lie in a file; an agent that has made
/// some of them itself is not sent these again.
pub struct FanOut {
    spool: Spool,
    entries: Vec<Kept>,
    /// By set, the outcomes that are increments to be published.
    increments: BTreeMap<SetNumber, Bytes>,
    /// By set, those that are joins to be folded.
    joins: BTreeMap<SetNumber, Bytes>,
}

enum Kept {
    Increment(Bytes),
    Fold(Vec<Bytes>),
}

/// Where the bytes of an outcome are, and who made them.
#[derive(Debug, Clone, Copy)]
struct Bytes {
    offset: u64,
    length: u64,
    digest: Digest,
    /// `None` of a set that was imported, or of a build that goes on.
    maker: Option<WorkerId>,
}

impl FanOut {
    /// Nothing yet. The bytes go to a file on the disk of this folder.
    ///
    /// # Errors
    /// When no file can be made there.
    pub fn in_folder(folder: &Path) -> io::Result<FanOut> {
        let (increments, joins) = (BTreeMap::new(), BTreeMap::new());
        Ok(FanOut { spool: Spool::in_folder(folder)?, entries: Vec::new(), increments, joins })
    }

    /// Keeps the outcome of a job until it is published or folded.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&mut self, made: &Made) -> io::Result<()> {
        let kept = match made.job {
            Job::Generate { number, .. } => self.increments.entry(number),
            Job::Join { number, .. } => self.joins.entry(number),
            Job::Evaluate { .. } => return Ok(()),
        };
        if let std::collections::btree_map::Entry::Vacant(kept) = kept {
            let (length, digest) = (made.bytes().len() as u64, made.digest);
            let offset = self.spool.append(made.bytes())?;
            kept.insert(Bytes { offset, length, digest, maker: Some(made.member) });
        }
        Ok(())
    }

    /// Forgets what was kept of a job: it is no outcome.
    pub fn forget(&mut self, job: Job) {
        match job {
            Job::Generate { number, .. } => self.increments.remove(&number),
            Job::Join { number, .. } => self.joins.remove(&number),
            Job::Evaluate { .. } => None,
        };
    }

    /// Appends the increment of the set `number`, the next one.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn publish(&mut self, number: SetNumber, increment: &Increment) -> io::Result<()> {
        let bytes = match self.increments.remove(&number) {
            Some(kept) => kept,
            None => put(&mut self.spool, &Outcome::Increment(Ok(increment.clone())))?,
        };
        self.entries.push(Kept::Increment(bytes));
        Ok(())
    }

    /// Appends the end of a round.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn fold(&mut self, round: &Round) -> io::Result<()> {
        let mut joins = Vec::with_capacity(round.sets.len());
        for set in &round.sets {
            joins.push(match self.joins.remove(&set.number) {
                Some(kept) => kept,
                None => put(&mut self.spool, &Outcome::Joined(set.joined.clone()))?,
            });
        }
        self.entries.push(Kept::Fold(joins));
        Ok(())
    }

    /// The entries from `place` on that fit into one message to `member`, at least one if there is one, and the place
    /// behind them.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn part(&self, place: usize, member: WorkerId) -> io::Result<(Vec<Entry>, usize)> {
        let mut part = Vec::new();
        let mut bytes = 0;
        for kept in &self.entries[place..] {
            bytes += match kept {
                Kept::Increment(kept) => kept.length_for(member),
                Kept::Fold(joins) => joins.iter().map(|kept| kept.length_for(member)).sum(),
            };
            if bytes > PART_BYTES_MAX && !part.is_empty() {
                break;
            }
            part.push(match kept {
                Kept::Increment(kept) => Entry::Increment(self.text(kept, member)?),
                Kept::Fold(joins) => {
                    let texts = joins.iter().map(|kept| self.text(kept, member));
                    Entry::Fold(texts.collect::<io::Result<_>>()?)
                }
            });
        }
        let next = place + part.len();
        Ok((part, next))
    }

    /// The place behind the last entry.
    pub fn end(&self) -> usize {
        self.entries.len()
    }

    fn text(&self, kept: &Bytes, member: WorkerId) -> io::Result<Text> {
        if kept.maker == Some(member) {
            return Ok(Text::Own(kept.digest));
        }
        Ok(Text::Here(Arc::new(self.spool.read(kept.offset, kept.length)?)))
    }
}

impl Bytes {
    /// How many bytes of a message to this member they take.
    fn length_for(&self, member: WorkerId) -> u64 {
        if self.maker == Some(member) { size_of::<Digest>() as u64 } else { self.length }
    }
}

/// Writes down an outcome that no agent has sent.
fn put(spool: &mut Spool, outcome: &Outcome) -> io::Result<Bytes> {
    let bytes = wire::encode(outcome);
    let (length, digest) = (bytes.len() as u64, Digest::of(&bytes));
    Ok(Bytes { offset: spool.append(&bytes)?, length, digest, maker: None })
}
