//! The channel between real processes, which are killed at bad moments.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use roadmill_workers::channel::{
    CHUNK_BYTES, ChannelError, Delivery, Hub, MESSAGE_BYTES_MAX, Received, WorkerEnd, WorkerId,
};
use rustix::event::{PollFd, PollFlags, Timespec, poll};

const DIRECTORY: &str = "ROADMILL_TEST_DIRECTORY";
const WORKER: &str = "ROADMILL_TEST_WORKER";
const ROLE: &str = "ROADMILL_TEST_ROLE";
const PATIENCE: Duration = Duration::from_secs(20);

fn sizes() -> [usize; 7] {
    let chunk = CHUNK_BYTES;
    [0, 1, chunk - 1, chunk, chunk + 1, 2 * chunk, 5_000_000]
}

fn pattern(len: usize, seed: u64) -> Vec<u8> {
    (0..len as u64).map(|i| (i.wrapping_mul(31).wrapping_add(seed) >> 3) as u8).collect()
}

fn env_path(name: &str) -> PathBuf {
    std::env::var_os(name).expect("the test sets it").into()
}

/// What this very executable does when it is started again as another process.
#[test]
fn other_process() {
    match std::env::var(ROLE).as_deref() {
        Err(_) => {}
        Ok("hub") => be_a_hub(),
        Ok(role) => be_a_worker(role),
    }
}

fn be_a_hub() {
    let hub = Hub::create(2).expect("the hub opens");
    let directory = hub.directory().as_os_str().as_encoded_bytes();
    let note = env_path(DIRECTORY);
    let draft = note.with_extension("draft");
    fs::write(&draft, directory).expect("the test's folder is there");
    fs::rename(draft, note).expect("the test's folder is there");
    thread::sleep(PATIENCE);
}

fn be_a_worker(role: &str) {
    let worker = std::env::var(WORKER).expect("the test names the worker");
    let worker = WorkerId(worker.parse().expect("the name is a number"));
    let mut link = WorkerEnd::open(&env_path(DIRECTORY), worker).expect("the link opens");
    let mut echo = |len: usize| {
        let message = pattern(len, worker.0);
        let reply = link.call(&message, &mut || true).expect("the hub answers");
        assert!(reply == message, "{len} bytes came back altered");
    };
    match role {
        "open" => thread::sleep(PATIENCE),
        "sizes" => sizes().map(&mut echo).iter().for_each(|()| ()),
        "many" => (0..300).for_each(|i| echo(1000 + i)),
        "long" => echo(500_000_000),
        "ahead" => work_ahead(&mut link, worker),
        other => panic!("no such role: {other}"),
    }
}

/// Sends, works for a while, and only then looks for the reply: a ring that was lost between the looking and
/// the sleeping would cost a second each time.
fn work_ahead(link: &mut WorkerEnd, worker: WorkerId) {
    for i in 0..1000u32 {
        let message =
            pattern(if i % 50 == 0 { CHUNK_BYTES + 1 } else { 9 }, worker.0 + u64::from(i));
        link.send(&message, &mut || true).expect("the hub is there");
        assert!(link.is_awaiting());
        if i % 3 == 0 {
            link.nudge();
        }
        let mut reply = None;
        for _ in 0..i % 40 {
            reply = link.try_receive(&mut || true).expect("the hub answers");
            if reply.is_some() {
                break;
            }
            (0..100).for_each(|_| std::hint::spin_loop());
        }
        let reply = reply.map_or_else(|| link.receive(&mut || true), Ok);
        assert!(reply.expect("the hub answers") == message, "message {i} came back altered");
    }
    assert!(link.try_receive(&mut || true).is_err(), "nothing was sent");
}

fn command(role: &str, directory: &Path, worker: u64) -> Command {
    let mut command = Command::new(std::env::current_exe().expect("the test is a file"));
    command
        .args(["--exact", "other_process", "--nocapture"])
        .env(ROLE, role)
        .env(DIRECTORY, directory)
        .env(WORKER, worker.to_string())
        .stdout(Stdio::null());
    command
}

