use roadmill::img::{Outcome, Round};
use roadmill::roadmap::{Digest, Increment};
use roadmill::wire;
use roadmill_workers::channel::Store;
use roadmill_workers::message::{Bytes, Entry};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most bytes of entries in one message; a worker that is far behind gets several.
const PART_BYTES_MAX: usize = 32 << 20;

/// Everything that has changed the replicas so far, ready to be sent: each worker has its place in
/// it, and a new one starts at the beginning. As long as there is room, the bytes stand in the channel's
/// store, once for all workers.
#[derive(Debug, Default)]
pub struct Log {
    entries: Vec<Entry>,
    /// By place, the bytes of outcomes that are increments to be published: as they came, so that they
    /// need not be encoded again.
    made: BTreeMap<u64, (Vec<u8>, Digest)>,
}

impl Log {
    /// Keeps the bytes of the outcome that is the increment at `place`, until it is published.
    pub fn keep(&mut self, place: u64, outcome: Vec<u8>, digest: Digest) {
        self.made.entry(place).or_insert((outcome, digest));
    }

    /// Appends the increment at `place`, the next one.
    pub fn publish(&mut self, place: u64, increment: &Increment, store: &mut Store) {
        let (bytes, digest) = self.made.remove(&place).unwrap_or_else(|| {
            let bytes = wire::encode(&Outcome::Increment(Ok(increment.clone())));
            let digest = Digest::of(&bytes);
            (bytes, digest)
        });
        self.entries.push(Entry::Increment(put(bytes, digest, store)));
    }

    /// Appends the end of a round.
    pub fn fold(&mut self, round: &Round, store: &mut Store) {
        let joins: Vec<_> = round.sets.iter().map(|set| &set.joined.edges).collect();
        let bytes = wire::encode(&joins);
        let digest = Digest::of(&bytes);
        self.entries.push(Entry::Fold(put(bytes, digest, store)));
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

fn put(bytes: Vec<u8>, digest: Digest, store: &mut Store) -> Bytes {
    match store.append(&bytes) {
        Some(offset) => Bytes::Stored { offset, length: bytes.len() as u64, digest },
        None => Bytes::Here(Arc::new(bytes)),
    }
}

/// Bytes that an entry takes in a message.
fn length(entry: &Entry) -> usize {
    let (Entry::Increment(bytes) | Entry::Fold(bytes)) = entry;
    match bytes {
        Bytes::Stored { .. } => size_of::<Entry>(),
        Bytes::Here(bytes) => bytes.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_whole_entries_and_together_the_log() {
        let sizes = [1, PART_BYTES_MAX - 1, 1, PART_BYTES_MAX + 5, 7, 9];
        let entry = |size: &usize| Entry::Fold(Bytes::Here(Arc::new(vec![0; *size])));
        let log = Log { entries: sizes.iter().map(entry).collect(), made: BTreeMap::new() };
        let (mut place, mut parts) = (0, Vec::new());
        while place < log.end() {
            let (part, next) = log.part(place);
            parts.push(part.len());
            place = next;
        }
        assert_eq!(parts, [2, 1, 1, 2]);
    }
}
