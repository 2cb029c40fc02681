use super::staff::{Audited, Made};
use roadmill::img::Job;
use roadmill::internal::wire;
use roadmill::roadmap::Digest;
use roadmill_workers::WorkerId;
use std::collections::BTreeMap;

/// Jobs that two machines do, so that their outcomes can be compared. Which jobs these are follows from the jobs and from a key that
/// never leaves this process: an agent cannot know. No outcome depends on it.
///
/// The first outcome is kept back until the second has come, however long that takes: a wrong one never gets into a
/// roadmap.
#[derive(Debug)]
pub struct Audit {
    share: f64,
    key: [u8; 32],
    /// First outcomes, and who is to make or makes the second.
    open: BTreeMap<Job, Second>,
    counts: Audited,
}

#[derive(Debug)]
struct Second {
    first: Made,
    /// The machine on which that was made.
    machine: usize,
    /// `None` while nobody has been given the job.
    by: Option<WorkerId>,
}

/// What comes of an outcome.
#[derive(Debug)]
pub enum Compared {
    /// It waits for a second one.
    Kept,
    /// It needs none, or the second one is the same.
    Same(Made),
    /// It is another than that of this agent.
    Differs(Made, WorkerId),
}

impl Audit {
    /// So large a share of all jobs is done twice; which, depends on `key`.
    pub fn new(share: f64, key: [u8; 32]) -> Audit {
        Audit { share, key, open: BTreeMap::new(), counts: Audited::default() }
    }

    /// Whether a job is one of those that are done twice.
    fn is_due(&self, job: Job) -> bool {
        let digest = Digest::of(&[&self.key[..], &wire::encode(&job)].concat());
        let [a, b, c, d, e, f, g, h, ..] = digest.0;
        let drawn = u64::from_le_bytes([a, b, c, d, e, f, g, h]);
        // 53 bits, as many as a number has: below 1, so that everything is due at a share of 1.
        let share = (drawn >> 11) as f64 / (1u64 << 53) as f64;
        share < self.share
    }

    /// Takes in an outcome that was made on this machine.
    pub fn take(&mut self, made: Made, machine: usize) -> Compared {
        if self.share <= 0.0 {
            return Compared::Same(made);
        }
        if let Some(second) = self.open.remove(&made.job) {
            if second.by != Some(made.member) {
                // Nobody asked for it: it is the first one again.
                let first = second.first.member;
                let is_same = second.first.digest == made.digest;
                self.open.insert(made.job, second);
                return if is_same { Compared::Kept } else { Compared::Differs(made, first) };
            }
            self.counts.compared += 1;
            if second.first.digest == made.digest {
                return Compared::Same(second.first);
            }
            return Compared::Differs(made, second.first.member);
        }
        if !self.is_due(made.job) {
            return Compared::Same(made);
        }
        self.open.insert(made.job, Second { first: made, machine, by: None });
        Compared::Kept
    }

    /// Jobs that this agent is to do a second time, so many at most; none that was done on its own machine.
    pub fn take_for(&mut self, member: WorkerId, machine: usize, most: usize) -> Vec<Job> {
        let mut jobs = Vec::new();
        for (job, second) in &mut self.open {
            if jobs.len() == most {
                break;
            }
            if second.by.is_none() && second.machine != machine {
                second.by = Some(member);
                jobs.push(*job);
            }
        }
        jobs
    }

    /// Takes note that an agent is lost while it held a job. Whether it was to do the job a second time.
    pub fn lose(&mut self, job: Job, member: WorkerId) -> bool {
        let Some(second) = self.open.get_mut(&job) else { return false };
        if second.by == Some(member) {
            second.by = None;
        }
        true
    }

    /// Whether an outcome waits for somebody who could make it a second time.
    pub fn is_waiting(&self) -> bool {
        self.open.values().any(|second| second.by.is_none())
    }

    /// What was compared so far, where anything is to be.
    pub fn counts(&self) -> Option<Audited> {
        (self.share > 0.0).then_some(self.counts)
    }
}
