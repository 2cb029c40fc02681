//! The header before every chunk, and the checks on it.
//!
//! Eight machine words, since both ends are on one machine:
//!
//! | word | content |
//! | --- | --- |
//! | 0 | magic (high half), protocol version, kind |
//! | 1 | worker |
//! | 2 | sequence number of the message, counted by the worker from 1 |
//! | 3 | length of the whole message in bytes |
//! | 4 | offset of the chunk in the message in bytes |
//! | 5 | length of the chunk in bytes |
//! | 6–7 | XXH3 (128 bits) of words 0–5 and of the XXH3 of the chunk |
//!
//! The sum is against damage, such as a chunk that is written to while it is read. Who could mean harm could
//! as well start processes of this user; outcomes have digests besides.

use twox_hash::XxHash3_128;

use super::{CHUNK_BYTES, MESSAGE_BYTES_MAX, WorkerId};

const MAGIC: u64 = 0x726d_696c; // "rmil"
const PROTOCOL_VERSION: u64 = 2;
const FIELD_WORDS: usize = 6;
const HEADER_WORDS: usize = 8;

/// A header as it lies in shared memory.
pub(super) type Words = [u64; HEADER_WORDS];

/// What is wrong with a chunk, or with its place in the conversation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Not a chunk of this protocol at all.
    #[error("the chunk has no valid magic number")]
    Magic,
    /// The other end is of another release.
    #[error("the chunk has protocol version {0}")]
    Version(u16),
    /// A kind that does not exist.
    #[error("the chunk is of unknown kind {0}")]
    Kind(u16),
    /// Lengths and offset contradict each other or a limit.
    #[error("the chunk's lengths and offset do not fit together")]
    Bounds,
    /// The bytes are not the ones that were sent.
    #[error("the chunk's checksum is wrong")]
    Checksum,
    /// The chunk names another worker than the one that sent it.
    #[error("the chunk names the wrong worker")]
    Worker,
    /// The chunk is not the one that had to come next.
    #[error("the chunk is out of turn")]
    Turn,
    /// The message does not fit into memory.
    #[error("there is no memory for the message")]
    Memory,
    /// The answer to the chunk could not be put into shared memory.
    #[error("the answer could not be delivered")]
    Undeliverable,
}

/// What a chunk is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u16)]
pub(super) enum Kind {
    /// a piece of a message
    Data = 1,
    /// hub to worker: got the message up to `offset`, go on
    Ack = 2,
    /// worker to hub: got the answer up to `offset`, go on
    Continue = 3,
}

/// The fields of a header. Lengths and offsets are in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub kind: Kind,
    pub worker: WorkerId,
    pub sequence: u64,
    pub total_bytes: u64,
    pub offset: u64,
    pub chunk_bytes: u64,
}

impl Header {
    /// The header of the piece of `message` at `offset`, and that piece.
    pub fn data(worker: WorkerId, sequence: u64, message: &[u8], offset: usize) -> (Header, &[u8]) {
        let rest = message.get(offset..).unwrap_or_default();
        let chunk = &rest[..rest.len().min(CHUNK_BYTES)];
        let header = Header {
            kind: Kind::Data,
            worker,
            sequence,
            total_bytes: message.len() as u64,
            offset: offset as u64,
            chunk_bytes: chunk.len() as u64,
        };
        (header, chunk)
    }

    /// The header of an empty chunk that asks for the bytes from `offset` on.
    pub fn go_on(
        kind: Kind,
        worker: WorkerId,
        sequence: u64,
        total_bytes: u64,
        offset: u64,
    ) -> Header {
        Header { kind, worker, sequence, total_bytes, offset, chunk_bytes: 0 }
    }

    /// The words of this header before `chunk`.
    pub fn encode(&self, chunk: &[u8]) -> Words {
        let mut words = [0; HEADER_WORDS];
        words[0] = MAGIC << 32 | PROTOCOL_VERSION << 16 | self.kind as u64;
        words[1] = self.worker.0;
        words[2] = self.sequence;
        words[3] = self.total_bytes;
        words[4] = self.offset;
        words[5] = self.chunk_bytes;
        let sum = checksum(&words, chunk);
        words[FIELD_WORDS..].copy_from_slice(&sum);
        words
    }

    /// Reads the fields and checks that they fit together; the checksum is left to [`verify`].
    pub fn decode(words: &Words) -> Result<Header, Fault> {
        if words[0] >> 32 != MAGIC {
            return Err(Fault::Magic);
        }
        let version = (words[0] >> 16) as u16;
        if u64::from(version) != PROTOCOL_VERSION {
            return Err(Fault::Version(version));
        }
        let kind = match words[0] as u16 {
            1 => Kind::Data,
            2 => Kind::Ack,
            3 => Kind::Continue,
            other => return Err(Fault::Kind(other)),
        };
        let header = Header {
            kind,
            worker: WorkerId(words[1]),
            sequence: words[2],
            total_bytes: words[3],
            offset: words[4],
            chunk_bytes: words[5],
        };
        if header.is_bounded() { Ok(header) } else { Err(Fault::Bounds) }
    }

