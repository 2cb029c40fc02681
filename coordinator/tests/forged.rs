//! Ledgers and files of sets that somebody has forged: every hash in them is right. They are refused with a reason, or
//! `verify --all` finds them out; nothing hangs, panics or takes more memory than the file has bytes for.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{Fields, SETS, file_of, frames, frames_behind, ledger_of, seal, set_places};
use rustix::fs::{CWD, Mode, mkfifoat};
use std::fs;
use std::sync::OnceLock;
use support::{Random, Scratch, trials};

/// Bodies that turn, two strategies, a judgement after each round.
const SMALL: &str = r#"
name = "small"
seed = 5
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [9.0, 9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [0.4, 0.2, 0.2] } } }]
[[obstacles]]
shape = { box = { size = [1.0, 1.0, 1.0] } }
position = [4.0, 4.0, 4.0]
[query]
start = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
goal = [8.0, 8.0, 8.0, 1.0, 0.0, 0.0, 0.0]
[img]
sets_per_round = 2
[[strategies]]
label = "a"
nodes = 4
sampler = { uniform = {} }
[[strategies]]
label = "b"
nodes = 3
sampler = { uniform = {} }
[[evaluators]]
all = [{ query = {} }, { not = { query = {} } }]
[limits]
sets = 8
"#;

/// The payloads of a run of [`SMALL`], built once.
fn small() -> Vec<Vec<u8>> {
    static RUN: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    let run = RUN.get_or_init(|| {
        let scratch = Scratch::new();
        scratch.write("small.toml", SMALL);
        scratch.build("run", &["small.toml", "--threads", "1"], 3);
        frames(&scratch.ledger("run")).into_iter().map(|frame| frame.payload).collect()
    });
    run.clone()
}

fn kind(payload: &[u8]) -> u32 {
    Fields(payload).u32()
}

fn first(payloads: &[Vec<u8>], wanted: u32) -> usize {
    payloads.iter().position(|payload| kind(payload) == wanted).expect("there is one")
}

fn last(payloads: &[Vec<u8>], wanted: u32) -> usize {
    payloads.iter().rposition(|payload| kind(payload) == wanted).expect("there is one")
}

fn put(bytes: &mut [u8], at: usize, value: &[u8]) {
    bytes[at..at + value.len()].copy_from_slice(value);
}

/// Makes the run folder `run` of these payloads.
fn forge(scratch: &Scratch, payloads: Vec<Vec<u8>>) {
    let folder = scratch.path("run");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir(&folder).expect("it can be made");
    fs::write(folder.join("ledger"), ledger_of(payloads)).expect("it can be written");
}

/// Codes of commands that end as commands do.
const ENDS: [i32; 7] = [0, 2, 3, 4, 5, 6, 7];

/// What is read, searched, exported, compared, verified and gone on with: all of it ends. The code of `verify --all`.
#[track_caller]
fn ends(scratch: &Scratch, what: &str, commands: &[&str]) -> (i32, String) {
    let mut verified = (0, String::new());
    for command in commands {
        // `Running::end` fails where something hangs or panics.
        let done = scratch.run(&command.split(' ').collect::<Vec<_>>());
        let code = done.status.code();
        assert!(code.is_some_and(|code| ENDS.contains(&code)), "{what}: {command}: {done:?}");
        if command.contains("--all") {
            verified = (code.unwrap_or(-1), done.stderr);
        }
    }
    verified
}

const VERIFY: &str = "verify run --all --threads 1";
const COMMANDS: [&str; 7] = [
    "status run",
    VERIFY,
    "query run",
    "log run",
    "export run --format graphml --out out.graphml",
    "diff run run",
    "resume run --threads 1 --max-sets 10 --max-time 2",
];

#[test]
fn what_was_not_forged_is_as_recorded() {
    let scratch = Scratch::new();
    let mut payloads = small();
    seal(&mut payloads);
    assert!(payloads == small(), "the roadmap's digest is as the document says");
    forge(&scratch, payloads);
    assert_eq!(ends(&scratch, "nothing", &[VERIFY]).0, 0);
}

