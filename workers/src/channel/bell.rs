//! Waking the other process: a datagram socket in the run's folder.
//!
//! iceoryx2's own event service is not used, because a wake-up can get lost there (0.10.0): a
//! notifier that is preempted between its datagram and marking the listener "notified" may mark it
//! after the listener has taken the datagram; from then on notifiers send nothing, while a listener
//! that sleeps on the descriptor waits for a datagram. With plain sockets the kernel keeps the
//! state, a dead peer is refused at once, and nothing is left in shared memory.
//!
//! To wake a process costs more than to send it a message, so a worker is woken only where it has said that
//! it sleeps: see [`Note`].

use std::fs::{self, Permissions};
use std::io::{self, ErrorKind};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::WorkerId;
use super::error::ChannelError;

/// The longest path a socket can be bound to (108 bytes with the closing zero).
pub(super) const SOCKET_PATH_BYTES_MAX: usize = 107;

const RINGS_PER_DRAIN_MAX: usize = 4096;

/// What became of a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rung {
    /// The peer will wake, or is awake.
    Yes,
    /// The system was out of something; ring again later.
    Later,
    /// Nobody is there.
    Gone,
}

/// What a ring says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Note {
    /// there is something to look at
    Look,
    /// this worker sleeps until the message that it sent with this sequence number is answered
    Asleep(WorkerId, u64),
}

impl Note {
    const BYTES: usize = 16;

    fn encode(self) -> [u8; Note::BYTES] {
        let mut bytes = [0; Note::BYTES];
        if let Note::Asleep(worker, sequence) = self {
            bytes[..8].copy_from_slice(&worker.0.to_le_bytes());
            // counted from 1
            bytes[8..].copy_from_slice(&sequence.to_le_bytes());
        }
        bytes
    }

    fn decode(bytes: &[u8]) -> Note {
        match bytes.as_chunks().0 {
            [worker, sequence] if *sequence != [0; 8] => {
                Note::Asleep(WorkerId(u64::from_le_bytes(*worker)), u64::from_le_bytes(*sequence))
            }
            _ => Note::Look,
        }
    }
}

/// One end's socket: it is rung by others, and rings others.
#[derive(Debug)]
pub(super) struct Bell {
    socket: UnixDatagram,
}

impl Bell {
    /// Binds a socket at `path`, which must not exist.
    pub fn bind(path: &Path) -> Result<Bell, ChannelError> {
        let socket = UnixDatagram::bind(path)
            .map_err(ChannelError::io("could not bind the socket", path))?;
        fs::set_permissions(path, Permissions::from_mode(0o600))
            .map_err(ChannelError::io("could not protect the socket", path))?;
        socket
            .set_nonblocking(true)
            .map_err(ChannelError::io("could not set up the socket", path))?;
        Ok(Bell { socket })
    }

    /// Wakes whoever sleeps on the socket at `path`. Never blocks.
    pub fn ring(&self, path: &Path, note: Note) -> Rung {
        loop {
            let error = match self.socket.send_to(&note.encode(), path) {
                Ok(_) => return Rung::Yes,
                Err(error) => error,
            };
            match error.kind() {
                ErrorKind::Interrupted => continue,
                // a full queue is readable, so its owner is about to wake anyway, but will not have read this
                ErrorKind::WouldBlock if note == Note::Look => return Rung::Yes,
                ErrorKind::NotFound | ErrorKind::ConnectionRefused => return Rung::Gone,
                _ => return Rung::Later,
            }
        }
    }

    /// Takes the rings that have come; not for ever, however fast new ones come.
    pub fn drain(&self, mut hear: impl FnMut(Note)) {
        let mut bytes = [0; Note::BYTES];
        for _ in 0..RINGS_PER_DRAIN_MAX {
            match self.socket.recv(&mut bytes) {
                Ok(length) => hear(Note::decode(&bytes[..length])),
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return,
            }
        }
    }

    /// Sleeps until rung, but no longer than `timeout`; may wake early. Takes the rings.
    pub fn wait(&self, timeout: Duration) -> io::Result<()> {
        let timeout =
            Timespec { tv_sec: timeout.as_secs() as i64, tv_nsec: timeout.subsec_nanos().into() };
        let mut sockets = [PollFd::new(&self.socket, PollFlags::IN)];
        match poll(&mut sockets, Some(&timeout)) {
            Ok(_) | Err(rustix::io::Errno::INTR) => {
                self.drain(|_| ());
                Ok(())
            }
            Err(error) => Err(error.into()),
        }
    }
}

impl AsFd for Bell {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }
}
