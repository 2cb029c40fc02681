use super::difference;
use super::interrupt::Interrupt;
use super::stops::Standing;
use super::workers::{Kind, Workers, start};
use crate::exit::{Code, Failure};
use crate::run::ledger::{Chapter, Judged, job_name};
use crate::run::{Replay, Scan, Told};
use crate::signals::Signals;
use roadmill::img::{
    Cut, Event, Executor, Finished, Job, LOSSES_MAX, Loss, Outcome, RoundSet, Setup, TICK, Threads,
};
use roadmill::internal::wire;
use roadmill::model::Scratch;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Roadmap};
use roadmill::{BITS_VERSION, Cancel};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The share that is recomputed unless something else is asked for.
const DEFAULT_SHARE: f64 = 0.01;
/// Increments per worker that may be waited for while later rounds are read.
const AHEAD_PER_WORKER: usize = 4;

/// What is recomputed.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// Everything.
    All,
    /// A share of all sets and judgements, from 0 to 1, at least one set. Which follows from the ledger's hash.
    Share(f64),
    /// These sets, each as `LABEL:ORDINAL`.
    Sets(Vec<String>),
}

/// One set or judgement in a hundred.
impl Default for Selection {
    fn default() -> Selection {
        Selection::Share(DEFAULT_SHARE)
    }
}

/// A run to be verified: see [`Run::verify`](super::Run::verify).
#[must_use = "nothing is verified before `check`"]
pub struct Verification {
    folder: PathBuf,
    selection: Selection,
    workers: Workers,
    interrupt: Interrupt,
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
    /// Digest of the roadmap; `None` where there is no complete round.
    pub digest: Option<Digest>,
}

impl Verification {
    pub(super) fn new(folder: &Path, selection: Selection) -> Verification {
        let (workers, interrupt) = (Workers::default(), Interrupt::default());
        Verification { folder: folder.to_owned(), selection, workers, interrupt }
    }

    /// Who recomputes; a thread for every processor if nothing is said.
    pub fn workers(self, workers: &Workers) -> Verification {
        Verification { workers: workers.clone(), ..self }
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

    /// Recomputes and compares.
    ///
    /// # Errors
    /// Exit code 7: something is not as it is recorded, which the message names; 2: there is no run, or a set that is
    /// not in it was asked for; 4: the run is damaged; 1: the system refuses; 5: the workers are lost; 6: it was
    /// ended before.
    pub fn check(self) -> Result<Verified, Failure> {
        let Verification { folder, selection, workers, interrupt } = self;
        workers.check()?;
        let scan = Scan::read(&folder)?;
        let problem = scan.problem()?;
        let choice = Choice::new(&selection, &scan, &problem)?;
        let setup = Arc::new(Setup::new(problem));
        let check = Check {
            scan: &scan,
            setup: &setup,
            choice,
            interrupt: &interrupt,
            ahead: AHEAD_PER_WORKER * workers.count,
            at_work: BTreeMap::new(),
            difference: None,
            counts: (0, 0),
        };
        let (sets, judgements) = match &workers.kind {
            Kind::Threads => {
                let threads = Threads::start(setup.clone(), workers.count).map_err(|error| {
                    Failure::system(format!("cannot start the threads: {error}"))
                })?;
                check.run(&mut { threads })?
            }
            Kind::Processes(program) => {
                let mut dispatcher =
                    start(&setup, workers.count, program.as_ref()).map_err(Failure::system)?;
                if let Some(signals) = &interrupt.signals {
                    dispatcher = dispatcher.with_signals(signals.clone());
                }
                let counts = check.run(&mut dispatcher);
                dispatcher.close().map_err(Failure::system)?;
                counts?
            }
        };
        let sets_recorded = scan.last_round.as_ref().map_or(0, |end| end.sets);
        let digest = scan.last_round.as_ref().map(|end| end.roadmap);
        Ok(Verified { sets, sets_recorded, judgements, digest })
    }
}

/// What is recomputed of a run.
enum Choice {
    All,
    /// Sets by label and ordinal.
    Named(BTreeSet<(String, u64)>),
    /// A share; which follows from the ledger's hash.
    Share(f64, Digest),
    /// As the least share: this place.
    One(u64),
}

impl Choice {
    fn new(selection: &Selection, scan: &Scan, problem: &Problem) -> Result<Choice, Failure> {
        let share = match selection {
            Selection::All => return Ok(Choice::All),
            Selection::Sets(names) => return Choice::named(names, problem),
            Selection::Share(share) => *share,
        };
        let sets = scan.last_round.as_ref().map_or(0, |end| end.sets);
        let lots = (0..sets).map(|place| (lot(&scan.end.chain, b"set", place), place));
        Ok(match lots.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((least, place)) if least >= share => Choice::One(place),
            _ => Choice::Share(share, scan.end.chain),
        })
    }