fn start(role: &str, directory: &Path, worker: u64) -> Child {
    command(role, directory, worker).spawn().expect("the test can be started again")
}

fn kill(mut child: Child) {
    child.kill().expect("the child is there");
    child.wait().expect("the child ends");
}

fn sleep_until_rung(hub: &Hub) {
    let nap = Timespec { tv_sec: 0, tv_nsec: 20_000_000 };
    let bell = hub.as_fd();
    let _ = poll(&mut [PollFd::new(&bell, PollFlags::IN)], Some(&nap));
}

/// Serves all workers until `done`.
fn serve(
    hub: &mut Hub,
    mut handle: impl FnMut(&mut Hub, Received),
    mut done: impl FnMut() -> bool,
) {
    let deadline = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < deadline, "the workers do not get ready");
        sleep_until_rung(hub);
        while let Some(received) = hub.receive().expect("the hub can receive") {
            handle(hub, received);
        }
    }
}

fn echo(hub: &mut Hub, received: Received) {
    let Received::Message { worker, message } = received else {
        panic!("unexpected: {received:?}");
    };
    let delivery = hub.reply(worker, message).expect("the hub can reply");
    assert_eq!(delivery, Delivery::Sent);
}

fn have_ended(children: &mut [Child]) -> bool {
    children.iter_mut().all(|child| {
        let status = child.try_wait().expect("the child can be waited for");
        assert!(status.is_none_or(|status| status.success()));
        status.is_some()
    })
}

fn first_message(hub: &mut Hub) -> (WorkerId, Vec<u8>) {
    let deadline = Instant::now() + PATIENCE;
    loop {
        match hub.receive().expect("the hub can receive") {
            Some(Received::Message { worker, message }) => return (worker, message),
            Some(broken) => panic!("unexpected: {broken:?}"),
            None => sleep_until_rung(hub),
        }
        assert!(Instant::now() < deadline, "no message comes");
    }
}

fn shared_memory_of(directory: &Path) -> Vec<PathBuf> {
    let run = directory.file_name().expect("a run has a name");
    let run = run.to_str().expect("the name is text");
    let entries = fs::read_dir("/dev/shm").expect("there is shared memory");
    let paths = entries.flatten().map(|entry| entry.path());
    let folders = paths.filter(|path| path.to_string_lossy().contains(run));
    let with_files = |folder: PathBuf| {
        let files = fs::read_dir(&folder).into_iter().flatten().flatten();
        let files: Vec<PathBuf> = files.map(|file| file.path()).collect();
        files.into_iter().chain([folder])
    };
    folders.flat_map(with_files).collect()
}

fn assert_nothing_left(directory: &Path) {
    assert!(!directory.exists(), "{directory:?} is still there");
    assert_eq!(shared_memory_of(directory), Vec::<PathBuf>::new());
}

fn close(hub: Hub) {
    let directory = hub.directory().to_path_buf();
    hub.close().expect("everything can be removed");
    assert_nothing_left(&directory);
}

#[test]
fn messages_of_all_sizes_come_back() {
    let mut hub = Hub::create(1).expect("the hub opens");
    let mut children = [start("sizes", hub.directory(), 1)];
    serve(&mut hub, echo, || have_ended(&mut children));
    close(hub);
}

#[test]
fn eight_workers_at_a_time() {
    let mut hub = Hub::create(8).expect("the hub opens");
    let directory = hub.directory().to_path_buf();
    let roles = ["sizes", "sizes", "sizes", "many", "many", "many", "many", "many"];
    let mut children: Vec<Child> = (0..8).map(|i| start(roles[i], &directory, i as u64)).collect();
    serve(&mut hub, echo, || have_ended(&mut children));
    close(hub);
}

#[test]
fn workers_that_go_on_while_their_messages_travel_are_woken_when_they_sleep() {
    let mut hub = Hub::create(2).expect("the hub opens");
    let mut children = [1, 2].map(|id| start("ahead", hub.directory(), id));
    serve(&mut hub, echo, || have_ended(&mut children));
    close(hub);
}

