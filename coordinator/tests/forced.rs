//! `--force`: there is a whole run at the path at every moment, and no run at work is touched.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{Fields, frames};
use rustix::process::Signal;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;
use support::{ENDLESS, Random, Scratch, children, trials, wait_until};

/// The same with another seed.
fn other() -> String {
    ENDLESS.replace("seed = 11", "seed = 12")
}

/// A folder with the problems `old.toml` and `new.toml`, and a run of the old one.
fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("old.toml", ENDLESS);
    scratch.write("new.toml", &other());
    fs::create_dir(scratch.path("runs")).expect("a folder can be made");
    scratch.build("runs/run", &["old.toml", "--threads", "1", "--max-sets", "4"], 0);
    scratch
}

const FORCE: [&str; 8] =
    ["build", "new.toml", "--out", "runs/run", "--force", "--max-sets", "8", "--workers"];

/// Everything beside the run.
fn beside(scratch: &Scratch) -> Vec<String> {
    let names = children(&scratch.path("runs")).into_iter();
    let names = names.map(|path| path.file_name().unwrap().to_string_lossy().into_owned());
    names.filter(|name| name != "run").collect()
}

/// Waits until what killed builds have left is gone: their workers end a moment later.
fn settle(scratch: &Scratch) {
    wait_until("nothing to be left", || {
        let build = ["build", "old.toml", "--out", "tidy", "--force", "--max-sets", "4"];
        scratch.run(&[&build[..], &["--threads", "1"]].concat()).assert_code(0);
        scratch.temporary_files().is_empty()
    });
}

/// The seed of the problem in the run at the path, whose ledger must have its beginning.
fn seed_of(run: &Path) -> u64 {
    let ledger = fs::read(run.join("ledger")).expect("there is a run");
    let frames = frames(&whole_part(&ledger));
    let mut fields = Fields(&frames[0].payload);
    // Kind and round, the program's version, its bits and the problem's name come before.
    fields.u32();
    fields.u64();
    fields.text();
    fields.u32();
    fields.text();
    fields.u64()
}

/// The records of a ledger that is being written, but for the last.
fn whole_part(ledger: &[u8]) -> Vec<u8> {
    let (mut at, mut end) = (16, 16);
    while at + 48 <= ledger.len() {
        let length = u64::from_le_bytes(ledger[at..at + 8].try_into().unwrap()) as usize;
        at += 48 + length;
        if at <= ledger.len() {
            end = at;
        }
    }
    ledger[..end].to_vec()
}

#[test]
fn a_run_replaces_another_and_leaves_nothing_beside_it() {
    let scratch = scratch();
    let done = scratch.run(&[&FORCE[..], &["2"]].concat());
    done.assert_code(0);
    assert_eq!((seed_of(&scratch.path("runs/run")), beside(&scratch)), (12, vec![]));
    // Where nothing is the folder is made.
    fs::remove_dir_all(scratch.path("runs/run")).expect("it is there");
    scratch.run(&[&FORCE[..], &["1"]].concat()).assert_code(0);
    assert_eq!((seed_of(&scratch.path("runs/run")), beside(&scratch)), (12, vec![]));
}

/// However few files may be open at a time, a build that cannot begin changes nothing, and whatever its end nothing
/// is left beside the run, of temporary files or in shared memory.
#[test]
fn a_build_that_may_open_few_files_leaves_nothing() {
    let scratch = scratch();
    let mut seed = 11;
    // From too few for the program to start to enough for two workers.
    for files in 6..=32 {
        seed += 1;
        let mut command = std::process::Command::new("sh");
        let script = format!("ulimit -n {files}; exec \"$0\" \"$@\"");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_roadmill")]);
        command.args(&FORCE[..2]).args(["--seed", &seed.to_string()]).args(&FORCE[2..]).arg("2");
        let before = seed_of(&scratch.path("runs/run"));
        // Which also finds what is left in shared memory.
        let done = scratch.start_command(command, "").finish();
        let code = done.status.code();
        assert!(matches!(code, Some(0..=2)), "{files}: {code:?}: {}", done.stderr);
        assert_eq!(scratch.temporary_files(), [] as [PathBuf; 0], "{files}: {}", done.stderr);
        assert_eq!(beside(&scratch), [""; 0], "{files}: {}", done.stderr);
        let now = seed_of(&scratch.path("runs/run"));
        assert!(now == before || now == seed, "{files}: {before}, {now}: {}", done.stderr);
        assert!(code != Some(0) || now == seed, "{files}: {now}: {}", done.stderr);
    }
}

