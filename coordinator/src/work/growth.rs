use super::change::{Change, Chapter, difference};
use super::interrupt::Interrupt;
use super::limits::limited;
use super::watch::{Begun, Keeper, Status, Torn, Watch, Weighed, path_in};
use super::workers::{Kind, start, start_agents};
use super::{Ended, Run, Workers};
use crate::cpu::CpuClock;
use crate::crew::CrewError;
use crate::dispatch::SetsFromFiles;
use crate::exit::Failure;
use crate::files::remove_unfinished;
use crate::run::ledger::LEDGER;
use crate::run::{
    LedgerWriter, MACHINES_JSON, PATH_CSV, RunFolder, RunLock, SUMMARY_JSON, Scan, SetFiles,
    run_cpu_seconds_in, tidy,
};
use crate::signals::Signals;
use roadmill::img::{Executor, Setup, Threads};
use roadmill::model::ValidityFunction;
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Tally};
use roadmill::{BITS_VERSION, Cancel};
use roadmill_workers::channel::remove_leftovers;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A roadmap to be grown in a run folder, from its beginning or from where a run stopped: see [`Run::begin`] and
/// [`Run::resume`].
#[must_use = "nothing is grown before `grow`"]
pub struct Growth<'a> {
    origin: Origin,
    workers: Workers,
    watch: Option<Box<dyn Watch + 'a>>,
    interrupt: Interrupt,
    cpu: Option<CpuClock>,
    seconds: Option<f64>,
    memory: Option<u64>,
    function: Option<ValidityFunction>,
}

/// What a build begins with.
enum Origin {
    Anew(Box<Anew>),
    Again { run: PathBuf, chapter: Chapter },
}

struct Anew {
    problem: Problem,
    /// Instead of the problem's own limits.
    max_nodes: Option<u64>,
    max_sets: Option<u64>,
    folder: Option<PathBuf>,
    replace: bool,
    or_resume: bool,
    imports: SetFiles,
}

/// What a build is after all preparations.
struct Prepared {
    problem: Problem,
    folder: RunFolder,
    ledger: LedgerWriter,
    /// The ledger as it was found, where a build goes on. Its verdicts are by the evaluators of `problem`.
    past: Option<Scan>,
    imports: SetFiles,
}

/// Tells a function how far a build is.
struct Telling<F>(F);

impl<F: FnMut(&Status)> Watch for Telling<F> {
    fn progress(&mut self, status: &Status) {
        (self.0)(status);
    }
}

