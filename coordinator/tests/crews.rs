//! Whatever crew the dispatcher has, and whoever leaves it: the same roadmap, in the same ledger. And whose
//! loss it is, a job's or a member's.

mod support;

use roadmill::img::{
    Core, Cut, Executor, Job, Judgement, Observer, Progress, Round, Setup, Stop, drive,
};
use roadmill::internal::wire;
use roadmill::numbers::{Ordinal, StrategyIndex};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Tally};
use roadmill_coordinator::crew::{
    Crew, Executable, LocalCrew, News, StreamCrew, WorkerThread, serve_stream,
};
use roadmill_coordinator::dispatch::Dispatcher;
use roadmill_coordinator::exit::Failure;
use roadmill_coordinator::run::{LedgerWriter, RunLock, Stopped};
use roadmill_workers::message::ToWorker;
use roadmill_workers::stream::{Kind, StreamLine, header};
use roadmill_workers::{Line, NothingShared, WorkerError, WorkerId, build_id, serve};
use rustix::event::{PollFd, PollFlags, poll};
use std::fs;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use support::{ENDLESS, PATIENCE, Scratch};

/// What a build came to.
struct Built {
    stop: Stop,
    digest: String,
    ledger: Vec<u8>,
}

/// Writes a build down, and does not wait for ever for its end.
struct Clerk {
    setup: Arc<Setup>,
    ledger: LedgerWriter,
    begun: Instant,
}

impl Observer for Clerk {
    type Error = Failure;

    fn folded(&mut self, round: &Round, tally: &Tally) -> Result<(), Failure> {
        self.ledger.round(round, self.setup.problem(), tally)
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Failure> {
        self.ledger.judged(judgement)
    }

    fn tick(&mut self, _: &Progress, _: &Tally, _: usize) -> Result<Option<Cut>, Failure> {
        assert!(self.begun.elapsed() < PATIENCE, "it hangs");
        Ok(None)
    }
}

/// Builds with this crew in this process, which is no `roadmill`.
fn build(problem: &Problem, crew: impl Crew) -> Built {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let setup = Arc::new(Setup::new(problem.clone()));
    let lock = RunLock::take(folder.path(), || false).expect("nobody else is there");
    let ledger = LedgerWriter::begin(folder.path(), problem, lock).expect("it can be written");
    let mut core = Core::new(&setup, 4 * crew.size() as u64);
    let mut dispatcher = Dispatcher::start(setup.clone(), crew).expect("workers start");
    let mut clerk = Clerk { setup, ledger, begun: Instant::now() };
    let stop = drive(&mut core, &mut dispatcher, &mut clerk).expect("the ledger can be written");
    clerk.ledger.stopped(&Stopped::new(&stop, problem)).expect("the ledger can be written");
    let digest = dispatcher.tally().digest().to_string();
    dispatcher.close().expect("nothing is left");
    let ledger = fs::read(folder.path().join("ledger")).expect("it was written");
    Built { stop, digest, ledger }
}

/// How a worker goes away.
#[derive(Clone, Copy, Debug)]
enum Departure {
    /// Its stream ends.
    Leaves,
    /// Its stream ends in the middle of a message.
    Half,
    /// It sends bytes that are no frame.
    Rubbish,
    /// It sends a frame that is no message.
    Nonsense,
    /// It dies: the only one of these that jobs answer for.
    Panics,
}

/// Panics as a job with a mistake would, without a report on the terminal.
fn panic_quietly() -> ! {
    std::panic::resume_unwind(Box::new("a mistake"))
}

/// A worker's line, until the worker goes away: when it has sent so many messages, or when it is given a job.
struct Departing<'a> {
    line: StreamLine<UnixStream, UnixStream>,
    stream: UnixStream,
    departure: Departure,
    messages_left: usize,
    job: Option<fn(&Job) -> bool>,
    departed: &'a AtomicUsize,
}

