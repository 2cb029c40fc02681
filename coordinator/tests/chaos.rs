//! Whatever is killed, stopped, torn or talks nonsense at whatever moment: the build goes on to the same
//! sets, and nothing is left behind.
//!
//! Every schedule follows from a number. `ROADMILL_CHAOS` sets how many are run, and
//! `ROADMILL_CHAOS_SEED` the one to run again. The moments are those of the machine, so a schedule that
//! failed may have to be run more than once.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{Fields, frames, hash};
use rustix::process::Signal;
use std::fs::{self, File};
use std::os::unix::fs::FileExt;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;
use support::{
    Done, ENDLESS, Random, Running, Scratch, Summary, children, processes_naming, send, wait_until,
};

const SETS: usize = 240;
/// Schedules at a time: each of them mostly waits.
const AT_ONCE: usize = 3;

/// An undisturbed build.
struct Undisturbed {
    ledger: Vec<u8>,
    summary: Summary,
}

impl Undisturbed {
    fn new() -> Undisturbed {
        let scratch = Scratch::new();
        let digest = scratch.undisturbed_digest(SETS as u64);
        let run = format!("undisturbed-{SETS}");
        let summary = scratch.summary(&run);
        assert_eq!(summary.digest, digest);
        Undisturbed { ledger: scratch.ledger(&run), summary }
    }
}

/// One schedule: the lives of a build, all but the last disturbed.
struct Schedule<'a> {
    seed: u64,
    random: Random,
    scratch: Scratch,
    whole: &'a Undisturbed,
    /// Whether a life came to the end of the build, behind which nothing is ever written.
    has_finished: bool,
    /// What was done, for whoever looks for the reason of a failure.
    story: Vec<String>,
}

impl Drop for Schedule<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            let story = self.story.join("\n  ");
            eprintln!("run again with ROADMILL_CHAOS_SEED={}\n  {story}", self.seed);
        }
    }
}