/// Of several at once one replaces the run, and the others say who works on it.
#[test]
fn builds_that_replace_a_run_at_once_are_kept_apart() {
    let scratch = scratch();
    for round in 0..trials(8) {
        if round % 2 == 1 {
            // Then it is about who is first.
            fs::remove_dir_all(scratch.path("runs/run")).expect("it is there");
        }
        let running: Vec<_> =
            (0..3).map(|_| scratch.start(&[&FORCE[..], &["1"]].concat())).collect();
        let done: Vec<_> = running.into_iter().map(|build| build.finish()).collect();
        let codes: Vec<_> = done.iter().map(|done| done.status.code().unwrap_or(-1)).collect();
        assert!(codes.contains(&0), "{round}: {codes:?}");
        assert!(codes.iter().all(|code| [0, 2].contains(code)), "{round}: {codes:?}");
        for loser in done.iter().filter(|done| done.status.code() == Some(2)) {
            let says = |text: &str| loser.stderr.contains(text);
            assert!(says("works on this run") || says("meanwhile"), "{round}: {}", loser.stderr);
        }
        assert_eq!(beside(&scratch), [""; 0]);
        scratch.run(&["verify", "runs/run", "--threads", "1"]).assert_code(0);
    }
}

/// A live run keeps its place, whenever somebody tries.
#[test]
fn a_run_at_work_is_not_replaced() {
    let scratch = scratch();
    let build = ["build", "old.toml", "--out", "runs/live", "--workers", "1"];
    let running = scratch.start(&build);
    wait_until("the ledger", || scratch.path("runs/live/ledger").exists());
    let force = ["build", "new.toml", "--out", "runs/live", "--force", "--max-sets", "4"];
    for _ in 0..3 {
        let done = scratch.run(&force);
        done.assert_code(2);
        done.assert_stderr(&["works on this run"]);
    }
    running.signal(Signal::TERM);
    running.finish().assert_code(6);
    assert_eq!(seed_of(&scratch.path("runs/live")), 11);
    scratch.run(&force).assert_code(0);
    assert_eq!(seed_of(&scratch.path("runs/live")), 12);
}

#[test]
fn a_kill_at_any_moment_leaves_a_whole_run_at_the_path() {
    let scratch = scratch();
    let mut random = Random::new(0xf0);
    let mut replaced = 0;
    for _ in 0..trials(15) {
        let before = seed_of(&scratch.path("runs/run"));
        let seed = before + 1;
        let text = seed.to_string();
        let force = [
            "build",
            "new.toml",
            "--seed",
            &text,
            "--out",
            "runs/run",
            "--force",
            "--workers",
            "1",
        ];
        let running = scratch.start(&force);
        thread::sleep(Duration::from_micros(random.below(60_000) as u64));
        running.signal(Signal::KILL);
        running.end();
        let now = seed_of(&scratch.path("runs/run"));
        assert!(now == before || now == seed, "{before}, {seed}: {now}");
        replaced += u64::from(now == seed);
        let next = scratch.run(&["resume", "runs/run", "--threads", "1", "--max-sets", "4"]);
        assert!([0, 2].contains(&next.status.code().unwrap_or(-1)), "{}", next.stderr);
        assert_eq!(beside(&scratch), [""; 0], "the next command tidies up");
    }
    eprintln!("{replaced} of {} replaced", trials(15));
    settle(&scratch);
}

