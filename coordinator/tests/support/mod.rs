//! The binary, run in a folder of its own with temporary files of its own.

#![allow(dead_code, reason = "every test file uses another part")]

pub mod browser;

use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::cell::RefCell;
use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Whatever takes longer hangs. Nothing else is ever concluded from a time.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A small ball in an empty room, whose query is solved at once.
pub const SMALL: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[query]
start = [1.0, 1.0]
goal = [8.0, 8.0]
[[strategies]]
label = "a"
nodes = 20
sampler = { uniform = {} }
"#;

/// A build without end, in small steps: whoever starts it stops it when enough has happened to
/// it, however fast the machine is, and then compares it with an undisturbed one of that size.
pub const ENDLESS: &str = r#"
seed = 11

[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [8.0, 4.0, 4.0]
bounds = "body"

[robot]
bodies = [{ shape = { box = { size = [1.0, 0.25, 0.25] } } }]

[[obstacles]]
shape = { box = { size = [0.2, 2.6, 4.0] } }
position = [2.0, 2.7, 2.0]
[[obstacles]]
shape = { box = { size = [0.2, 2.6, 4.0] } }
position = [4.0, 1.3, 2.0]
[[obstacles]]
shape = { cylinder = { radius = 0.6, height = 4.0 } }
position = [6.0, 2.0, 2.0]

[img]
sets_per_round = 4
schedule = ["a", "b", "a"]

[[strategies]]
label = "a"
nodes = 12
sampler = { uniform = {} }

[[strategies]]
label = "b"
nodes = 7
sampler = { uniform = {} }
within = { nearest = { neighbors = 4 } }

[limits]
nodes = 4000000
"#;

/// Polls until something has become true.
pub fn wait_until(what: &str, mut is_true: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_true() {
        assert!(begun.elapsed() < PATIENCE, "still waiting for this: {what}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// How often a test tries what depends on chance: `ROADMILL_TRIALS` says so for a longer run.
pub fn trials(usual: usize) -> usize {
    let asked = std::env::var("ROADMILL_TRIALS").ok();
    asked.map_or(usual, |number| number.parse().expect("a number of trials"))
}

/// A fixed pseudo-random sequence (xorshift), so that every run of a test does the same.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        // Seeds that follow one another begin alike otherwise; zero would stay zero.
        Random((seed ^ 0x9e37_79b9_7f4a_7c15).wrapping_mul(0xff51_afd7_ed55_8ccd) | 1)
    }

    pub fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        // The low bits are the worst.
        ((self.0 >> 16) % end as u64) as usize
    }
}

/// A folder in which the binary is run. When it is dropped the runs must have tidied up.
pub struct Scratch {
    folder: TempDir,
    /// Process ids.
    started: RefCell<Vec<u32>>,
}

impl Scratch {
    pub fn new() -> Scratch {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let scratch = Scratch { folder, started: RefCell::default() };
        fs::create_dir(scratch.temporary()).expect("a folder can be made");
        scratch
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, contents: &str) {
        fs::write(self.path(name), contents).expect("a file can be written");
    }

    /// The `TMPDIR` of the processes.
    pub fn temporary(&self) -> PathBuf {
        self.path("temporary")
    }

    /// Files and folders in `TMPDIR`, at any depth.
    pub fn temporary_files(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut folders = vec![self.temporary()];
        while let Some(folder) = folders.pop() {
            for path in children(&folder) {
                if path.is_dir() {
                    folders.push(path.clone());
                }
                found.push(path);
            }
        }
        found
    }

    /// Starts the binary with these arguments; relative paths are in this folder.
    pub fn start(&self, arguments: &[&str]) -> Running {
        self.start_with_faults(arguments, "")
    }

    /// The same with faults in its workers (see `roadmill-workers`, `faults.rs`).
    pub fn start_with_faults(&self, arguments: &[&str], faults: &str) -> Running {
        let mut command = Command::new(env!("CARGO_BIN_EXE_roadmill"));
        command.args(arguments);
        self.start_command(command, faults)
    }

    /// The same where no file may grow beyond this size: as a full disk does, the system refuses.
    pub fn start_with_file_limit(&self, arguments: &[&str], blocks: u64) -> Running {
        let mut command = Command::new("sh");
        // The limit is in blocks of 512 or of 1024 bytes, as the shell likes.
        let script = format!("trap '' XFSZ; ulimit -f {blocks} && exec \"$0\" \"$@\"");
        command.arg("-c").arg(script).arg(env!("CARGO_BIN_EXE_roadmill")).args(arguments);
        self.start_command(command, "")
    }

    pub fn start_command(&self, mut command: Command, faults: &str) -> Running {
        let mut started = self.started.borrow_mut();
        let number = started.len();
        let [stdout, stderr] =
            ["stdout", "stderr"].map(|stream| self.path(&format!("{number}.{stream}")));
        let file = |path: &Path| Stdio::from(File::create(path).expect("a file can be made"));
        command
            .current_dir(self.folder.path())
            .env("TMPDIR", self.temporary())
            .env_remove("ROADMILL_FAULTS")
            // No test opens a browser on somebody's desktop.
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null())
            // Files take any amount without a reader.
            .stdout(file(&stdout))
            .stderr(file(&stderr));
        if !faults.is_empty() {
            command.env("ROADMILL_FAULTS", faults);
        }
        let child = command.spawn().expect("the binary starts");
        started.push(child.id());
        Running { child, stdout, stderr, temporary: self.temporary() }
    }

    /// Runs the binary to its end.
    pub fn run(&self, arguments: &[&str]) -> Done {
        self.start(arguments).finish()
    }

    /// Builds into the folder `run` and expects this exit code; the roadmap's digest.
    pub fn build(&self, run: &str, arguments: &[&str], code: i32) -> String {
        let done = self.run(&[&["build", "--out", run], arguments].concat());
        done.assert_code(code);
        self.summary(run).digest
    }

    /// What the summary in a run folder says.
    pub fn summary(&self, run: &str) -> Summary {
        let text = fs::read(self.path(run).join("summary.json")).expect("there is a summary");
        let json: Value = serde_json::from_slice(&text).expect("it is JSON");
        let text = |key: &str| json[key].as_str().expect("a text is there").to_owned();
        Summary {
            sets: json["sets"].as_u64().expect("a number is there"),
            stop: text("stop"),
            digest: text("digest"),
            cpu_seconds: json["cpu_seconds"].as_f64().expect("a number is there"),
            run_cpu_seconds: json["run_cpu_seconds"].as_f64(),
        }
    }

    pub fn ledger(&self, run: &str) -> Vec<u8> {
        fs::read(self.path(run).join("ledger")).unwrap_or_default()
    }

    /// Waits until the ledger has been begun and has then grown a number of times.
    pub fn wait_for_rounds(&self, run: &str, rounds: usize) {
        self.wait_for_rounds_or(run, rounds, || false);
    }

    /// Waits likewise, or until something else has come to pass: a run with a limit may end before
    /// its ledger was seen growing so often, for a busy machine writes several rounds between two looks.
    pub fn wait_for_rounds_or(&self, run: &str, rounds: usize, mut over: impl FnMut() -> bool) {
        let path = self.path(run).join("ledger");
        let length = || fs::metadata(&path).map_or(0, |metadata| metadata.len());
        wait_until("the ledger", || length() > 0 || over());
        for _ in 0..rounds {
            let before = length();
            wait_until("the next round", || length() > before || over());
        }
    }

    /// What all coordinators started here have left of their channels.
    pub fn left(&self) -> Vec<PathBuf> {
        let started = self.started.borrow();
        started.iter().flat_map(|pid| left_of(*pid, &self.temporary())).collect()
    }

    /// The digest of an undisturbed build of [`ENDLESS`], in a single process, with `sets` sets.
    pub fn undisturbed_digest(&self, sets: u64) -> String {
        self.write("endless.toml", ENDLESS);
        let sets = sets.to_string();
        let run = format!("undisturbed-{sets}");
        self.build(&run, &["endless.toml", "--threads", "2", "--max-sets", &sets], 0)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if !thread::panicking() {
            assert_eq!(self.temporary_files(), [] as [PathBuf; 0], "left in TMPDIR");
        }
        // A test that has failed leaves no shared memory behind either.
        for path in self.left() {
            let _ = fs::remove_dir_all(path);
        }
    }
}

