use roadmill::img::Round;
use roadmill::roadmap::Increment;
use roadmill::wire;
use roadmill_workers::message::Entry;

/// The most bytes of entries in one message; a worker that is far behind gets several.
const PART_BYTES_MAX: usize = 32 << 20;

/// Everything that has changed the replicas so far, ready to be sent: each worker has its place in
/// it, and a new one starts at the beginning.
#[derive(Debug, Default)]
pub struct Log {
    entries: Vec<Vec<u8>>,
}

impl Log {
    /// Appends an increment.
    pub fn publish(&mut self, increment: &Increment) {
        self.entries.push(wire::encode(&Entry::Increment(increment.clone())));
    }

    /// Appends the end of a round.
    pub fn fold(&mut self, round: &Round) {
        let joins = round.sets.iter().map(|set| set.joined.edges.clone()).collect();
        self.entries.push(wire::encode(&Entry::Fold(joins)));
    }

    /// The entries from `place` on that fit into one message, at least one if there is one, and
    /// the place behind them.
    pub fn part(&self, place: usize) -> (Vec<Vec<u8>>, usize) {
        let mut bytes = 0;
        let fits = |entry: &&Vec<u8>| {
            bytes += entry.len();
            bytes <= PART_BYTES_MAX || bytes == entry.len()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_whole_entries_and_together_the_log() {
        let sizes = [1, PART_BYTES_MAX - 1, 1, PART_BYTES_MAX + 5, 7, 9];
        let log = Log { entries: sizes.iter().map(|size| vec![0; *size]).collect() };
        let (mut place, mut parts) = (0, Vec::new());
        while place < log.end() {
            let (part, next) = log.part(place);
            parts.push(part.len());
            place = next;
        }
        assert_eq!(parts, [2, 1, 1, 2]);
    }
}