    /// Every chunk of a message but the last is full, and only an empty message has an empty one.
    fn is_bounded(&self) -> bool {
        let chunk_max = CHUNK_BYTES as u64;
        if self.total_bytes > MESSAGE_BYTES_MAX || self.offset > self.total_bytes {
            return false;
        }
        let rest = self.total_bytes - self.offset;
        match self.kind {
            Kind::Data => {
                self.chunk_bytes == rest.min(chunk_max)
                    && (rest > 0 || self.total_bytes == 0)
                    && self.offset.is_multiple_of(chunk_max)
            }
            Kind::Ack | Kind::Continue => self.chunk_bytes == 0 && rest > 0 && self.offset > 0,
        }
    }
}

/// Checks the bytes of a chunk, and the fields before them, against the checksum in `words`.
pub(super) fn verify(words: &Words, chunk: &[u8]) -> Result<(), Fault> {
    if words[FIELD_WORDS..] == checksum(words, chunk) { Ok(()) } else { Err(Fault::Checksum) }
}

fn checksum(words: &Words, chunk: &[u8]) -> [u64; HEADER_WORDS - FIELD_WORDS] {
    let mut bytes = [0; 8 * HEADER_WORDS];
    let (fields, of_chunk) = bytes.split_at_mut(8 * FIELD_WORDS);
    for (field, word) in fields.as_chunks_mut().0.iter_mut().zip(words) {
        *field = word.to_le_bytes();
    }
    of_chunk.copy_from_slice(&XxHash3_128::oneshot(chunk).to_le_bytes());
    let sum = XxHash3_128::oneshot(&bytes);
    [sum as u64, (sum >> 64) as u64]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn data(worker: u64, sequence: u64, message: &[u8], offset: usize) -> (Words, Vec<u8>) {
        let (header, chunk) = Header::data(WorkerId(worker), sequence, message, offset);
        (header.encode(chunk), chunk.to_vec())
    }

    proptest! {
        #[test]
        fn a_header_survives_the_trip(
            worker: u64, sequence: u64, chunks_before in 0usize..3, tail in 0usize..CHUNK_BYTES,
        ) {
            let message = vec![7; chunks_before * CHUNK_BYTES + tail + 1];
            let (header, chunk) =
                Header::data(WorkerId(worker), sequence, &message, chunks_before * CHUNK_BYTES);
            let words = header.encode(chunk);
            prop_assert_eq!(Header::decode(&words), Ok(header));
            prop_assert_eq!(verify(&words, chunk), Ok(()));
            let go_on = Header::go_on(Kind::Ack, WorkerId(worker), sequence, 9, 4);
            prop_assert_eq!(Header::decode(&go_on.encode(&[])), Ok(go_on));
        }

        #[test]
        fn random_words_are_refused(words: Words, chunk: Vec<u8>) {
            let refused = Header::decode(&words).is_err() || verify(&words, &chunk).is_err();
            prop_assert!(refused);
        }

        #[test]
        fn random_fields_never_panic(fields: [u64; 5], kind in 0u64..5) {
            let mut words = [0; HEADER_WORDS];
            words[0] = MAGIC << 32 | PROTOCOL_VERSION << 16 | kind;
            words[1..6].copy_from_slice(&fields);
            if let Ok(header) = Header::decode(&words) {
                prop_assert!(header.offset + header.chunk_bytes <= MESSAGE_BYTES_MAX);
            }
        }

        #[test]
        fn one_flipped_byte_is_noticed(
            worker: u64, message in proptest::collection::vec(any::<u8>(), 0..300),
            at: prop::sample::Index, flip in 1u8..,
        ) {
            let (mut words, mut chunk) = data(worker, 1, &message, 0);
            let header_bytes = 8 * HEADER_WORDS;
            let at = at.index(header_bytes + chunk.len());
            if at < header_bytes {
                words[at / 8] ^= u64::from(flip) << (8 * (at % 8));
            } else {
                chunk[at - header_bytes] ^= flip;
            }
            let noticed = Header::decode(&words).is_err() || verify(&words, &chunk).is_err();
            prop_assert!(noticed);
        }
    }

    #[test]
    fn only_an_empty_message_has_an_empty_chunk() {
        let (words, chunk) = data(1, 1, &[], 0);
        assert!(chunk.is_empty() && Header::decode(&words).is_ok());
        let past_the_end = data(1, 1, &[1, 2, 3], 3).0;
        assert_eq!(Header::decode(&past_the_end), Err(Fault::Bounds));
    }
}
