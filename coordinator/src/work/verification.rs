use super::difference;
use super::interrupt::Interrupt;
use super::replanned::check_parent;
use super::selection::{Choice, Selection};
use super::stops::Standing;
use super::workers::{Kind, Workers, start, start_agents};
use crate::dispatch::{Dispatcher, Staff};
use crate::exit::{Code, Failure};
use crate::run::ledger::{Chapter, Judged, job_name};
use crate::run::{Replay, Scan, Told};
use crate::signals::Signals;
use roadmill::evaluate::{EvaluatorKind, Verdict};
use roadmill::img::{
    Cut, Event, Executor, Finished, Job, LOSSES_MAX, Loss, Outcome, RoundSet, Setup, TICK, Threads,
};
use roadmill::internal::wire;
use roadmill::model::{Scratch, ValidityFunction, with_functions};
use roadmill::numbers::SetNumber;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Roadmap};
use roadmill::{BITS_VERSION, Cancel, Strategy};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Increments per worker that may be waited for while later rounds are read.
const AHEAD_PER_WORKER: usize = 4;

/// A run to be verified: see [`Run::verify`](super::Run::verify).
#[must_use = "nothing is verified before `check`"]
pub struct Verification {
    folder: PathBuf,
    selection: Selection,
    parent: Option<PathBuf>,
    workers: Workers,
    interrupt: Interrupt,
    function: Option<ValidityFunction>,
}

/// What a verification found to be as it is recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verified {
    /// Sets recomputed.
    pub sets: u64,
    /// Sets of the run.
    pub sets_recorded: u64,
    /// Judgements recomputed.
    pub judgements: u64,
    /// Those of them that are right for paths through the roadmap only: an earlier version of the program recorded them,
    /// which did not try the direct motion between a query's ends. This version would have judged otherwise.
    pub judgements_without_direct_motion: u64,
    /// Digest of the roadmap; `None` where there is no complete round.
    pub digest: Option<Digest>,
}

impl Verification {
    pub(super) fn new(folder: &Path, selection: Selection) -> Verification {
        let (workers, interrupt) = (Workers::default(), Interrupt::default());
        let (folder, function) = (folder.to_owned(), None);
        Verification { folder, selection, parent: None, workers, interrupt, function }
    }

    /// Who recomputes; a thread for every processor if nothing is said.
    pub fn workers(self, workers: &Workers) -> Verification {
        Verification { workers: workers.clone(), ..self }
    }

    /// Of a run that replans another: where that other run's folder is, if it is no longer where it was, from this run's
    /// own folder. A run that replans none has no use for it, and is refused.
    pub fn parent(self, folder: impl Into<PathBuf>) -> Verification {
        Verification { parent: Some(folder.into()), ..self }
    }

    /// The validity function of the run's problem, which the ledger only names.
    pub fn validity_function(self, function: &ValidityFunction) -> Verification {
        Verification { function: Some(function.clone()), ..self }
    }

    /// Ends when `cancel` says so, with a failure.
    pub fn cancel(mut self, cancel: &Cancel) -> Verification {
        self.interrupt.cancel = cancel.clone();
        self
    }

    /// Ends when a signal comes, with a failure.
    pub fn signals(mut self, signals: &Arc<Signals>) -> Verification {
        self.interrupt.signals = Some(signals.clone());
        self
    }

    /// Ends when what ends the work as a whole comes.
    pub(super) fn interrupt(self, interrupt: &Interrupt) -> Verification {
        Verification { interrupt: interrupt.clone(), ..self }
    }

