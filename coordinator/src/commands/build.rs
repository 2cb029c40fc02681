use super::load::load;
use super::write_whole;
use crate::cli::BuildArguments;
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::pool::Pool;
use crate::progress::{Reporter, print_json};
use crate::run::{LedgerWriter, RunFolder, Stopped, Summary, Times};
use crate::signals::Signals;
use roadmill::evaluate::Verdict;
use roadmill::export::path_csv;
use roadmill::img::{
    Core, Cut, Executor, Judgement, Observer, Progress, Round, Setup, Stop, Threads, drive,
};
use roadmill::problem::Problem;
use roadmill::roadmap::Roadmap;
use roadmill_workers::channel::private_umask;
use std::io::Write;
use std::sync::Arc;

/// The most worker processes or threads.
const WORKERS_MAX: usize = 4096;
/// Sets per worker that may be generated ahead of the current round.
const LOOKAHEAD_PER_WORKER: u64 = 4;

/// Grows a roadmap.
pub fn build(arguments: &BuildArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    // Run folders and shared memory are their owner's business.
    private_umask();
    let problem = problem(arguments)?;
    let workers = workers(arguments)?;
    // Listened to from here on, so that a signal never leaves half a folder unexplained.
    let signals = Signals::listen().map_err(Failure::system)?;
    let signals = Arc::new(signals);
    let mut folder = RunFolder::make(arguments.out.as_deref(), &problem.name, arguments.force)?;
    let ledger = match LedgerWriter::begin(folder.path(), &problem) {
        Ok(ledger) => ledger,
        Err(failure) => {
            folder.discard();
            return Err(failure);
        }
    };
    if !arguments.json {
        eprintln!(
            "{}: seed {}, run folder {}",
            problem.name,
            problem.seed,
            folder.path().display()
        );
        problem.notes.iter().for_each(|note| eprintln!("{}: {note}", problem.name));
    }

    let setup = Arc::new(Setup::new(problem));
    let mut core = Core::new(&setup, LOOKAHEAD_PER_WORKER * workers as u64);
    let mut watch = Watch {
        setup: setup.clone(),
        ledger,
        reporter: Reporter::new(arguments.json),
        signals: signals.clone(),
        workers,
        cpu,
        verdicts: Vec::new(),
    };
    let (stop, roadmap) = if arguments.threads.is_some() {
        let mut threads = Threads::new(setup.clone(), workers);
        folder.begun()?;
        let stop = drive(&mut core, &mut threads, &mut watch)?;
        (stop, threads.into_roadmap())
    } else {
        let pool = Pool::start(setup.clone(), workers, signals);
        let mut pool = match pool {
            Ok(pool) => pool,
            Err(error) => {
                folder.discard();
                return Err(Failure::system(error));
            }
        };
        folder.begun()?;
        let stop = drive(&mut core, &mut pool, &mut watch);
        // Also where the ledger cannot be written: the workers end before their channel does.
        let (roadmap, closed) = pool.close();
        if let Err(error) = closed {
            eprintln!("{}: {error}; the next run tries again", watch.setup.problem.name);
        }
        (stop?, roadmap)
    };
    watch.reporter.finish();
    end(arguments, &folder, watch, &stop, &roadmap)
}

