use super::{Crew, CrewError, News, SILENCE_MAX};
use roadmill::roadmap::Digest;
use roadmill_workers::WorkerId;
use roadmill_workers::message::MESSAGE_BYTES_MAX;
use roadmill_workers::stream::{Frame, Frames, HEADER_BYTES, Kind, header};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::collections::{BTreeMap, VecDeque};
use std::io::{self, ErrorKind, Write};
use std::net::Shutdown;
use std::os::fd::BorrowedFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often one stream is read before the next has its turn.
const READS_MAX: usize = 64;

/// How the far end of a stream came to its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ending {
    /// The worker died of itself; how, for people.
    Died(String),
    /// The stream broke, or whoever is at its far end left it; why, for people.
    Left(String),
}

/// Who is at the far end of a member's stream: what is known of the worker besides what it says.
pub trait FarEnd {
    /// How it ended. Called once the stream has ended, so that it may wait for an end that is near.
    fn ended(&mut self) -> Ending;

    /// Ends it, as far as the end of its stream does not.
    fn end(&mut self) {}

    /// Waits until it has ended. The last call; the stream has ended, and [`end`](FarEnd::end) was called.
    fn wait(&mut self) {}
}

/// A worker that was started: the crew's end of its stream, and what is known of it at the far end.
pub type Started = (UnixStream, Box<dyn FarEnd>);

/// Workers that speak along connected sockets, in frames ([`roadmill_workers::stream`]). They share nothing:
/// all that they are to know goes to each of them in messages. So they may be threads of this process, its
/// children with a socket as standard input and output, or, through a program that leads such a child's
/// streams on, processes of other machines.
pub struct StreamCrew {
    /// Starts the worker of this name.
    start: Box<dyn FnMut(WorkerId) -> io::Result<Started>>,
    program: String,
    build: Digest,
    size: usize,
    next_member: u64,
    silence_max: Duration,
    members: BTreeMap<WorkerId, Member>,
    /// Dismissed, and perhaps not yet ended.
    dismissed: Vec<Box<dyn FarEnd>>,
    news: VecDeque<News>,
}

struct Member {
    /// Does not block.
    stream: UnixStream,
    far_end: Box<dyn FarEnd>,
    frames: Frames,
    replies: VecDeque<Reply>,
    /// When anything came from it last.
    heard: Instant,
    /// Its loss is among the news: nothing more is read.
    is_lost: bool,
}

/// A reply, as far as it has not been written.
struct Reply {
    header: [u8; HEADER_BYTES],
    message: Arc<Vec<u8>>,
    /// Bytes of both that have been written.
    written: usize,
}

impl StreamCrew {
    /// A crew of so many members, none of which is started yet. `start` starts one; `program` is what they
    /// run, for people, and `build` what they say of it in their first message.
    pub fn new(
        size: usize,
        program: impl Into<String>,
        build: Digest,
        start: impl FnMut(WorkerId) -> io::Result<Started> + 'static,
    ) -> StreamCrew {
        StreamCrew {
            start: Box::new(start),
            program: program.into(),
            build,
            size,
            next_member: 0,
            silence_max: SILENCE_MAX,
            members: BTreeMap::new(),
            dismissed: Vec::new(),
            news: VecDeque::new(),
        }
    }

    /// The same crew, whose members are given up when they are silent for this long.
    pub fn with_silence_max(self, silence_max: Duration) -> StreamCrew {
        StreamCrew { silence_max, ..self }
    }
}

impl Member {
    /// Reads what has come; what the member said, and what it is lost for if it is.
    fn read(&mut self, id: WorkerId, news: &mut VecDeque<News>) {
        for _ in 0..READS_MAX {
            let read = self.frames.read_from(&mut &self.stream);
            match read {
                Ok(0) => return self.lose(id, None, news),
                Ok(_) => self.heard = Instant::now(),
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                // The far end was closed with something unread in it.
                Err(error) if error.kind() == ErrorKind::ConnectionReset => {
                    return self.lose(id, None, news);
                }
                Err(error) => {
                    return self.lose(id, Some(format!("its stream broke: {error}")), news);
                }
            }
            loop {
                match self.frames.take() {
                    Ok(Some(Frame::Message(message))) => {
                        news.push_back(News::Message { member: id, message });
                    }
                    Ok(Some(Frame::Beat)) => {}
                    Ok(None) => break,
                    Err(error) => return self.lose(id, Some(format!("it sent {error}")), news),
                }
            }
        }
    }

