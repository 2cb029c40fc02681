//! What `build` and `resume` share: growing a roadmap from its beginning, or from where a run stopped.

use super::write_whole;
use crate::cli::{CrewArguments, GrowthArguments};
use crate::cpu::CpuClock;
use crate::crew::{CrewError, Executable, LocalCrew};
use crate::dispatch::{Dispatcher, Imported};
use crate::exit::{Code, Failure};
use crate::memory::resident_bytes;
use crate::progress::{Reporter, print_json};
use crate::run::{
    CoordinatorCpu, LedgerWriter, Replay, RunFolder, Scan, SetFiles, Stopped, Summary, Times, Told,
};
use crate::signals::Signals;
use roadmill::evaluate::Verdict;
use roadmill::export::path_csv;
use roadmill::img::{
    Core, Cut, Executor, Judgement, Observer, Past, Progress, Round, Setup, Stop, Threads, drive,
};
use roadmill::problem::Problem;
use roadmill::roadmap::Tally;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The most worker processes or threads.
const WORKERS_MAX: usize = 4096;
/// Sets per worker that may be generated ahead of the current round. Where sets are short these are some
/// milliseconds of work for each worker, so that no worker has to wait for the end of a round.
const LOOKAHEAD_PER_WORKER: u64 = 8;
/// Between two times that the memory of all processes is added up, which takes a while.
const MEMORY_PAUSE: Duration = Duration::from_secs(1);

/// A roadmap to be grown, and by whom.
pub(super) struct Growth<'a> {
    pub problem: Problem,
    pub folder: RunFolder,
    pub ledger: LedgerWriter,
    /// The ledger as it was found, where a build goes on. Its verdicts are by the evaluators of `problem`.
    pub past: Option<Scan>,
    /// Files of sets, which are read instead of being generated.
    pub imports: SetFiles,
    pub arguments: &'a GrowthArguments,
    pub workers: usize,
    pub signals: Arc<Signals>,
    pub cpu: CpuClock,
}

impl Growth<'_> {
    /// Grows the roadmap until the build stops; the exit code.
    pub fn grow(self) -> Result<Code, Failure> {
        let Growth { mut folder, past, imports, arguments, workers, signals, .. } = self;
        let verdicts = past.as_ref().and_then(|past| past.verdicts.clone()).unwrap_or_default();
        let setup = Arc::new(Setup::new(self.problem));
        let mut watch = Watch {
            setup: setup.clone(),
            ledger: self.ledger,
            reporter: Reporter::new(arguments.json),
            signals: signals.clone(),
            workers,
            cpu: self.cpu,
            verdicts,
            seconds: arguments.max_time.or(setup.problem.limits.seconds),
            memory: arguments.max_memory,
            weighed: (past.as_ref().map_or(0, Scan::rounds), None),
            stored: Arc::default(),
        };
        let (stop, tally, seconds) = if arguments.crew.threads.is_some() {
            let threads = Threads::new(setup.clone(), workers);
            let mut threads = Imported::new(threads, imports);
            folder.begun()?;
            let stop = watch.drive(past.as_ref(), &mut threads)?;
            (stop, threads.tally().clone(), None)
        } else {
            let dispatcher = match start(&setup, workers) {
                Ok(dispatcher) => dispatcher.with_signals(signals),
                Err(error) => {
                    if past.is_none() {
                        folder.discard();
                    }
                    return Err(Failure::system(error));
                }
            };
            folder.begun()?;
            watch.stored = dispatcher.stored_bytes();
            let mut dispatcher = Imported::new(dispatcher, imports);
            let stop = watch.drive(past.as_ref(), &mut dispatcher);
            // Closed before a failure is returned, too: the workers have to end before their channel does.
            let (tally, dispatcher) = (dispatcher.tally().clone(), dispatcher.into_inner());
            let seconds = (dispatcher.message_seconds(), dispatcher.fold_seconds());
            if let Err(error) = dispatcher.close() {
                eprintln!("{}: {error}; the next run tries again", watch.setup.problem.name);
            }
            (stop?, tally, Some(seconds))
        };
        watch.reporter.finish();
        watch.end(arguments.json, &folder, &stop, &tally, seconds)
    }
}

/// Starts worker processes that run this program.
pub(super) fn start(
    setup: &Arc<Setup>,
    workers: usize,
) -> Result<Dispatcher<LocalCrew>, CrewError> {
    Dispatcher::start(setup.clone(), LocalCrew::open(Executable::own()?, workers)?)
}

/// How many workers or threads the command line asks for; one for each processor if it does not say.
pub(super) fn workers(crew: &CrewArguments) -> Result<usize, Failure> {
    let (option, workers) = match (crew.workers, crew.threads) {
        (Some(workers), _) => ("--workers", workers),
        (None, Some(threads)) => ("--threads", threads),
        // Counts only the processors that the system lets this process use.
        (None, None) => ("", std::thread::available_parallelism().map_or(1, usize::from)),
    };
    if (1..=WORKERS_MAX).contains(&workers) {
        Ok(workers)
    } else {
        Err(Failure::usage(format!("{option}: {workers} found, 1 to {WORKERS_MAX} expected")))
    }
}

