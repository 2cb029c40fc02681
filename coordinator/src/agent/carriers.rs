use super::fleet::{Condition, Fleet, News, REFUSED};
use super::link::{Bell, Link, Patience, Pump, Traffic};
use super::place::{Carrier, Place};
use crate::output::note;
use roadmill_workers::WorkerId;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, Signal, kill_process_group};
use std::collections::{BTreeMap, VecDeque};
use std::io::{self, BufRead, BufReader, Read};
use std::os::fd::BorrowedFd;
use std::process::{Child, ChildStderr};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// An agent from which nothing has come for this long is stopped, stuck or cut off, and is given up.
pub const SILENCE_MAX: Duration = Duration::from_secs(30);
/// Before an agent that was lost is started again: at first this long, then twice as long each time, up to the most.
const PAUSES: (Duration, Duration) = (Duration::from_secs(1), Duration::from_secs(300));
/// An agent that has worked for this long starts again as if it were the first time.
const STEADY: Duration = Duration::from_secs(60);
/// So long an agent may take to end when it is told to, and then again when it is made to.
const LEAVE: Duration = Duration::from_secs(5);
/// Messages of one agent that are taken before the next has its turn.
const MESSAGES_MAX: usize = 1000;
/// Lines of an agent's standard error that are shown, each time that it is started.
const LINES_MAX: usize = 20;
/// The most bytes of a line that are shown.
const LINE_BYTES_MAX: u64 = 1000;

/// A fleet whose agents are reached through processes, which carry their standard input and output: see [`Place`].
pub struct Carriers {
    slots: Vec<Slot>,
    /// Which place has which member.
    members: BTreeMap<WorkerId, usize>,
    next_member: u64,
    /// The first number of the conversations of this process: relays may have kept frames of another.
    session: u64,
    /// Rung when a link has something to be looked at.
    bell: Arc<Bell>,
    news: VecDeque<News>,
    silence: Duration,
    /// Carriers that are to end.
    leaving: Vec<Leaving>,
}

/// A carrier that is to end, with all that it has started.
struct Leaving {
    child: Child,
    /// Its link, where something is still to be written to it.
    _pump: Option<Pump>,
    /// Signals that are to be sent to it, the next one last, and when.
    signals: Vec<(Instant, Signal)>,
}

/// A place and its agent.
struct Slot {
    place: Place,
    state: State,
    restarts: u64,
    pause: Duration,
    /// Traffic of links that have ended.
    traffic: Traffic,
    /// Why its agent was lost last.
    last_loss: String,
}

enum State {
    /// To be started then, after it was lost for this reason.
    Waiting(Instant, String),
    Running(Box<Running>),
    /// Never to be started again.
    Refused(String),
}

struct Running {
    member: WorkerId,
    pump: Pump,
    child: Child,
    errors: Errors,
    has_joined: bool,
    begun: Instant,
}

