//! The build as a state machine without input or output: events in, commands out.

use super::{Finished, Job, Outcome, Setup};
use crate::evaluate::Verdict;
use crate::numbers::{EvaluatorIndex, Ordinal, RoundNumber, SetName, SetNumber, StrategyIndex};
use crate::problem::Limits;
use crate::roadmap::{Digest, Increment, Joined, Round, RoundSet, SetForm};
use crate::sampler::GaveUp;
use crate::schedule::Plan;
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;
use std::sync::Arc;

/// A job at which this many workers have died is taken to be what kills them.
pub const LOSSES_MAX: u32 = 3;

/// Why a job was lost: whether the job may be to blame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// The worker died of itself while it held the job: by a signal, a panic or an exit. The job may be
    /// what killed it.
    Death,
    /// The worker was lost, or was ended, whatever its jobs: its connection broke, it fell silent, or it
    /// sent something that is no message. The job is not to blame.
    Departure,
}

/// What happened.
#[derive(Clone, Debug)]
pub enum Event {
    /// A job was done, for the first time or again.
    Done(Job, Finished),
    /// A job was lost with the worker that held it.
    Lost(Job, Loss),
    /// A job was done twice, and with two outcomes; by whom, for people.
    Contradiction(Job, String),
    /// The build is to end where it is.
    Cut(Cut),
}

/// What is to be done, in this order.
#[derive(Clone, Debug)]
pub enum Command {
    /// Make the increment of the next set known to the jobs that come.
    Publish(Arc<Increment>),
    /// Fold the published increments: the round is complete.
    Fold(Round),
    /// Do a job.
    Submit(Job),
    /// Note down what the evaluators said of the round folded last.
    Judge(Judgement),
    /// The build is over.
    Stop(Stop),
}

/// What the evaluators said of the roadmap after a round.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The round.
    pub round: RoundNumber,
    /// One verdict per evaluator of the problem.
    pub verdicts: Vec<Verdict>,
}

impl Judgement {
    /// Whether all criteria are met; without criteria there is nothing to meet.
    pub fn satisfied(&self) -> bool {
        satisfied(&self.verdicts)
    }
}

fn satisfied(verdicts: &[Verdict]) -> bool {
    !verdicts.is_empty() && verdicts.iter().all(|verdict| verdict.satisfied)
}

/// Why a build was ended from outside.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The limit on seconds.
    Time,
    /// The limit on memory, in bytes.
    Memory(u64),
    /// A signal.
    Interrupted,
    /// No worker is left and none can be started.
    WorkersLost(String),
}

/// Why a build stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Every evaluator is satisfied.
    Satisfied,
    /// As many nodes as asked for.
    NodeLimit,
    /// As many sets as asked for.
    SetLimit,
    /// A generator found no milestone.
    GaveUp {
        /// The strategy.
        strategy: StrategyIndex,
        /// The set's number within it.
        ordinal: Ordinal,
        /// How hard it tried.
        gave_up: GaveUp,
    },
    /// A job at which [`LOSSES_MAX`] workers died.
    Deadly(Job),
    /// A job that gave two different outcomes: a machine or the program is broken. By whom, for people, where it is known.
    Contradiction(Job, String),
    /// An outcome that the job cannot have, or one that nobody asked for.
    Nonsense(Job),
    /// Ended from outside.
    Cut(Cut),
}

/// How far a build is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Sets generated, folded or not.
    pub sets_generated: u64,
    /// Sets joined, folded or not.
    pub sets_joined: u64,
    /// Rounds folded.
    pub rounds: u64,
    /// Nodes folded.
    pub nodes: u64,
    /// The verdicts on the last judged round.
    pub verdicts: Vec<Verdict>,
}

/// How far a build had come that goes on.
#[derive(Clone, Debug)]
pub struct Past {
    plan: Plan,
    rounds: u64,
    nodes: u64,
    /// The verdicts on the last round; `None` where it is to be judged first.
    pub verdicts: Option<Vec<Verdict>>,
}

impl Past {
    /// Nothing yet.
    pub fn new(setup: &Setup) -> Past {
        Past { plan: setup.plan.clone(), rounds: 0, nodes: 0, verdicts: None }
    }

    /// Takes in the next round that was folded.
    pub fn fold(&mut self, round: &Round) {
        self.plan.observe(round);
        self.rounds += 1;
        self.nodes += round.sets.iter().map(|set| set.increment.configs.len() as u64).sum::<u64>();
        self.verdicts = None;
    }
}