    fn named(names: &[String], problem: &Problem) -> Result<Choice, Failure> {
        let known = |label: &str| problem.strategies.iter().any(|known| known.label == label);
        let parse = |text: &String| {
            let (label, ordinal) = text.rsplit_once(':')?;
            known(label).then_some((label.to_owned(), ordinal.parse().ok()?))
        };
        let parse = |text| {
            parse(text).ok_or_else(|| {
                let labels: Vec<_> = problem.strategies.iter().map(|s| &*s.label).collect();
                let labels = labels.join(", ");
                let expected = format!("LABEL:ORDINAL expected, with a label of {labels}");
                Failure::usage(format!("--set: `{text}` found; {expected}"))
            })
        };
        names.iter().map(parse).collect::<Result<_, _>>().map(Choice::Named)
    }

    fn has_set(&self, set: &RoundSet, label: &str) -> bool {
        match self {
            Choice::All => true,
            Choice::Named(names) => names.contains(&(label.to_owned(), set.ordinal)),
            Choice::Share(share, chain) => lot(chain, b"set", set.place) < *share,
            Choice::One(place) => set.place == *place,
        }
    }

    /// Whether any judgement may be recomputed.
    fn has_judgements(&self) -> bool {
        matches!(self, Choice::All | Choice::Share(..))
    }

    fn has_judgement(&self, round: u64) -> bool {
        match self {
            Choice::All => true,
            Choice::Share(share, chain) => lot(chain, b"judgement", round) < *share,
            Choice::Named(_) | Choice::One(_) => false,
        }
    }
}

/// A number in `[0, 1)` that looks drawn by lot.
fn lot(chain: &Digest, what: &[u8], number: u64) -> f64 {
    let bytes = [&chain.0, what, &number.to_le_bytes()].concat();
    let [a, b, c, d, e, f, ..] = Digest::of(&bytes).0;
    u64::from_le_bytes([a, b, c, d, e, f, 0, 0]) as f64 / (1u64 << 48) as f64
}

struct Check<'a> {
    scan: &'a Scan,
    setup: &'a Setup,
    choice: Choice,
    interrupt: &'a Interrupt,
    ahead: usize,
    /// What each job should come to, and how many workers died at it.
    at_work: BTreeMap<Job, (Outcome, u32)>,
    /// The first job, in the order of the ledger, that came to something else.
    difference: Option<((u64, u8), String)>,
    /// Sets and judgements recomputed.
    counts: (u64, u64),
}