/// A number of a chapter, a set or a round that is another: at the first byte of its place.
#[test]
fn forged_numbers_are_found() {
    let scratch = Scratch::new();
    let genuine = small();
    let (set, end, judged, stop) =
        (first(&genuine, 1), last(&genuine, 2), last(&genuine, 3), last(&genuine, 4));
    let (dofs, values) = set_places(&genuine[set]);
    let value = |index: usize| values + 8 * index;
    let mut chapter = Fields(&genuine[0]);
    chapter.u32();
    chapter.u64();
    chapter.text();
    let bits = genuine[0].len() - chapter.0.len();
    chapter.u32();
    chapter.text();
    let seed = genuine[0].len() - chapter.0.len();
    let source = seed + 8 + 4 + 32 + 8 + 8 + "small.toml".len();
    let edges = values + 8 * 4 * 7;
    let nan = f64::NAN.to_le_bytes();
    let cases: [(&str, usize, usize, &[u8]); 22] = [
        ("a huge value", set, value(0), &1e307f64.to_le_bytes()),
        ("a value beyond the bounds", set, value(1), &9.5f64.to_le_bytes()),
        ("no number", set, value(2), &nan),
        ("a quaternion of no length", set, value(3), &0.5f64.to_le_bytes()),
        ("another value", set, value(0), &4.4f64.to_le_bytes()),
        ("2^60 values", set, values - 8, &(1u64 << 60).to_le_bytes()),
        ("2^27 values", set, values - 8, &(1u64 << 27).to_le_bytes()),
        ("no degrees of freedom", set, dofs, &0u32.to_le_bytes()),
        ("edges to nowhere", set, edges + 8 + 4, &u32::MAX.to_le_bytes()),
        ("an unknown planner", set, edges + 8 + 8, &[250]),
        ("a negative length", set, edges + 8 + 9, &(-1.0f64).to_le_bytes()),
        ("other sets", end, 12, &999u64.to_le_bytes()),
        ("other nodes", end, 20, &7u64.to_le_bytes()),
        ("other edges", end, 28, &7u64.to_le_bytes()),
        ("other components", end, 36, &12345u64.to_le_bytes()),
        ("another verdict", judged, 4 + 8 + 8, &[1]),
        ("another value of a verdict", judged, 4 + 8 + 8 + 1 + 7, &[0x41]),
        ("another seed", 0, seed, &4242u64.to_le_bytes()),
        ("other degrees of freedom", 0, seed + 8, &3u32.to_le_bytes()),
        ("another name", 0, bits + 4 + 8, b"l"),
        ("another source", 0, source, &[0; 4]),
        ("another reason", stop, 4 + 8 + "set-limit".len() + 8, b"x"),
    ];
    for (what, record, at, bytes) in cases {
        let mut payloads = genuine.clone();
        put(&mut payloads[record], at, bytes);
        if record == set && dofs + 4 < at && !what.starts_with('2') && what != "no number" {
            seal(&mut payloads);
        }
        forge(&scratch, payloads);
        let (code, message) = ends(&scratch, what, &COMMANDS);
        assert!([4, 7].contains(&code), "{what}: {code}: {message}");
    }
}

fn stop(word: &str, reason: &str) -> Vec<u8> {
    let mut payload = 4u32.to_le_bytes().to_vec();
    for text in [word, reason] {
        payload.extend((text.len() as u64).to_le_bytes());
        payload.extend(text.as_bytes());
    }
    payload
}

#[test]
fn forged_stops_are_found() {
    let scratch = Scratch::new();
    let genuine = small();
    let last_stop = last(&genuine, 4);
    let early = first(&genuine, 3) + 1;
    let cases = [
        (early, "satisfied", "all criteria are met"),
        (early, "set-limit", "the limit of 8 sets is reached"),
        (last_stop, "satisfied", "all criteria are met"),
        (last_stop, "node-limit", "the limit of 1 nodes is reached"),
        (last_stop, "gave-up", "set a:4: gave up after 7 attempts"),
        (last_stop, "gave-up", "set c:0: it did"),
        (last_stop, "bogus", "x"),
    ];
    for (place, word, reason) in cases {
        let mut payloads = genuine[..place].to_vec();
        payloads.push(stop(word, reason));
        forge(&scratch, payloads);
        let (code, message) = ends(&scratch, word, &COMMANDS[..3]);
        assert_eq!(code, 7, "{word}: {message}");
        assert!(message.contains("the stop"), "{message}");
    }
    // What has its cause outside cannot be recomputed.
    let mut payloads = genuine[..early].to_vec();
    payloads.push(stop("interrupted", "a signal came"));
    forge(&scratch, payloads);
    assert_eq!(ends(&scratch, "interrupted", &[VERIFY]).0, 0);
}

/// A problem of other bits has another digest, which then says nothing.
#[test]
fn a_forged_problem_of_other_bits_ends_as_problem_files_do() {
    let scratch = Scratch::new();
    let genuine = small();
    let mut fields = Fields(&genuine[0]);
    fields.u32();
    fields.u64();
    fields.text();
    let bits = genuine[0].len() - fields.0.len();
    fields.u32();
    fields.text();
    fields.u64();
    fields.u32();
    fields.hash();
    fields.list(|fields| (fields.text(), fields.hash()));
    let problem = genuine[0].len() - fields.0.len() + 8;
    let end = genuine[0].len();
    let mut random = Random::new(0x6f72);
    let mut codes = std::collections::BTreeMap::new();
    for number in 0..trials(40) {
        let mut payloads = genuine.clone();
        put(&mut payloads[0], bits, &1u32.to_le_bytes());
        for _ in 0..1 + random.below(3) {
            let at = problem + random.below(end - problem - 8);
            match random.below(4) {
                0 => payloads[0][at] ^= 1 << random.below(8),
                1 => payloads[0][at] = random.below(256) as u8,
                2 => put(&mut payloads[0], at, &f64::NAN.to_le_bytes()),
                _ => put(&mut payloads[0], at, &(1u64 << random.below(63)).to_le_bytes()),
            }
        }
        forge(&scratch, payloads);
        let command = [
            "status run",
            "query run",
            VERIFY,
            "resume run --threads 1 --accept-bits --max-sets 10 --max-time 2",
        ][number % 4];
        let done = scratch.run(&command.split(' ').collect::<Vec<_>>());
        let code = done.status.code().unwrap_or(-1);
        assert!(ENDS.contains(&code), "{number}: {command}: {done:?}");
        *codes.entry((command, code)).or_insert(0) += 1;
    }
    eprintln!("{codes:?}");
}

