use super::interrupt::Interrupt;
use super::{Ended, Run};
use crate::cpu::CpuClock;
use crate::dispatch::{Board, Dispatcher, Machine, Machines, SetsFromFiles, Staff};
use crate::exit::Failure;
use crate::files::write_whole;
use crate::memory::resident_bytes;
use crate::output::{Plain, note};
use crate::run::{
    CoordinatorCpu, LedgerWriter, PATH_CSV, Replay, RunFolder, SUMMARY_JSON, Scan, SetFiles,
    Stopped, Summary, Times, Told,
};
use roadmill::evaluate::Verdict;
use roadmill::export::path_csv;
use roadmill::img::{
    Core, Cut, Executor, Judgement, Observer, Past, Progress, Round, Setup, Stop, drive,
};
use roadmill::problem::Problem;
use roadmill::query::Path;
use roadmill::roadmap::Tally;
use std::path::{Path as FilePath, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// Sets per worker that may be generated ahead of the current round. Where sets are short these are some
/// milliseconds of work for each worker, so that no worker has to wait for the end of a round.
const LOOKAHEAD_PER_WORKER: u64 = 8;
/// Between two times that the memory of all processes is added up, which takes a while.
const MEMORY_PAUSE: Duration = Duration::from_secs(1);

/// Between two times that what the machines do is written to a file.
const MACHINES_PAUSE: Duration = Duration::from_secs(2);

/// Whoever is told how a build goes. All of it is called from the thread that grows the roadmap, which waits.
pub trait Watch {
    /// The build begins.
    fn begun(&mut self, _begun: &Begun) {}

    /// Called between events, at least five times a second.
    fn progress(&mut self, _status: &Status) {}
}

/// Nobody.
impl Watch for () {}

/// How a build begins.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Begun<'a> {
    /// A new one.
    Anew {
        /// The problem.
        problem: &'a Problem,
        /// The run folder.
        folder: &'a FilePath,
        /// Sets that are read from files when they are needed.
        imported: usize,
    },
    /// One that goes on.
    Again {
        /// The problem.
        problem: &'a Problem,
        /// The run folder.
        folder: &'a FilePath,
        /// Complete rounds that are there.
        rounds: u64,
        /// Nodes that are there.
        nodes: u64,
        /// Whether a chapter is opened for what is changed.
        is_chapter: bool,
        /// What there was of an unfinished round.
        torn: Option<Torn<'a>>,
    },
}

/// What an interrupted build left of an unfinished round.
#[derive(Clone, Copy, Debug)]
pub struct Torn<'a> {
    /// Number of bytes.
    pub bytes: u64,
    /// The file that they were moved to.
    pub file: &'a FilePath,
}

/// How far a build is.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Status<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// How far sets, rounds and verdicts are.
    pub progress: &'a Progress,
    /// What the roadmap comes to.
    pub tally: &'a Tally,
    /// Workers that are ready or at work.
    pub workers_alive: usize,
    /// How many workers there are to be.
    pub workers_wanted: usize,
    /// What each machine does, where agents of several do the work.
    pub machines: &'a [Machine],
    /// Whether the limit of time is reached, and the build goes on only until a round is finished and judged.
    pub is_late: bool,
}

/// The path of the problem's own query, if the verdicts have one.
pub(super) fn path_in(verdicts: &[Verdict]) -> Option<Path> {
    let answers = verdicts.iter().filter_map(Verdict::answer);
    answers.filter_map(|answer| answer.path.clone()).next()
}

/// Why a build stopped, what the roadmap came to, and CPU seconds for messages and for folds, where they are known.
pub(super) type Driven = (Stop, Tally, Option<(f64, f64)>);

