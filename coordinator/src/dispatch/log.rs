use crate::agent::message::Text;
use crate::crew::Crew;
use roadmill::img::{Job, Outcome, Round};
use roadmill::internal::wire;
use roadmill::numbers::SetNumber;
use roadmill::roadmap::{Digest, Increment};
use roadmill_workers::message::{Bytes, Entry};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most bytes of entries in one message; a worker that is far behind gets several.
const PART_BYTES_MAX: usize = 32 << 20;

/// Everything that has changed the workers' replicas so far, ready to be sent. Each worker has read the log up
/// to a place of its own; a new worker begins at the beginning. Where the crew can store bytes for all its
/// members they stand there once, as they came from the worker that made them.
#[derive(Debug, Default)]
pub struct EntryLog {
    entries: Vec<Entry>,
    /// By set, the outcomes that are increments to be published.
    increments: BTreeMap<SetNumber, Bytes>,
    /// By set, those that are joins to be folded.
    joins: BTreeMap<SetNumber, Bytes>,
}

impl EntryLog {
    /// Keeps the outcome of a job until it is published or folded.
    pub fn keep(&mut self, job: Job, outcome: Bytes) {
        match job {
            Job::Generate { number, .. } => self.increments.entry(number).or_insert(outcome),
            Job::Join { number, .. } => self.joins.entry(number).or_insert(outcome),
            Job::Evaluate { .. } => return,
        };
    }

    /// Forgets what was kept of a job: it is no outcome.
    pub fn forget(&mut self, job: Job) {
        match job {
            Job::Generate { number, .. } => self.increments.remove(&number),
            Job::Join { number, .. } => self.joins.remove(&number),
            Job::Evaluate { .. } => None,
        };
    }

    /// Appends the increment of the set `number`, the next one, as it came from a coordinator. False where it is one that
    /// was kept, and it was not.
    pub fn publish_text(&mut self, number: SetNumber, text: Text, crew: &mut impl Crew) -> bool {
        let kept = self.increments.remove(&number);
        let bytes = taken(text, kept, crew);
        let is_there = bytes.is_some();
        self.entries.extend(bytes.map(Entry::Increment));
        is_there
    }

    /// Appends the end of a round, which begins with the set `first`, in the same way.
    pub fn fold_texts(&mut self, first: SetNumber, texts: Vec<Text>, crew: &mut impl Crew) -> bool {
        let joins = texts.into_iter().zip(0..).map(|(text, offset)| {
            let kept = self.joins.remove(&(first + offset));
            taken(text, kept, crew)
        });
        let joins: Option<Vec<Bytes>> = joins.collect();
        let is_there = joins.is_some();
        self.entries.extend(joins.map(Entry::Fold));
        is_there
    }

    /// Appends the increment of the set `number`, the next one.
    pub fn publish(&mut self, number: SetNumber, increment: &Increment, crew: &mut impl Crew) {
        let kept = self.increments.remove(&number);
        let made = || Outcome::Increment(Ok(increment.clone()));
        self.entries.push(Entry::Increment(kept.unwrap_or_else(|| put(&made(), crew))));
    }

    /// Appends the end of a round.
    pub fn fold(&mut self, round: &Round, crew: &mut impl Crew) {
        let joins = round.sets.iter().map(|set| {
            let kept = self.joins.remove(&set.number);
            kept.unwrap_or_else(|| put(&Outcome::Joined(set.joined.clone()), crew))
        });
        self.entries.push(Entry::Fold(joins.collect()));
    }

    /// The entries from `place` on that fit into one message, at least one if there is one, and
    /// the place behind them.
    pub fn part(&self, place: usize) -> (Vec<Entry>, usize) {
        let mut bytes = 0;
        let fits = |entry: &&Entry| {
            bytes += length(entry);
            bytes <= PART_BYTES_MAX || bytes == length(entry)
        };
        let part: Vec<_> = self.entries[place..].iter().take_while(fits).cloned().collect();
        let next = place + part.len();
        (part, next)
    }

    /// The place behind the last entry.
    pub fn end(&self) -> usize {
        self.entries.len()
    }
}

/// The bytes of an outcome that no worker has sent: of a set that was imported, or of a build that goes on.
fn put(outcome: &Outcome, crew: &mut impl Crew) -> Bytes {
    let bytes = wire::encode(outcome);
    let stored = crew.store(&bytes);
    bytes_of(&bytes, stored, Digest::of(&bytes))
}

/// The bytes of an outcome that came from a coordinator: those that were kept, if they are the same.
fn taken(text: Text, kept: Option<Bytes>, crew: &mut impl Crew) -> Option<Bytes> {
    match text {
        Text::Own(digest) => kept.filter(|kept| digest_of(kept) == digest),
        Text::Here(bytes) => {
            let stored = crew.store(&bytes);
            Some(bytes_of(&bytes, stored, Digest::of(&bytes)))
        }
    }
}

fn digest_of(bytes: &Bytes) -> Digest {
    match bytes {
        Bytes::Stored { digest, .. } => *digest,
        Bytes::Here(bytes) => Digest::of(bytes),
    }
}

/// Bytes as an entry names them: where the crew has stored them, or else themselves.
pub fn bytes_of(bytes: &[u8], stored: Option<u64>, digest: Digest) -> Bytes {
    match stored {
        Some(offset) => Bytes::Stored { offset, length: bytes.len() as u64, digest },
        None => Bytes::Here(Arc::new(bytes.to_vec())),
    }
}

/// Bytes that an entry takes in a message.
fn length(entry: &Entry) -> usize {
    let of = |bytes: &Bytes| match bytes {
        Bytes::Stored { .. } => size_of::<Bytes>(),
        Bytes::Here(bytes) => bytes.len(),
    };
    match entry {
        Entry::Increment(bytes) => of(bytes),
        Entry::Fold(joins) => joins.iter().map(of).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_whole_entries_and_together_the_log() {
        let sizes = [1, PART_BYTES_MAX - 1, 1, PART_BYTES_MAX + 5, 7, 9];
        let entry = |size: &usize| Entry::Fold(vec![Bytes::Here(Arc::new(vec![0; *size]))]);
        let log = EntryLog { entries: sizes.iter().map(entry).collect(), ..EntryLog::default() };
        let (mut place, mut parts) = (0, Vec::new());
        while place < log.end() {
            let (part, next) = log.part(place);
            parts.push(part.len());
            place = next;
        }
        assert_eq!(parts, [2, 1, 1, 2]);
    }
}