/// Between the start of a build and its first round.
#[test]
fn a_build_killed_while_it_starts_goes_on_at_once() {
    let scratch = Scratch::new();
    scratch.write("old.toml", ENDLESS);
    let mut random = Random::new(0x57);
    let mut resumed = 0usize;
    for number in 0..trials(8) {
        let run = format!("run{number}");
        let running = scratch.start(&["build", "old.toml", "--out", &run, "--workers", "4"]);
        let wanted = 1 + random.below(4);
        wait_until("workers", || {
            let path = format!("/proc/{0}/task/{0}/children", running.pid());
            let children = fs::read_to_string(path).unwrap_or_default();
            children.split_whitespace().count() >= wanted || !running.is_alive()
        });
        running.signal(Signal::KILL);
        running.end();
        let resume = ["resume", &run, "--threads", "1", "--max-sets", "4"];
        scratch.run(&resume).assert_code(0);
        resumed += 1;
    }
    assert_eq!(resumed, trials(8));
    settle(&scratch);
}

/// An import replaces a problem file in one step, too, and tidies up after others that were killed.
#[test]
fn an_import_replaces_a_problem_and_what_dead_ones_have_left() {
    let scratch = Scratch::new();
    scratch.write("old.toml", ENDLESS);
    scratch.write("new.toml", &other());
    let import = |from: &str| {
        scratch.run(&["import", from, "--out", "out/copy.toml", "--force"]).assert_code(0);
        let check = scratch.run(&["check", "out/copy.toml"]);
        let original = scratch.run(&["check", from]);
        let digest = |done: &support::Done| {
            let line = done.stdout.lines().find(|line| line.contains("digest"));
            line.expect("there is a digest").to_owned()
        };
        assert_eq!(digest(&check), digest(&original));
    };
    fs::create_dir(scratch.path("out")).expect("a folder can be made");
    import("old.toml");
    let mut child = std::process::Command::new("true").spawn().expect("it starts");
    child.wait().expect("it ends");
    let left = scratch.path(&format!("out/.copy.toml.import-{}", child.id()));
    fs::create_dir(&left).expect("a folder can be made");
    fs::write(left.join("copy.toml"), "half").expect("it can be written");
    import("new.toml");
    assert_eq!(children(&scratch.path("out")), [scratch.path("out/copy.toml")]);
}