impl Carriers {
    /// A fleet with an agent at each of these places, none of which is started yet. `session` is a number that no
    /// other process is likely to have.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn new(places: Vec<Place>, session: u64) -> io::Result<Carriers> {
        let now = Instant::now();
        let slot = |place| Slot {
            place,
            state: State::Waiting(now, String::new()),
            restarts: 0,
            pause: PAUSES.0,
            traffic: Traffic::default(),
            last_loss: String::new(),
        };
        Ok(Carriers {
            slots: places.into_iter().map(slot).collect(),
            members: BTreeMap::new(),
            next_member: 0,
            session,
            bell: Arc::new(Bell::new()?),
            news: VecDeque::new(),
            silence: SILENCE_MAX,
            leaving: Vec::new(),
        })
    }

    /// The same fleet, which gives agents up that are silent for this long.
    pub fn with_silence_max(self, silence: Duration) -> Carriers {
        Carriers { silence, ..self }
    }

    fn running(&self, member: WorkerId) -> Option<&Running> {
        match &self.slots[*self.members.get(&member)?].state {
            State::Running(running) => Some(running),
            _ => None,
        }
    }

    /// Takes an agent away from its place, and gives it so long to read what was sent to it.
    fn end(&mut self, member: WorkerId, why: &str, grace: Duration) -> Option<usize> {
        let place = self.members.remove(&member)?;
        let slot = &mut self.slots[place];
        let waiting = State::Waiting(Instant::now(), why.to_owned());
        let State::Running(running) = std::mem::replace(&mut slot.state, waiting) else {
            return None;
        };
        let Running { pump, child, has_joined, begun, .. } = *running;
        if has_joined && begun.elapsed() >= STEADY {
            slot.pause = PAUSES.0;
        }
        slot.state = State::Waiting(Instant::now() + slot.pause, why.to_owned());
        slot.pause = (slot.pause * 2).min(PAUSES.1);
        add(&mut slot.traffic, pump.traffic());
        why.clone_into(&mut slot.last_loss);
        pump.close();
        let _pump = (!grace.is_zero()).then_some(pump);
        let begin = Instant::now() + grace;
        let signals = vec![(begin + LEAVE, Signal::KILL), (begin, Signal::TERM)];
        self.leaving.push(Leaving { child, _pump, signals });
        self.news.retain(|news| match news {
            News::Joined { member: of, .. }
            | News::Message { member: of, .. }
            | News::Lost { member: of, .. } => *of != member,
        });
        Some(place)
    }

    /// Starts agents whose time has come.
    fn start_due(&mut self) {
        for place in 0..self.slots.len() {
            let State::Waiting(due, why) = &self.slots[place].state else { continue };
            if Instant::now() < *due {
                continue;
            }
            let is_again = !why.is_empty();
            self.slots[place].restarts += u64::from(is_again);
            let started = self.start(place);
            let slot = &mut self.slots[place];
            slot.state = match started {
                Ok(running) => State::Running(Box::new(running)),
                Err(error) => {
                    let why = format!("cannot be started: {error}");
                    why.clone_into(&mut slot.last_loss);
                    if !is_again {
                        note(format_args!("agent {}: {why}", slot.place));
                    }
                    let due = Instant::now() + slot.pause;
                    slot.pause = (slot.pause * 2).min(PAUSES.1);
                    State::Waiting(due, why)
                }
            };
        }
    }

    fn start(&mut self, place: usize) -> io::Result<Running> {
        let member = WorkerId(self.next_member);
        self.next_member += 1;
        let slot = &self.slots[place];
        let Carrier { mut child, reader, writer, errors } = slot.place.start()?;
        let link = Link::near(self.session.wrapping_add(member.0));
        let patience = Patience { opening: None, silence: self.silence };
        let pump = Pump::start(link, reader, writer, self.bell.clone(), patience);
        let pump = pump.and_then(|pump| Ok((pump, Errors::read(errors, slot.place.name())?)));
        let (pump, errors) = match pump {
            Ok(started) => started,
            Err(error) => {
                // Without streams it has nothing to do.
                let _ = child.kill().and_then(|()| child.wait());
                return Err(error);
            }
        };
        self.members.insert(member, place);
        Ok(Running { member, pump, child, errors, has_joined: false, begun: Instant::now() })
    }
}

impl Fleet for Carriers {
    fn places(&self) -> Vec<&Place> {
        self.slots.iter().map(|slot| &slot.place).collect()
    }

    fn condition(&self, place: usize) -> Condition {
        let slot = &self.slots[place];
        let (restarts, mut traffic) = (slot.restarts, slot.traffic);
        let (state, reason, round_trip) = match &slot.state {
            State::Waiting(_, why) if why.is_empty() => ("starting", String::new(), None),
            State::Waiting(_, why) => ("waiting", why.clone(), None),
            State::Refused(why) => (REFUSED, why.clone(), None),
            State::Running(running) => {
                add(&mut traffic, running.pump.traffic());
                let state = if running.has_joined { "joined" } else { "starting" };
                let why = if running.has_joined { "" } else { &slot.last_loss };
                (state, why.to_owned(), running.pump.round_trip())
            }
        };
        Condition { state, reason, restarts, traffic, round_trip }
    }

    fn place_of(&self, member: WorkerId) -> Option<&str> {
        Some(self.slots[*self.members.get(&member)?].place.name())
    }

    fn last_loss(&self) -> Option<String> {
        let slot = self.slots.iter().rev().find(|slot| !slot.last_loss.is_empty())?;
        Some(format!("{}: {}", slot.place, slot.last_loss))
    }

    fn send(&self, member: WorkerId, message: Arc<Vec<u8>>) {
        if let Some(running) = self.running(member) {
            running.pump.send(message);
        }
    }

    fn queued(&self, member: WorkerId) -> u64 {
        self.running(member).map_or(0, |running| running.pump.queued())
    }

    fn round_trip(&self, member: WorkerId) -> Option<Duration> {
        self.running(member)?.pump.round_trip()
    }

    fn dismiss(&mut self, member: WorkerId, why: &str) {
        self.end(member, why, Duration::ZERO);
    }

    fn refuse(&mut self, member: WorkerId, why: &str) {
        if let Some(place) = self.end(member, why, Duration::from_secs(1)) {
            self.slots[place].state = State::Refused(why.to_owned());
        }
    }

    fn tend(&mut self) {
        self.leaving.retain_mut(|leaving| !leaving.has_ended());
        self.start_due();
    }

