use super::frame::{Frame, Frames, Kind, header};
use crate::error::WorkerError;
use crate::line::{HEARTBEAT, Line};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::AsFd;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// A worker's end of a pair of byte streams. A thread of its own sends the signs of life, so that jobs may
/// take as long as they like.
pub struct StreamLine<R, W> {
    reader: R,
    /// Shared with the thread that sends the signs of life.
    writer: Arc<Mutex<W>>,
    frames: Frames,
    is_awaiting: bool,
    /// Nothing is ever sent here: that thread ends when this is dropped.
    _life: Sender<()>,
}

impl<R: Read + AsFd, W: Write + Send + 'static> StreamLine<R, W> {
    /// Replies are read from `reader`, which must block and keep no bytes back in a buffer of its own;
    /// messages are written to `writer`.
    ///
    /// # Errors
    /// When no thread can be started.
    pub fn open(reader: R, writer: W) -> io::Result<StreamLine<R, W>> {
        let writer = Arc::new(Mutex::new(writer));
        let (life, ended) = channel::<()>();
        let beating = writer.clone();
        thread::Builder::new().name("heartbeat".to_owned()).spawn(move || {
            while ended.recv_timeout(HEARTBEAT) == Err(RecvTimeoutError::Timeout) {
                // A coordinator that cannot be written to is found gone when the worker next turns to it.
                if write(&beating, Kind::Beat, &[]).is_err() {
                    return;
                }
            }
        })?;
        Ok(StreamLine {
            reader,
            writer,
            frames: Frames::default(),
            is_awaiting: false,
            _life: life,
        })
    }

    /// The reply, if all of it has come.
    fn reply(&mut self) -> Result<Option<Vec<u8>>, WorkerError> {
        while let Some(frame) = self.frames.take()? {
            if let Frame::Message(reply) = frame {
                self.is_awaiting = false;
                return Ok(Some(reply));
            }
        }
        Ok(None)
    }

    /// Reads what has come; sleeps where nothing has.
    fn read(&mut self) -> Result<(), WorkerError> {
        match self.frames.read_from(&mut self.reader) {
            Ok(0) => Err(WorkerError::Gone),
            Ok(_) => Ok(()),
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            Err(error) => Err(failure("cannot read from the coordinator", error)),
        }
    }

    /// Whether reading would not sleep.
    fn is_readable(&self) -> Result<bool, WorkerError> {
        let mut fds = [PollFd::new(&self.reader, PollFlags::IN)];
        match poll(&mut fds, Some(&Timespec { tv_sec: 0, tv_nsec: 0 })) {
            Ok(_) => Ok(!fds[0].revents().is_empty()),
            Err(rustix::io::Errno::INTR) => Ok(false),
            Err(errno) => Err(WorkerError::System("cannot look at the stream", errno.into())),
        }
    }
}

impl<R: Read + AsFd, W: Write + Send + 'static> Line for StreamLine<R, W> {
    fn send(&mut self, message: &[u8]) -> Result<(), WorkerError> {
        if std::mem::replace(&mut self.is_awaiting, true) {
            return Err(WorkerError::OutOfTurn);
        }
        write(&self.writer, Kind::Message, message)
            .map_err(|error| failure("cannot write to the coordinator", error))
    }

    fn receive(&mut self) -> Result<Vec<u8>, WorkerError> {
        if !self.is_awaiting {
            return Err(WorkerError::OutOfTurn);
        }
        loop {
            if let Some(reply) = self.reply()? {
                return Ok(reply);
            }
            self.read()?;
        }
    }

    fn try_receive(&mut self) -> Result<Option<Vec<u8>>, WorkerError> {
        if !self.is_awaiting {
            return Err(WorkerError::OutOfTurn);
        }
        loop {
            if let Some(reply) = self.reply()? {
                return Ok(Some(reply));
            }
            if !self.is_readable()? {
                return Ok(None);
            }
            self.read()?;
        }
    }

    /// The coordinator sleeps at its streams, so that each message wakes it by itself.
    fn nudge(&mut self) {}

    fn is_awaiting(&self) -> bool {
        self.is_awaiting
    }
}

fn write(writer: &Mutex<impl Write>, kind: Kind, bytes: &[u8]) -> io::Result<()> {
    // Where one thread has panicked the other ends by itself.
    let mut writer = writer.lock().unwrap_or_else(PoisonError::into_inner);
    writer.write_all(&header(kind, bytes))?;
    writer.write_all(bytes)?;
    writer.flush()
}

/// A stream that the other end has closed says no more than that.
fn failure(what: &'static str, error: io::Error) -> WorkerError {
    match error.kind() {
        ErrorKind::BrokenPipe | ErrorKind::ConnectionReset => WorkerError::Gone,
        _ => WorkerError::System(what, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::net::UnixStream;

    /// A line, and the coordinator's end of it.
    fn pair() -> (StreamLine<UnixStream, UnixStream>, UnixStream) {
        let (near, far) = UnixStream::pair().expect("sockets can be made");
        let writer = near.try_clone().expect("a socket can be shared");
        (StreamLine::open(near, writer).expect("a thread starts"), far)
    }

    #[test]
    fn message_and_reply_take_turns() {
        let (mut line, mut far) = pair();
        assert!(matches!(line.receive(), Err(WorkerError::OutOfTurn)));
        assert!(matches!(line.try_receive(), Err(WorkerError::OutOfTurn)));
        line.send(b"done").expect("it is sent");
        assert!(line.is_awaiting());
        assert!(matches!(line.send(b"more"), Err(WorkerError::OutOfTurn)));
        let mut frames = Frames::default();
        let sent = loop {
            frames.read_from(&mut far).expect("it can be read");
            match frames.take().expect("frames come") {
                Some(Frame::Message(message)) => break message,
                Some(Frame::Beat) | None => {}
            }
        };
        assert_eq!(sent, b"done");
        assert!(matches!(line.try_receive(), Ok(None)));
        // Half a reply is none yet.
        let reply = [&header(Kind::Message, b"work"), &b"work"[..]].concat();
        far.write_all(&reply[..20]).expect("it is sent");
        assert!(matches!(line.try_receive(), Ok(None)));
        far.write_all(&reply[20..]).expect("it is sent");
        assert_eq!(line.receive().expect("it has come"), b"work");
        assert!(!line.is_awaiting());
    }

    #[test]
    fn a_stream_that_is_closed_is_the_end_and_rubbish_an_error() {
        let (mut line, far) = pair();
        line.send(b"").expect("it is sent");
        drop(far);
        let error = line.receive().expect_err("nobody answers");
        assert!(error.is_end(), "{error}");
        let error = pair_with_rubbish().receive().expect_err("it is no frame");
        assert!(!error.is_end() && matches!(error, WorkerError::Frame(_)), "{error}");
    }

    fn pair_with_rubbish() -> StreamLine<UnixStream, UnixStream> {
        let (mut line, mut far) = pair();
        line.send(b"").expect("it is sent");
        far.write_all(&[0xff; 64]).expect("it is sent");
        line
    }
}