    /// Recomputes and compares.
    ///
    /// # Errors
    /// Exit code 7: something is not as it is recorded, which the message names; 2: there is no run, a run that it replans
    /// is not found, it replans none and is given one, a set that is not in it was asked for, or the problem's validity function
    /// is missing or fails; 4: the run is damaged; 1: the system refuses; 5: the workers are lost; 6: it was
    /// ended before.
    pub fn check(self) -> Result<Verified, Failure> {
        let Verification { folder, selection, parent, workers, mut interrupt, function } = self;
        workers.check()?;
        let scan = Scan::read(&folder)?;
        let supplied = |problem: Problem| {
            let refuse = |why| Failure::usage(format!("{}: {why}", folder.display()));
            problem.supplied_with(function.as_ref()).map_err(refuse)
        };
        let problem = supplied(scan.problem()?)?;
        workers.check_for(&problem)?;
        interrupt.function = problem.validity_function().cloned();
        match (problem.survivors(), &parent) {
            (Some(_), parent) => check_parent(&folder, &scan.problem_of(0)?, parent.as_deref())?,
            (None, Some(parent)) => {
                return Err(Failure::usage(format!(
                    "{}: replans no other run; --parent {} found, none expected",
                    folder.display(),
                    parent.display()
                )));
            }
            (None, None) => {}
        }
        let choice = Choice::new(&selection, &scan, &problem)?;
        let mut counts = Counts::default();
        for stretch in stretches(&scan, problem)? {
            let setup = Arc::new(Setup::new(supplied(stretch.problem)?));
            let check = Check {
                scan: &scan,
                setup: &setup,
                supplied: &supplied,
                chapters: stretch.chapters,
                choice: &choice,
                interrupt: &interrupt,
                ahead: AHEAD_PER_WORKER * workers.count,
                at_work: BTreeMap::new(),
                difference: None,
                counts,
            };
            counts = match &workers.kind {
                Kind::Threads => {
                    let threads = Threads::start(setup.clone(), workers.count);
                    let mut threads = threads.map_err(|error| {
                        Failure::system(format!("cannot start the threads: {error}"))
                    })?;
                    with_functions(|| check.run(&mut threads)).map_err(Failure::usage)??
                }
                Kind::Processes(program) => {
                    let dispatcher = start(&setup, workers.count, program.as_ref());
                    check.dispatch(dispatcher.map_err(Failure::system)?)?
                }
                Kind::Agents(places, options) => {
                    let dispatcher = start_agents(&setup, places, options, &std::env::temp_dir());
                    check.dispatch(dispatcher.map_err(Failure::system)?)?
                }
            };
        }
        if choice.has_more_sets_than(counts.sets) {
            return Err(Failure::usage("--set: not every set that is named is in the run"));
        }
        let sets_recorded = scan.last_round.as_ref().map_or(0, |end| end.sets);
        let digest = scan.last_round.as_ref().map(|end| end.roadmap);
        Ok(Verified {
            sets: counts.sets,
            sets_recorded,
            judgements: counts.judgements,
            judgements_without_direct_motion: counts.without_direct_motion,
            digest,
        })
    }
}

/// Chapters whose sets are recomputed under one problem, that of the last of them.
struct Stretch {
    chapters: Range<usize>,
    problem: Problem,
}

/// The chapters of a run, whose last problem is `problem`, in stretches: the sets of a chapter are recomputed under the query that the
/// build then had. All chapters are one stretch where no set depends on the query.
fn stretches(scan: &Scan, problem: Problem) -> Result<Vec<Stretch>, Failure> {
    let mut stretches = vec![Stretch { chapters: 0..scan.chapters.len(), problem }];
    let reads = |known: &Strategy| known.generator().method().reads_query();
    if !stretches[0].problem.strategies().iter().any(reads) {
        return Ok(stretches);
    }
    // From the last to the first, of which each becomes one of its own where the query is another.
    for chapter in (0..scan.chapters.len() - 1).rev() {
        let problem = scan.problem_of(chapter)?;
        let later = &mut stretches[0];
        if problem.query() != later.problem.query() {
            later.chapters.start = chapter + 1;
            stretches.insert(0, Stretch { chapters: 0..chapter + 1, problem });
        }
    }
    Ok(stretches)
}

/// What was recomputed.
#[derive(Clone, Copy, Default)]
struct Counts {
    sets: u64,
    judgements: u64,
    /// Judgements that are right without the direct motion between a query's ends only.
    without_direct_motion: u64,
}

/// The sets and judgements of a stretch are recomputed; those before it are read, since what comes later depends on them.
struct Check<'a> {
    scan: &'a Scan,
    /// The problem of the stretch.
    setup: &'a Setup,
    /// A problem with its validity function, which the ledger only names.
    supplied: &'a dyn Fn(Problem) -> Result<Problem, Failure>,
    /// The chapters of the stretch.
    chapters: Range<usize>,
    choice: &'a Choice,
    interrupt: &'a Interrupt,
    ahead: usize,
    at_work: BTreeMap<Job, Recorded>,
    /// What differs first, in the order of the ledger.
    difference: Option<Difference>,
    counts: Counts,
}

/// A job whose outcome is in the ledger.
struct Recorded {
    outcome: Outcome,
    /// How many workers died at the job.
    deaths: u32,
}

/// Something that was recomputed and is not as it is recorded.
struct Difference {
    at: Position,
    /// What it is, for people.
    what: String,
}

/// Where in the order of the ledger something was recomputed.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Position {
    /// The set, or of a judgement or stop the first one after its round.
    set: SetNumber,
    part: Part,
}

/// What was recomputed, in the order in which it comes about.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Judgement,
    Stop,
    Increment,
    Joined,
    /// An outcome of another kind than the job's.
    Other,
}