#[test]
fn a_worker_killed_while_it_waits_is_replaced() {
    let mut hub = Hub::create(1).expect("the hub opens");
    // more often than there are places, so that every place must have been given back
    for id in 0..20 {
        let child = start("many", hub.directory(), id);
        let (worker, _) = first_message(&mut hub);
        kill(child);
        if id % 2 == 0 {
            let delivery = hub.reply(worker, vec![1; 3 * CHUNK_BYTES]);
            assert_eq!(delivery.expect("the hub can reply"), Delivery::Sent);
        }
        hub.forget(worker);
        let delivery = hub.reply(worker, vec![2]).expect("the hub can reply");
        assert_eq!(delivery, Delivery::Gone);
    }
    let mut children = [start("sizes", hub.directory(), 100)];
    serve(&mut hub, echo, || have_ended(&mut children));
    close(hub);
}

#[test]
fn a_worker_killed_in_mid_message_is_replaced() {
    let mut hub = Hub::create(2).expect("the hub opens");
    let mut survivor = [start("many", hub.directory(), 1000)];
    for id in 0..8 {
        let child = start("long", hub.directory(), id);
        let end = Instant::now() + Duration::from_millis(500 + 7 * id);
        serve(&mut hub, echo, || Instant::now() > end);
        kill(child);
        hub.forget(WorkerId(id));
    }
    serve(&mut hub, echo, || have_ended(&mut survivor));
    close(hub);
}

#[test]
fn workers_killed_while_they_join_do_no_harm() {
    let mut hub = Hub::create(2).expect("the hub opens");
    for id in 0..40 {
        let child = start("open", hub.directory(), id);
        thread::sleep(Duration::from_micros(1500 + 500 * (id % 20)));
        kill(child);
        assert_eq!(hub.receive().expect("the hub can receive"), None);
        hub.forget(WorkerId(id));
    }
    let mut children = [start("sizes", hub.directory(), 100), start("many", hub.directory(), 101)];
    serve(&mut hub, echo, || have_ended(&mut children));
    close(hub);
}

