use super::identity::Identity;
use super::link::{Bell, Ending, Link, Patience, Pump};
use super::message::{FromAgent, ToAgent};
use crate::crew::{Crew, CrewError, Executable, LocalCrew};
use crate::dispatch::{Foreman, Made, Report, Staff};
use crate::signals::Signals;
use roadmill::img::{Job, Loss, Setup, canaries};
use roadmill::internal::wire;
use roadmill_workers::message::Done;
use rustix::event::{PollFd, PollFlags, Timespec, epoll, poll};
use std::io;
use std::os::fd::{AsFd, OwnedFd};
use std::sync::Arc;
use std::time::Duration;

/// An agent that has heard nothing for this long, not even a sign of life, ends: whoever needs it starts another.
const SILENCE_MAX: Duration = Duration::from_secs(60);
/// So long what is still to be said may take when an agent ends.
const LAST_WORDS: Duration = Duration::from_secs(5);
/// The longest time between two looks at whether the coordinator is there.
const TICK: Duration = Duration::from_secs(1);

/// Why an agent has ended.
#[derive(Debug)]
pub enum Served {
    /// The coordinator has closed the link: the build is over.
    Closed,
    /// The link is broken, or the coordinator was silent for too long; why, for people.
    Cut(String),
    /// The coordinator does not want it; why, for people.
    Refused(String),
    /// A signal came.
    Signalled,
    /// Its workers were lost, or what it was told makes no sense; why, for people.
    Failed(String),
}

/// Works as an agent for the coordinator at the other end of two streams until it is told to end or is left alone.
/// `workers` is how many worker processes it starts where the coordinator does not say. To be called from a thread that lives
/// as long as the process.
///
/// # Errors
/// When the system refuses what it needs.
pub fn serve(
    reader: OwnedFd,
    writer: OwnedFd,
    workers: usize,
    signals: &Signals,
) -> Result<Served, CrewError> {
    let bell = Arc::new(Bell::new().map_err(CrewError::system("cannot wait"))?);
    let wakes = both(&bell, signals).map_err(CrewError::system("cannot wait"))?;
    let patience = Patience { opening: Some(SILENCE_MAX), silence: SILENCE_MAX };
    let pump = Pump::start(Link::far(), reader, writer, bell.clone(), patience)
        .map_err(CrewError::system("cannot start a thread"))?;
    let agent = Agent { pump, bell, wakes, signals };
    let served = agent.work(workers);
    if let Ok(Served::Signalled) = &served {
        agent.say(&FromAgent::Leaving("a signal came".to_owned()));
    }
    if let Ok(Served::Failed(why)) = &served {
        agent.say(&FromAgent::Leaving(why.clone()));
    }
    if let Err(error) = &served {
        agent.say(&FromAgent::Leaving(error.to_string()));
    }
    agent.pump.close();
    agent.pump.wait_for_end(LAST_WORDS);
    served
}

/// A file that is readable when one of the two is.
fn both(bell: &Bell, signals: &Signals) -> io::Result<OwnedFd> {
    let wakes = epoll::create(epoll::CreateFlags::CLOEXEC)?;
    for (number, fd) in [bell.as_fd(), signals.as_fd()].into_iter().enumerate() {
        let data = epoll::EventData::new_u64(number as u64);
        epoll::add(&wakes, fd, data, epoll::EventFlags::IN)?;
    }
    Ok(wakes)
}

struct Agent<'a> {
    pump: Pump,
    bell: Arc<Bell>,
    /// Readable when there is something to be looked at.
    wakes: OwnedFd,
    signals: &'a Signals,
}

/// A message, or the end.
enum Heard {
    Message(ToAgent),
    End(Served),
}

