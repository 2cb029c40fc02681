use super::bell::Bell;
use super::state::Link;
use roadmill_workers::HEARTBEAT;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read, write};
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// So much is read at once.
const READ_BYTES: usize = 64 << 10;
/// So much is written at once: a file that is ready takes this much without blocking, whatever it is (`PIPE_BUF`).
/// Files here may be shared with other processes, which would not expect them not to block.
const WRITE_BYTES: usize = 4 << 10;

/// When fewer bytes of messages than this wait to be written, it is time for more.
const QUEUED_FEW: u64 = 512 << 10;

/// For how long an end puts up with silence.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    /// Of an end that has not opened the link: a login may take a while, and a queue longer.
    pub opening: Option<Duration>,
    /// Of one that has.
    pub silence: Duration,
}

/// How a link came to its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ending {
    /// The other end has said that nothing more will come.
    Closed,
    /// The stream ended or broke, what came was no link's, or nothing came for too long; why, for people.
    Cut(String),
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Ending::Closed => f.write_str("it has closed the link"),
            Ending::Cut(why) => f.write_str(why),
        }
    }
}

/// What has gone over a link.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Bytes that came.
    pub came: u64,
    /// Bytes that were sent.
    pub sent: u64,
    /// Frames of earlier conversations that were dropped.
    pub stale: u64,
}

/// Moves the bytes of a [`Link`] from and to two files, in a thread of its own: signs of life are sent and answered
/// whatever else this process does, and what comes is always read.
pub struct Pump {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    state: Mutex<State>,
    /// Wakes the pump's thread.
    wake: Bell,
    /// Rung when a message has come, or the link has ended.
    bell: Arc<Bell>,
    begun: Instant,
    patience: Patience,
}

struct State {
    link: Link,
    /// When anything came last.
    heard: Instant,
    /// How the link ended, once nothing more will come.
    ended: Option<Ending>,
    /// Once all is written, no more is to be.
    is_closing: bool,
    /// The thread is to end at once.
    is_dropped: bool,
}

impl Pump {
    /// Starts to move the bytes of `link` between `reader` and `writer`. `bell` is rung when there is something to be
    /// looked at.
    ///
    /// # Errors
    /// When no thread can be started.
    pub fn start(
        link: Link,
        reader: OwnedFd,
        writer: OwnedFd,
        bell: Arc<Bell>,
        patience: Patience,
    ) -> io::Result<Pump> {
        let now = Instant::now();
        let state = State { link, heard: now, ended: None, is_closing: false, is_dropped: false };
        let shared = Arc::new(Shared {
            state: Mutex::new(state),
            wake: Bell::new()?,
            bell,
            begun: now,
            patience,
        });
        let of_thread = shared.clone();
        let thread = Builder::new().name("link".to_owned());
        let thread = thread.spawn(move || of_thread.run(&reader, writer))?;
        Ok(Pump { shared, thread: Some(thread) })
    }

    /// The next message, or `None` where none has come.
    pub fn next(&self) -> Option<Vec<u8>> {
        let message = self.shared.lock().link.next()?;
        // There may be credit to be told.
        self.shared.wake.ring();
        Some(message)
    }

    /// Queues a message.
    pub fn send(&self, message: Arc<Vec<u8>>) {
        self.shared.lock().link.send(message);
        self.shared.wake.ring();
    }

    /// Says that nothing more will come, once all messages are written, and closes the writer.
    pub fn close(&self) {
        let mut state = self.shared.lock();
        if !std::mem::replace(&mut state.is_closing, true) {
            state.link.end();
        }
        drop(state);
        self.shared.wake.ring();
    }

    /// Bytes of messages that are still to be written.
    pub fn queued(&self) -> u64 {
        self.shared.lock().link.queued()
    }

    /// How the link ended, once nothing more will come and all that came was taken.
    pub fn ended(&self) -> Option<Ending> {
        let state = self.shared.lock();
        state.ended.clone().filter(|_| !state.link.has_message())
    }

    /// Whether the other end has opened the link.
    pub fn is_open(&self) -> bool {
        self.shared.lock().link.is_open()
    }

    /// How long a sign of life takes to the other end and back.
    pub fn round_trip(&self) -> Option<Duration> {
        self.shared.lock().link.round_trip().map(Duration::from_micros)
    }

    /// What has gone over the link.
    pub fn traffic(&self) -> Traffic {
        let state = self.shared.lock();
        let (came, sent) = state.link.bytes();
        Traffic { came, sent, stale: state.link.stale() }
    }