impl<'a> Growth<'a> {
    pub(super) fn anew(problem: Problem) -> Growth<'a> {
        Growth::of(Origin::Anew(Box::new(Anew {
            problem,
            max_nodes: None,
            max_sets: None,
            folder: None,
            replace: false,
            or_resume: false,
            imports: SetFiles::default(),
        })))
    }

    pub(super) fn again(run: &Path) -> Growth<'a> {
        Growth::of(Origin::Again { run: run.to_owned(), chapter: Chapter::default() })
    }

    fn of(origin: Origin) -> Growth<'a> {
        Growth {
            origin,
            workers: Workers::default(),
            watch: None,
            interrupt: Interrupt::default(),
            cpu: None,
            seconds: None,
            memory: None,
            function: None,
        }
    }

    /// Who does the jobs; a thread for every processor if nothing is said.
    pub fn workers(self, workers: &Workers) -> Growth<'a> {
        Growth { workers: workers.clone(), ..self }
    }

    /// Calls `progress` between events, in this thread, at least five times a second.
    pub fn progress(self, progress: impl FnMut(&Status) + 'a) -> Growth<'a> {
        self.watch(Telling(progress))
    }

    /// Tells `watch` how the build goes.
    pub fn watch(self, watch: impl Watch + 'a) -> Growth<'a> {
        Growth { watch: Some(Box::new(watch)), ..self }
    }

    /// Ends the build when `cancel` says so; the complete rounds are saved.
    pub fn cancel(mut self, cancel: &Cancel) -> Growth<'a> {
        self.interrupt.cancel = cancel.clone();
        self
    }

    /// Ends the build when a signal comes; the complete rounds are saved.
    pub fn signals(mut self, signals: &Arc<Signals>) -> Growth<'a> {
        self.interrupt.signals = Some(signals.clone());
        self
    }

    /// Stops the build after this time, instead of that of the problem's limits: within a round, which is then lost,
    /// but not before one round has been finished and judged. The time begins with the call of [`Growth::grow`]. Of a
    /// new run whose limit of nodes is left open the time is the only limit.
    pub fn max_seconds(self, seconds: Option<f64>) -> Growth<'a> {
        Growth { seconds, ..self }
    }

    /// Stops the build at the end of a round when all processes together hold so many bytes of memory.
    pub fn max_memory(self, memory: Option<u64>) -> Growth<'a> {
        Growth { memory, ..self }
    }

    /// Stops the build at the end of the first round with so many nodes, instead of at the problem's limit. Of a build
    /// that goes on this opens a chapter.
    pub fn max_nodes(mut self, nodes: u64) -> Growth<'a> {
        match &mut self.origin {
            Origin::Anew(anew) => anew.max_nodes = Some(nodes),
            Origin::Again { chapter, .. } => chapter.max_nodes = Some(nodes),
        }
        self
    }

    /// Stops the build at the end of the first round with so many sets, as [`Growth::max_nodes`].
    pub fn max_sets(mut self, sets: u64) -> Growth<'a> {
        match &mut self.origin {
            Origin::Anew(anew) => anew.max_sets = Some(sets),
            Origin::Again { chapter, .. } => chapter.max_sets = Some(sets),
        }
        self
    }

    /// Of a new run: its folder, which must not exist; without one it is `runs/NAME`, or the first free of
    /// `runs/NAME-2` and so on.
    pub fn folder(self, folder: impl Into<PathBuf>) -> Growth<'a> {
        let folder = Some(folder.into());
        self.if_anew(|anew| anew.folder = folder)
    }

    /// Of a new run: replaces the run that is in its folder.
    pub fn replace(self) -> Growth<'a> {
        self.if_anew(|anew| anew.replace = true)
    }

    /// Of a new run: goes on with the run that is in its folder, if there is one of this problem.
    pub fn or_resume(self) -> Growth<'a> {
        self.if_anew(|anew| anew.or_resume = true)
    }

    /// Of a new run: takes sets from files instead of generating them.
    pub fn import(self, files: SetFiles) -> Growth<'a> {
        self.if_anew(|anew| anew.imports = files)
    }

    /// Of a build that goes on: opens a chapter with the query, the criteria, the limits and the schedule of this
    /// problem.
    pub fn with(self, problem: Problem) -> Growth<'a> {
        self.if_again(|chapter| chapter.with = Some(Box::new(problem)))
    }

    /// Of a build that goes on: opens a chapter even if its sets were made by a version of the library that
    /// makes other bits.
    pub fn accept_bits(self) -> Growth<'a> {
        self.if_again(|chapter| chapter.accept_bits = true)
    }

    /// The validity function of a problem that came out of a ledger, which only names it.
    pub fn validity_function(self, function: &ValidityFunction) -> Growth<'a> {
        Growth { function: Some(function.clone()), ..self }
    }

    /// Ends the build when what ends the work as a whole comes.
    pub(super) fn interrupt(self, interrupt: &Interrupt) -> Growth<'a> {
        Growth { interrupt: interrupt.clone(), ..self }
    }

    /// Counts CPU seconds from a clock that was started before.
    pub(crate) fn clock(self, cpu: CpuClock) -> Growth<'a> {
        Growth { cpu: Some(cpu), ..self }
    }

    fn if_anew(mut self, change: impl FnOnce(&mut Anew)) -> Growth<'a> {
        if let Origin::Anew(anew) = &mut self.origin {
            change(anew);
        }
        self
    }

    fn if_again(mut self, change: impl FnOnce(&mut Chapter)) -> Growth<'a> {
        if let Origin::Again { chapter, .. } = &mut self.origin {
            change(chapter);
        }
        self
    }

    /// Grows the roadmap until the build stops. A build that has ended before, and of which nothing is changed, is
    /// left as it is.
    ///
    /// # Errors
    /// Exit code 2: the problem, its limits, the workers or the run folder cannot be used, another process works
    /// on the run, or the problem's validity function is missing or fails; 4: the run is damaged; 1: the system refuses; 6: it was to end before it had gone on. A
    /// build that stops, for whatever reason, is none: [`Ended::outcome`] says what it came to.
    pub fn grow(self) -> Result<Ended, Failure> {
        let begun = Instant::now();
        let Growth { origin, workers, watch, mut interrupt, cpu, seconds, memory, function } = self;
        let cpu = cpu.unwrap_or_else(CpuClock::start);
        let mut watch = watch.unwrap_or_else(|| Box::new(()));
        workers.check()?;
        // A limit of time belongs to this call: the one that is given, or the problem file's, or else the run's own.
        let mut seconds = seconds;
        let prepared = match origin {
            Origin::Anew(mut anew) => {
                let supplied = anew.problem.supplied_with(function.as_ref());
                anew.problem = supplied.map_err(Failure::usage)?;
                let of_file = anew.problem.limits().seconds;
                workers.check_for(&anew.problem)?;
                let prepared = anew.prepare(seconds, &workers, &interrupt, &mut *watch)?;
                seconds = seconds.or(of_file);
                prepared
            }
            Origin::Again { run, chapter } => {
                tidy(&run);
                if !run.join(LEDGER).is_file() {
                    return Err(Failure::usage(format!("{}: no run here", run.display())));
                }
                let lock = RunLock::take(&run, || interrupt.came())?;
                let change = Change::Chapter(chapter);
                go_on(&run, lock, change, (&workers, function.as_ref()), &mut *watch)?
            }
        };
        let Prepared { problem, mut folder, ledger, past, imports } = match prepared {
            Ok(prepared) => prepared,
            Err(ended) => return Ok(*ended),
        };

        let verdicts = past.as_ref().and_then(|past| past.verdicts.clone()).unwrap_or_default();
        let rounds = past.as_ref().map_or(0, Scan::rounds);
        let function = problem.validity_function().cloned();
        interrupt.function = function.clone();
        let setup = Arc::new(Setup::new(problem));
        let mut keeper = Keeper {
            setup: setup.clone(),
            ledger,
            watch: &mut *watch,
            interrupt: interrupt.clone(),
            workers: workers.count,
            cpu,
            begun,
            verdicts,
            seconds: seconds.or(setup.problem().limits().seconds),
            memory,
            rounds,
            may_stop: false,
            weighed: Weighed { after_rounds: rounds, at: None },
            cpu_seconds_before: match &past {
                None => Some(0.0),
                Some(past) => cpu_seconds_of(past, setup.problem()),
            },
            stored: Arc::default(),
            board: None,
            machines_file: folder.file(MACHINES_JSON),
            machines_written: None,
        };
        let (stop, tally, seconds) = match &workers.kind {
            Kind::Threads => {
                // Nobody else would look after what killed runs have left while only threads are used.
                remove_leftovers();
                let threads = match Threads::start(setup.clone(), workers.count) {
                    Ok(threads) => threads,
                    Err(error) => {
                        if past.is_none() {
                            folder.discard();
                        }
                        return Err(Failure::system(format!("cannot start the threads: {error}")));
                    }
                };
                let mut threads = SetsFromFiles::new(threads, imports);
                folder.begun()?;
                let stop = keeper.drive(past.as_ref(), &mut threads)?;
                (stop, threads.tally().clone(), None)
            }
            Kind::Processes(program) => match start(&setup, workers.count, program.as_ref()) {
                Ok(dispatcher) => {
                    keeper.dispatch(dispatcher, &mut folder, past.as_ref(), imports)?
                }
                Err(error) => return Err(not_started(error, folder, past.is_some())),
            },
            Kind::Agents(places, options) => {
                match start_agents(&setup, places, options, folder.path()) {
                    Ok(dispatcher) => {
                        keeper.dispatch(dispatcher, &mut folder, past.as_ref(), imports)?
                    }
                    Err(error) => return Err(not_started(error, folder, past.is_some())),
                }
            }
        };
        let ended = keeper.end(&folder, &stop, &tally, seconds)?;
        // The complete rounds are saved; nothing that the function had to do with since is in them.
        match function.as_ref().and_then(ValidityFunction::failure) {
            Some(failed) => Err(Failure::usage(failed)),
            None => Ok(ended),
        }
    }
}