/// What the tests read of a `summary.json`.
#[derive(Debug, PartialEq)]
pub struct Summary {
    pub sets: u64,
    pub stop: String,
    pub digest: String,
    pub cpu_seconds: f64,
    pub run_cpu_seconds: Option<f64>,
}

impl Summary {
    /// What every build of a problem comes to, whoever was killed on the way.
    pub fn result(&self) -> (u64, &str, &str) {
        (self.sets, &self.stop, &self.digest)
    }
}

/// The binary at work. Ended when dropped.
pub struct Running {
    child: Child,
    stdout: PathBuf,
    stderr: PathBuf,
    temporary: PathBuf,
}

impl Running {
    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    /// The worker processes in ascending order of their ids.
    pub fn workers(&self) -> Vec<u32> {
        let is_worker = |process: &Process| process.parent == self.pid() && process.state != 'Z';
        let mut workers: Vec<u32> =
            processes().filter(is_worker).map(|process| process.id).collect();
        workers.sort_unstable();
        workers
    }

    /// Whether it has not ended yet.
    pub fn is_alive(&self) -> bool {
        Process::of(self.pid()).is_some_and(|process| process.state != 'Z')
    }

    /// Whether it has something to do when this signal comes, rather than to end at once.
    pub fn catches(&self, signal: Signal) -> bool {
        let status = fs::read_to_string(format!("/proc/{}/status", self.pid())).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        caught.is_some_and(|mask| mask >> (signal.as_raw() - 1) & 1 == 1)
    }