/// Bytes anywhere in a ledger, under hashes made anew.
#[test]
fn records_of_any_bytes_end_with_a_code() {
    let scratch = Scratch::new();
    let genuine = small();
    let mut random = Random::new(0x616e79);
    for number in 0..trials(40) {
        let mut payloads = genuine.clone();
        for _ in 0..1 + random.below(3) {
            let record = random.below(payloads.len());
            let length = payloads[record].len();
            if length < 16 {
                break;
            }
            let at = random.below(length - 8);
            match random.below(6) {
                0 => payloads[record][at] ^= 1 << random.below(8),
                1 => put(&mut payloads[record], at, &u32::MAX.to_le_bytes()),
                2 => payloads[record].truncate(at),
                3 => payloads.swap(record, number % genuine.len()),
                4 => drop(payloads.remove(record)),
                _ => payloads[record].extend_from_within(at..),
            }
            if payloads.iter().any(Vec::is_empty) || payloads.len() < 3 {
                break;
            }
        }
        forge(&scratch, payloads);
        let commands = [COMMANDS[number % COMMANDS.len()], VERIFY];
        ends(&scratch, &number.to_string(), &commands);
    }
}

#[test]
fn forged_sets_are_refused_before_a_build_begins() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    let generate = ["generate", "small.toml", "--sets", "a:0..3", "--out", "a.sets"];
    scratch.run(&[&generate[..], &["--threads", "1"]].concat()).assert_code(0);
    let file = fs::read(scratch.path("a.sets")).expect("it is there");
    let genuine: Vec<_> = frames_behind(SETS, &file).into_iter().map(|f| f.payload).collect();
    // Kind, ordinal, that it was made, degrees of freedom, number of values.
    let values = 4 + 8 + 4 + 4 + 8;
    for (what, at, bytes) in [
        ("huge", values, 1e307f64.to_le_bytes()),
        ("no number", values, f64::NAN.to_le_bytes()),
        ("not a rotation", values + 24, 9.0f64.to_le_bytes()),
        ("too many", values - 8, (1u64 << 60).to_le_bytes()),
    ] {
        let mut payloads = genuine.clone();
        put(&mut payloads[1], at, &bytes);
        fs::write(scratch.path("forged.sets"), file_of(SETS, payloads)).expect("it is written");
        let build = ["build", "small.toml", "--out", "run", "--import", "forged.sets"];
        let done = scratch.run(&[&build[..], &["--threads", "1"]].concat());
        assert_eq!(done.status.code(), Some(4), "{what}: {}", done.stderr);
        done.assert_stderr(&["forged.sets: damaged"]);
        assert!(!scratch.path("run").exists(), "{what}: something was begun");
    }
}

/// What is no file is refused before anything is read from it; links in a run folder lead nowhere.
#[test]
fn fifos_devices_and_links_are_refused() {
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    let fifo = |name: &str| {
        let _ = fs::remove_file(scratch.path(name));
        mkfifoat(CWD, scratch.path(name), Mode::RUSR | Mode::WUSR).expect("it can be made");
    };
    let refused = |command: &str, what: &str| {
        let done = scratch.run(&command.split(' ').collect::<Vec<_>>());
        assert!(matches!(done.status.code(), Some(1 | 2)), "{command}: {done:?}");
        done.assert_stderr(&[what]);
    };
    fifo("a.sets");
    let import = "build small.toml --threads 1 --out new --import";
    refused(&format!("{import} a.sets"), "a.sets: cannot be read: a named pipe found");
    refused(&format!("{import} /dev/zero"), "/dev/zero: cannot be read: a device found");
    fs::create_dir(scratch.path("run")).expect("it can be made");
    fifo("run/ledger");
    for command in ["status run", "resume run --threads 1", "verify run", "query run"] {
        refused(command, "run");
    }
    forge(&scratch, small());
    scratch.write("precious", "precious");
    for name in ["lock", "ledger.durable"] {
        let link = scratch.path("run").join(name);
        std::os::unix::fs::symlink(scratch.path("precious"), &link).expect("it can be made");
        refused("resume run --threads 1 --max-sets 10", "a link found");
        fs::remove_file(link).expect("it is there");
    }
    fifo("run/lock");
    refused("resume run --threads 1 --max-sets 10", "a named pipe found");
    let precious = fs::read_to_string(scratch.path("precious")).expect("it is there");
    assert_eq!(precious, "precious");
}