impl Departing<'_> {
    fn depart(&mut self, message: &[u8]) -> Result<(), WorkerError> {
        self.departed.fetch_add(1, Ordering::Relaxed);
        let sent = match self.departure {
            Departure::Leaves => Ok(()),
            Departure::Half => self.stream.write_all(&header(Kind::Message, message)[..20]),
            Departure::Rubbish => self.stream.write_all(&[0xff; 100]),
            // It goes on until it is ended.
            Departure::Nonsense => return self.line.send(&[0xff; 24]),
            Departure::Panics => panic_quietly(),
        };
        sent.expect("the coordinator is there");
        Err(WorkerError::Gone)
    }

    fn look_at(&mut self, reply: Vec<u8>) -> Result<Vec<u8>, WorkerError> {
        let Some(is_it) = self.job else { return Ok(reply) };
        match wire::decode(&reply)? {
            ToWorker::Work { jobs, .. } if jobs.iter().any(is_it) => {
                self.depart(&[]).map(|()| Vec::new())
            }
            _ => Ok(reply),
        }
    }
}

impl Line for Departing<'_> {
    fn send(&mut self, message: &[u8]) -> Result<(), WorkerError> {
        match self.messages_left.checked_sub(1) {
            None => self.depart(message),
            Some(left) => {
                self.messages_left = left;
                self.line.send(message)
            }
        }
    }

    fn receive(&mut self) -> Result<Vec<u8>, WorkerError> {
        let reply = self.line.receive()?;
        self.look_at(reply)
    }

    fn try_receive(&mut self) -> Result<Option<Vec<u8>>, WorkerError> {
        let reply = self.line.try_receive()?;
        reply.map(|reply| self.look_at(reply)).transpose()
    }

    fn nudge(&mut self) {
        self.line.nudge();
    }

    fn is_awaiting(&self) -> bool {
        self.line.is_awaiting()
    }
}

/// Works until it goes away.
fn serve_for_a_while(
    stream: UnixStream,
    departure: Departure,
    messages: usize,
    job: Option<fn(&Job) -> bool>,
    departed: &AtomicUsize,
) -> WorkerError {
    let shared = || stream.try_clone().expect("a socket can be shared");
    let line = StreamLine::open(shared(), shared()).expect("a thread starts");
    let build = build_id().expect("this program is a file");
    let mut line = Departing { line, stream, departure, messages_left: messages, job, departed };
    match serve(&mut line, &NothingShared, build) {
        Ok(never) => match never {},
        Err(error) => error,
    }
}

/// A crew in which the first dozen members go away in all ways, from their second message on; how many have.
fn inconstant_crew(size: usize) -> (StreamCrew, Arc<AtomicUsize>) {
    const DEPARTURES: [Departure; 6] = [
        Departure::Leaves,
        Departure::Panics,
        Departure::Half,
        Departure::Nonsense,
        Departure::Rubbish,
        Departure::Leaves,
    ];
    let departed = Arc::new(AtomicUsize::new(0));
    let counted = departed.clone();
    let crew = WorkerThread::crew(size, move |WorkerId(id), stream| {
        let id = id as usize;
        // Two of them panic, so that no job can seem deadly.
        match DEPARTURES.get(id % 6).filter(|_| id < 12) {
            Some(departure) => {
                serve_for_a_while(stream, *departure, 1 + 3 * id % 5, None, &counted)
            }
            None => serve_stream(stream),
        }
    });
    (crew.expect("this program is a file"), departed)
}

fn golden(name: &str) -> PathBuf {
    let problems = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/problems");
    Path::new(problems).join(format!("{name}.toml"))
}

fn load(path: &Path) -> Problem {
    Problem::load(path).unwrap_or_else(|error| panic!("{error}"))
}