/// Changes a problem's limits to those of the command line.
pub(super) fn limit(problem: &mut Problem, arguments: &GrowthArguments) -> Result<(), Failure> {
    let limits = &mut problem.limits;
    limits.nodes = arguments.max_nodes.unwrap_or(limits.nodes);
    limits.sets = arguments.max_sets.unwrap_or(limits.sets);
    match limits.complaint() {
        // The file's own limits have been checked.
        Some((limit, message)) => Err(Failure::usage(format!("--max-{limit}: {message}"))),
        None => Ok(()),
    }
}

/// Watches a build: writes its ledger, reports how far the build is, and ends it when time is up, memory is
/// short or a signal comes.
struct Watch {
    setup: Arc<Setup>,
    ledger: LedgerWriter,
    reporter: Reporter,
    signals: Arc<Signals>,
    workers: usize,
    cpu: CpuClock,
    verdicts: Vec<Verdict>,
    seconds: Option<f64>,
    memory: Option<u64>,
    /// After which round the memory was added up last, and when.
    weighed: (u64, Option<Instant>),
    /// Bytes stored for the workers in shared memory, which count as no process's own.
    stored: Arc<AtomicU64>,
}

impl Watch {
    fn drive(
        &mut self,
        past: Option<&Scan>,
        executor: &mut Imported<impl Executor>,
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

    /// Folds the rounds that the ledger has already.
    fn restore(&self, scan: &Scan, executor: &mut impl Executor) -> Result<Past, Failure> {
        let mut replay = Replay::new(scan, &self.setup.problem)?;
        let mut past = Past::new(&self.setup);
        while let Some(told) = replay.read()? {
            if let Told::Round(round, digest) = told {
                executor.restore(&round);
                replay.check(executor.tally(), digest)?;
                past.fold(&round);
            }
            if self.signals.came() {
                return Err(Failure::new(Code::Interrupted, "a signal came"));
            }
        }
        past.verdicts.clone_from(&scan.verdicts);
        Ok(past)
    }

    /// Writes the summary and the ledger's last record, and reports them. `dispatch_seconds` are the CPU seconds
    /// that the dispatcher spent on messages and on folds, where there was one.
    fn end(
        mut self,
        json: bool,
        folder: &RunFolder,
        stop: &Stop,
        tally: &Tally,
        dispatch_seconds: Option<(f64, f64)>,
    ) -> Result<Code, Failure> {
        let problem = &self.setup.problem;
        let stopped = Stopped::new(stop, problem);
        let answers = self.verdicts.iter().filter_map(Verdict::answer);
        if let Some(path) = answers.filter_map(|answer| answer.path.as_ref()).next() {
            write_whole(&folder.file("path.csv"), path_csv(&self.setup.cx.space, path))?;
        }
        let coordinator_cpu_seconds = self.cpu.own_seconds();
        let coordinator_cpu = dispatch_seconds.map(|(messages, fold)| {
            let ledger = self.ledger.cpu_seconds();
            let rest = coordinator_cpu_seconds - messages - fold - ledger;
            CoordinatorCpu { messages, fold, ledger, rest }
        });
        let times = Times {
            cpu_seconds: coordinator_cpu_seconds + self.cpu.children_seconds(),
            coordinator_cpu_seconds,
            coordinator_cpu,
            wall_seconds: self.reporter.seconds(),
            ledger_seconds: self.ledger.seconds(),
        };
        let summary = Summary::new(problem, folder.path(), tally, &self.verdicts, &stopped, times);
        let text = serde_json::to_string_pretty(&summary).map_err(Failure::system)?;
        write_whole(&folder.file("summary.json"), text + "\n")?;
        // Written last: a build that is killed before this has no end in its ledger and can go on to here again.
        self.ledger.stopped(&stopped)?;
        if json {
            print_json(&summary);
        } else {
            // A pipe that its reader has closed is no failure: the reader has seen enough.
            let _ = writeln!(std::io::stdout(), "{summary}");
        }
        match stopped.outcome(problem) {
            (Code::Done, _) => Ok(Code::Done),
            (code, reason) => Err(Failure::new(code, reason)),
        }
    }

    /// Whether memory is short. Added up once after a round, since only rounds make the roadmap larger.
    fn is_short_of_memory(&mut self, rounds: u64) -> bool {
        let (round, at) = self.weighed;
        let Some(limit) = self.memory.filter(|_| round < rounds) else { return false };
        if at.is_some_and(|at| at.elapsed() < MEMORY_PAUSE) {
            return false;
        }
        self.weighed = (rounds, Some(Instant::now()));
        resident_bytes() + self.stored.load(Ordering::Relaxed) >= limit
    }
}

impl Observer for Watch {
    type Error = Failure;

    fn folded(&mut self, round: &Round, tally: &Tally) -> Result<(), Failure> {
        self.ledger.round(round, &self.setup.problem, tally)
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        self.verdicts = judgement.verdicts.clone();
        self.ledger.judged(judgement)
    }

    fn tick(
        &mut self,
        progress: &Progress,
        tally: &Tally,
        alive: usize,
    ) -> Result<Option<Cut>, Failure> {
        self.ledger.sync_if_due()?;
        let workers = (alive, self.workers);
        self.reporter.report(&self.setup.problem, progress, tally, workers);
        Ok(if self.signals.came() {
            Some(Cut::Interrupted)
        } else if self.seconds.is_some_and(|limit| self.reporter.seconds() >= limit) {
            Some(Cut::Time)
        } else if self.is_short_of_memory(progress.rounds) {
            self.memory.map(Cut::Memory)
        } else {
            None
        })
    }
}
