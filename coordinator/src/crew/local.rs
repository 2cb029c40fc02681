use super::executable::Executable;
use super::process::{Pulse, WorkerProcess};
use super::{Crew, CrewError, News, SILENCE_MAX};
use roadmill::roadmap::Digest;
use roadmill_workers::WorkerId;
use roadmill_workers::channel::{Delivery, Hub, Received};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::os::fd::BorrowedFd;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// Between two times that the hearts of all workers are listened to.
const LOOK_PAUSE: Duration = Duration::from_secs(1);

/// Worker processes of this machine. Messages travel through shared memory, where the members also share what
/// is stored for them and the parts of the roadmap that never change any more.
pub struct LocalCrew {
    /// Dropped before the hub, whose files they use.
    processes: BTreeMap<WorkerId, WorkerProcess>,
    hub: Hub,
    executable: Executable,
    size: usize,
    next_member: u64,
    /// Whether messages may have come since there were none.
    may_have_messages: bool,
    /// Processes that have shown that they live, or have ended, or were not listened to for a while.
    to_listen_to: Vec<WorkerId>,
    /// Found lost; told once all messages are.
    lost: VecDeque<News>,
    /// When all hearts were listened to last.
    listened: Instant,
}

impl LocalCrew {
    /// Opens the channel for so many members, none of which is started yet.
    ///
    /// # Errors
    /// When the channel cannot be made.
    pub fn open(executable: Executable, size: usize) -> Result<LocalCrew, CrewError> {
        Ok(LocalCrew {
            processes: BTreeMap::new(),
            // A dead worker may hold its place until it is cleaned up after.
            hub: Hub::create(size + 2)?,
            executable,
            size,
            next_member: 0,
            may_have_messages: false,
            to_listen_to: Vec::new(),
            lost: VecDeque::new(),
            listened: Instant::now(),
        })
    }
}

impl Crew for LocalCrew {
    fn size(&self) -> usize {
        self.size
    }

    fn program(&self) -> String {
        self.executable.path().display().to_string()
    }

    fn build(&self) -> Digest {
        self.executable.build()
    }

    fn hire(&mut self) -> io::Result<WorkerId> {
        let member = WorkerId(self.next_member);
        self.next_member += 1;
        self.hub.close_on_exec();
        let process = WorkerProcess::start(&self.executable, self.hub.directory(), member)?;
        self.processes.insert(member, process);
        Ok(member)
    }

    fn dismiss(&mut self, member: WorkerId) -> Option<String> {
        let status = self.processes.remove(&member)?.end();
        self.hub.forget(member);
        // The hub may have come upon messages of others.
        self.may_have_messages = true;
        status.map(|status| status.to_string())
    }

    fn send(&mut self, member: WorkerId, message: Arc<Vec<u8>>) -> Result<(), CrewError> {
        match self.hub.reply(member, message)? {
            // A worker that is gone shows it by its heart.
            Delivery::Sent | Delivery::Gone => Ok(()),
        }
    }

    fn wait(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) {
        let wait = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
        let mut fds = Vec::with_capacity(2 + self.processes.len());
        fds.push(PollFd::from_borrowed_fd(self.hub.as_fd(), PollFlags::IN));
        for process in self.processes.values() {
            fds.push(PollFd::from_borrowed_fd(process.as_fd(), PollFlags::IN));
        }
        fds.extend(also.map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN)));
        // An interrupted sleep is a short one.
        let _ = poll(&mut fds, Some(&wait));
        self.may_have_messages |= !fds[0].revents().is_empty();
        if self.listened.elapsed() >= LOOK_PAUSE {
            self.listened = Instant::now();
            self.to_listen_to = self.processes.keys().copied().collect();
        } else {
            let hearts = self.processes.keys().zip(&fds[1..]);
            let heard = hearts.filter(|(_, heart)| !heart.revents().is_empty());
            self.to_listen_to = heard.map(|(member, _)| *member).collect();
        }
    }

    fn next(&mut self) -> Result<Option<News>, CrewError> {
        loop {
            if self.may_have_messages {
                match self.hub.receive()? {
                    Some(Received::Message { worker: member, message }) => {
                        return Ok(Some(News::Message { member, message }));
                    }
                    Some(Received::Broken { worker: member, reason }) => {
                        let why = format!("it sent a broken message: {reason}");
                        return Ok(Some(News::Lost { member, why }));
                    }
                    None => self.may_have_messages = false,
                }
            }
            if let Some(news) = self.lost.pop_front() {
                return Ok(Some(news));
            }
            let Some(member) = self.to_listen_to.pop() else { return Ok(None) };
            // One that was dismissed meanwhile is nobody's concern.
            let Some(process) = self.processes.get_mut(&member) else { continue };
            let news = match process.look() {
                Pulse::Beating => continue,
                Pulse::Ended => News::Died { member, why: "it ended".to_owned() },
                Pulse::Silent => {
                    let seconds = SILENCE_MAX.as_secs();
                    News::Lost { member, why: format!("it was silent for {seconds} s") }
                }
            };
            // What it had still sent counts.
            self.lost.push_back(news);
            self.may_have_messages = true;
        }
    }

    fn store(&mut self, bytes: &[u8]) -> Option<u64> {
        self.hub.store().append(bytes)
    }

    fn stored_bytes(&self) -> Arc<AtomicU64> {
        self.hub.stored_bytes()
    }

    fn close(self) -> Result<(), CrewError> {
        drop(self.processes);
        Ok(self.hub.close()?)
    }
}