/// Watches a build: writes its ledger, reports how far the build is, and ends it when time is up, memory is
/// short or a signal comes.
pub(super) struct Keeper<'a> {
    pub setup: Arc<Setup>,
    pub ledger: LedgerWriter,
    pub watch: &'a mut dyn Watch,
    pub interrupt: Interrupt,
    pub workers: usize,
    pub cpu: CpuClock,
    /// When this call began. What is done before the first round counts, too: the ledger is begun then, or read.
    pub begun: Instant,
    pub verdicts: Vec<Verdict>,
    pub seconds: Option<f64>,
    pub memory: Option<u64>,
    /// Complete rounds.
    pub rounds: u64,
    /// Whether a limit of time or memory may end the build now: since it was begun or went on a round was finished and
    /// judged, and no later one awaits its judgement. So every call comes on, however short its time.
    pub may_stop: bool,
    pub weighed: Weighed,
    /// CPU seconds of the calls that grew the run before; `None` where they are not known.
    pub cpu_seconds_before: Option<f64>,
    /// Bytes stored for the workers in shared memory, which count as no process's own.
    pub stored: Arc<AtomicU64>,
    /// What each machine does, where there are several.
    pub board: Option<Board>,
    /// Where it is written for other programs, and when that was done last.
    pub machines_file: PathBuf,
    pub machines_written: Option<Instant>,
}

/// When the memory was added up last.
#[derive(Clone, Copy)]
pub(super) struct Weighed {
    /// How many rounds were complete.
    pub after_rounds: u64,
    pub at: Option<Instant>,
}

impl Keeper<'_> {
    pub fn drive(
        &mut self,
        past: Option<&Scan>,
        executor: &mut SetsFromFiles<impl Executor>,
    ) -> Result<Stop, Failure> {
        let past = match past {
            Some(scan) => self.restore(scan, executor)?,
            None => Past::new(&self.setup),
        };
        let lookahead = LOOKAHEAD_PER_WORKER * self.workers as u64;
        let mut core = Core::resume(&self.setup, lookahead, past);
        let stop = drive(&mut core, executor, self)?;
        executor.take_failure().map_or(Ok(stop), Err)
    }

    /// Drives the build by a dispatcher, and ends its staff; why the build stopped, what the roadmap came to, and the
    /// dispatcher's CPU seconds for messages and for folds.
    pub fn dispatch<S: Staff>(
        &mut self,
        dispatcher: Dispatcher<S>,
        folder: &mut RunFolder,
        past: Option<&Scan>,
        imports: SetFiles,
    ) -> Result<Driven, Failure> {
        let dispatcher = match self.interrupt.signals.clone() {
            Some(signals) => dispatcher.with_signals(signals),
            None => dispatcher,
        };
        folder.begun()?;
        self.stored = dispatcher.stored_bytes();
        self.board = dispatcher.board();
        let mut dispatcher = SetsFromFiles::new(dispatcher, imports);
        let stop = self.drive(past, &mut dispatcher);
        // Closed before a failure is returned, too: the workers have to end before their channel does.
        let (tally, dispatcher) = (dispatcher.tally().clone(), dispatcher.into_inner());
        let seconds = (dispatcher.message_seconds(), dispatcher.fold_seconds());
        if let Err(error) = dispatcher.close() {
            let name = Plain(self.setup.problem().name());
            note(format_args!("{name}: {error}; the next run tries again"));
        }
        Ok((stop?, tally, Some(seconds)))
    }

    /// Folds the rounds that the ledger has already.
    fn restore(&self, scan: &Scan, executor: &mut impl Executor) -> Result<Past, Failure> {
        let mut replay = Replay::new(scan, self.setup.problem())?;
        let mut past = Past::new(&self.setup);
        while let Some(told) = replay.read()? {
            if let Told::Round(round, digest) = told {
                executor.restore(&round);
                replay.check(executor.tally(), digest)?;
                past.fold(&round);
            }
            self.interrupt.check()?;
        }
        past.verdicts.clone_from(&scan.verdicts);
        Ok(past)
    }

    /// Writes the summary and the ledger's last record, and reports them. `dispatch_seconds` are the CPU seconds
    /// that the dispatcher spent on messages and on folds, where there was one.
    pub fn end(
        mut self,
        folder: &RunFolder,
        stop: &Stop,
        tally: &Tally,
        dispatch_seconds: Option<(f64, f64)>,
    ) -> Result<Ended, Failure> {
        let problem = self.setup.problem();
        let mut stopped = Stopped::new(stop, problem);
        if *stop == Stop::Cut(Cut::Interrupted) {
            self.interrupt.reason().clone_into(&mut stopped.reason);
        }
        let path = path_in(&self.verdicts);
        if let Some(path) = &path {
            write_whole(&folder.file(PATH_CSV), path_csv(self.setup.context().space(), path))?;
        }
        let coordinator_cpu_seconds = self.cpu.own_seconds();
        let coordinator_cpu = dispatch_seconds.map(|(messages, fold)| {
            let ledger = self.ledger.cpu_seconds();
            let rest = coordinator_cpu_seconds - messages - fold - ledger;
            CoordinatorCpu { messages, fold, ledger, rest }
        });
        let cpu_seconds = coordinator_cpu_seconds + self.cpu.children_seconds();
        let times = Times {
            cpu_seconds,
            run_cpu_seconds: self.cpu_seconds_before.map(|before| before + cpu_seconds),
            coordinator_cpu_seconds,
            coordinator_cpu,
            wall_seconds: self.begun.elapsed().as_secs_f64(),
            ledger_seconds: self.ledger.seconds(),
        };
        let mut summary =
            Summary::new(problem, folder.path(), tally, &self.verdicts, &stopped, times);
        if let Some(board) = &self.board {
            let machines = board.lock().unwrap_or_else(PoisonError::into_inner).clone();
            summary.set_machines(machines);
            // What it says of the machines stands in the summary.
            let _ = std::fs::remove_file(&self.machines_file);
        }
        let text = serde_json::to_string_pretty(&summary).map_err(Failure::system)?;
        write_whole(&folder.file(SUMMARY_JSON), text + "\n")?;
        // Written last: a build that is killed before this has no end in its ledger and can go on to here again.
        self.ledger.stopped(&stopped)?;
        Ok(Ended {
            run: Run::at(folder.path()),
            problem: problem.clone(),
            stopped,
            rounds: self.rounds,
            digest: tally.digest(),
            path,
            summary: Some(summary),
        })
    }

    /// What each machine does, which is written for other programs now and then.
    fn write_machines(&mut self) -> Machines {
        let Some(board) = &self.board else { return Machines::default() };
        let machines = board.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if self.machines_written.is_none_or(|written| written.elapsed() >= MACHINES_PAUSE) {
            self.machines_written = Some(Instant::now());
            if let Ok(text) = serde_json::to_string_pretty(&machines) {
                // A build does not end because nobody can be told how it goes.
                let _ = write_whole(&self.machines_file, text + "\n");
            }
        }
        machines
    }

    /// Whether memory is short. Added up once after a round, since only rounds make the roadmap larger.
    fn is_short_of_memory(&mut self, rounds: u64) -> bool {
        let Weighed { after_rounds, at } = self.weighed;
        let Some(limit) = self.memory.filter(|_| after_rounds < rounds) else { return false };
        if at.is_some_and(|at| at.elapsed() < MEMORY_PAUSE) {
            return false;
        }
        self.weighed = Weighed { after_rounds: rounds, at: Some(Instant::now()) };
        resident_bytes() + self.stored.load(Ordering::Relaxed) >= limit
    }
}

