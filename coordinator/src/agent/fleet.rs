use super::link::Traffic;
use super::place::Place;
use crate::output::note;
use roadmill_workers::WorkerId;
use std::fmt;
use std::os::fd::BorrowedFd;
use std::sync::Arc;
use std::time::Duration;

/// What has happened in a fleet.
#[derive(Debug)]
pub enum News {
    /// An agent has opened its link.
    Joined {
        /// The name that it has until it is lost.
        member: WorkerId,
        /// The number of its place.
        place: usize,
    },
    /// A whole message has come.
    Message {
        /// Who sent it.
        member: WorkerId,
        /// Its bytes.
        message: Vec<u8>,
    },
    /// An agent is lost. It is started again after a while.
    Lost {
        /// Who is.
        member: WorkerId,
        /// Why, for people.
        why: String,
    },
}

/// The state of a place that will never have an agent again.
pub const REFUSED: &str = "refused";

/// How a place is doing, for people.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Condition {
    /// One word.
    pub state: &'static str,
    /// Why it is not running, where there is a reason.
    pub reason: String,
    /// How often its agent was started after it was lost.
    pub restarts: u64,
    /// What has gone over its links.
    pub traffic: Traffic,
    /// How long a sign of life takes there and back.
    pub round_trip: Option<Duration>,
}

/// Agents and the way to them: a fleet starts one at each place, notices when it is lost, and starts it again. It
/// carries bytes and knows nothing of jobs.
pub trait Fleet {
    /// The places.
    fn places(&self) -> Vec<&Place>;

    /// How a place is doing.
    fn condition(&self, place: usize) -> Condition;

    /// The name of a member's place, while the member is there.
    fn place_of(&self, member: WorkerId) -> Option<&str>;

    /// Why the agent that was lost last is not there, for people.
    fn last_loss(&self) -> Option<String>;

    /// Queues a message. It need not arrive: a member that is gone shows it in the news.
    fn send(&self, member: WorkerId, message: Arc<Vec<u8>>);

    /// Bytes of messages that are still to be written to a member.
    fn queued(&self, member: WorkerId) -> u64;

    /// How long a sign of life takes to a member and back.
    fn round_trip(&self, member: WorkerId) -> Option<Duration>;

    /// Ends a member; another is started at its place after a while. No news come of the member any more.
    fn dismiss(&mut self, member: WorkerId, why: &str);

    /// Ends a member, and starts no other at its place: it would be like it. What was sent to it still goes there.
    fn refuse(&mut self, member: WorkerId, why: &str);

    /// Starts agents whose time has come, and ends those whose time is over.
    fn tend(&mut self);

    /// Sleeps until there may be news, `also` is readable, or the time is over.
    fn wait(&mut self, wait: Duration, also: Option<BorrowedFd<'_>>);

    /// The next news, without waiting. After a loss the member is to be [dismissed](Fleet::dismiss).
    fn next(&mut self) -> Option<News>;

    /// Tells people what has happened to an agent.
    fn tell(&self, text: fmt::Arguments<'_>) {
        note(text);
    }

    /// Tells all agents to end, and sees to it that they do.
    fn close(self);
}