/// The state of a build.
pub struct Core {
    plan: Plan,
    form: SetForm,
    set_nodes: Vec<u64>,
    /// Per strategy: whether its sets grow from the roadmap at the start of their round.
    grows: Vec<bool>,
    limits: Limits,
    evaluators: u32,
    lookahead: u64,

    /// The round to be folded next.
    round: RoundNumber,
    /// Increments that came before those of sets with smaller numbers.
    early: BTreeMap<SetNumber, Result<Increment, GaveUp>>,
    published: Vec<Arc<Increment>>,
    joined: BTreeMap<SetNumber, Joined>,
    /// Verdicts on the round before `round`, while they are awaited.
    awaited: Option<BTreeMap<EvaluatorIndex, Verdict>>,
    /// Of a build that goes on: whether its last round has been judged.
    is_judged: bool,
    next_generate: SetNumber,
    /// Sets that grow from a roadmap that is not there yet.
    waiting: VecDeque<SetNumber>,
    /// Nodes of the roadmap after the round of the last set to be generated.
    nodes_ahead: u64,
    /// Jobs at work, and how many workers died at each ([`Loss::Death`]).
    at_work: BTreeMap<Job, u32>,
    done: BTreeMap<Job, Digest>,
    progress: Progress,
    stopped: bool,
}

impl Core {
    /// The build of a problem, from the beginning. `lookahead` is how many sets beyond the
    /// current round may be generated; it changes how well workers are kept busy, never a result.
    pub fn new(setup: &Setup, lookahead: u64) -> Core {
        Core::resume(setup, lookahead, Past::new(setup))
    }

    /// The build of a problem from where it was interrupted; what was folded is known to the jobs
    /// that come.
    pub fn resume(setup: &Setup, lookahead: u64, past: Past) -> Core {
        let strategies = &setup.problem.strategies;
        let round = RoundNumber(past.rounds);
        let first_set = setup.plan.sets_of(round).start;
        let is_judged = past.verdicts.is_some();
        Core {
            plan: past.plan,
            form: SetForm::of(setup.problem.model.description()),
            set_nodes: strategies.iter().map(|strategy| u64::from(strategy.nodes)).collect(),
            grows: strategies.iter().map(|strategy| strategy.generator.grows()).collect(),
            limits: setup.problem.limits,
            evaluators: setup.problem.evaluators.len() as u32,
            lookahead,
            round,
            early: BTreeMap::new(),
            published: Vec::new(),
            joined: BTreeMap::new(),
            awaited: None,
            is_judged,
            next_generate: first_set,
            waiting: VecDeque::new(),
            nodes_ahead: past.nodes,
            at_work: BTreeMap::new(),
            done: BTreeMap::new(),
            progress: Progress {
                sets_generated: first_set.0,
                sets_joined: first_set.0,
                rounds: past.rounds,
                nodes: past.nodes,
                verdicts: past.verdicts.unwrap_or_default(),
            },
            stopped: false,
        }
    }

    /// The first commands.
    pub fn start(&mut self) -> Vec<Command> {
        let mut commands = Vec::new();
        match self.round.0.checked_sub(1) {
            None => {}
            // It may have been the last round.
            Some(_) if self.is_judged => self.decide(&mut commands),
            Some(last) => self.evaluate(RoundNumber(last), &mut commands),
        }
        self.advance(&mut commands);
        commands
    }

    /// Takes an event in; the commands that follow from it.
    pub fn on_event(&mut self, event: Event) -> Vec<Command> {
        let mut commands = Vec::new();
        if self.stopped {
            return commands;
        }
        match event {
            Event::Done(job, finished) => self.done(job, finished, &mut commands),
            Event::Lost(job, loss) => self.lost(job, loss, &mut commands),
            Event::Contradiction(job, by) => self.stop(Stop::Contradiction(job, by), &mut commands),
            Event::Cut(cut) => self.stop(Stop::Cut(cut), &mut commands),
        }
        self.advance(&mut commands);
        commands
    }

    /// Changes how many sets beyond the current round may be generated.
    pub fn look_ahead(&mut self, lookahead: u64) {
        self.lookahead = lookahead;
    }

