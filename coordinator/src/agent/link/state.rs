use super::frame::{Frame, FrameError, HEADER_BYTES, Kind, PIECE_BYTES};
use roadmill_workers::message::MESSAGE_BYTES_MAX;
use std::collections::VecDeque;
use std::sync::Arc;

/// The bytes with which each end opens a link. No greeting of a machine contains them.
pub const OPENING: &[u8] = b"\x00\xff\x00roadmill link 1\x00\xff\x00\n";
/// So many bytes may come before the opening.
pub const PREAMBLE_BYTES_MAX: usize = 1 << 20;
/// So far a sender may be ahead of what the receiver has taken in, in bytes of frames with parts of messages.
pub const WINDOW_BYTES: u64 = 4 << 20;

/// So many of the last answers to signs of life are remembered.
const ROUND_TRIPS: usize = 16;

/// Why a link is of no more use.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// What came is no frame, or not the one that had to come.
    #[error("it sent {0}")]
    Frame(#[from] FrameError),
    /// The link was not opened within so many bytes.
    #[error("it sent {PREAMBLE_BYTES_MAX} bytes and did not open the link{}", heard(.0))]
    NotOpened(String),
    /// More bytes of messages than there was credit for.
    #[error("it sent more than it had credit for")]
    Credit,
    /// It says that more was taken in than was sent.
    #[error("it took in {0} bytes of the {1} that it was sent")]
    Taken(u64, u64),
    /// A message is longer than messages can be.
    #[error("it sent a message of more than {MESSAGE_BYTES_MAX} bytes")]
    TooLong,
}

/// What a part of a message takes of the credit: its frame counts, too, so that messages of nothing do not come without end.
fn cost(piece: &[u8]) -> u64 {
    (HEADER_BYTES + 1 + piece.len()) as u64
}

/// The last of what was heard instead of an opening, for people.
fn heard(preamble: &str) -> String {
    if preamble.is_empty() { String::new() } else { format!("; its last words: {preamble}") }
}

/// One end of a link, as a state machine: bytes in, messages out, and the other way round. Times are microseconds on any
/// clock of this end that never goes back.
#[derive(Debug, Default)]
pub struct Link {
    /// `None` at the far end until the first frame says it.
    session: Option<u64>,
    is_open: bool,
    /// Bytes that came and are not yet part of anything.
    input: Vec<u8>,
    /// Bytes before the opening that were dropped.
    preamble: usize,
    /// The number of the frame that comes next.
    next_in: u64,
    next_out: u64,
    /// The message that is coming.
    assembling: Vec<u8>,
    /// Messages that nobody has taken yet.
    messages: VecDeque<Vec<u8>>,
    /// Bytes of messages that have come, and of these those that count as taken in.
    came: u64,
    taken: u64,
    /// What the other end was told of it.
    told: u64,

    /// Messages to be sent, and how much of the first is on its way.
    outbox: VecDeque<Arc<Vec<u8>>>,
    begun: usize,
    queued: u64,
    /// Bytes of messages that were sent, and of these those that the other end has taken in.
    sent: u64,
    acknowledged: u64,
    /// Short frames that go before the next part of a message.
    short: VecDeque<(Kind, Option<u64>)>,
    /// The frame on its way, and how much of it was written.
    output: Vec<u8>,
    written: usize,

    has_ended: bool,
    /// How long the last answers to signs of life took.
    round_trips: VecDeque<u64>,
    bytes_in: u64,
    bytes_out: u64,
    stale: u64,
}

impl Link {
    /// The coordinator's end, which chooses the number of the conversation.
    pub fn near(session: u64) -> Link {
        Link { session: Some(session), output: OPENING.to_vec(), ..Link::default() }
    }

    /// The agent's end.
    pub fn far() -> Link {
        Link { output: OPENING.to_vec(), ..Link::default() }
    }