    /// The member is lost, for this reason or because its stream has ended.
    fn lose(&mut self, id: WorkerId, why: Option<String>, news: &mut VecDeque<News>) {
        self.is_lost = true;
        let ending = why.map_or_else(|| self.far_end.ended(), Ending::Left);
        news.push_back(match ending {
            Ending::Died(why) => News::Died { member: id, why },
            Ending::Left(why) => News::Lost { member: id, why },
        });
    }

    /// Writes as much of the replies as the stream takes.
    fn write(&mut self) {
        while let Some(reply) = self.replies.front_mut() {
            let rest = match reply.written.checked_sub(HEADER_BYTES) {
                None => &reply.header[reply.written..],
                Some(written) => &reply.message[written..],
            };
            if rest.is_empty() {
                self.replies.pop_front();
                continue;
            }
            match (&self.stream).write(rest) {
                Ok(written) => reply.written += written,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                // A far end that takes nothing has ended, which shows when the stream is read.
                Err(_) => return self.replies.clear(),
            }
        }
    }

    /// Ends the stream, and what is at its far end.
    fn end(&mut self) {
        // One that has ended cannot be ended.
        let _ = self.stream.shutdown(Shutdown::Both);
        self.far_end.end();
    }
}

impl Crew for StreamCrew {
    fn size(&self) -> usize {
        self.size
    }

    fn program(&self) -> String {
        self.program.clone()
    }

    fn build(&self) -> Digest {
        self.build
    }

    fn hire(&mut self) -> io::Result<WorkerId> {
        let id = WorkerId(self.next_member);
        self.next_member += 1;
        let (stream, far_end) = (self.start)(id)?;
        stream.set_nonblocking(true)?;
        let member = Member {
            stream,
            far_end,
            frames: Frames::default(),
            replies: VecDeque::new(),
            heard: Instant::now(),
            is_lost: false,
        };
        self.members.insert(id, member);
        Ok(id)
    }

    fn dismiss(&mut self, member: WorkerId) -> Option<String> {
        let mut gone = self.members.remove(&member)?;
        gone.end();
        self.dismissed.push(gone.far_end);
        self.news.retain(|news| match news {
            News::Message { member: of, .. }
            | News::Died { member: of, .. }
            | News::Lost { member: of, .. } => *of != member,
        });
        None
    }

    fn send(&mut self, member: WorkerId, message: Arc<Vec<u8>>) -> Result<(), CrewError> {
        if message.len() as u64 > MESSAGE_BYTES_MAX {
            let found =
                format!("{} bytes found, at most {MESSAGE_BYTES_MAX} expected", message.len());
            let error = io::Error::new(ErrorKind::InvalidInput, found);
            return Err(CrewError::System("the message is too long".to_owned(), error));
        }
        if let Some(member) = self.members.get_mut(&member) {
            let header = header(Kind::Message, &message);
            member.replies.push_back(Reply { header, message, written: 0 });
            member.write();
        }
        Ok(())
    }

    fn wait(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) {
        let wait = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
        let mut fds: Vec<PollFd<'_>> = Vec::with_capacity(1 + self.members.len());
        for member in self.members.values().filter(|member| !member.is_lost) {
            let to_write =
                if member.replies.is_empty() { PollFlags::empty() } else { PollFlags::OUT };
            fds.push(PollFd::new(&member.stream, PollFlags::IN | to_write));
        }
        fds.extend(also.map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN)));
        // An interrupted sleep is a short one.
        let _ = poll(&mut fds, Some(&wait));
        let woken: Vec<PollFlags> = fds.iter().map(PollFd::revents).collect();
        let members = self.members.iter_mut().filter(|(_, member)| !member.is_lost);
        for ((id, member), woken) in members.zip(woken) {
            if woken.contains(PollFlags::OUT) {
                member.write();
            }
            if woken.intersects(PollFlags::IN | PollFlags::HUP | PollFlags::ERR) {
                member.read(*id, &mut self.news);
            } else if member.heard.elapsed() > self.silence_max {
                let why = format!("it was silent for {:?}", self.silence_max);
                member.lose(*id, Some(why), &mut self.news);
            }
        }
    }

    fn next(&mut self) -> Result<Option<News>, CrewError> {
        Ok(self.news.pop_front())
    }

    fn close(mut self) -> Result<(), CrewError> {
        let members: Vec<WorkerId> = self.members.keys().copied().collect();
        members.into_iter().for_each(|member| drop(self.dismiss(member)));
        self.dismissed.iter_mut().for_each(|far_end| far_end.wait());
        Ok(())
    }
}