impl Check<'_> {
    /// Runs the check by a dispatcher, and ends its staff.
    fn dispatch<S: Staff>(self, dispatcher: Dispatcher<S>) -> Result<Counts, Failure> {
        let mut dispatcher = match &self.interrupt.signals {
            Some(signals) => dispatcher.with_signals(signals.clone()),
            None => dispatcher,
        };
        let counts = self.run(&mut dispatcher);
        dispatcher.close().map_err(Failure::system)?;
        counts
    }

    fn run(mut self, executor: &mut impl Executor) -> Result<Counts, Failure> {
        let mut replay = Replay::new(self.scan, self.setup.problem())?.to_end_of(self.chapters.end);
        // The problem of the chapter in which the build was judged last, and what was said.
        let mut judge: Option<(usize, Setup)> = None;
        let mut verdicts = Vec::new();
        let space = self.setup.context().space();
        // For the judgements; sets are recomputed by those who have a roadmap of their own.
        let mut roadmap = self.choice.has_judgements().then(|| Roadmap::new(space));
        while let Some(told) = replay.read()? {
            let chapter = replay.chapter();
            let is_own = self.chapters.contains(&chapter);
            match told {
                Told::Round(round, digest) => {
                    verdicts.clear();
                    for set in &round.sets {
                        executor.publish(&set.increment);
                        if is_own {
                            self.hand_out(set, chapter, executor)?;
                        }
                    }
                    // A fold takes away what these jobs read.
                    while self.readers() > 0 || self.at_work.len() > self.ahead {
                        self.take(executor)?;
                    }
                    executor.fold(&round);
                    replay.check(executor.tally(), digest)?;
                    if let Some(roadmap) = &mut roadmap {
                        roadmap.fold_round(space, round.parts());
                    }
                }
                Told::Judged(judged) => {
                    if is_own && self.choice.has_judgement(judged.round) {
                        let setup = self.chapter(chapter, &mut judge)?;
                        if let Some(roadmap) = &roadmap {
                            self.judge(&judged, setup, chapter, roadmap)?;
                        }
                    }
                    verdicts = judged.verdicts;
                }
                Told::Stopped(stopped) => {
                    if let (true, Choice::All, Some(roadmap)) = (is_own, self.choice, &roadmap) {
                        needs_bits("the stop", &self.scan.chapters[chapter])?;
                        let setup = self.chapter(chapter, &mut judge)?;
                        let last_round = replay.last_round();
                        let standing = Standing { setup, last_round, verdicts: &verdicts, roadmap };
                        if let Some(what) = standing.difference(&stopped) {
                            let set = SetNumber(last_round.map_or(0, |end| end.sets));
                            self.note(Position { set, part: Part::Stop }, what);
                        }
                    }
                }
            }
            if self.difference.is_some() {
                break;
            }
        }
        while !self.at_work.is_empty() {
            self.take(executor)?;
        }
        match self.difference {
            Some(Difference { what, .. }) => {
                let run = self.scan.folder().display();
                Err(Failure::new(Code::Differs, format!("{run}: {what}")))
            }
            None => Ok(self.counts),
        }
    }

    /// The problem of a chapter, made ready for work if that was not done.
    fn chapter<'b>(
        &self,
        chapter: usize,
        known: &'b mut Option<(usize, Setup)>,
    ) -> Result<&'b mut Setup, Failure> {
        if let Some((index, _)) = known
            && *index != chapter
        {
            *known = None;
        }
        let (_, setup) = match known {
            Some(known) => known,
            None => {
                let problem = (self.supplied)(self.scan.problem_of(chapter)?)?;
                known.insert((chapter, Setup::new(problem)))
            }
        };
        Ok(setup)
    }

    /// Has a set recomputed if it is chosen.
    fn hand_out(
        &mut self,
        set: &RoundSet,
        chapter: usize,
        executor: &mut impl Executor,
    ) -> Result<(), Failure> {
        let label = self.setup.problem().strategies()[set.strategy.index()].label();
        if !self.choice.has_set(set, label) {
            return Ok(());
        }
        needs_bits(&format!("set {label}:{}", set.ordinal), &self.scan.chapters[chapter])?;
        let RoundSet { number, strategy, ordinal, .. } = *set;
        let increment = Outcome::Increment(Ok((*set.increment).clone()));
        let joined = Outcome::Joined(set.joined.clone());
        for (job, outcome) in [
            (Job::Generate { number, strategy, ordinal }, increment),
            (Job::Join { number, strategy, ordinal }, joined),
        ] {
            self.at_work.insert(job, Recorded { outcome, deaths: 0 });
            executor.submit(job);
        }
        self.counts.sets += 1;
        Ok(())
    }

    /// Jobs at work that read the roadmap at the start of the round.
    fn readers(&self) -> usize {
        let reads = |job: &&Job| match **job {
            Job::Join { .. } => true,
            Job::Generate { strategy, .. } => self.setup.grows(strategy),
            Job::Evaluate { .. } => false,
        };
        self.at_work.keys().filter(reads).count()
    }

    /// Takes in what comes next from the executor.
    fn take(&mut self, executor: &mut impl Executor) -> Result<(), Failure> {
        self.interrupt.check()?;
        match executor.next(TICK) {
            Some(Event::Done(job, finished)) => {
                if let Some(recorded) = self.at_work.remove(&job) {
                    self.compare(job, &recorded.outcome, &finished);
                }
            }
            Some(Event::Lost(job, loss)) => {
                if let Some(recorded) = self.at_work.get_mut(&job) {
                    recorded.deaths += u32::from(loss == Loss::Death);
                    if recorded.deaths >= LOSSES_MAX {
                        let name = job_name(job, self.setup.problem());
                        let message = format!("{name} killed its workers");
                        return Err(Failure::new(Code::WorkersLost, message));
                    }
                    executor.submit(job);
                }
            }
            Some(Event::Contradiction(job, by)) => {
                let name = job_name(job, self.setup.problem());
                let message = format!("{name} gave two different outcomes: {by}");
                return Err(Failure::new(Code::BrokenRun, message));
            }
            Some(Event::Cut(Cut::WorkersLost(why))) => {
                return Err(Failure::new(Code::WorkersLost, why));
            }
            Some(Event::Cut(cut)) => {
                return Err(Failure::new(Code::WorkersLost, format!("{cut:?}")));
            }
            None => {}
        }
        Ok(())
    }

    fn compare(&mut self, job: Job, expected: &Outcome, finished: &Finished) {
        if Digest::of(&wire::encode(expected)) == finished.digest {
            return;
        }
        let (set, part, found) = match (job, expected, &finished.outcome) {
            (
                Job::Generate { number, .. },
                Outcome::Increment(Ok(recorded)),
                Outcome::Increment(Ok(found)),
            ) => {
                let found =
                    difference::of_increments(self.setup.context().space(), recorded, found);
                (number, Part::Increment, found)
            }
            (Job::Generate { number, .. }, _, Outcome::Increment(Err(gave_up))) => {
                (number, Part::Increment, Some(format!("a set and none: {gave_up}")))
            }
            (Job::Join { number, .. }, Outcome::Joined(recorded), Outcome::Joined(found)) => {
                (number, Part::Joined, difference::of_joins(recorded, found))
            }
            (Job::Generate { number, .. } | Job::Join { number, .. }, _, _) => {
                (number, Part::Other, None)
            }
            (Job::Evaluate { .. }, _, _) => return,
        };
        let found = found.unwrap_or_else(|| "what was recomputed is no such thing".to_owned());
        let name = job_name(job, self.setup.problem());
        let at = Position { set, part };
        self.note(at, format!("{name}: recorded and recomputed differ: {found}"));
    }

    fn judge(
        &mut self,
        judged: &Judged,
        judge: &mut Setup,
        chapter: usize,
        roadmap: &Roadmap,
    ) -> Result<(), Failure> {
        let name = format!("the judgement of round {}", judged.round);
        needs_bits(&name, &self.scan.chapters[chapter])?;
        self.counts.judgements += 1;
        if let Some(found) = difference::of_verdicts(&judged.verdicts, &verdicts(judge, roadmap)) {
            // No version of the program or of its bits tells apart who tried the direct motion.
            judge.context_mut().try_direct_motion(false);
            let earlier = verdicts(judge, roadmap);
            judge.context_mut().try_direct_motion(true);
            if difference::of_verdicts(&judged.verdicts, &earlier).is_none() {
                self.counts.without_direct_motion += 1;
                return Ok(());
            }
            let set = self.setup.plan().sets_of(judged.round).end;
            let at = Position { set, part: Part::Judgement };
            self.note(at, format!("{name}: recorded and recomputed differ: {found}"));
        }
        Ok(())
    }

    fn note(&mut self, at: Position, what: String) {
        if self.difference.as_ref().is_none_or(|first| at < first.at) {
            self.difference = Some(Difference { at, what });
        }
    }
}

/// What the evaluators of a problem say of a roadmap.
fn verdicts(judge: &Setup, roadmap: &Roadmap) -> Vec<Verdict> {
    let evaluators = judge.problem().evaluators().iter().enumerate();
    let verdict = |(index, evaluator): (usize, &EvaluatorKind)| {
        evaluator.method().evaluate(
            judge.context(),
            &index.to_string(),
            roadmap,
            &mut Scratch::new(),
        )
    };
    evaluators.map(verdict).collect()
}

/// Whether this program makes the bits of a chapter.
fn needs_bits(what: &str, chapter: &Chapter) -> Result<(), Failure> {
    let Chapter { bits_version: bits, program, .. } = chapter;
    if *bits == BITS_VERSION {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{what} needs a roadmill with bits of version {bits}, as roadmill {program} has; this one has \
         version {BITS_VERSION}"
    )))
}
