//! Disks and shared memory that are too small, as mounts that nobody else sees.

mod support;

use std::process::Command;
use support::{Done, ENDLESS, Random, Scratch, trials};

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
    for (size, run_folder, workers) in [("64m", "docker", 8), ("5400k", "just", 2)] {
        build(size, run_folder, workers).assert_code(0);
        assert_eq!(scratch.summary(run_folder).digest, digest, "{size}");
    }
    let done = build("1m", "tiny", 2);
    done.assert_code(1);
    done.assert_stderr(&["/dev/shm has", "use fewer workers or enlarge it"]);
    assert!(!scratch.path("tiny").exists(), "nothing was begun");
}

/// What takes all shared memory takes nothing from a build but speed, or ends it with a message: never without one.
#[test]
fn shared_memory_that_fills_up_at_any_moment_ends_nothing_without_a_word() {
    if !may_mount() {
        return;
    }
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    let digest = scratch.undisturbed_digest(200);
    let mut random = Random::new(0xf111);
    let mut clean = 0;
    for number in 0..trials(5) {
        let (run_folder, pause) = (format!("run{number}"), random.below(400));
        let workers = 1 + random.below(4);
        let script = format!(
            "mount -t tmpfs -o size=16m tmpfs /dev/shm
             $roadmill build endless.toml --out {run_folder} --workers {workers} --max-sets 200 &
             sleep 0.{pause:03}
             dd if=/dev/zero of=/dev/shm/filler bs=4k 2> /dev/null || true
             wait $! && code=0 || code=$?
             rm /dev/shm/filler
             echo code $code"
        );
        let done = run(&scratch, &script);
        done.assert_code(0);
        if done.stdout.contains("code 0\n") {
            clean += 1;
        } else {
            // No code of a signal, and it says why.
            let is_said = ["code 1\n", "code 5\n"].iter().any(|code| done.stdout.contains(code));
            assert!(is_said, "{}\n{}", done.stdout, done.stderr);
            done.assert_stderr(&["roadmill: "]);
        }
        if scratch.path(&run_folder).join("ledger").exists() {
            let resume = [
                "build",
                "endless.toml",
                "--out",
                &run_folder,
                "--or-resume",
                "--max-sets",
                "200",
                "--threads",
                "1",
            ];
            scratch.run(&resume).assert_code(0);
            assert_eq!(scratch.summary(&run_folder).digest, digest);
        }
    }
    eprintln!("{clean} of {} came to their end in one go", trials(5));
}

#[test]
fn a_full_disk_is_the_systems_failure_and_nothing_is_left_on_it() {
    if !may_mount() {
        return;
    }
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    scratch.build("run", &["endless.toml", "--threads", "1", "--max-sets", "60"], 0);
    let pose = "1 0.6 1 1 0 0 0";
    let script = format!(
        "mkdir small; mount -t tmpfs -o size=8k tmpfs small
         for command in 'export run --format graphml --out small/out.graphml' \
             'import endless.toml --out small/in.toml' \
             'generate endless.toml --sets a:0..40 --out small/part.sets --threads 1'; do
             $roadmill $command && echo code 0 || echo code $?
         done
         dd if=/dev/zero of=small/filler bs=1k 2> /dev/null || true
         $roadmill query run --start '{pose}' --goal '{pose}' --out small/path.csv || echo code $?
         rm small/filler; echo left $(ls -A small)
         # Room for the nodes of a table, and not for its edges.
         $roadmill export run --format csv --out all.csv
         mkdir half; mount -t tmpfs -o size=$(($(stat -c %s all.csv) / 1024 + 8))k tmpfs half
         $roadmill export run --format csv --out half/out.csv || echo code $?
         echo left $(ls -A half)"
    );
    let done = run(&scratch, &script);
    done.assert_code(0);
    let codes: Vec<&str> = done.stdout.lines().filter(|line| line.starts_with("code")).collect();
    let is_right = codes.iter().all(|code| ["code 1", "code 0"].contains(code));
    assert!(is_right && codes.len() >= 4, "{}\n{}", done.stdout, done.stderr);
    done.assert_stderr(&["out.graphml: cannot write: No space left on device", "path.csv"]);
    let left: Vec<&str> =
        done.stdout.lines().filter_map(|line| line.strip_prefix("left")).collect();
    let is_whole = |name: &str| ["in.toml", "path.csv"].contains(&name);
    assert!(left[0].split_whitespace().all(is_whole), "{left:?}");
    assert_eq!(left[1].trim(), "", "{}", done.stderr);
    done.assert_stderr(&["out.edges.csv: cannot write"]);
}