impl Agent<'_> {
    fn say(&self, message: &FromAgent<'_>) {
        self.pump.send(Arc::new(wire::encode(message)));
    }

    /// The next message, if one has come.
    fn next(&self) -> Option<Heard> {
        if let Some(message) = self.pump.receive() {
            return Some(match wire::decode::<ToAgent>(&message) {
                Ok(ToAgent::Refused(why)) => Heard::End(Served::Refused(why)),
                Ok(message) => Heard::Message(message),
                Err(error) => Heard::End(Served::Failed(format!("it was sent {error}"))),
            });
        }
        if self.signals.came() {
            return Some(Heard::End(Served::Signalled));
        }
        self.pump.ended().map(|ending| match ending {
            Ending::Closed => Heard::End(Served::Closed),
            Ending::Cut(why) => Heard::End(Served::Cut(why)),
        })
    }

    /// Sleeps until a message has come.
    fn listen(&self) -> Heard {
        loop {
            self.bell.answer();
            if let Some(heard) = self.next() {
                return heard;
            }
            let tick = Timespec { tv_sec: TICK.as_secs() as i64, tv_nsec: 0 };
            // An interrupted sleep is a short one.
            let _ = poll(&mut [PollFd::new(&self.wakes, PollFlags::IN)], Some(&tick));
        }
    }

    fn work(&self, workers: usize) -> Result<Served, CrewError> {
        let asked = match self.listen() {
            Heard::Message(ToAgent::Greeting { workers, .. }) => workers as usize,
            Heard::Message(_) => return Ok(out_of_turn()),
            Heard::End(served) => return Ok(served),
        };
        let cores = if asked == 0 { workers } else { asked };
        let host = rustix::system::uname().nodename().to_string_lossy().into_owned();
        // Whether the two fit together is the coordinator's to say.
        self.say(&FromAgent::Hello { who: Identity::own(), cores: cores as u32, host });
        let crew = LocalCrew::open(Executable::own()?, cores)?;
        let problem = match self.listen() {
            Heard::Message(ToAgent::Problem(problem)) => problem,
            other => {
                crew.close()?;
                return Ok(match other {
                    Heard::Message(_) => out_of_turn(),
                    Heard::End(served) => served,
                });
            }
        };
        let setup = Arc::new(Setup::new(*problem));
        let mut foreman = Foreman::start(setup.clone(), crew)?;
        self.say(&FromAgent::Ready { canaries: canaries(&setup) });
        let served = self.lead(&mut foreman);
        foreman.close()?;
        Ok(served)
    }

    /// Hands on what the coordinator says to the workers, and what they say to the coordinator.
    fn lead(&self, foreman: &mut Foreman<LocalCrew>) -> Served {
        loop {
            self.bell.answer();
            while let Some(heard) = self.next() {
                let (entries, jobs, alone) = match heard {
                    Heard::Message(ToAgent::Work { entries, jobs, alone }) => {
                        (entries, jobs, alone)
                    }
                    Heard::Message(_) => return out_of_turn(),
                    Heard::End(served) => return served,
                };
                for entry in entries {
                    if !foreman.take_in(entry) {
                        let why = "it was told to take an outcome of its own that it never made";
                        return Served::Failed(why.to_owned());
                    }
                }
                for job in jobs {
                    if alone.contains(&job) {
                        foreman.submit_alone(job)
                    } else {
                        foreman.submit(job)
                    }
                }
            }
            let mut report = foreman.next(TICK, Some(self.wakes.as_fd()));
            let mut made = Vec::new();
            let mut died = Vec::new();
            while let Some(told) = report {
                match told {
                    Report::Done(done) => made.push(done),
                    // The job is not to blame: another worker does it.
                    Report::Lost(job, Loss::Departure) => foreman.submit(job),
                    Report::Lost(job, Loss::Death) => died.push(job),
                    Report::Failed(why) => return Served::Failed(why),
                    Report::Contradiction(job, by) => {
                        return Served::Failed(format!("{job}: {by}"));
                    }
                }
                report = foreman.pending();
            }
            self.tell(&made, died);
        }
    }

    fn tell(&self, made: &[Made], died: Vec<Job>) {
        if !made.is_empty() {
            let done = made.iter().map(|made| Done {
                job: made.job,
                micros: made.micros,
                outcome: made.bytes(),
            });
            self.say(&FromAgent::Done(done.collect()));
        }
        if !died.is_empty() {
            let why = format!(
                "it held {}",
                died.iter().map(Job::to_string).collect::<Vec<_>>().join(", ")
            );
            self.say(&FromAgent::Died { jobs: died, why });
        }
    }
}

fn out_of_turn() -> Served {
    Served::Failed("it was sent a message out of turn".to_owned())
}