/// Problems with meshes, which stand in a folder beside the file.
#[test]
fn an_import_that_is_killed_leaves_a_whole_problem_and_the_next_tidies_up() {
    let scratch = Scratch::new();
    scratch.write(
        "corner.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    let mesh = |scale: &str| {
        let shape = format!("{{ mesh = {{ file = \"corner.obj\", scale = {scale} }} }}");
        format!("{ENDLESS}[[obstacles]]\nshape = {shape}\nposition = [0.1, 0.1, 0.1]\n")
    };
    scratch.write("old.toml", &mesh("0.2"));
    scratch.write("new.toml", &mesh("0.3"));
    let digest = |file: &str| {
        let check = scratch.run(&["check", file]);
        check.assert_code(0);
        let line = check.stdout.lines().find(|line| line.contains("digest"));
        line.expect("there is a digest").to_owned()
    };
    let digests = ["old.toml", "new.toml"].map(digest);
    fs::create_dir(scratch.path("out")).expect("a folder can be made");
    let import = |from: &str| scratch.start(&["import", from, "--out", "out/copy.toml", "--force"]);
    let names = || {
        let mut names: Vec<_> = children(&scratch.path("out")).into_iter().collect();
        names.sort();
        names
    };
    let [file, meshes, others] =
        ["copy.toml", "copy-meshes", "copy-meshes-2"].map(|name| scratch.path("out").join(name));
    import("old.toml").finish().assert_code(0);
    assert_eq!(names(), [meshes.clone(), file.clone()]);
    // The new meshes stand beside the old ones, and only the file is replaced.
    import("new.toml").finish().assert_code(0);
    assert_eq!(names(), [others, file.clone()]);
    assert_eq!(digest("out/copy.toml"), digests[1]);
    let mut random = Random::new(0x1e);
    for _ in 0..trials(10) {
        let present = digest("out/copy.toml");
        let other = if present == digests[0] { "new.toml" } else { "old.toml" };
        let running = import(other);
        thread::sleep(Duration::from_micros(random.below(12_000) as u64));
        running.signal(Signal::KILL);
        running.end();
        let now = digest("out/copy.toml");
        assert!(digests.contains(&now), "{now}");
    }
    import("old.toml").finish().assert_code(0);
    assert_eq!(digest("out/copy.toml"), digests[0]);
    assert_eq!(names().len(), 2, "{:?}", names());
    // One that was killed between its two steps: the meshes are there, the file is not.
    let mut child = std::process::Command::new("true").spawn().expect("it starts");
    child.wait().expect("it ends");
    let left = scratch.path(&format!("out/.copy.toml.import-{}", child.id()));
    fs::create_dir(&left).expect("a folder can be made");
    fs::write(left.join("copy.toml"), "half").expect("it can be written");
    fs::write(left.join("folders"), "copy-meshes-7\0copy-meshes\0").expect("it can be written");
    fs::create_dir(scratch.path("out/copy-meshes-7")).expect("a folder can be made");
    import("new.toml").finish().assert_code(0);
    assert_eq!(digest("out/copy.toml"), digests[1]);
    assert_eq!(names().len(), 2, "{:?}", names());
}

/// Meshes go when a problem of another kind, or one without any, comes to stand there, and so do structures; a folder that the
/// problem did not use stays.
#[test]
fn what_a_replaced_problem_used_goes_whatever_comes_after_it() {
    let scratch = Scratch::new();
    scratch.write(
        "corner.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    let shape = "{ mesh = { file = \"corner.obj\", scale = 0.2 } }";
    let meshes = format!("{ENDLESS}[[obstacles]]\nshape = {shape}\nposition = [0.1, 0.1, 0.1]\n");
    scratch.write("meshes.toml", &meshes);
    scratch.write("plain.toml", ENDLESS);
    fs::create_dir(scratch.path("out")).expect("a folder can be made");
    let peptide = concat!(env!("CARGO_MANIFEST_DIR"), "/../problems/structures/1UAO.pdb");
    let write = |command: &[&str]| {
        let out = ["--out", "out/copy.toml", "--force"];
        scratch.run(&[command, &out].concat()).assert_code(0);
        scratch.run(&["check", "out/copy.toml"]).assert_code(0);
        let mut names: Vec<String> = children(&scratch.path("out"))
            .iter()
            .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
            .collect();
        names.sort();
        names
    };
    let (meshes, plain) = (["import", "meshes.toml"], ["import", "plain.toml"]);
    let protein = ["protein", "problem", peptide];
    assert_eq!(write(&meshes), ["copy-meshes", "copy.toml"]);
    assert_eq!(write(&protein), ["copy-structures", "copy.toml"]);
    assert_eq!(write(&plain), ["copy.toml"]);
    assert_eq!(write(&meshes), ["copy-meshes", "copy.toml"]);
    assert_eq!(write(&plain), ["copy.toml"]);
    fs::create_dir(scratch.path("out/copy-structures-3")).expect("a folder can be made");
    scratch.write("out/copy-structures-3/mine.cif", "data_mine\n");
    assert_eq!(write(&meshes), ["copy-meshes", "copy-structures-3", "copy.toml"]);
    assert_eq!(write(&plain), ["copy-structures-3", "copy.toml"]);
}