fn any_crew_builds_what_threads_build(name: &str) {
    let scratch = Scratch::new();
    let path = golden(name);
    let arguments = ["build", path.to_str().expect("UTF-8"), "--threads", "2", "--out", "run"];
    let code = scratch.run(&arguments).status.code();
    assert!(matches!(code, Some(0 | 3)), "{code:?}");
    let (digest, ledger) = (scratch.summary("run").digest, scratch.ledger("run"));
    let problem = load(&path);
    let compare = |what: &str, crew: Box<dyn FnOnce(&Problem) -> Built>| {
        let built = crew(&problem);
        assert_eq!(built.digest, digest, "{name}: {what}");
        assert!(built.ledger == ledger, "{name}: {what}: the ledger differs");
    };
    for members in [1, 2, 4] {
        compare(
            &format!("{members} members"),
            Box::new(move |problem| {
                let crew = WorkerThread::crew(members, |_, stream| serve_stream(stream));
                build(problem, crew.expect("this program is a file"))
            }),
        );
        compare(
            &format!("{members} members that go away"),
            Box::new(move |problem| {
                let (crew, departed) = inconstant_crew(members);
                let built = build(problem, crew);
                assert!(departed.load(Ordering::Relaxed) >= 3, "this would test little");
                built
            }),
        );
    }
    compare("worker processes", Box::new(|problem| build(problem, processes(2))));
}

/// A crew of processes that run `roadmill`.
fn processes(size: usize) -> LocalCrew {
    let program = Executable::at(Path::new(env!("CARGO_BIN_EXE_roadmill"))).expect("it is built");
    LocalCrew::open(program, size).expect("the channel opens")
}

#[test]
fn the_same_ledger_for_rigid_bodies() {
    ["ball", "planar", "meshes", "slide"]
        .iter()
        .for_each(|name| any_crew_builds_what_threads_build(name));
}

#[test]
fn the_same_ledger_for_a_linkage_and_every_sampler() {
    ["arm", "sampled", "axis"].iter().for_each(|name| any_crew_builds_what_threads_build(name));
}

#[test]
fn the_same_ledger_for_evaluators_and_a_schedule_that_adapts() {
    ["judged", "settled", "adaptive"]
        .iter()
        .for_each(|name| any_crew_builds_what_threads_build(name));
}

#[test]
fn the_same_ledger_for_energies_and_sets_that_grow() {
    ["landscape", "expansion", "growth", "directions", "neighbors"]
        .iter()
        .for_each(|name| any_crew_builds_what_threads_build(name));
}

fn endless() -> Problem {
    Problem::parse(Path::new("endless.toml"), ENDLESS).unwrap_or_else(|error| panic!("{error}"))
}

/// Of the strategy `b`, far enough on for some rounds to be complete.
fn is_twelfth(job: &Job) -> bool {
    matches!(job, Job::Generate { strategy: StrategyIndex(1), ordinal: Ordinal(12), .. })
}

/// A crew in which whoever is given that set goes away.
fn crew_that_goes_away_at_a_job(
    size: usize,
    departure: Departure,
) -> (StreamCrew, Arc<AtomicUsize>) {
    let departed = Arc::new(AtomicUsize::new(0));
    let counted = departed.clone();
    let crew = WorkerThread::crew(size, move |_, stream| {
        serve_for_a_while(stream, departure, usize::MAX, Some(is_twelfth), &counted)
    });
    (crew.expect("this program is a file"), departed)
}

#[test]
fn a_job_at_which_workers_die_ends_the_build_by_name() {
    let (crew, departed) = crew_that_goes_away_at_a_job(2, Departure::Panics);
    let built = build(&endless(), crew);
    assert!(matches!(&built.stop, Stop::Deadly(job) if is_twelfth(job)), "{:?}", built.stop);
    assert_eq!(departed.load(Ordering::Relaxed), 3);
}

