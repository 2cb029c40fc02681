//! Sets generated apart from a build, and builds that take them in.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{Fields, SETS, file_of, frames_behind};
use std::fs;
use support::{Done, ENDLESS, Scratch};

fn scratch() -> Scratch {
    let scratch = Scratch::new();
    scratch.write("endless.toml", ENDLESS);
    fs::create_dir(scratch.path("parts")).expect("a folder can be made");
    scratch
}

fn generate(scratch: &Scratch, sets: &str, out: &str) -> Done {
    scratch.run(&["generate", "endless.toml", "--sets", sets, "--out", out, "--threads", "2"])
}

fn import(scratch: &Scratch, files: &[&str]) -> Done {
    let build = ["build", "endless.toml", "--out", "run", "--threads", "1", "--max-sets", "24"];
    scratch.run(&[&build[..], &["--import"], files].concat())
}

fn payloads(scratch: &Scratch, name: &str) -> Vec<Vec<u8>> {
    let file = fs::read(scratch.path(name)).expect("it is there");
    frames_behind(SETS, &file).into_iter().map(|frame| frame.payload).collect()
}

fn write(scratch: &Scratch, name: &str, payloads: &[Vec<u8>]) {
    let file = file_of(SETS, payloads.iter().cloned());
    fs::write(scratch.path(name), file).expect("it can be written");
}

#[test]
fn a_build_with_imported_sets_has_the_same_ledger_and_does_not_generate_them() {
    let scratch = scratch();
    // They overlap, and go beyond what is needed.
    for (sets, out) in
        [("a:2..9", "parts/1.sets"), ("a:7..40", "parts/2.sets"), ("b:0..3", "parts/b.sets")]
    {
        let done = generate(&scratch, sets, out);
        done.assert_code(0);
        assert!(done.stdout.contains(sets), "{}", done.stdout);
    }
    let plain = ["endless.toml", "--threads", "2", "--max-sets", "48"];
    scratch.build("plain", &plain, 0);
    // Whoever generated one of these sets would die.
    let faults = "die-at=a:2,die-at=a:8,die-at=a:31,die-at=b:1";
    let build = ["build", "endless.toml", "--workers", "2", "--max-sets", "48"];
    let imports = ["--import", "parts/?.sets", "--out", "run"];
    let done = scratch.start_with_faults(&[&build[..], &imports].concat(), faults).finish();
    done.assert_code(0);
    done.assert_stderr(&["41 sets are imported"]);
    assert!(scratch.ledger("run") == scratch.ledger("plain"), "the ledgers differ");
    scratch.run(&["verify", "run", "--all", "--threads", "2"]).assert_code(0);
    // Without them they are generated, and the sets kill their workers.
    let lonely = [&build[..], &["--out", "lonely"]].concat();
    scratch.start_with_faults(&lonely, faults).finish().assert_code(5);
    // What is there goes on with them.
    let go_on = [&build[..], &["--out", "lonely", "--or-resume"], &imports[..2]].concat();
    scratch.start_with_faults(&go_on, faults).finish().assert_code(0);
    assert_eq!(scratch.summary("lonely").digest, scratch.summary("plain").digest);
}