impl Observer for Keeper<'_> {
    type Error = Failure;

    fn folded(&mut self, round: &Round, tally: &Tally) -> Result<(), Failure> {
        self.rounds = round.number.0 + 1;
        self.may_stop = false;
        self.ledger.round(round, self.setup.problem(), tally)
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        self.verdicts = judgement.verdicts.clone();
        self.may_stop = true;
        self.ledger.judged(judgement)
    }

    fn tick(
        &mut self,
        progress: &Progress,
        tally: &Tally,
        alive: usize,
    ) -> Result<Option<Cut>, Failure> {
        self.ledger.sync_if_due()?;
        let machines = self.write_machines();
        let is_over = self.seconds.is_some_and(|limit| self.begun.elapsed().as_secs_f64() >= limit);
        self.watch.progress(&Status {
            problem: self.setup.problem(),
            progress,
            tally,
            workers_alive: alive,
            workers_wanted: self.workers,
            machines: &machines.machines,
            is_late: is_over && !self.may_stop,
        });
        Ok(if self.interrupt.came() {
            Some(Cut::Interrupted)
        } else if !self.may_stop {
            None
        } else if is_over {
            Some(Cut::Time)
        } else if self.is_short_of_memory(progress.rounds) {
            self.memory.map(Cut::Memory)
        } else {
            None
        })
    }
}
