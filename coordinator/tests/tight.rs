//! Disks and shared memory that are too small, as mounts that nobody else sees.

mod support;

use std::process::Command;
use support::{Done, ENDLESS, Scratch};

/// Becomes root of a user namespace with mounts of its own.
const UNSHARE: [&str; 4] = ["unshare", "--user", "--map-root-user", "--mount"];

/// Whether this system lets everybody mount in a namespace. Says so if not.
fn may_mount() -> bool {
    let mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", "/dev/shm"];
    let tried = Command::new(UNSHARE[0]).args(&UNSHARE[1..]).args(mount).output();
    let may = tried.is_ok_and(|output| output.status.success());
    if !may {
        eprintln!("skipped: no private mounts are allowed here");
    }
    may
}

/// Runs a script in the folder of `scratch` with mounts of its own; `$roadmill` is the program.
fn run(scratch: &Scratch, script: &str) -> Done {
    let mut command = Command::new(UNSHARE[0]);
    command.args(&UNSHARE[1..]).args(["sh", "-c", &format!("set -e\n{script}")]);
    command.env("roadmill", env!("CARGO_BIN_EXE_roadmill"));
    scratch.start_command(command, "").finish()
}

#[test]
fn a_full_disk_ends_a_build_and_it_goes_on_once_there_is_space() {
    if !may_mount() {
        return;
    }
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    for crew in ["--workers 2", "--threads 2"] {
        let done = run(
            &scratch,
            &format!(
                "mkdir -p disk; mount -t tmpfs -o size=256k tmpfs disk
                 $roadmill build endless.toml --out disk/run {crew} --max-sets 400 || echo code $?
                 $roadmill status disk/run
                 $roadmill verify disk/run --sample 2% --threads 1
                 $roadmill resume disk/run {crew} || echo code $?
                 cp disk/run/ledger before
                 mount -o remount,size=64m disk
                 $roadmill resume disk/run {crew}
                 rm -rf run; cp -r disk/run run"
            ),
        );
        done.assert_code(0);
        assert_eq!(done.stdout.matches("code 1\n").count(), 2, "{}", done.stdout);
        done.assert_stderr(&["disk/run", "No space left on device"]);
        assert_eq!(scratch.summary("run").digest, scratch.undisturbed_digest(400));
        let undisturbed = scratch.ledger("undisturbed-400");
        assert!(scratch.ledger("run") == undisturbed, "the ledgers differ");
        std::fs::remove_dir_all(scratch.path("undisturbed-400")).expect("it can be removed");
    }
}

#[test]
fn a_small_shared_memory_suffices_or_is_refused() {
    if !may_mount() {
        return;
    }
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let digest = scratch.undisturbed_digest(48);
    let build = |size: &str, run_folder: &str, workers: u32| {
        let script = format!(
            "mount -t tmpfs -o size={size} tmpfs /dev/shm
             $roadmill build endless.toml --out {run_folder} --workers {workers} --max-sets 48"
        );
        run(&scratch, &script)
    };
    // As much as containers get by default; and hardly more than the program says that it needs.
    for (size, run_folder, workers) in [("64m", "docker", 8), ("3600k", "just", 2)] {
        build(size, run_folder, workers).assert_code(0);
        assert_eq!(scratch.summary(run_folder).digest, digest, "{size}");
    }
    let done = build("1m", "tiny", 2);
    done.assert_code(1);
    done.assert_stderr(&["/dev/shm has", "use fewer workers or enlarge it"]);
    assert!(!scratch.path("tiny").exists(), "nothing was begun");
}