/// The failure of a build whose workers cannot be started: nothing is left of a new one.
fn not_started(error: CrewError, folder: RunFolder, is_old: bool) -> Failure {
    if !is_old {
        folder.discard();
    }
    Failure::system(error)
}

/// The CPU seconds that have gone into a run. A call that was killed has left no word of its end, and nobody knows its seconds.
fn cpu_seconds_of(scan: &Scan, problem: &Problem) -> Option<f64> {
    let has_ended = scan.stopped.is_some();
    has_ended.then(|| run_cpu_seconds_in(scan.folder(), digest_of(scan, problem)))?
}

/// The digest of the roadmap of the complete rounds.
fn digest_of(scan: &Scan, problem: &Problem) -> Digest {
    match &scan.last_round {
        Some(end) => end.roadmap,
        None => Tally::new(&problem.space()).digest(),
    }
}

/// A build to be grown, or one that has ended before.
type Found = Result<Prepared, Box<Ended>>;

impl Anew {
    /// `seconds` is the limit of time, where it is another one than the problem's.
    fn prepare(
        self,
        seconds: Option<f64>,
        workers: &Workers,
        interrupt: &Interrupt,
        watch: &mut dyn Watch,
    ) -> Result<Found, Failure> {
        let Anew { problem, max_nodes, max_sets, folder: out, replace, or_resume, imports } = self;
        let mut limits = problem.limits();
        if seconds.is_some() && problem.leaves_nodes_open() {
            limits = limits.with_time(&problem.space());
        }
        let problem = limited(problem, limits, max_nodes, max_sets)?;
        let existing = out.as_deref().filter(|_| or_resume);
        existing.into_iter().for_each(tidy);
        let has_ledger = |out: &Path| out.join(LEDGER).is_file();
        let folder = match existing {
            None => RunFolder::make(out.as_deref(), problem.name(), replace)?,
            Some(out) if has_ledger(out) => RunFolder::of(out),
            Some(out) => RunFolder::make_or_take(out)?,
        };
        let lock = match RunLock::take(folder.path(), || interrupt.came()) {
            Ok(lock) => lock,
            Err(failure) => {
                if existing.is_none() {
                    folder.discard();
                }
                return Err(failure);
            }
        };
        // Looked for again now that nobody else can make it.
        if let Some(out) = existing.filter(|out| has_ledger(out)) {
            let function = problem.validity_function().cloned();
            let change = Change::None(Box::new(problem), imports);
            return go_on(out, lock, change, (workers, function.as_ref()), watch);
        }
        let mut ledger = match LedgerWriter::begin(folder.path(), &problem, lock) {
            Ok(ledger) => ledger,
            Err(failure) => {
                folder.discard();
                return Err(failure);
            }
        };
        let folder = folder.settle(&mut ledger)?;
        let imported = imports.count();
        watch.begun(&Begun::Anew { problem: &problem, folder: folder.path(), imported });
        Ok(Ok(Prepared { problem, folder, ledger, past: None, imports }))
    }
}