    /// Takes in bytes that came from the other end, at the time `now`.
    ///
    /// # Errors
    /// When they are no link's. It is then of no more use.
    pub fn take_in(&mut self, bytes: &[u8], now: u64) -> Result<(), LinkError> {
        self.bytes_in += bytes.len() as u64;
        self.input.extend(bytes);
        if !self.is_open && !self.open()? {
            return Ok(());
        }
        let input = std::mem::take(&mut self.input);
        let mut at = 0;
        while let Some((frame, length)) = Frame::read(&input[at..])? {
            at += length;
            if *self.session.get_or_insert(frame.session) != frame.session {
                self.stale += 1;
                continue;
            }
            if frame.number != self.next_in {
                let (found, expected) = (frame.number, self.next_in);
                return Err(FrameError::Number { found, expected }.into());
            }
            self.next_in += 1;
            self.take_frame(&frame, now)?;
        }
        self.input = input;
        self.input.drain(..at);
        Ok(())
    }

    /// Looks for the opening; whether it was found.
    fn open(&mut self) -> Result<bool, LinkError> {
        let found = self.input.windows(OPENING.len()).position(|bytes| bytes == OPENING);
        if let Some(at) = found {
            self.input.drain(..at + OPENING.len());
            self.is_open = true;
            return Ok(true);
        }
        if self.preamble + self.input.len() > PREAMBLE_BYTES_MAX {
            return Err(LinkError::NotOpened(self.last_words()));
        }
        // What may be the beginning of an opening stays, and enough for people to see what was said instead.
        let surplus = self.input.len().saturating_sub(1 << 10);
        self.input.drain(..surplus);
        self.preamble += surplus;
        Ok(false)
    }

    /// The last line of what has come instead of an opening.
    pub fn last_words(&self) -> String {
        if self.is_open {
            return String::new();
        }
        let text = String::from_utf8_lossy(&self.input);
        let line = text.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or_default();
        line.chars().take(200).filter(|char| !char.is_control()).collect()
    }

    fn take_frame(&mut self, frame: &Frame<'_>, now: u64) -> Result<(), LinkError> {
        match frame.kind {
            Kind::Piece | Kind::Last => {
                self.came += cost(frame.bytes);
                if self.came - self.taken > WINDOW_BYTES {
                    return Err(LinkError::Credit);
                }
                if (self.assembling.len() + frame.bytes.len()) as u64 > MESSAGE_BYTES_MAX {
                    return Err(LinkError::TooLong);
                }
                self.assembling.extend(frame.bytes);
                if frame.kind == Kind::Last {
                    self.messages.push_back(std::mem::take(&mut self.assembling));
                }
                self.give_credit();
            }
            Kind::Beat => {
                // Only the last one needs an answer: whoever sends many does not make this end remember them.
                self.short.retain(|(kind, _)| *kind != Kind::Echo);
                self.short.push_back((Kind::Echo, Some(frame.value()?)));
            }
            Kind::Echo => {
                self.round_trips.push_back(now.saturating_sub(frame.value()?));
                if self.round_trips.len() > ROUND_TRIPS {
                    self.round_trips.pop_front();
                }
            }
            Kind::Credit => {
                let taken = frame.value()?;
                if taken > self.sent {
                    return Err(LinkError::Taken(taken, self.sent));
                }
                self.acknowledged = self.acknowledged.max(taken);
            }
            Kind::End => self.has_ended = true,
        }
        Ok(())
    }

    /// What nobody waits to take counts as taken in at once, or no message longer than the window could come. So the most
    /// that lies here is one message that is coming, or the window.
    fn give_credit(&mut self) {
        if self.messages.is_empty() {
            self.taken = self.came;
        }
        // Told in larger steps: each is a frame.
        let due = self.taken - self.told >= WINDOW_BYTES / 4;
        if due && !self.short.iter().any(|(kind, _)| *kind == Kind::Credit) {
            self.short.push_back((Kind::Credit, None));
        }
    }