/// Starts a hub in another process, and tells where its folder is.
fn start_hub(scratch: &Path, temporary: &Path) -> (Child, PathBuf) {
    let note = scratch.join("directory");
    let child = command("hub", &note, 0)
        .env("TMPDIR", temporary)
        .spawn()
        .expect("the test can be started again");
    let deadline = Instant::now() + PATIENCE;
    loop {
        match fs::read_to_string(&note) {
            Ok(text) if !text.is_empty() => return (child, PathBuf::from(text)),
            _ => assert!(Instant::now() < deadline, "the hub does not open"),
        }
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_temporary_folder_too_long_for_sockets_is_not_used() {
    let scratch = tempfile::tempdir().expect("there is a temporary folder");
    let long = scratch.path().join("x".repeat(80));
    fs::create_dir(&long).expect("the folder can be made");
    let (child, directory) = start_hub(scratch.path(), &long);
    kill(child);
    assert_eq!(directory.parent().and_then(Path::parent), Some(Path::new("/tmp")));
}

#[test]
fn what_a_killed_hub_leaves_is_reaped_by_the_next() {
    let scratch = tempfile::tempdir().expect("there is a temporary folder");
    let (child, directory) = start_hub(scratch.path(), &std::env::temp_dir());
    let waiting = start("many", &directory, 1);
    let living = Hub::create(1).expect("a second hub opens");
    assert!(directory.exists() && !shared_memory_of(&directory).is_empty());
    kill(child);
    kill(waiting);
    let next = Hub::create(1).expect("the next hub opens");
    assert_nothing_left(&directory);
    assert!(living.directory().exists() && !shared_memory_of(living.directory()).is_empty());
    close(living);
    close(next);
}

#[test]
fn two_hubs_side_by_side_do_not_see_each_other() {
    let run = || {
        let mut hub = Hub::create(2).expect("the hub opens");
        let directory = hub.directory().to_path_buf();
        // the same names in both runs
        let mut children = [start("many", &directory, 1), start("sizes", &directory, 2)];
        serve(&mut hub, echo, || have_ended(&mut children));
        close(hub);
    };
    for thread in [thread::spawn(run), thread::spawn(run)] {
        thread.join().expect("the run succeeds");
    }
}

#[test]
fn files_are_private() {
    let hub = Hub::create(2).expect("the hub opens");
    let link = WorkerEnd::open(hub.directory(), WorkerId(1)).expect("the link opens");
    let mut paths = shared_memory_of(hub.directory());
    assert!(paths.len() > 2);
    paths.push(hub.directory().to_path_buf());
    let entries = fs::read_dir(hub.directory()).expect("the folder is there");
    let files = entries.flatten().map(|entry| entry.path());
    paths.extend(files.filter(|path| !path.is_dir()));
    for path in paths {
        let metadata = fs::metadata(&path).expect("the file is there");
        let mode = metadata.permissions().mode();
        assert_eq!(mode & 0o077, 0, "{path:?} has mode {mode:o}");
    }
    drop(link);
    close(hub);
}

/// Runs `work` with a link of worker 7 on this thread while `serve` has the hub on another.
fn with_link<T>(
    serve: impl FnOnce(&mut Hub) + Send + 'static,
    work: impl FnOnce(&mut WorkerEnd) -> T,
) -> T {
    let (send_directory, directory) = mpsc::channel();
    let (end, ended) = mpsc::channel::<()>();
    let hub = thread::spawn(move || {
        let mut hub = Hub::create(1).expect("the hub opens");
        send_directory.send(hub.directory().to_path_buf()).expect("the worker waits for it");
        serve(&mut hub);
        let _ = ended.recv();
        close(hub);
    });
    let directory = directory.recv().expect("the hub opens");
    let mut link = WorkerEnd::open(&directory, WorkerId(7)).expect("the link opens");
    let result = work(&mut link);
    drop(link);
    drop(end);
    hub.join().expect("the hub closes");
    result
}

#[test]
fn a_reply_may_come_late_and_comes_once() {
    let serve = |hub: &mut Hub| {
        let (worker, _) = first_message(hub);
        let shared = Arc::new(pattern(3, 3));
        thread::sleep(Duration::from_millis(1100));
        let reply = hub.reply(worker, Arc::clone(&shared));
        assert_eq!(reply.expect("the hub can reply"), Delivery::Sent);
        let again = hub.reply(worker, shared);
        assert_eq!(again.expect("the hub can reply"), Delivery::Gone);
    };
    let mut asked = 0;
    let mut keep_waiting = || {
        asked += 1;
        true
    };
    let reply = with_link(serve, |link| link.call(&[1], &mut keep_waiting));
    assert_eq!(reply.expect("the hub answers"), pattern(3, 3));
    assert!((2..10).contains(&asked), "the link does not sleep: {asked}");
}

#[test]
fn waiting_can_be_given_up() {
    let (first, second) = with_link(
        |_| {},
        |link| {
            let first = link.call(&[1], &mut || false);
            (first, link.call(&[1], &mut || true))
        },
    );
    assert!(matches!(first, Err(ChannelError::Abandoned)), "{first:?}");
    assert!(matches!(second, Err(ChannelError::Spoiled)), "{second:?}");
}

#[test]
fn a_forgotten_worker_is_refused() {
    let serve = |hub: &mut Hub| {
        let (worker, _) = first_message(hub);
        hub.forget(worker);
    };
    let result = with_link(serve, |link| link.call(&[1], &mut || true));
    assert!(matches!(result, Err(ChannelError::Refused)), "{result:?}");
}

#[test]
fn a_message_over_the_limit_is_refused_before_it_is_sent() {
    let message = vec![0; MESSAGE_BYTES_MAX as usize + 1];
    let result = with_link(|_| {}, |link| link.call(&message, &mut || true));
    assert!(matches!(result, Err(ChannelError::TooLarge { .. })), "{result:?}");
}

#[test]
fn a_run_that_has_ended_cannot_be_joined() {
    let hub = Hub::create(1).expect("the hub opens");
    let directory = hub.directory().to_path_buf();
    close(hub);
    let result = WorkerEnd::open(&directory, WorkerId(1)).map(|_| ());
    assert!(matches!(result, Err(ChannelError::HubGone)), "{result:?}");
}
