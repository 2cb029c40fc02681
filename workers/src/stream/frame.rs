use crate::message::MESSAGE_BYTES_MAX;
use std::io::{self, Read};
use twox_hash::XxHash3_128;

/// How long the header of a frame is, in bytes.
pub const HEADER_BYTES: usize = 32;
/// The first bytes of every frame; the digit is the version.
const MAGIC: [u8; 4] = *b"rmf1";
/// Where the checksum begins.
const CHECKED_BYTES: usize = 16;
/// So much is read from a stream at once.
const READ_BYTES: usize = 64 << 10;

/// Bytes that are no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// They do not begin as frames do.
    #[error("{0:02x?} where a frame should begin, with {MAGIC:02x?}")]
    Magic([u8; 4]),
    /// There are no frames of this kind.
    #[error("a frame of the unknown kind {0}")]
    Kind(u32),
    /// It says that it is longer than a message can be.
    #[error("a frame of {0} bytes, at most {MESSAGE_BYTES_MAX} expected")]
    TooLong(u64),
    /// The bytes are not the ones that were sent.
    #[error("a frame whose checksum is wrong")]
    Checksum,
}

/// What a frame is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It is a message.
    Message = 1,
    /// It shows that the worker lives, and has no bytes of its own.
    Beat = 2,
}

/// A frame that has come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Frame {
    /// The bytes of a message.
    Message(Vec<u8>),
    /// The worker lives.
    Beat,
}

/// The header of the frame with these bytes, to be sent before them.
pub fn header(kind: Kind, bytes: &[u8]) -> [u8; HEADER_BYTES] {
    let mut header = [0; HEADER_BYTES];
    header[..4].copy_from_slice(&MAGIC);
    header[4..8].copy_from_slice(&(kind as u32).to_le_bytes());
    header[8..CHECKED_BYTES].copy_from_slice(&(bytes.len() as u64).to_le_bytes());
    let sum = checksum(&header[..CHECKED_BYTES], bytes);
    header[CHECKED_BYTES..].copy_from_slice(&sum);
    header
}

/// The bytes of a header from `at` on.
fn field<const BYTES: usize>(header: &[u8; HEADER_BYTES], at: usize) -> [u8; BYTES] {
    std::array::from_fn(|index| header[at + index])
}

/// Covers the fields and, by their own sum, the bytes.
fn checksum(fields: &[u8], bytes: &[u8]) -> [u8; 16] {
    let inner = XxHash3_128::oneshot(bytes).to_le_bytes();
    XxHash3_128::oneshot(&[fields, &inner].concat()).to_le_bytes()
}

/// Puts frames together from the pieces in which a stream gives them.
///
/// | bytes | content, all numbers little-endian |
/// | --- | --- |
/// | 0–3 | `rmf1` |
/// | 4–7 | kind: 1 message, 2 sign of life |
/// | 8–15 | length of the bytes that follow the header |
/// | 16–31 | XXH3 (128 bits) of bytes 0–15 and of the XXH3 of the bytes that follow |
///
/// Memory is taken for bytes that have come, never for a length that is only claimed. The sum is against
/// damage, not against harm: outcomes have digests besides.
#[derive(Debug, Default)]
pub struct Frames {
    bytes: Vec<u8>,
}

impl Frames {
    /// Reads once from a stream; how many bytes came, 0 at its end.
    ///
    /// # Errors
    /// Those of the stream.
    pub fn read_from(&mut self, stream: &mut impl Read) -> io::Result<usize> {
        let before = self.bytes.len();
        self.bytes.resize(before + READ_BYTES, 0);
        let read = stream.read(&mut self.bytes[before..]);
        self.bytes.truncate(before + read.as_ref().map_or(0, |read| *read));
        read
    }

