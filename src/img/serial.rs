use super::{Event, Executor, Finished, InProcess, Job, Replica, Round, Setup};
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap, Tally};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

/// Does the jobs one after another in the calling thread, the most urgent first.
pub struct Serial {
    setup: Arc<Setup>,
    replica: Replica,
    jobs: BTreeSet<Job>,
    scratch: Scratch,
}

impl Serial {
    /// An executor for one build.
    pub fn new(setup: Arc<Setup>) -> Serial {
        let replica = Replica::new(&setup);
        Serial { setup, replica, jobs: BTreeSet::new(), scratch: Scratch::new() }
    }
}

impl Executor for Serial {
    fn publish(&mut self, increment: &Arc<Increment>) {
        self.replica.publish(&self.setup, increment.clone());
    }

    fn fold(&mut self, round: &Round) {
        self.replica.fold(&self.setup, round.joins());
    }

    fn submit(&mut self, job: Job) {
        self.jobs.insert(job);
    }

    fn next(&mut self, _wait: Duration) -> Option<Event> {
        let job = self.jobs.pop_first()?;
        let task = self.replica.task(&self.setup, job)?;
        Some(Event::Done(job, Finished::new(task.run(&self.setup, &mut self.scratch))))
    }

    fn alive(&self) -> usize {
        1
    }

    fn tally(&self) -> &Tally {
        self.replica.roadmap().tally()
    }
}

impl InProcess for Serial {
    fn into_roadmap(self) -> Roadmap {
        self.replica.into_roadmap()
    }
}