/// Goes on with the build in the folder `run`, which `lock` holds, by these workers and with the validity function that is given.
fn go_on(
    run: &Path,
    lock: RunLock,
    change: Change,
    (workers, function): (&Workers, Option<&ValidityFunction>),
    watch: &mut dyn Watch,
) -> Result<Found, Failure> {
    let mut scan = Scan::read(run)?;
    let refuse = |why: String| Failure::usage(format!("{}: cannot go on: {why}", run.display()));
    let bits = scan.chapter().bits_version;
    if bits != BITS_VERSION && !change.accepts_bits() {
        return Err(refuse(format!(
            "its sets have bits of version {bits} (roadmill {}), this roadmill {} makes version \
             {BITS_VERSION}; --accept-bits of `resume` opens a chapter with them",
            scan.chapter().program,
            env!("CARGO_PKG_VERSION"),
        )));
    }
    let present = scan.problem()?;
    let problem = change.apply(&scan, &present).map_err(refuse)?;
    let problem = problem.supplied_with(function).map_err(refuse)?;
    workers.check_for(&problem)?;
    let is_chapter = bits != BITS_VERSION || difference(&present, &problem).is_some();
    if let Some(stopped) = scan.stopped.as_ref().filter(|stopped| stopped.is_final() && !is_chapter)
    {
        let stopped = stopped.clone();
        let digest = digest_of(&scan, &problem);
        return Ok(Err(Box::new(Ended {
            run: Run::at(run),
            problem,
            stopped,
            rounds: scan.rounds(),
            digest,
            path: path_in(&scan.last_verdicts),
            summary: None,
        })));
    }
    remove_unfinished(run, &[SUMMARY_JSON, PATH_CSV, MACHINES_JSON]);
    let (mut ledger, torn) = LedgerWriter::resume(&scan, &present, lock)?;
    if is_chapter {
        ledger.chapter(scan.next_round(), &problem)?;
        scan.verdicts = None;
    }
    watch.begun(&Begun::Again {
        problem: &problem,
        folder: run,
        rounds: scan.rounds(),
        nodes: scan.last_round.as_ref().map_or(0, |end| end.nodes),
        is_chapter,
        torn: torn.as_deref().map(|file| Torn { bytes: scan.torn_bytes, file }),
    });
    let imports = match change {
        Change::None(_, imports) => imports,
        Change::Chapter(_) => SetFiles::default(),
    };
    let folder = RunFolder::of(run);
    Ok(Ok(Prepared { problem, folder, ledger, past: Some(scan), imports }))
}