    pub fn signal(&self, signal: Signal) {
        send(self.pid(), signal);
    }

    /// Waits for the end. Unless the process was killed, nothing of it may be left.
    pub fn finish(self) -> Done {
        let (pid, temporary) = (self.pid(), self.temporary.clone());
        let done = self.end();
        if done.status.signal() != Some(Signal::KILL.as_raw()) {
            assert_eq!(left_of(pid, &temporary), [] as [PathBuf; 0]);
        }
        done
    }

    /// Waits for the end of a process that may have no time to tidy up.
    pub fn end(mut self) -> Done {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("it can be waited for") {
                break status;
            }
            if begun.elapsed() > PATIENCE {
                let [stdout, stderr] = self.output();
                panic!("it hangs\n{stdout}\n{stderr}");
            }
            thread::sleep(Duration::from_millis(2));
        };
        let [stdout, stderr] = self.output();
        assert!(!stderr.contains("panicked"), "{stderr}");
        Done { status, stdout, stderr }
    }

    fn output(&self) -> [String; 2] {
        [&self.stdout, &self.stderr]
            .map(|path| String::from_utf8_lossy(&fs::read(path).unwrap_or_default()).into_owned())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Both fail after `finish`, as they should.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What came out.
#[derive(Debug)]
pub struct Done {
    pub status: ExitStatus,
    pub stdout: String,
    pub stderr: String,
}

impl Done {
    #[track_caller]
    pub fn assert_code(&self, code: i32) {
        assert_eq!(self.status.code(), Some(code), "{}\n{}", self.stdout, self.stderr);
    }

    #[track_caller]
    pub fn assert_stderr(&self, fragments: &[&str]) {
        for fragment in fragments {
            assert!(self.stderr.contains(fragment), "no `{fragment}` in\n{}", self.stderr);
        }
    }
}

/// The channel's files of a run by the coordinator `pid`, on disk and in shared memory.
pub fn left_of(pid: u32, temporary: &Path) -> Vec<PathBuf> {
    let named = |path: &PathBuf, start: &str| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(start))
    };
    let run = format!("{pid}-");
    let shared = format!("roadmill-{pid}-");
    let on_disk = children(temporary).into_iter().flat_map(|user| children(&user));
    let mut left: Vec<PathBuf> = on_disk.filter(|path| named(path, &run)).collect();
    let in_memory = children(Path::new("/dev/shm")).into_iter();
    left.extend(in_memory.filter(|path| named(path, &shared)));
    left
}

/// Processes whose command line names this folder, as that of every worker does.
pub fn processes_naming(folder: &Path) -> Vec<u32> {
    let name = folder.to_string_lossy().into_owned();
    let names = |id: &u32| {
        let command = fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&command).contains(&name)
    };
    processes().map(|process| process.id).filter(names).collect()
}

pub fn children(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).collect()
}

pub fn send(pid: u32, signal: Signal) {
    let pid = Pid::from_raw(pid.cast_signed()).expect("a process id");
    // One that has just ended by itself needs no signal.
    let _ = kill_process(pid, signal);
}

/// A process, as `/proc` describes it.
pub struct Process {
    pub id: u32,
    pub state: char,
    pub parent: u32,
}

impl Process {
    pub fn of(id: u32) -> Option<Process> {
        let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
        // The name before the last parenthesis may hold anything.
        let mut fields = stat.rsplit(')').next()?.split_whitespace();
        let state = fields.next()?.chars().next()?;
        let parent = fields.next()?.parse().ok()?;
        Some(Process { id, state, parent })
    }
}

fn processes() -> impl Iterator<Item = Process> {
    let entries = fs::read_dir("/proc").expect("there is /proc").flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).filter_map(Process::of)
}