    /// Waits until the link has ended, but no longer than this.
    pub fn wait_for_end(&self, longest: Duration) {
        let until = Instant::now() + longest;
        while self.shared.lock().ended.is_none() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

impl Drop for Pump {
    fn drop(&mut self) {
        self.shared.lock().is_dropped = true;
        self.shared.wake.ring();
        // A thread that has panicked has ended, too.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // Where one thread has panicked the link ends by itself.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now(&self) -> u64 {
        self.begun.elapsed().as_micros() as u64
    }

    /// The thread: moves bytes until the link ends.
    fn run(&self, reader: &OwnedFd, writer: OwnedFd) {
        let mut writer = Some(writer);
        let why = self.move_bytes(reader, &mut writer);
        // The other end sees the end of the stream.
        drop(writer);
        self.lock().ended = Some(why);
        self.bell.ring();
    }

    /// How the link has ended.
    fn move_bytes(&self, reader: &OwnedFd, writer: &mut Option<OwnedFd>) -> Ending {
        let mut next_beat = Instant::now() + HEARTBEAT;
        let mut buffer = vec![0; READ_BYTES];
        loop {
            let mut state = self.lock();
            if state.is_dropped {
                return Ending::Cut("this end was dropped".to_owned());
            }
            if let Some(why) = self.silence(&state) {
                return Ending::Cut(why);
            }
            if Instant::now() >= next_beat {
                next_beat = Instant::now() + HEARTBEAT;
                state.link.beat(self.now());
            }
            let is_done = state.is_closing && state.link.output().is_empty();
            let has_output = !state.link.output().is_empty();
            drop(state);
            if is_done {
                *writer = None;
            }
            let mut fds =
                vec![PollFd::new(&self.wake, PollFlags::IN), PollFd::new(reader, PollFlags::IN)];
            if let Some(writer) = writer.as_ref().filter(|_| has_output) {
                fds.push(PollFd::new(writer, PollFlags::OUT));
            }
            let wait = next_beat.saturating_duration_since(Instant::now());
            let wait =
                Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
            // An interrupted sleep is a short one.
            let _ = poll(&mut fds, Some(&wait));
            let woken: Vec<bool> = fds.iter().map(|fd| !fd.revents().is_empty()).collect();
            if woken[0] {
                self.wake.answer();
            }
            if woken[1]
                && let Some(ending) = self.read(reader, &mut buffer)
            {
                return ending;
            }
            if let Some(writer) = writer.as_ref().filter(|_| woken.get(2) == Some(&true))
                && let Some(why) = self.write(writer)
            {
                return Ending::Cut(why);
            }
        }
    }

    /// Whether the other end has been silent for too long.
    fn silence(&self, state: &State) -> Option<String> {
        let silent = state.heard.elapsed();
        let longest =
            if state.link.is_open() { self.patience.silence } else { self.patience.opening? };
        (silent > longest).then(|| {
            let words = state.link.last_words();
            let words = if words.is_empty() { words } else { format!(" after “{words}”") };
            format!("it was silent for {} s{words}", longest.as_secs())
        })
    }

    /// Reads once; how the link has ended, if it has.
    fn read(&self, reader: &OwnedFd, buffer: &mut [u8]) -> Option<Ending> {
        let length = match read(reader, &mut *buffer) {
            Ok(0) => {
                let state = self.lock();
                let words = state.link.last_words();
                let after = if words.is_empty() { words } else { format!(", after “{words}”") };
                return Some(match (state.link.has_ended(), state.link.is_open()) {
                    (true, _) => Ending::Closed,
                    (false, true) => Ending::Cut("its stream ended".to_owned()),
                    (false, false) => {
                        Ending::Cut(format!("its stream ended before it opened the link{after}"))
                    }
                });
            }
            Ok(length) => length,
            Err(Errno::INTR | Errno::AGAIN) => return None,
            Err(errno) => {
                return Some(Ending::Cut(format!("its stream broke: {}", io::Error::from(errno))));
            }
        };
        let now = self.now();
        let mut state = self.lock();
        state.heard = Instant::now();
        if let Err(error) = state.link.take_in(&buffer[..length], now) {
            return Some(Ending::Cut(error.to_string()));
        }
        if state.link.has_message() {
            self.bell.ring();
        }
        None
    }

    /// Writes once; why the link has ended, if it has.
    fn write(&self, writer: &OwnedFd) -> Option<String> {
        let mut state = self.lock();
        let output = state.link.output();
        let output = output[..output.len().min(WRITE_BYTES)].to_vec();
        drop(state);
        match write(writer.as_fd(), &output) {
            Ok(length) => {
                let mut state = self.lock();
                let before = state.link.queued();
                state.link.written(length);
                // Whoever waits until there is room for more is to be woken.
                if before >= QUEUED_FEW && state.link.queued() < QUEUED_FEW {
                    self.bell.ring();
                }
                None
            }
            Err(Errno::INTR | Errno::AGAIN) => None,
            // What the other end had still sent is read first: its stream ends, too.
            Err(Errno::PIPE | Errno::CONNRESET) => {
                std::thread::sleep(Duration::from_millis(1));
                self.lock().link.written(output.len());
                None
            }
            Err(errno) => Some(format!("it cannot be written to: {}", io::Error::from(errno))),
        }
    }
}