#[test]
fn a_job_is_not_blamed_for_members_that_leave_and_they_end_the_build_all_the_same() {
    for departure in [Departure::Leaves, Departure::Half, Departure::Rubbish, Departure::Nonsense] {
        let (crew, departed) = crew_that_goes_away_at_a_job(2, departure);
        let built = build(&endless(), crew);
        let Stop::Cut(Cut::WorkersLost(why)) = &built.stop else { panic!("{:?}", built.stop) };
        assert!(why.starts_with("7 workers were lost one after the other"), "{why}");
        let last = match departure {
            Departure::Rubbish => "where a frame should begin",
            Departure::Nonsense => "undecodable bytes",
            _ => "the coordinator is gone",
        };
        assert!(why.contains(last), "{departure:?}: {why}");
        assert!(departed.load(Ordering::Relaxed) >= 7);
    }
}

fn first_news(crew: &mut impl Crew) -> News {
    let begun = Instant::now();
    loop {
        assert!(begun.elapsed() < PATIENCE, "it hangs");
        crew.wait(Duration::from_millis(2), None);
        if let Some(news) = crew.next().expect("the crew is well") {
            return news;
        }
    }
}

#[test]
fn a_member_that_is_silent_is_lost() {
    let crew = WorkerThread::crew(1, |_, mut stream| {
        let end = stream.read(&mut [0; 1]);
        assert!(matches!(end, Ok(0)), "nobody speaks to it: {end:?}");
        WorkerError::Gone
    });
    let crew = crew.expect("this program is a file");
    let mut crew = crew.with_silence_max(Duration::from_millis(1));
    let member = crew.hire().expect("it starts");
    let news = first_news(&mut crew);
    let News::Lost { member: lost, why } = news else { panic!("{news:?}") };
    assert!(lost == member && why.contains("silent"), "{lost} {why}");
    crew.dismiss(member);
    crew.close().expect("nothing is left");
}

/// Also when it dies before it has read what was sent to it, which breaks the connection.
#[test]
fn a_worker_that_panics_has_died() {
    let crew = WorkerThread::crew(1, |_, stream| {
        let mut fds = [PollFd::new(&stream, PollFlags::IN)];
        poll(&mut fds, None).expect("it can be waited for");
        panic_quietly()
    });
    let mut crew = crew.expect("this program is a file");
    let member = crew.hire().expect("it starts");
    crew.send(member, Arc::new(b"unread".to_vec())).expect("it is short");
    let news = first_news(&mut crew);
    assert!(matches!(&news, News::Died { member: died, .. } if *died == member), "{news:?}");
    crew.dismiss(member);
    crew.close().expect("nothing is left");
}

#[test]
fn a_worker_of_another_program_is_refused() {
    let crew = StreamCrew::new(1, "/bin/other", Digest([7; 32]), {
        WorkerThread::starter(|_, stream| serve_stream(stream))
    });
    let stop = build(&endless(), crew).stop;
    let Stop::Cut(Cut::WorkersLost(why)) = &stop else { panic!("{stop:?}") };
    assert!(why.contains("runs another program than /bin/other"), "{why}");
}

#[test]
fn an_executable_that_is_no_worker_is_named() {
    let program = Executable::at(Path::new("/bin/true")).expect("it can be executed");
    let crew = LocalCrew::open(program, 1).expect("the channel opens");
    let stop = build(&endless(), crew).stop;
    let Stop::Cut(Cut::WorkersLost(why)) = &stop else { panic!("{stop:?}") };
    assert!(why.contains("is /bin/true roadmill?"), "{why}");
    let scratch = Scratch::new();
    scratch.write("text", "no program");
    let text = scratch.path("text");
    for (path, reason) in [
        (Path::new("/no/such/file"), "No such file"),
        (Path::new("/bin"), "something that is no file found"),
        (&text, "a file that nobody may execute found"),
    ] {
        let error = Executable::at(path).expect_err("it is no program").to_string();
        let named = error.contains(&path.display().to_string());
        assert!(named && error.contains(reason), "{error}");
    }
}
