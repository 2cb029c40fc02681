//! A link: messages both ways between a coordinator and an agent, along a pair of byte streams that something else
//! carries: `ssh`, `srun`, a pipe, a relay of Dask.
//!
//! What comes before a link is opened, a greeting of the machine that is logged in to, say, is skipped up to the
//! [opening](OPENING). Then come frames, all numbers little-endian:
//!
//! | bytes | content |
//! | --- | --- |
//! | 0–3 | `rml1` |
//! | 4–7 | kind: 1 a part of a message, 2 its last, 3 sign of life, 4 its answer, 5 credit, 6 end |
//! | 8–15 | session: the conversation that the frame belongs to; others are dropped |
//! | 16–23 | number of the frame in its direction, from 0 |
//! | 24–31 | length of the bytes that follow the header, below 64 KiB |
//! | 32–39 | XXH3 of bytes 0–31 and of the bytes that follow |
//! | last | 0x0a: carriers that hand on whole lines, as `srun` does, hold no frame back |
//!
//! - **Nobody waits for the other end to read.** Each end reads whatever comes, at any time, so that two ends
//!   that both have much to say never stand with full pipes in front of one another. What is read and not yet
//!   taken in is bounded by **credit**: a sender is at most [`WINDOW_BYTES`] of messages ahead of what the receiver
//!   has taken in.
//! - **A sign of life never waits** behind more than one frame, however long a message is.
//! - **A frame is never taken for another**: one that comes twice, or out of its order, ends the link; one of an
//!   earlier conversation, which a relay had kept, is dropped.
//!
//! [`Link`] is all of this without input, output or a clock; [`Pump`] moves its bytes from and to files.

mod bell;
mod frame;
mod pump;
mod state;

pub use bell::Bell;
pub use frame::{Frame, FrameError, HEADER_BYTES, Kind, PIECE_BYTES};
pub use pump::{Ending, Patience, Pump, Traffic};
pub use state::{Link, LinkError, OPENING, PREAMBLE_BYTES_MAX, WINDOW_BYTES};

#[cfg(test)]
mod tests;