#[test]
fn files_that_do_not_belong_to_the_build_are_refused_by_name() {
    let scratch = scratch();
    generate(&scratch, "a:0..3", "parts/a.sets").assert_code(0);
    let records = payloads(&scratch, "parts/a.sets");
    let refused = |files: &[&str], code: i32, what: &[&str]| {
        let done = import(&scratch, files);
        done.assert_code(code);
        done.assert_stderr(what);
        assert!(!scratch.path("run").exists(), "nothing was begun");
    };
    refused(&["nowhere/*.sets"], 2, &["nowhere/*.sets", "no such file"]);
    refused(&["endless.toml"], 2, &["endless.toml: no file of sets"]);
    let other =
        ["generate", "endless.toml", "--seed", "5", "--sets", "a:0..1", "--out", "seed.sets"];
    scratch.run(&other).assert_code(0);
    refused(&["parts/a.sets", "seed.sets"], 2, &["seed.sets: sets of a problem with digest"]);

    // The beginning: kind, program, version of the bits, digest of the problem, label.
    let mut fields = Fields(&records[0]);
    fields.u32();
    fields.text();
    let bits = records[0].len() - fields.0.len();
    fields.u32();
    fields.hash();
    assert_eq!(fields.text(), "a");
    assert_eq!((fields.u64(), fields.u64()), (0, 3));
    assert!(fields.0.is_empty());
    let label = records[0].len() - 8 - 8 - 1;
    for (byte, what) in [(bits, "bits of version"), (label, "sets of `!` found")] {
        let mut changed = records.clone();
        changed[0][byte] = b'!';
        write(&scratch, "changed.sets", &changed);
        refused(&["changed.sets"], 2, &["changed.sets", what]);
    }
    // A milestone of the second set, hashes and all.
    let mut changed = records.clone();
    changed[2][40] ^= 1;
    write(&scratch, "changed.sets", &changed);
    refused(&["parts/*.sets", "changed.sets"], 2, &["changed.sets: set a:1 is another one"]);
    // A set that is not in turn, and one that is missing.
    let mut changed = records.clone();
    changed.swap(1, 2);
    write(&scratch, "changed.sets", &changed);
    refused(&["changed.sets"], 4, &["changed.sets: damaged", "set 0 expected"]);
    write(&scratch, "changed.sets", &records[..3]);
    refused(&["changed.sets"], 4, &["changed.sets: damaged", "cut off"]);
    // Alone it cannot be told from a right one here; `verify` can.
    let mut changed = records.clone();
    changed[2][40] ^= 1;
    write(&scratch, "changed.sets", &changed);
    import(&scratch, &["changed.sets"]).assert_code(0);
    let verified = scratch.run(&["verify", "run", "--set", "a:1", "--threads", "1"]);
    verified.assert_code(7);
}

#[test]
fn every_damaged_byte_of_a_file_is_noticed() {
    let scratch = scratch();
    generate(&scratch, "b:1..3", "parts/b.sets").assert_code(0);
    let file = fs::read(scratch.path("parts/b.sets")).expect("it is there");
    // A process each: at the edges of the heading and of the records, and in between.
    let mut bytes = vec![0, 14, 15];
    for frame in frames_behind(SETS, &file) {
        bytes.extend([frame.start, frame.start + 9, frame.start + 20, frame.end - 1]);
    }
    for byte in bytes {
        let mut damaged = file.clone();
        damaged[byte] ^= 0x10;
        fs::write(scratch.path("damaged.sets"), &damaged).expect("it can be written");
        let done = import(&scratch, &["damaged.sets"]);
        done.assert_code(if byte < 16 { 2 } else { 4 });
        done.assert_stderr(&["damaged.sets"]);
    }
}

#[test]
fn a_file_is_there_whole_or_not_at_all_and_none_is_replaced_unasked() {
    let scratch = scratch();
    generate(&scratch, "a:0..2", "parts/a.sets").assert_code(0);
    let first = fs::read(scratch.path("parts/a.sets")).expect("it is there");
    let done = generate(&scratch, "a:0..3", "parts/a.sets");
    done.assert_code(2);
    done.assert_stderr(&["parts/a.sets: exists already", "--force"]);
    assert!(fs::read(scratch.path("parts/a.sets")).expect("it is there") == first);
    let again =
        ["generate", "endless.toml", "--sets", "a:0..2", "--out", "parts/a.sets", "--force"];
    scratch.run(&again).assert_code(0);
    assert!(
        fs::read(scratch.path("parts/a.sets")).expect("it is there") == first,
        "the same bytes"
    );
    for (sets, what) in
        [("c:0..2", "one of a, b expected"), ("a:2..2", "FIRST..END"), ("a", "FIRST..END")]
    {
        let done = generate(&scratch, sets, "parts/c.sets");
        done.assert_code(2);
        done.assert_stderr(&[what]);
    }
    let endless =
        ["generate", "endless.toml", "--sets", "a:0..1000000000", "--out", "parts/c.sets"];
    let running = scratch.start(&endless);
    support::wait_until("the file", || support::children(&scratch.path("parts")).len() > 1);
    running.signal(rustix::process::Signal::TERM);
    running.finish().assert_code(6);
    assert_eq!(support::children(&scratch.path("parts")), [scratch.path("parts/a.sets")]);
}