    /// The next frame, if all of it has come.
    ///
    /// # Errors
    /// When what has come is no frame, as soon as its header shows it. The stream is then of no more use.
    pub fn take(&mut self) -> Result<Option<Frame>, FrameError> {
        let Some((header, rest)) = self.bytes.split_first_chunk::<HEADER_BYTES>() else {
            return Ok(None);
        };
        let (fields, sum) = header.split_at(CHECKED_BYTES);
        let magic = field(header, 0);
        if magic != MAGIC {
            return Err(FrameError::Magic(magic));
        }
        let kind = match u32::from_le_bytes(field(header, 4)) {
            1 => Kind::Message,
            2 => Kind::Beat,
            other => return Err(FrameError::Kind(other)),
        };
        let length = u64::from_le_bytes(field(header, 8));
        if length > MESSAGE_BYTES_MAX {
            return Err(FrameError::TooLong(length));
        }
        let Some(bytes) = rest.get(..length as usize) else { return Ok(None) };
        if checksum(fields, bytes) != sum {
            return Err(FrameError::Checksum);
        }
        let frame = match kind {
            Kind::Message => Frame::Message(bytes.to_vec()),
            Kind::Beat => Frame::Beat,
        };
        self.bytes.drain(..HEADER_BYTES + length as usize);
        Ok(Some(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn frame(kind: Kind, bytes: &[u8]) -> Vec<u8> {
        [&header(kind, bytes), bytes].concat()
    }

    /// Gives its bytes in pieces of these lengths.
    struct Pieces<'a>(&'a [u8], Vec<usize>);

    impl Read for Pieces<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let most = self.1.pop().unwrap_or(usize::MAX).max(1);
            let length = most.min(self.0.len());
            self.0.read(&mut buffer[..length.min(READ_BYTES)])
        }
    }

    proptest! {
        #[test]
        fn frames_come_as_they_were_sent_however_they_are_cut(
            messages in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..300), 0..6),
            pieces in proptest::collection::vec(1usize..100, 0..60),
        ) {
            let mut sent = Vec::new();
            for message in &messages {
                sent.extend(frame(Kind::Message, message));
                sent.extend(frame(Kind::Beat, &[]));
            }
            let mut stream = Pieces(&sent, pieces);
            let (mut frames, mut found) = (Frames::default(), Vec::new());
            while frames.read_from(&mut stream).expect("it can be read") > 0 {
                while let Some(frame) = frames.take().expect("it is a frame") {
                    found.push(frame);
                }
            }
            let expected = messages.into_iter().flat_map(|message| [Frame::Message(message), Frame::Beat]);
            prop_assert!(found.into_iter().eq(expected));
        }

        #[test]
        fn one_flipped_byte_is_noticed(
            message in proptest::collection::vec(any::<u8>(), 0..200),
            at: prop::sample::Index, flip in 1u8..,
        ) {
            let mut sent = frame(Kind::Message, &message);
            let at = at.index(sent.len());
            sent[at] ^= flip;
            // A frame that has become longer is noticed when as many bytes have come.
            sent.resize(sent.len() + 70_000, 0);
            let mut frames = Frames { bytes: sent };
            if let Ok(found) = frames.take() {
                prop_assert!(found.is_none() && (8..16).contains(&at));
            }
        }
    }

    #[test]
    fn what_is_no_frame_is_told_by_its_header() {
        let error = |bytes: &[u8]| Frames { bytes: bytes.to_vec() }.take();
        let good = frame(Kind::Message, b"message");
        assert_eq!(error(&good[..HEADER_BYTES - 1]), Ok(None));
        assert_eq!(error(&good[..good.len() - 1]), Ok(None));
        assert_eq!(error(&[b'x'; 40]), Err(FrameError::Magic([b'x'; 4])));
        let with = |at: usize, value: u8| {
            let mut bytes = good.clone();
            bytes[at] = value;
            error(&bytes[..HEADER_BYTES])
        };
        assert_eq!(with(4, 9), Err(FrameError::Kind(9)));
        assert_eq!(with(15, 1), Err(FrameError::TooLong(7 | 1 << 56)));
        let most = (MESSAGE_BYTES_MAX + 1).to_le_bytes();
        let long = [&good[..8], &most, &good[16..]].concat();
        assert_eq!(error(&long), Err(FrameError::TooLong(MESSAGE_BYTES_MAX + 1)));
    }
}