impl Schedule<'_> {
    fn run(mut self) {
        let lives = 1 + self.random.below(4);
        // Only a process that ends of itself can say that it was ended.
        let mut notes = 0;
        for life in 0..lives {
            let running = self.start(life);
            // A second signal leaves no time to tidy up; the next life does.
            let at_once = self.disturb(&running);
            let done = if at_once { running.end() } else { running.finish() };
            let (code, signal) = (done.status.code(), done.status.signal());
            self.story.push(format!("ended: code {code:?}, signal {signal:?}"));
            notes += usize::from(code.is_some_and(|code| code != 0));
            assert!(
                matches!(code, Some(0 | 5 | 6)) || signal.is_some_and(|signal| signal != 7),
                "{done:?}"
            );
            self.has_finished |= code == Some(0);
            self.no_process_is_left();
            if signal.is_some() && !self.has_finished {
                self.tear();
            }
        }
        let done = self.start_with("").finish();
        done.assert_code(0);
        self.compare(notes, &done);
        self.nothing_is_left();
    }

    fn start(&mut self, life: usize) -> Running {
        let mut faults = Vec::new();
        for number in 0..self.random.below(3) {
            let name = ["garble-at", "twice-at", "half-at"][self.random.below(3)];
            let (label, sets) = [("a", SETS / 3 * 2), ("b", SETS / 3)][self.random.below(2)];
            let mark = self.scratch.path(&format!("mark-{life}-{number}"));
            let ordinal = self.random.below(sets);
            faults.push(format!("{name}={label}:{ordinal}:{}", mark.display()));
        }
        self.start_with(&faults.join(","))
    }

    /// By either command, with any number of workers.
    fn start_with(&mut self, faults: &str) -> Running {
        let workers = (1 + self.random.below(4)).to_string();
        let sets = SETS.to_string();
        let build = ["build", "endless.toml", "--out", "run", "--or-resume", "--max-sets", &*sets];
        let begun = self.scratch.path("run/ledger").is_file();
        let command =
            if begun && self.random.below(2) == 0 { &["resume", "run"][..] } else { &build };
        let arguments = [command, &["--workers", &workers]].concat();
        self.story.push(format!("{arguments:?} {faults}"));
        self.scratch.start_with_faults(&arguments, faults)
    }

    /// A moment that passes by the clock, or until the build has come further.
    fn wait(&mut self, running: &Running) {
        if self.random.below(2) == 0 {
            let range = [3, 40, 400][self.random.below(3)];
            let moment = self.random.below(range) as u64;
            return thread::sleep(Duration::from_millis(moment));
        }
        let path = self.scratch.path("run/ledger");
        let length = || fs::metadata(&path).map_or(0, |metadata| metadata.len() as usize);
        let further = length() + self.random.below(self.whole.ledger.len() / 3);
        wait_until("the ledger to grow, or the end", || length() > further || !running.is_alive());
    }

    /// Whether it was told twice to end.
    fn disturb(&mut self, running: &Running) -> bool {
        for _ in 0..1 + self.random.below(4) {
            self.wait(running);
            let workers = running.workers();
            let worker = match workers.len() {
                0 => None,
                count => Some(workers[self.random.below(count)]),
            };
            let what = self.random.below(8);
            self.story.push(format!("{what} to {worker:?} of {workers:?}"));
            match (what, worker) {
                (0, Some(worker)) => send(worker, Signal::KILL),
                (1, Some(worker)) => send(worker, Signal::TERM),
                (2, _) => workers.iter().for_each(|worker| send(*worker, Signal::KILL)),
                (3, Some(worker)) => {
                    send(worker, Signal::STOP);
                    self.wait_by_clock();
                    send(worker, Signal::CONT);
                }
                (4, _) => {
                    running.signal(Signal::STOP);
                    // Workers may die meanwhile.
                    if let Some(worker) = worker.filter(|_| self.random.below(2) == 0) {
                        send(worker, Signal::KILL);
                    }
                    self.wait_by_clock();
                    running.signal(Signal::CONT);
                }
                (5, _) => {
                    running.signal(Signal::KILL);
                    return false;
                }
                (6, Some(worker)) => {
                    // Stopped, it cannot end by itself when the coordinator does.
                    send(worker, Signal::STOP);
                    running.signal(Signal::KILL);
                    return false;
                }
                (7, _) => {
                    let signals = [Signal::TERM, Signal::INT, Signal::HUP];
                    let signal = signals[self.random.below(3)];
                    running.signal(signal);
                    let at_once = self.random.below(3) == 0;
                    if at_once {
                        running.signal(signal);
                    }
                    return at_once;
                }
                _ => {}
            }
        }
        self.wait(running);
        match self.random.below(3) {
            0 => running.signal(Signal::KILL),
            1 => running.signal(Signal::TERM),
            _ => {}
        }
        false
    }

    fn wait_by_clock(&mut self) {
        thread::sleep(Duration::from_millis(self.random.below(300) as u64));
    }

    /// The kernel ends workers with the coordinator, also stopped ones, except one that was stopped before
    /// it could ask for that. That one ends as soon as it runs again.
    fn no_process_is_left(&self) {
        let temporary = self.scratch.temporary();
        let mut looks = 0;
        wait_until("the end of all workers", || {
            let left = processes_naming(&temporary);
            looks += 1;
            if looks % 100 == 0 {
                left.iter().for_each(|process| send(*process, Signal::CONT));
            }
            left.is_empty()
        });
    }

    /// What the failure of the machine may do to a ledger: anything, beyond the durable mark.
    fn tear(&mut self) {
        let run = self.scratch.path("run");
        let (ledger, side) = (run.join("ledger"), run.join("ledger.durable"));
        let Ok(file) = File::options().write(true).open(&ledger) else { return };
        let slots = fs::read(&side).expect("made before the ledger");
        let (mark, older) = newest(&slots);
        let length = file.metadata().expect("it is there").len() as usize;
        let behind = length - mark;
        let what = self.random.below(5);
        let place = mark + self.random.below(behind + 1);
        self.story.push(format!("tear {what} at {place}: {mark} of {length} bytes are durable"));
        let rubbish: Vec<u8> = (0..70).map(|_| self.random.below(256) as u8).collect();
        match what {
            0 => file.set_len(place as u64).expect("it can be cut"),
            1 if behind > 0 => {
                let place = place.min(length - 1) as u64;
                file.write_all_at(&rubbish[..1], place).expect("it can be written");
            }
            2 => file.write_all_at(&rubbish, length as u64).expect("it can be written"),
            3 => {
                let side = File::options().write(true).open(&side).expect("it is there");
                side.write_all_at(&rubbish, older as u64).expect("it can be written");
            }
            _ => {}
        }
    }

    fn compare(&self, notes: usize, done: &Done) {
        let summary = self.scratch.summary("run");
        assert_eq!(summary.result(), self.whole.summary.result(), "{}", done.stderr);
        let ledger = self.scratch.ledger("run");
        let without_stops = |ledger: &[u8]| -> Vec<Vec<u8>> {
            let payloads = frames(ledger).into_iter().map(|frame| frame.payload);
            payloads.filter(|payload| payload[0] != 4).collect()
        };
        let (found, expected) = (without_stops(&ledger), without_stops(&self.whole.ledger));
        assert_eq!(found.len(), expected.len());
        let first = found.iter().zip(&expected).position(|(found, expected)| found != expected);
        assert_eq!(first, None, "the first record that differs");
        if notes == 0 {
            assert!(ledger == self.whole.ledger, "killed only, and another ledger");
        }
        let stops = frames(&ledger).len() - found.len();
        assert!((1..=1 + notes).contains(&stops), "{stops} stops, {notes} ends that say so");
    }

    fn nothing_is_left(&self) {
        self.no_process_is_left();
        assert_eq!(self.scratch.left(), [] as [&Path; 0], "of the channels");
        assert_eq!(self.scratch.temporary_files(), [] as [&Path; 0]);
        for path in children(&self.scratch.path("run")) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let known = ["ledger", "ledger.durable", "lock", "summary.json"];
            assert!(known.contains(&&*name) || name.starts_with("ledger.torn-"), "{name}");
        }
        let lock = fs::metadata(self.scratch.path("run/lock")).expect("it stays");
        assert_eq!(lock.len(), 0, "nobody holds it");
    }
}

