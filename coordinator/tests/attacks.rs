//! Another user of the machine, who may put files into `/dev/shm` and open what others leave open, changes no result.
//! Only root can play another user: elsewhere these tests are skipped.

mod support;

use rustix::process::{geteuid, getppid};
use std::fs::{self, File};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use support::{ENDLESS, Scratch, children, trials};

const ROLE: &str = "ROADMILL_TEST_ATTACKER";
/// The user `nobody` of most systems.
const OTHER: u32 = 65534;

/// Whether tests can play another user here. Says so if not.
fn may_be_another() -> bool {
    let may = geteuid().is_root();
    if !may {
        eprintln!("skipped: only root can play another user");
    }
    may
}

/// What this very executable does when it is started as the other user.
#[test]
fn attacker() {
    if std::env::var_os(ROLE).is_some() {
        attack();
    }
}

/// Until it is ended: creates first whatever a run could look for, and opens and shortens what it can. Says what it
/// could do.
fn attack() {
    let end = Instant::now() + Duration::from_secs(600);
    let parent = getppid();
    // Not longer than the test that has started it.
    while Instant::now() < end && getppid() == parent {
        for path in children(Path::new("/dev/shm")) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            // Its own files have names with a dash below.
            if !name.starts_with("roadmill-") || name.contains('_') {
                continue;
            }
            let mut touched = children(&path);
            touched.push(path.clone());
            for file in touched.iter().filter(|file| file.is_file()) {
                if let Ok(opened) = File::options().write(true).open(file) {
                    let _ = opened.set_len(0);
                    println!("opened {}", file.display());
                }
            }
            for number in 0..40 {
                for kind in ["configs", "edges", "store", "claim"] {
                    // In the run's folder, and beside it.
                    let inside = path.join(format!("{kind}-{number}"));
                    let beside = PathBuf::from(format!("{}_{kind}-{number}", path.display()));
                    if plant(&inside) {
                        println!("made {}", inside.display());
                    }
                    plant(&beside);
                }
            }
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}

fn plant(path: &Path) -> bool {
    let made = File::options().write(true).create_new(true).mode(0o644).open(path);
    made.is_ok_and(|file| file.set_len(81920).is_ok())
}

/// Starts the attacker; `None`, with a word, where that user may not run this test.
fn start(says: &Path) -> Option<Child> {
    let mut command = Command::new(std::env::current_exe().expect("the test is a file"));
    command.args(["--exact", "attacker", "--nocapture"]).env(ROLE, "1").current_dir("/");
    command.stdout(File::create(says).expect("a file")).stderr(Stdio::null());
    let started = command.uid(OTHER).gid(OTHER).spawn();
    if let Err(error) = &started {
        eprintln!("skipped: the other user may not run this test: {error}");
    }
    started.ok()
}

#[test]
fn another_user_changes_no_result() {
    if !may_be_another() {
        return;
    }
    let scratch = Scratch::new();
    let digest = scratch.undisturbed_digest(200);
    let says = scratch.path("says");
    let Some(mut attacker) = start(&says) else { return };
    for number in 0..trials(4) {
        let run = format!("run{number}");
        let build = ["endless.toml", "--workers", "3", "--max-sets", "200"];
        let attacked = scratch.start(&[&["build", "--out", &run], &build[..]].concat()).end();
        attacked.assert_code(0);
        assert_eq!(scratch.summary(&run).digest, digest);
    }
    attacker.kill().expect("it is there");
    attacker.wait().expect("it ends");
    let could = fs::read_to_string(&says).expect("it said something");
    let could: Vec<&str> = could
        .lines()
        .filter(|line| line.starts_with("opened") || line.starts_with("made"))
        .collect();
    assert_eq!(could, [""; 0]);
    // The attacker's own files, which are none of the runs'.
    for path in children(Path::new("/dev/shm")) {
        if path.to_string_lossy().contains('_') && path.is_file() {
            let _ = fs::remove_file(path);
        }
    }
}

/// What belongs to another user is neither removed nor in the way of removing the rest.
#[test]
fn leftovers_are_removed_past_what_belongs_to_others() {
    if !may_be_another() {
        return;
    }
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let parent = scratch.temporary().join("roadmill-0");
    let names = ["4194303-00000000000a", "4194303-00000000000b"];
    let mut private = fs::DirBuilder::new();
    private.mode(0o700).recursive(true);
    for name in names {
        private.create(parent.join(name)).expect("it can be made");
        private.create(Path::new("/dev/shm").join(format!("roadmill-{name}"))).expect("made");
    }
    let [foreign, own] = names.map(|name| Path::new("/dev/shm").join(format!("roadmill-{name}")));
    chown(&foreign, Some(OTHER), Some(OTHER)).expect("root may");
    // Threads have nothing to do with these folders, but look after them.
    let build = ["build", "endless.toml", "--max-sets", "4", "--threads", "1", "--out", "run"];
    let done = scratch.run(&build);
    let left = (foreign.exists(), own.exists(), children(&parent).len());
    let _ = fs::remove_dir(&foreign);
    done.assert_code(0);
    assert_eq!(left, (true, false, 0));
}