    /// How far the build is.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    fn stop(&mut self, stop: Stop, commands: &mut Vec<Command>) {
        if !self.stopped {
            self.stopped = true;
            commands.push(Command::Stop(stop));
        }
    }

    /// Hands a lost job out again, unless too many workers died at it.
    fn lost(&mut self, job: Job, loss: Loss, commands: &mut Vec<Command>) {
        if let Some(deaths) = self.at_work.get_mut(&job) {
            *deaths += u32::from(loss == Loss::Death);
            if *deaths >= LOSSES_MAX {
                self.stop(Stop::Deadly(job), commands);
            } else {
                commands.push(Command::Submit(job));
            }
        }
    }

    fn done(&mut self, job: Job, finished: Finished, commands: &mut Vec<Command>) {
        if let Some(digest) = self.done.get(&job) {
            if *digest != finished.digest {
                self.stop(Stop::Contradiction(job, String::new()), commands);
            }
            return;
        }
        if self.at_work.remove(&job).is_none() || !self.fits(job, &finished.outcome) {
            self.stop(Stop::Nonsense(job), commands);
            return;
        }
        self.done.insert(job, finished.digest);
        match (job, finished.outcome) {
            (Job::Generate { number, .. }, Outcome::Increment(increment)) => {
                self.progress.sets_generated += 1;
                self.early.insert(number, increment);
            }
            (Job::Join { number, .. }, Outcome::Joined(joined)) => {
                self.progress.sets_joined += 1;
                self.joined.insert(number, joined);
            }
            (Job::Evaluate { evaluator, .. }, Outcome::Verdict(verdict)) => {
                if let Some(awaited) = &mut self.awaited {
                    awaited.insert(evaluator, *verdict);
                }
            }
            _ => unreachable!("the outcome fits the job"),
        }
    }

    /// Whether an outcome is one that the job could have: workers are other processes.
    fn fits(&self, job: Job, outcome: &Outcome) -> bool {
        match (job, outcome) {
            (Job::Generate { .. }, Outcome::Increment(Err(_))) => true,
            (Job::Generate { strategy, .. }, Outcome::Increment(Ok(increment))) => {
                let nodes = self.set_nodes[strategy.index()];
                // What does not grow has no links: it may have been made before the round's start.
                let before = if self.grows[strategy.index()] { self.folded() } else { 0 };
                increment.is_sound(self.form, before) && increment.configs.len() as u64 == nodes
            }
            (Job::Join { number, .. }, Outcome::Joined(joined)) => {
                let offset = number.since(self.current().start) as usize;
                let before = &self.published[..offset.min(self.published.len())];
                let first = self.progress.nodes
                    + before.iter().map(|increment| increment.configs.len() as u64).sum::<u64>();
                let own = self.published.get(offset).map_or(0, |own| own.configs.len() as u64);
                joined.edges.iter().all(|edge| {
                    u64::from(edge.low.0) < first
                        && (first..first + own).contains(&u64::from(edge.high.0))
                        && self.form.has_cost(edge)
                })
            }
            (Job::Evaluate { .. }, Outcome::Verdict(_)) => true,
            _ => false,
        }
    }

    /// Everything that can be done now.
    fn advance(&mut self, commands: &mut Vec<Command>) {
        while !self.stopped {
            self.judge(commands);
            self.publish(commands);
            if self.stopped || !self.fold(commands) {
                break;
            }
        }
        if !self.stopped {
            self.generate(commands);
        }
    }

    /// Once all verdicts on the last round are there, decides whether to go on.
    fn judge(&mut self, commands: &mut Vec<Command>) {
        let complete = |awaited: &BTreeMap<_, _>| awaited.len() == self.evaluators as usize;
        let Some(awaited) = self.awaited.take_if(|awaited| complete(awaited)) else {
            return;
        };
        let verdicts: Vec<Verdict> = awaited.into_values().collect();
        let judgement = Judgement { round: RoundNumber(self.round.0 - 1), verdicts };
        self.progress.verdicts = judgement.verdicts.clone();
        commands.push(Command::Judge(judgement));
        self.decide(commands);
    }

    /// Stops after the last round if its verdicts or a limit say so.
    fn decide(&mut self, commands: &mut Vec<Command>) {
        if satisfied(&self.progress.verdicts) {
            self.stop(Stop::Satisfied, commands);
        } else if self.progress.nodes >= self.limits.nodes {
            self.stop(Stop::NodeLimit, commands);
        } else if self.current().start.0 >= self.limits.sets {
            self.stop(Stop::SetLimit, commands);
        }
    }

    /// Publishes increments of the current round in order and hands out their joins. This may run
    /// before the last round is judged: a join depends on folded rounds only.
    fn publish(&mut self, commands: &mut Vec<Command>) {
        loop {
            let number = self.current().start + self.published.len() as u64;
            if self.stopped || number == self.current().end {
                return;
            }
            match self.early.get(&number) {
                None => return,
                Some(Err(gave_up)) => {
                    // Not before the judgement: it may say that the set was never needed.
                    if self.awaited.is_none() {
                        let SetName { strategy, ordinal } = self.name_of(number);
                        let gave_up = gave_up.clone();
                        self.stop(Stop::GaveUp { strategy, ordinal, gave_up }, commands);
                    }
                    return;
                }
                Some(Ok(_)) => {}
            }
            if let Some(Ok(increment)) = self.early.remove(&number) {
                let increment = Arc::new(increment);
                self.published.push(increment.clone());
                commands.push(Command::Publish(increment));
                let SetName { strategy, ordinal } = self.name_of(number);
                self.submit(Job::Join { number, strategy, ordinal }, commands);
            }
        }
    }

    /// Folds the current round if it is complete and the one before it judged.
    fn fold(&mut self, commands: &mut Vec<Command>) -> bool {
        let numbers = self.current();
        let count = numbers.end.since(numbers.start) as usize;
        if self.awaited.is_some() || self.published.len() < count || self.joined.len() < count {
            return false;
        }
        let joined = std::mem::take(&mut self.joined).into_values();
        let mut sets = Vec::with_capacity(count);
        let published = std::mem::take(&mut self.published).into_iter();
        for (increment, (number, joined)) in published.zip(SetNumber::each(numbers).zip(joined)) {
            self.progress.nodes += increment.configs.len() as u64;
            let SetName { strategy, ordinal } = self.name_of(number);
            sets.push(RoundSet { number, strategy, ordinal, increment, joined });
        }
        let round = self.round;
        let folded = Round { number: round, sets };
        self.plan.observe(&folded);
        commands.push(Command::Fold(folded));
        self.round = round.next();
        self.progress.rounds += 1;
        self.evaluate(round, commands);
        true
    }

    /// Hands out the evaluations of the last round.
    fn evaluate(&mut self, round: RoundNumber, commands: &mut Vec<Command>) {
        self.awaited = Some(BTreeMap::new());
        for evaluator in (0..self.evaluators).map(EvaluatorIndex) {
            self.submit(Job::Evaluate { round, evaluator }, commands);
        }
    }

    /// Hands out sets up to the lookahead, but none past the round that reaches a limit, and none
    /// whose strategy depends on rounds to come.
    fn generate(&mut self, commands: &mut Vec<Command>) {
        let current = self.current();
        while let Some(number) =
            self.waiting.front().copied().filter(|number| current.contains(number))
        {
            self.waiting.pop_front();
            self.submit_set(number, commands);
        }
        let end = (self.current().end + self.lookahead).min(self.plan.known_until());
        while self.next_generate < end {
            let number = self.next_generate;
            let round = self.plan.sets_of(self.plan.round_of(number));
            let enough = self.nodes_ahead >= self.limits.nodes || number.0 >= self.limits.sets;
            if number == round.start && enough {
                return;
            }
            if number == round.start {
                let nodes = |number| self.set_nodes[self.name_of(number).strategy.index()];
                self.nodes_ahead += SetNumber::each(round).map(nodes).sum::<u64>();
            }
            self.next_generate = number.next();
            let grows = self.grows[self.name_of(number).strategy.index()];
            if grows && !self.current().contains(&number) {
                self.waiting.push_back(number);
            } else {
                self.submit_set(number, commands);
            }
        }
    }

    fn submit_set(&mut self, number: SetNumber, commands: &mut Vec<Command>) {
        let SetName { strategy, ordinal } = self.name_of(number);
        self.submit(Job::Generate { number, strategy, ordinal }, commands);
    }

    fn submit(&mut self, job: Job, commands: &mut Vec<Command>) {
        let before = self.at_work.insert(job, 0);
        debug_assert!(before.is_none() && !self.done.contains_key(&job), "{job:?} twice");
        commands.push(Command::Submit(job));
    }

    /// The name of a set of the current round, or of one that was generated ahead.
    fn name_of(&self, number: SetNumber) -> SetName {
        self.plan.name_of(number).expect("nothing is generated where the schedule is not known")
    }

    /// Nodes of the roadmap at the start of the current round.
    fn folded(&self) -> u64 {
        self.progress.nodes
    }

    /// The sets of the current round.
    fn current(&self) -> Range<SetNumber> {
        self.plan.sets_of(self.round)
    }
}