/// The offset of the durable mark, and where the slot is that does not count.
fn newest(side: &[u8]) -> (usize, usize) {
    let slot = |start: usize| {
        let (body, check) = side[start..start + 88].split_at(56);
        let mut fields = Fields(body);
        let (sequence, offset) = (fields.u64(), fields.u64());
        (hash(&[body]) == check).then_some((sequence, offset as usize, 4096 - start))
    };
    let (_, offset, older) = slot(0).max(slot(4096)).expect("one of them can be read");
    (offset, older)
}

#[test]
fn no_schedule_of_deaths_and_nonsense_changes_a_bit_or_leaves_anything() {
    let number = |name| std::env::var(name).ok().map(|text| text.parse::<u64>().expect("a number"));
    let seeds = match number("ROADMILL_CHAOS_SEED") {
        Some(only) => only..only + 1,
        None => 0..number("ROADMILL_CHAOS").unwrap_or(6),
    };
    let whole = Undisturbed::new();
    let next = AtomicU64::new(seeds.start);
    thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if !seeds.contains(&seed) {
                        return;
                    }
                    let (random, scratch) = (Random::new(seed), Scratch::new());
                    scratch.write("endless.toml", ENDLESS);
                    Schedule {
                        seed,
                        random,
                        scratch,
                        whole: &whole,
                        has_finished: false,
                        story: Vec::new(),
                    }
                    .run();
                }
            });
        }
    });
    println!("{} schedules", seeds.end - seeds.start);
}