    fn wait(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>) {
        let now = Instant::now();
        let due = self.slots.iter().filter_map(|slot| match &slot.state {
            State::Waiting(due, _) => Some(due.saturating_duration_since(now)),
            _ => None,
        });
        let wait = due.min().map_or(wait, |due| due.min(wait));
        let wait = Timespec { tv_sec: wait.as_secs() as i64, tv_nsec: wait.subsec_nanos().into() };
        let mut fds = vec![PollFd::new(&self.bell, PollFlags::IN)];
        fds.extend(also.map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN)));
        // An interrupted sleep is a short one.
        let _ = poll(&mut fds, Some(&wait));
        self.bell.answer();
        for slot in &mut self.slots {
            let State::Running(running) = &mut slot.state else { continue };
            let (member, place) = (running.member, self.members[&running.member]);
            if !running.has_joined && running.pump.is_open() {
                running.has_joined = true;
                self.news.push_back(News::Joined { member, place });
            }
            for _ in 0..MESSAGES_MAX {
                let Some(message) = running.pump.receive() else { break };
                self.news.push_back(News::Message { member, message });
            }
            if let Some(why) = running.pump.ended() {
                let why = running.why(&why.to_string());
                self.news.push_back(News::Lost { member, why });
            }
        }
    }

    fn next(&mut self) -> Option<News> {
        self.news.pop_front()
    }

    fn close(mut self) {
        let begin = Instant::now() + LEAVE;
        for slot in std::mem::take(&mut self.slots) {
            let State::Running(running) = slot.state else { continue };
            let Running { pump, child, has_joined, .. } = *running;
            pump.close();
            // One that has not even opened its link has nothing to put in order.
            let begin = if has_joined { begin } else { Instant::now() };
            let signals = vec![(begin + LEAVE, Signal::KILL), (begin, Signal::TERM)];
            self.leaving.push(Leaving { child, _pump: Some(pump), signals });
        }
        let until = begin + 2 * LEAVE;
        loop {
            self.leaving.retain_mut(|leaving| !leaving.has_ended());
            if self.leaving.is_empty() || Instant::now() > until {
                return;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

impl Leaving {
    /// Whether the process has ended; sends the signal whose time has come.
    fn has_ended(&mut self) -> bool {
        if !matches!(self.child.try_wait(), Ok(None)) {
            return true;
        }
        if let Some((_, signal)) = self.signals.pop_if(|(due, _)| *due <= Instant::now())
            && let Some(group) = Pid::from_raw(self.child.id() as i32)
        {
            // One that has ended cannot be ended.
            let _ = kill_process_group(group, signal);
        }
        false
    }
}

impl Running {
    /// Why the agent is lost, with what was said on its standard error and how its carrier ended, where that is known.
    fn why(&mut self, why: &str) -> String {
        // The two ends of a carrier's life come shortly after one another.
        let status = ended_within(&mut self.child, Duration::from_millis(30));
        let status = status.filter(|status| !status.success());
        let status = status.map_or_else(String::new, |status| format!(" ({status})"));
        match self.errors.last() {
            Some(words) => format!("{why}{status}: {words}"),
            None => format!("{why}{status}"),
        }
    }
}

fn add(sum: &mut Traffic, more: Traffic) {
    sum.came += more.came;
    sum.sent += more.sent;
    sum.stale += more.stale;
}

/// How a process ended, if it does within this time.
fn ended_within(child: &mut Child, longest: Duration) -> Option<std::process::ExitStatus> {
    let until = Instant::now() + longest;
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) if Instant::now() < until => std::thread::sleep(Duration::from_millis(2)),
            Ok(None) | Err(_) => return None,
        }
    }
}

/// What an agent, and whatever carries its streams, says on standard error: shown as notes, in a thread of its own.
struct Errors {
    last: Arc<Mutex<Option<String>>>,
    /// Ends with the stream.
    _thread: JoinHandle<()>,
}

impl Errors {
    fn read(stream: ChildStderr, name: &str) -> io::Result<Errors> {
        let last = Arc::new(Mutex::new(None));
        let (of_thread, name) = (last.clone(), name.to_owned());
        let thread = Builder::new().name("errors".to_owned()).spawn(move || {
            let mut stream = BufReader::new(stream);
            for count in 0.. {
                let mut line = Vec::new();
                let read = stream.by_ref().take(LINE_BYTES_MAX).read_until(b'\n', &mut line);
                if !read.is_ok_and(|read| read > 0) {
                    return;
                }
                let line = String::from_utf8_lossy(&line).trim_end().to_owned();
                if line.is_empty() {
                    continue;
                }
                if count < LINES_MAX {
                    note(format_args!("agent {name}: {line}"));
                }
                *of_thread.lock().unwrap_or_else(PoisonError::into_inner) = Some(line);
            }
        })?;
        Ok(Errors { last, _thread: thread })
    }

    /// The last line.
    fn last(&self) -> Option<String> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
