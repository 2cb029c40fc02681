//! Messages along a pair of byte streams: a connected socket, or the two pipes of a process whose standard
//! input and output lead to its coordinator.
//!
//! Each message is a frame: a header with its length and a checksum, then its bytes ([`Frames`] lists the
//! fields). The worker sends messages, and every second a frame that says only that it lives; the coordinator
//! sends replies. Nothing is shared besides, so the two ends may be on different machines. Whoever has read
//! something that is no frame can find no other frame behind it: the stream is of no more use.
//!
//! [`StreamLine`] is the worker's end.

mod frame;
mod line;

pub use frame::{Frame, FrameError, Frames, HEADER_BYTES, Kind, header};
pub use line::StreamLine;
