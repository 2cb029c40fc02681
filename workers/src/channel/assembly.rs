//! Putting a message together from its chunks.

use super::header::{Fault, Header, Words, verify};

/// A message of which a part has come. Both ends use it.
#[derive(Debug)]
pub(super) struct Assembly {
    sequence: u64,
    total_bytes: u64,
    bytes: Vec<u8>,
}

impl Assembly {
    /// An empty message, as announced by the header of its first chunk.
    pub fn new(first: &Header) -> Assembly {
        Assembly { sequence: first.sequence, total_bytes: first.total_bytes, bytes: Vec::new() }
    }

    /// Bytes that have come so far.
    pub fn len(&self) -> u64 {
        self.bytes.len() as u64
    }

    /// Whether all bytes have come.
    pub fn is_complete(&self) -> bool {
        self.len() == self.total_bytes
    }

    /// The message, as far as it has come.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// Appends the next chunk. Memory grows with the bytes that came, not with those announced.
    pub fn push(&mut self, header: &Header, words: &Words, chunk: &[u8]) -> Result<(), Fault> {
        let in_turn = header.sequence == self.sequence
            && header.total_bytes == self.total_bytes
            && header.offset == self.len();
        if !in_turn {
            return Err(Fault::Turn);
        }
        if chunk.len() as u64 != header.chunk_bytes {
            return Err(Fault::Bounds);
        }
        let before = self.bytes.len();
        self.bytes.try_reserve(chunk.len()).map_err(|_| Fault::Memory)?;
        self.bytes.extend_from_slice(chunk);
        // the other process could still write into the chunk: only the copy can be trusted
        verify(words, &self.bytes[before..]).inspect_err(|_| self.bytes.truncate(before))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{CHUNK_BYTES, WorkerId};
    use super::*;

    #[test]
    fn chunks_in_order_make_the_message() {
        for len in [0, 1, CHUNK_BYTES, CHUNK_BYTES + 1, 3 * CHUNK_BYTES] {
            let message: Vec<u8> = (0..len).map(|i| (i % 251) as u8).collect();
            let (first, _) = Header::data(WorkerId(3), 1, &message, 0);
            let mut assembly = Assembly::new(&first);
            loop {
                let (header, chunk) =
                    Header::data(WorkerId(3), 1, &message, assembly.len() as usize);
                let words = header.encode(chunk);
                assembly.push(&header, &words, chunk).expect("the chunk is right");
                if assembly.is_complete() {
                    break;
                }
            }
            assert_eq!(assembly.into_bytes(), message);
        }
    }

    #[test]
    fn a_huge_announcement_takes_no_memory() {
        let message = vec![0; CHUNK_BYTES];
        let (mut header, chunk) = Header::data(WorkerId(3), 1, &message, 0);
        header.total_bytes = super::super::MESSAGE_BYTES_MAX;
        let words = header.encode(chunk);
        let mut assembly = Assembly::new(&header);
        assembly.push(&header, &words, chunk).expect("the chunk is right");
        assert!(assembly.bytes.capacity() <= 2 * CHUNK_BYTES);
    }

    proptest! {
        #[test]
        fn a_chunk_out_of_turn_changes_nothing(sequence in 0u64..3, offset in 0usize..3) {
            let message = vec![5; 3 * CHUNK_BYTES];
            let (first, chunk) = Header::data(WorkerId(3), 1, &message, 0);
            let mut assembly = Assembly::new(&first);
            assembly.push(&first, &first.encode(chunk), chunk).expect("the chunk is right");
            let (header, chunk) =
                Header::data(WorkerId(3), sequence, &message, offset * CHUNK_BYTES);
            let result = assembly.push(&header, &header.encode(chunk), chunk);
            prop_assert_eq!(result.is_ok(), (sequence, offset) == (1, 1));
            prop_assert_eq!(assembly.len(), if result.is_ok() { 2 } else { 1 } * CHUNK_BYTES as u64);
        }
    }
}