    /// The next message, if one has come.
    pub fn receive(&mut self) -> Option<Vec<u8>> {
        let message = self.messages.pop_front()?;
        self.give_credit();
        Some(message)
    }

    /// Whether a message has come that nobody has taken.
    pub fn has_message(&self) -> bool {
        !self.messages.is_empty()
    }

    /// Queues a message.
    pub fn send(&mut self, message: Arc<Vec<u8>>) {
        self.queued += message.len() as u64;
        self.outbox.push_back(message);
    }

    /// Queues a sign of life.
    ///
    /// Not before the other end has opened the link: it would wait in the stream until then and be answered much later.
    pub fn beat(&mut self, now: u64) {
        if self.is_open && !self.short.iter().any(|(kind, _)| *kind == Kind::Beat) {
            self.short.push_back((Kind::Beat, Some(now)));
        }
    }

    /// Queues the end of the link, behind all messages.
    pub fn end(&mut self) {
        self.short.push_back((Kind::End, None));
    }

    /// The bytes that are to be written next; none where there is nothing to say or no credit to say it.
    pub fn output(&mut self) -> &[u8] {
        if self.written == self.output.len() {
            self.output.clear();
            self.written = 0;
            self.fill();
        }
        &self.output[self.written..]
    }

    /// Takes note that so many bytes of [`Link::output`] were written.
    pub fn written(&mut self, bytes: usize) {
        self.written = (self.written + bytes).min(self.output.len());
        self.bytes_out += bytes as u64;
    }

    /// Makes the next frame, if there is one that may be sent.
    fn fill(&mut self) {
        // Without the number of the conversation there is nobody to talk to.
        let Some(session) = self.session else { return };
        let number = self.next_out;
        // The last word comes behind all messages.
        let may_go = |(kind, _): &(Kind, _)| *kind != Kind::End || self.outbox.is_empty();
        let short = self.short.iter().position(may_go);
        if let Some((kind, value)) = short.and_then(|at| self.short.remove(at)) {
            let value = match kind {
                Kind::Credit => {
                    self.told = self.taken;
                    Some(self.taken)
                }
                _ => value,
            };
            let bytes = value.map(u64::to_le_bytes);
            let bytes = bytes.as_ref().map_or(&[][..], |bytes| bytes);
            Frame { kind, session, number, bytes }.write(&mut self.output);
            self.next_out += 1;
            return;
        }
        let Some(message) = self.outbox.front() else { return };
        let credit = self.acknowledged + WINDOW_BYTES - self.sent;
        let rest = &message[self.begun..];
        let piece = &rest[..rest.len().min(PIECE_BYTES)];
        if cost(piece) > credit {
            return;
        }
        let kind = if piece.len() == rest.len() { Kind::Last } else { Kind::Piece };
        Frame { kind, session, number, bytes: piece }.write(&mut self.output);
        self.next_out += 1;
        self.sent += cost(piece);
        self.queued -= piece.len() as u64;
        self.begun += piece.len();
        if kind == Kind::Last {
            self.outbox.pop_front();
            self.begun = 0;
        }
    }

    /// Bytes of messages that are still to be written.
    pub fn queued(&self) -> u64 {
        self.queued + (self.output.len() - self.written).saturating_sub(HEADER_BYTES + 1) as u64
    }

    /// Whether the other end has opened the link.
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Whether the other end has said that nothing more will come.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// How long an answer to a sign of life takes, in microseconds: the longest of the last ones. Some carriers are quick
    /// with short frames and slow with long ones, which a sign of life shows only when it travels behind one.
    pub fn round_trip(&self) -> Option<u64> {
        self.round_trips.iter().copied().max()
    }

    /// Bytes that came and that were written, frames and all.
    pub fn bytes(&self) -> (u64, u64) {
        (self.bytes_in, self.bytes_out)
    }

    /// Frames of other conversations that were dropped.
    pub fn stale(&self) -> u64 {
        self.stale
    }
}
