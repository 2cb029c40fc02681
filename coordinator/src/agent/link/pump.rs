use super::bell::Bell;
use super::state::Link;
use roadmill_workers::HEARTBEAT;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FileType, Mode, OFlags, fstat, open};
use rustix::io::{Errno, read, write};
use std::io;
use std::os::fd::{AsRawFd, OwnedFd};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// So much is read at once.
const READ_BYTES: usize = 64 << 10;
/// So much is written at once: a file that is ready takes this much without blocking, whatever it is (`PIPE_BUF`).
/// Files here may be shared with other processes, which would not expect them not to block.
const WRITE_BYTES: usize = 4 << 10;
/// So much where the file is this process's alone, and does not block.
const OWN_WRITE_BYTES: usize = 64 << 10;

/// When fewer bytes of messages than this wait to be written, it is time for more.
const QUEUED_FEW: u64 = 512 << 10;

/// Whether it has become time for more.
fn has_room_again(before: u64, after: u64) -> bool {
    before >= QUEUED_FEW && after < QUEUED_FEW
}

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

/// What is written to.
struct Writer {
    /// Shared with the thread that sleeps until it can be written to.
    file: Arc<OwnedFd>,
    /// So much at once.
    most: usize,
}

impl Writer {
    /// A pipe is opened once more, for this process alone, so that it need not block.
    fn new(file: OwnedFd) -> Writer {
        let own = || {
            let is_pipe = FileType::from_raw_mode(fstat(&file)?.st_mode) == FileType::Fifo;
            let path = format!("/proc/self/fd/{}", file.as_raw_fd());
            let flags = OFlags::WRONLY | OFlags::NONBLOCK | OFlags::CLOEXEC;
            if is_pipe { open(path, flags, Mode::empty()) } else { Err(Errno::NOTSUP) }
        };
        match own() {
            Ok(own) => Writer { file: Arc::new(own), most: OWN_WRITE_BYTES },
            Err(_) => Writer { file: Arc::new(file), most: WRITE_BYTES },
        }
    }
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
    /// Rung when the link was opened, a message has come, or the link has ended.
    bell: Arc<Bell>,
    begun: Instant,
    patience: Patience,
}

struct State {
    link: Link,
    /// `None` once nothing more is to be written.
    writer: Option<Writer>,
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
        let writer = Some(Writer::new(writer));
        let state =
            State { link, writer, heard: now, ended: None, is_closing: false, is_dropped: false };
        let shared = Arc::new(Shared {
            state: Mutex::new(state),
            wake: Bell::new()?,
            bell,
            begun: now,
            patience,
        });
        let of_thread = shared.clone();
        let thread = Builder::new().name("link".to_owned());
        let thread = thread.spawn(move || of_thread.run(&reader))?;
        Ok(Pump { shared, thread: Some(thread) })
    }

    /// The next message, or `None` where none has come.
    pub fn receive(&self) -> Option<Vec<u8>> {
        let message = self.shared.lock().link.receive()?;
        // There may be credit to be told.
        self.shared.wake.ring();
        Some(message)
    }

    /// Queues a message.
    pub fn send(&self, message: Arc<Vec<u8>>) {
        let mut state = self.shared.lock();
        state.link.send(message);
        let before = state.link.queued();
        // At once, where that cannot block: a thread need not be woken for it. What goes wrong the thread notices, too.
        let is_own = state.writer.as_ref().is_some_and(|writer| writer.most == OWN_WRITE_BYTES);
        while is_own && matches!(state.write(), Written::Some) {}
        let is_done = state.link.output().is_empty();
        if has_room_again(before, state.link.queued()) {
            self.shared.bell.ring();
        }
        drop(state);
        if !is_done {
            self.shared.wake.ring();
        }
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
    fn run(&self, reader: &OwnedFd) {
        let ending = self.move_bytes(reader);
        let mut state = self.lock();
        // The other end sees the end of the stream.
        state.writer = None;
        state.ended = Some(ending);
        drop(state);
        self.bell.ring();
    }

    /// How the link has ended.
    fn move_bytes(&self, reader: &OwnedFd) -> Ending {
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
            let has_output = !state.link.output().is_empty();
            if state.is_closing && !has_output {
                state.writer = None;
            }
            let writer = state.writer.as_ref().filter(|_| has_output);
            let writer = writer.map(|writer| writer.file.clone());
            drop(state);
            let mut fds =
                vec![PollFd::new(&self.wake, PollFlags::IN), PollFd::new(reader, PollFlags::IN)];
            if let Some(writer) = &writer {
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
            if woken.get(2) == Some(&true)
                && let Some(why) = self.write()
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
        let was_open = state.link.is_open();
        if let Err(error) = state.link.take_in(&buffer[..length], now) {
            return Some(Ending::Cut(error.to_string()));
        }
        if state.link.has_message() || state.link.is_open() != was_open {
            self.bell.ring();
        }
        None
    }

    /// Writes once; why the link has ended, if it has.
    fn write(&self) -> Option<String> {
        let mut state = self.lock();
        let before = state.link.queued();
        match state.write() {
            Written::Some => {
                // Whoever waits until there is room for more is to be woken.
                if has_room_again(before, state.link.queued()) {
                    self.bell.ring();
                }
                None
            }
            Written::Nothing => None,
            Written::Failed(error) => Some(format!("it cannot be written to: {error}")),
        }
    }
}

/// What came of writing once.
enum Written {
    Some,
    /// There is nothing to be written, or no room for it.
    Nothing,
    Failed(io::Error),
}

impl State {
    /// Writes once.
    fn write(&mut self) -> Written {
        let Some(writer) = &self.writer else { return Written::Nothing };
        let output = self.link.output();
        if output.is_empty() {
            return Written::Nothing;
        }
        let length = output.len().min(writer.most);
        match write(&writer.file, &output[..length]) {
            Ok(length) => {
                self.link.written(length);
                Written::Some
            }
            Err(Errno::INTR | Errno::AGAIN) => Written::Nothing,
            // What the other end had still sent is read first: its stream ends, too.
            Err(Errno::PIPE | Errno::CONNRESET) => {
                self.link.written(length);
                Written::Some
            }
            Err(errno) => Written::Failed(errno.into()),
        }
    }
}
