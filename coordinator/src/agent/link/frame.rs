use twox_hash::XxHash3_128;

/// How long the header of a frame is, in bytes.
pub const HEADER_BYTES: usize = 40;
/// The last byte of every frame. Some carriers, `srun` among them, hand on whole lines: they hold no frame back.
const LAST: u8 = b'\n';
/// The most bytes of a message in one frame, so that a sign of life never waits behind more than this.
pub const PIECE_BYTES: usize = (64 << 10) - HEADER_BYTES - 1;
/// The first bytes of every frame; the digit is the version.
const MAGIC: [u8; 4] = *b"rml1";
/// Where the checksum begins.
const CHECKED_BYTES: usize = 32;

/// Bytes that are no frame, or not the one that had to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// They do not begin as frames do.
    #[error("{0:02x?} where a frame should begin, with {MAGIC:02x?}")]
    Magic([u8; 4]),
    /// There are no frames of this kind.
    #[error("a frame of the unknown kind {0}")]
    Kind(u8),
    /// It says that it is longer than a frame can be.
    #[error("a frame of {0} bytes, at most {PIECE_BYTES} expected")]
    TooLong(u32),
    /// The bytes are not the ones that were sent.
    #[error("a frame whose checksum is wrong")]
    Checksum,
    /// A frame came twice, or one is missing.
    #[error("frame {found} where frame {expected} should be")]
    Number {
        /// Its number.
        found: u64,
        /// The number that has its turn.
        expected: u64,
    },
    /// A sign of life or a credit without the number that it should have.
    #[error("a frame of {found} bytes, {expected} expected")]
    Length {
        /// Its length.
        found: usize,
        /// What its kind has.
        expected: usize,
    },
}

/// What a frame is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// A part of a message, and not its last.
    Piece = 1,
    /// The last part of a message.
    Last = 2,
    /// A sign of life: the time at which it was sent, on the sender's clock, to be sent back.
    Beat = 3,
    /// The answer to a sign of life, with its time.
    Echo = 4,
    /// How many bytes of messages the receiver has taken in since the link was opened.
    Credit = 5,
    /// Nothing more will come.
    End = 6,
}

impl Kind {
    fn of(number: u8) -> Option<Kind> {
        [Kind::Piece, Kind::Last, Kind::Beat, Kind::Echo, Kind::Credit, Kind::End]
            .into_iter()
            .find(|kind| *kind as u8 == number)
    }
}

/// A frame, as it lies in the bytes that have come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// What it is for.
    pub kind: Kind,
    /// To which conversation it belongs.
    pub session: u64,
    /// Its number in that conversation, counted from 0 for each direction.
    pub number: u64,
    /// What follows the header.
    pub bytes: &'a [u8],
}

impl<'a> Frame<'a> {
    /// Puts the frame behind `output`.
    pub fn write(&self, output: &mut Vec<u8>) {
        let begin = output.len();
        output.extend(MAGIC);
        output.extend([self.kind as u8, 0, 0, 0]);
        output.extend(self.session.to_le_bytes());
        output.extend(self.number.to_le_bytes());
        output.extend((self.bytes.len() as u64).to_le_bytes());
        let sum = checksum(&output[begin..], self.bytes);
        output.extend(sum.to_le_bytes());
        output.extend(self.bytes);
        output.push(LAST);
    }

    /// The frame at the beginning of `input` and how many bytes it takes, if all of it has come.
    ///
    /// # Errors
    /// When what has come is no frame, as soon as its header shows it.
    pub fn read(input: &'a [u8]) -> Result<Option<(Frame<'a>, usize)>, FrameError> {
        let Some((header, rest)) = input.split_first_chunk::<HEADER_BYTES>() else {
            return Ok(None);
        };
        let (fields, sum) = header.split_at(CHECKED_BYTES);
        let magic = field(header, 0);
        if magic != MAGIC {
            return Err(FrameError::Magic(magic));
        }
        let [kind, zeros @ ..] = field::<4>(header, 4);
        let kind = Kind::of(kind).filter(|_| zeros == [0; 3]).ok_or(FrameError::Kind(kind))?;
        let length = u32::from_le_bytes(field(header, 24));
        if length as usize > PIECE_BYTES || field(header, 28) != [0; 4] {
            return Err(FrameError::TooLong(length));
        }
        let Some([bytes @ .., end]) = rest.get(..=length as usize) else { return Ok(None) };
        if checksum(fields, bytes).to_le_bytes() != *sum || *end != LAST {
            return Err(FrameError::Checksum);
        }
        let session = u64::from_le_bytes(field(header, 8));
        let number = u64::from_le_bytes(field(header, 16));
        Ok(Some((Frame { kind, session, number, bytes }, HEADER_BYTES + bytes.len() + 1)))
    }

    /// The number that a sign of life, its answer and a credit carry.
    ///
    /// # Errors
    /// When it is not there.
    pub fn value(&self) -> Result<u64, FrameError> {
        let wrong = FrameError::Length { found: self.bytes.len(), expected: 8 };
        Ok(u64::from_le_bytes(self.bytes.try_into().map_err(|_| wrong)?))
    }
}

/// The bytes of a header from `at` on.
fn field<const BYTES: usize>(header: &[u8; HEADER_BYTES], at: usize) -> [u8; BYTES] {
    std::array::from_fn(|index| header[at + index])
}

/// Covers the fields and the bytes. It is against damage, not against harm: outcomes have digests besides.
fn checksum(fields: &[u8], bytes: &[u8]) -> u64 {
    XxHash3_128::oneshot_with_seed(XxHash3_128::oneshot(fields) as u64, bytes) as u64
}