/// Writes down and says what the build came to.
fn end(
    arguments: &BuildArguments,
    folder: &RunFolder,
    mut watch: Watch,
    stop: &Stop,
    roadmap: &Roadmap,
) -> Result<Code, Failure> {
    let problem = &watch.setup.problem;
    let stopped = Stopped::new(stop, problem);
    watch.ledger.stopped(&stopped)?;
    let answers = watch.verdicts.iter().filter_map(Verdict::answer);
    if let Some(path) = answers.filter_map(|answer| answer.path.as_ref()).next() {
        write_whole(&folder.file("path.csv"), path_csv(&watch.setup.cx.space, path))?;
    }
    let coordinator_cpu_seconds = watch.cpu.own_seconds();
    let times = Times {
        cpu_seconds: coordinator_cpu_seconds + watch.cpu.children_seconds(),
        coordinator_cpu_seconds,
        wall_seconds: watch.reporter.seconds(),
    };
    let summary = Summary::new(problem, folder.path(), roadmap, &watch.verdicts, &stopped, times);
    let json = serde_json::to_string_pretty(&summary).map_err(Failure::system)?;
    write_whole(&folder.file("summary.json"), json + "\n")?;
    if arguments.json {
        print_json(&summary);
    } else {
        // Whoever closes the pipe does not want it.
        let _ = writeln!(std::io::stdout(), "{summary}");
    }
    let failed = |code| Err(Failure::new(code, &stopped.reason));
    match stop {
        Stop::Satisfied => Ok(Code::Done),
        // Without criteria the limit is what was asked for.
        Stop::NodeLimit | Stop::SetLimit | Stop::Cut(Cut::Time)
            if problem.evaluators.is_empty() =>
        {
            Ok(Code::Done)
        }
        Stop::NodeLimit | Stop::SetLimit | Stop::Cut(Cut::Time) => {
            let reason = format!("{} before all criteria are met", stopped.reason);
            Err(Failure::new(Code::NoSuccess, reason))
        }
        Stop::GaveUp { .. } => failed(Code::NoSuccess),
        Stop::Contradiction(_) | Stop::Nonsense(_) => failed(Code::BrokenRun),
        Stop::Deadly(_) | Stop::Cut(Cut::WorkersLost(_)) => failed(Code::WorkersLost),
        Stop::Cut(Cut::Interrupted) => failed(Code::Interrupted),
    }
}

/// The problem with what the command line changes of it.
fn problem(arguments: &BuildArguments) -> Result<Problem, Failure> {
    let mut problem = load(&arguments.problem)?;
    problem.seed = arguments.seed.unwrap_or(problem.seed);
    let limits = &mut problem.limits;
    limits.nodes = arguments.max_nodes.unwrap_or(limits.nodes);
    limits.sets = arguments.max_sets.unwrap_or(limits.sets);
    limits.seconds = arguments.max_time.or(limits.seconds);
    match limits.complaint() {
        // The file's own limits have been checked.
        Some((limit, message)) => Err(Failure::usage(format!("--max-{limit}: {message}"))),
        None => Ok(problem),
    }
}

fn workers(arguments: &BuildArguments) -> Result<usize, Failure> {
    let (option, workers) = match (arguments.workers, arguments.threads) {
        (Some(workers), _) => ("--workers", workers),
        (None, Some(threads)) => ("--threads", threads),
        // Knows the process's affinity and its group's quota.
        (None, None) => ("", std::thread::available_parallelism().map_or(1, usize::from)),
    };
    if (1..=WORKERS_MAX).contains(&workers) {
        Ok(workers)
    } else {
        Err(Failure::usage(format!("{option}: {workers} found, 1 to {WORKERS_MAX} expected")))
    }
}

/// Keeps the ledger, tells how far the build is, and ends it when time is up or a signal comes.
struct Watch {
    setup: Arc<Setup>,
    ledger: LedgerWriter,
    reporter: Reporter,
    signals: Arc<Signals>,
    workers: usize,
    cpu: CpuClock,
    verdicts: Vec<Verdict>,
}

impl Observer for Watch {
    type Error = Failure;

    fn folded(&mut self, round: &Round, roadmap: &Roadmap) -> Result<(), Failure> {
        self.ledger.round(round, roadmap.digest())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        self.verdicts = judgement.verdicts.clone();
        self.ledger.judged(judgement)
    }

    fn tick(&mut self, progress: &Progress, roadmap: &Roadmap, alive: usize) -> Option<Cut> {
        let workers = (alive, self.workers);
        self.reporter.report(&self.setup.problem, progress, roadmap, workers);
        let seconds = self.setup.problem.limits.seconds;
        if self.signals.came() {
            Some(Cut::Interrupted)
        } else if seconds.is_some_and(|limit| self.reporter.seconds() >= limit) {
            Some(Cut::Time)
        } else {
            None
        }
    }
}