impl Check<'_> {
    fn run(mut self, executor: &mut impl Executor) -> Result<(u64, u64), Failure> {
        let mut replay = Replay::new(self.scan, &self.setup.problem)?;
        // The problem of the chapter in which the build was judged last, and what was said.
        let mut judge: Option<(usize, Setup)> = None;
        let mut verdicts = Vec::new();
        let space = &self.setup.cx.space;
        // For the judgements; sets are recomputed by those who have a roadmap of their own.
        let mut roadmap = self.choice.has_judgements().then(|| Roadmap::new(space));
        while let Some(told) = replay.read()? {
            match told {
                Told::Round(round, digest) => {
                    verdicts.clear();
                    let chapter = replay.chapter();
                    for set in &round.sets {
                        executor.publish(&set.increment);
                        self.hand_out(set, chapter, executor)?;
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
                    if self.choice.has_judgement(judged.round) {
                        let chapter = self.chapter(replay.chapter(), &mut judge)?;
                        if let Some(roadmap) = &roadmap {
                            self.judge(&judged, chapter, replay.chapter(), roadmap)?;
                        }
                    }
                    verdicts = judged.verdicts;
                }
                Told::Stopped(stopped) => {
                    if let (Choice::All, Some(roadmap)) = (&self.choice, &roadmap) {
                        needs_bits("the stop", &self.scan.chapters[replay.chapter()])?;
                        let setup = self.chapter(replay.chapter(), &mut judge)?;
                        let last_round = replay.last_round();
                        let standing = Standing { setup, last_round, verdicts: &verdicts, roadmap };
                        if let Some(what) = standing.difference(&stopped) {
                            let places = last_round.map_or(0, |end| end.sets);
                            self.note((places, 1), what);
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
        match (self.difference, self.choice) {
            (Some((_, what)), _) => {
                let run = self.scan.folder().display();
                Err(Failure::new(Code::Differs, format!("{run}: {what}")))
            }
            (None, Choice::Named(names)) if self.counts.0 < names.len() as u64 => {
                Err(Failure::usage("--set: not every set that is named is in the run"))
            }
            (None, _) => Ok(self.counts),
        }
    }

    /// The problem of a chapter, made ready for work if that was not done.
    fn chapter<'b>(
        &self,
        chapter: usize,
        known: &'b mut Option<(usize, Setup)>,
    ) -> Result<&'b Setup, Failure> {
        if let Some((index, _)) = known
            && *index != chapter
        {
            *known = None;
        }
        let (_, setup) = match known {
            Some(known) => known,
            None => known.insert((chapter, Setup::new(self.scan.problem_of(chapter)?))),
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
        let label = &self.setup.problem.strategies[set.strategy as usize].label;
        if !self.choice.has_set(set, label) {
            return Ok(());
        }
        needs_bits(&format!("set {label}:{}", set.ordinal), &self.scan.chapters[chapter])?;
        let RoundSet { place, strategy, ordinal, .. } = *set;
        let increment = Outcome::Increment(Ok((*set.increment).clone()));
        let joined = Outcome::Joined(set.joined.clone());
        for (job, outcome) in [
            (Job::Generate { place, strategy, ordinal }, increment),
            (Job::Join { place, strategy, ordinal }, joined),
        ] {
            self.at_work.insert(job, (outcome, 0));
            executor.submit(job);
        }
        self.counts.0 += 1;
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
                if let Some((expected, _)) = self.at_work.remove(&job) {
                    self.compare(job, &expected, &finished);
                }
            }
            Some(Event::Lost(job, loss)) => {
                if let Some((_, deaths)) = self.at_work.get_mut(&job) {
                    *deaths += u32::from(loss == Loss::Death);
                    if *deaths >= LOSSES_MAX {
                        let name = job_name(job, &self.setup.problem);
                        let message = format!("{name} killed its workers");
                        return Err(Failure::new(Code::WorkersLost, message));
                    }
                    executor.submit(job);
                }
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
        let (at, found) = match (job, expected, &finished.outcome) {
            (
                Job::Generate { place, .. },
                Outcome::Increment(Ok(recorded)),
                Outcome::Increment(Ok(found)),
            ) => {
                let found = difference::of_increments(&self.setup.cx.space, recorded, found);
                ((place, 0), found)
            }
            (Job::Generate { place, .. }, _, Outcome::Increment(Err(gave_up))) => {
                ((place, 0), Some(format!("a set and none: {gave_up}")))
            }
            (Job::Join { place, .. }, Outcome::Joined(recorded), Outcome::Joined(found)) => {
                ((place, 1), difference::of_joins(recorded, found))
            }
            (Job::Generate { place, .. } | Job::Join { place, .. }, _, _) => ((place, 2), None),
            (Job::Evaluate { .. }, _, _) => return,
        };
        let found = found.unwrap_or_else(|| "what was recomputed is no such thing".to_owned());
        let name = job_name(job, &self.setup.problem);
        self.note(at, format!("{name}: recorded and recomputed differ: {found}"));
    }

    fn judge(
        &mut self,
        judged: &Judged,
        judge: &Setup,
        chapter: usize,
        roadmap: &Roadmap,
    ) -> Result<(), Failure> {
        let name = format!("the judgement of round {}", judged.round);
        needs_bits(&name, &self.scan.chapters[chapter])?;
        let evaluators = judge.problem.evaluators.iter().enumerate();
        let verdicts: Vec<_> = evaluators
            .map(|(index, evaluator)| {
                let method = evaluator.method();
                let scratch = &mut Scratch::new();
                method.evaluate(&judge.cx, &index.to_string(), roadmap, scratch)
            })
            .collect();
        self.counts.1 += 1;
        if let Some(found) = difference::of_verdicts(&judged.verdicts, &verdicts) {
            let at = (self.setup.plan.places_of(judged.round).end, 0);
            self.note(at, format!("{name}: recorded and recomputed differ: {found}"));
        }
        Ok(())
    }

    fn note(&mut self, at: (u64, u8), what: String) {
        if self.difference.as_ref().is_none_or(|(first, _)| at < *first) {
            self.difference = Some((at, what));
        }
    }
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
