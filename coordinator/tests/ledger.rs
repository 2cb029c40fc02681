//! The ledger's bytes: as its document says, and whatever happens to them.

#[path = "support/by_hand.rs"]
mod by_hand;
mod support;

use by_hand::{Fields, Frame, durable, frames, hash, ledger_of};
use proptest::prelude::*;
use roadmill::internal::wire;
use roadmill::numbers::RoundNumber;
use roadmill::problem::Problem;
use roadmill::scene::Shape;
use roadmill_coordinator::exit::Code;
use roadmill_coordinator::run::ledger::{Chapter, DURABLE, LEDGER, Record};
use roadmill_coordinator::run::{Ledger, LedgerWriter, RunLock, Scan};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;
use support::Scratch;
use tempfile::TempDir;

/// Small, with several rounds, two strategies and a judgement after each round.
const SMALL: &str = r#"
name = "small"
seed = 5
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [9.0, 9.0]
bounds = "body"
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { mesh = { file = "wall.obj" } }
[query]
start = [1.0, 1.0]
goal = [8.0, 8.0]
[img]
sets_per_round = 2
[[strategies]]
label = "a"
nodes = 3
sampler = { uniform = {} }
[[strategies]]
label = "b"
nodes = 2
sampler = { uniform = {} }
[[evaluators]]
all = [{ query = {} }, { not = { query = {} } }]
[limits]
sets = 6
"#;

/// A closed wedge in a corner.
const WALL: &str = "v 4 4 -1\nv 6 4 -1\nv 4 6 -1\nv 4 4 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// The run of [`SMALL`], built once.
fn small() -> &'static (Vec<u8>, Vec<u8>) {
    static RUN: OnceLock<(Vec<u8>, Vec<u8>)> = OnceLock::new();
    RUN.get_or_init(|| {
        let scratch = Scratch::new();
        scratch.write("small.toml", SMALL);
        scratch.write("wall.obj", WALL);
        scratch.build("run", &["small.toml", "--threads", "1"], 3);
        let durable = fs::read(scratch.path("run").join(DURABLE)).expect("a side file");
        (scratch.ledger("run"), durable)
    })
}

/// A folder where syncing costs nothing: ledgers are written thousands of times.
fn in_memory() -> TempDir {
    tempfile::tempdir_in("/dev/shm").expect("a folder")
}

fn write(folder: &Path, ledger: &[u8], durable: &[u8]) {
    fs::write(folder.join(LEDGER), ledger).expect("it can be written");
    fs::write(folder.join(DURABLE), durable).expect("it can be written");
}

#[test]
fn the_document_suffices_to_read_a_ledger() {
    let (ledger, durable) = small();
    let frames = frames(ledger);
    let mut kinds = String::new();
    let (mut nodes, mut edges, mut places, mut ordinals) = (0, 0, 0, BTreeMap::new());
    let mut canonical = blake3::Hasher::new_derive_key("roadmill 1 roadmap digest");
    canonical.update(&2u64.to_le_bytes());
    for Frame { payload, .. } in &frames {
        let mut fields = Fields(payload);
        let kind = fields.u32();
        kinds.push(char::from(b'0' + kind as u8));
        match kind {
            0 => {
                assert_eq!(fields.u64(), 0, "from the first round on");
                assert_eq!(fields.text(), env!("CARGO_PKG_VERSION"));
                assert_eq!(fields.u32(), roadmill::BITS_VERSION);
                assert_eq!((fields.text(), fields.u64(), fields.u32()), ("small".into(), 5, 2));
                fields.hash();
                let sources = fields.list(|fields| (fields.text(), fields.hash()));
                let expected = [("small.toml", SMALL), ("wall.obj", WALL)]
                    .map(|(path, text)| (path.to_owned(), hash(&[text.as_bytes()])));
                assert_eq!(sources, expected);
                fields.list(Fields::u8);
            }
            1 => {
                assert_eq!(fields.u64(), places);
                places += 1;
                let (label, ordinal) = (fields.text(), fields.u64());
                let next = ordinals.entry(label.clone()).or_insert(0);
                assert_eq!(ordinal, *next);
                *next += 1;
                assert_eq!(fields.u32(), 2);
                let values = fields.list(Fields::f64);
                assert_eq!(values.len(), if label == "a" { 6 } else { 4 });
                assert!(values.iter().all(|value| (0.2..=8.8).contains(value)), "{values:?}");
                let inner = fields.list(Fields::edge);
                assert!(fields.u64() > 0 && fields.u64() > 0, "something was checked");
                let joining = fields.list(Fields::edge);
                fields.bytes(16);

                let first = nodes;
                nodes += values.len() as u32 / 2;
                edges += inner.len() + joining.len();
                canonical.update(&(values.len() as u64 / 2).to_le_bytes());
                for value in values {
                    canonical.update(&value.to_le_bytes());
                }
                for (edges, shift) in [(inner, first), (joining, 0)] {
                    canonical.update(&(edges.len() as u64).to_le_bytes());
                    for (low, high, planner, weight) in edges {
                        assert!(low < high && high + shift < nodes);
                        canonical.update(&(low + shift).to_le_bytes());
                        canonical.update(&(high + shift).to_le_bytes());
                        canonical.update(&[planner]);
                        canonical.update(&weight.to_le_bytes());
                    }
                }
            }
            2 => {
                assert_eq!((fields.u64(), fields.u64()), (places / 2 - 1, places));
                assert_eq!((fields.u64(), fields.u64()), (u64::from(nodes), edges as u64));
                assert!((1..=u64::from(nodes)).contains(&fields.u64()), "components");
                assert_eq!(fields.hash(), *canonical.finalize().as_bytes());
            }
            3 => {
                assert_eq!(fields.u64(), places / 2 - 1);
                let verdicts = fields.list(Fields::verdict);
                assert_eq!(verdicts.iter().map(|(met, ..)| *met).collect::<Vec<_>>(), [false]);
            }
            4 => {
                assert_eq!(fields.text(), "set-limit");
                assert_eq!(fields.text(), "the limit of 6 sets is reached");
            }
            other => panic!("kind {other}"),
        }
        assert_eq!(fields.0, [] as [u8; 0], "kind {kind}: all of it is described");
    }
    assert_eq!(kinds, "0112311231123".to_owned() + "4");

    // The newer slot marks the end of the ledger.
    let slots = [&durable[..88], &durable[4096..4096 + 88]].map(|slot| {
        assert!(slot[56..] == hash(&[&slot[..56]]) || slot == [0; 88]);
        let mut fields = Fields(slot);
        (fields.u64(), fields.u64(), fields.u64(), fields.hash())
    });
    let last = frames.last().expect("frames");
    let newest = slots.into_iter().max().expect("two");
    assert_eq!(newest.1, ledger.len() as u64);
    assert_eq!((newest.2, newest.3), (frames.len() as u64, last.hash));
}

/// Whichever byte is damaged, the record that it belongs to is named and nothing is changed.
#[test]
fn every_flipped_byte_is_found() {
    let (ledger, durable) = small();
    let folder = in_memory();
    let mut records = frames(ledger).into_iter().enumerate().peekable();
    for place in 0..ledger.len() {
        records.next_if(|(_, frame)| frame.end <= place);
        let (record, start) = match records.peek() {
            Some((number, frame)) if place >= 16 => (*number, frame.start),
            _ => (0, 0),
        };
        let mut damaged = ledger.clone();
        damaged[place] ^= 1 << (place % 8);
        write(folder.path(), &damaged, durable);
        let error = Ledger::read(folder.path()).expect_err("damage");
        let name = format!("record {record} at byte {start}: ");
        assert!(error.message.contains(&name), "byte {place}: {name} expected of {error:?}");
        assert_eq!(error.code, Code::BrokenRun);
        assert!(fs::read(folder.path().join(LEDGER)).expect("a file") == damaged);
    }
}

/// A side file that is damaged never lets damage to the ledger pass, and does none of its own.
#[test]
fn a_damaged_side_file_takes_nothing_away() {
    let (ledger, durable) = small();
    let folder = in_memory();
    let digest = |folder: &Path| Ledger::read(folder).expect("whole").roadmap.digest();
    write(folder.path(), ledger, durable);
    let expected = digest(folder.path());
    for place in (0..88).chain(4096..4096 + 88) {
        let mut damaged = durable.clone();
        damaged[place] ^= 1 << (place % 8);
        write(folder.path(), ledger, &damaged);
        assert_eq!(digest(folder.path()), expected, "byte {place}");
    }
    // Without it all bytes count as durable.
    for side in [Vec::new(), durable[..50].to_vec(), vec![0; 8192]] {
        write(folder.path(), ledger, &side);
        assert_eq!(digest(folder.path()), expected);
        write(folder.path(), &ledger[..ledger.len() - 1], &side);
        let error = Ledger::read(folder.path()).expect_err("damage");
        assert_eq!(error.code, Code::BrokenRun, "{error:?}");
    }
}

#[test]
fn a_ledger_shorter_than_its_mark_or_not_the_marked_one_is_broken() {
    let (ledger, side) = small();
    let folder = in_memory();
    for length in 0..ledger.len() {
        write(folder.path(), &ledger[..length], side);
        let error = Ledger::read(folder.path()).expect_err("damage");
        assert_eq!(error.code, Code::BrokenRun, "{length}: {error:?}");
    }
    // Whole in itself, but with another history.
    let mut payloads: Vec<_> = frames(ledger).into_iter().map(|frame| frame.payload).collect();
    let at = payloads[1].len() - 1;
    payloads[1][at] ^= 1;
    write(folder.path(), &ledger_of(payloads), side);
    let error = Ledger::read(folder.path()).expect_err("not the same");
    assert!(error.message.contains("not the ledger that was made durable"), "{error:?}");
}

#[test]
fn another_format_is_refused_by_name() {
    let (ledger, durable) = small();
    let folder = in_memory();
    for (version, words) in [(3, "a newer one is needed"), (1, "knows format 2")] {
        let mut other = ledger.clone();
        other[15] = version;
        write(folder.path(), &other, durable);
        let error = Ledger::read(folder.path()).expect_err("unknown");
        assert!(error.message.contains(&format!("a ledger of format {version}")), "{error:?}");
        assert!(error.message.contains(words), "{error:?}");
    }
}

/// A ledger whole in itself, with hashes as they should be, of a problem that no file could give: among its bytes are
/// other values.
#[test]
fn a_problem_that_no_file_could_give_is_refused_with_the_reason() {
    let (ledger, _) = small();
    let wedge = match wire::decode(&frames(ledger)[0].payload) {
        Ok(Record::Chapter(chapter)) => chapter.decode().expect("it is sound"),
        other => panic!("{other:?}"),
    };
    let text = "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2.0]\nenergy = { muller-brown = {} }\n\
        tolerance = 0.123\n";
    let landscape = Problem::parse(Path::new("landscape.toml"), text).expect("it is sound");
    let folder = in_memory();
    let refused = |problem: &Problem, value: &[u8], other: &[u8], expected: &str| {
        let mut chapter = Chapter::new(RoundNumber(0), problem);
        let windows = chapter.problem.windows(value.len()).enumerate();
        let places: Vec<usize> =
            windows.filter(|(_, window)| *window == value).map(|(at, _)| at).collect();
        let [place] = places[..] else { panic!("{value:?} found at {places:?}") };
        chapter.problem[place..place + other.len()].copy_from_slice(other);
        let record = wire::encode(&chapter.into_record());
        fs::write(folder.path().join(LEDGER), ledger_of([record])).expect("written");
        let error = Ledger::read(folder.path()).expect_err(expected);
        assert_eq!(error.code, Code::BrokenRun, "{error:?}");
        assert!(error.message.contains(expected), "{error:?}");
    };
    let tolerance = 0.123f64.to_le_bytes();
    refused(&landscape, &tolerance, &f64::NAN.to_le_bytes(), "tolerance: NaN found");
    refused(&landscape, &tolerance, &0f64.to_le_bytes(), "tolerance: 0 found");
    let bodies = wedge.model().bodies().expect("it has bodies");
    let resolution = bodies.resolution().to_le_bytes();
    refused(&wedge, &resolution, &f64::NAN.to_le_bytes(), "resolution: NaN found");
    let Shape::Mesh(mesh) = &bodies.obstacles()[0].shape else { panic!("the wedge is a mesh") };
    let triangles = mesh.triangles.as_flattened().iter();
    let triangles: Vec<u8> = triangles.flat_map(|corner| corner.to_le_bytes()).collect();
    refused(&wedge, &triangles, &1_000_000u32.to_le_bytes(), "a triangle of [1000000,");
}

/// A build killed while it wrote, or a machine that failed: whatever of the bytes beyond the mark is
/// there, complete rounds count, and the rest is kept beside the ledger.
#[test]
fn a_torn_tail_is_kept_beside_and_the_build_goes_on_to_the_same_bytes() {
    let (ledger, _) = small();
    let frames = frames(ledger);
    let scratch = Scratch::new();
    scratch.write("small.toml", SMALL);
    scratch.write("wall.obj", WALL);
    let memory = in_memory();
    let folder = memory.path().to_owned();
    let mut resumed = BTreeMap::new();
    // Behind the beginning, and behind the first judgement.
    for durable_frames in [1, 5] {
        let side = durable(&frames[..durable_frames]);
        let mark = frames[durable_frames - 1].end;
        for length in mark..ledger.len() {
            let whole = frames
                .iter()
                .rfind(|frame| frame.end <= length && (frame.payload[0] != 1 || frame.end <= mark));
            let end = whole.expect("the beginning").end;
            write(&folder, &ledger[..length], &side);
            let scan = Scan::read(&folder).expect("whole up to the mark");
            assert_eq!((scan.end.offset, scan.torn_bytes), (end as u64, (length - end) as u64));
            let lock = RunLock::take(&folder, || false).expect("free");
            let (writer, torn) =
                LedgerWriter::resume(&scan, &scan.problem().expect("it is sound"), lock)
                    .expect("it goes on");
            drop(writer);
            assert!(fs::read(folder.join(LEDGER)).expect("a ledger") == ledger[..end]);
            match torn {
                None => assert_eq!(length, end),
                Some(path) => {
                    assert!(fs::read(&path).expect("the tail") == ledger[end..length]);
                    fs::remove_file(path).expect("it can be removed");
                }
            }
            // What remains takes few values; each goes on to the end once, as a process of its own.
            resumed.entry(end).or_insert_with(|| {
                fs::create_dir_all(scratch.path("run")).expect("a folder");
                write(&scratch.path("run"), &ledger[..length], &side);
                let done = scratch.run(&["resume", "run", "--threads", "1"]);
                done.assert_code(3);
                assert!(scratch.ledger("run") == *ledger, "from byte {end}: another ledger");
            });
        }
    }
    assert_eq!(resumed.len(), 7, "every end of a round, every judgement, and the beginning");
}

#[test]
fn tails_are_saved_under_names_of_their_own() {
    let (ledger, _) = small();
    let frames = frames(ledger);
    let folder = in_memory();
    write(folder.path(), ledger, &durable(&frames[..5]));
    for number in 1..=3 {
        let mut torn = fs::read(folder.path().join(LEDGER)).expect("a ledger");
        torn.extend([number; 5]);
        fs::write(folder.path().join(LEDGER), torn).expect("it can be written");
        let scan = Scan::read(folder.path()).expect("whole");
        let lock = RunLock::take(folder.path(), || false).expect("free");
        LedgerWriter::resume(&scan, &scan.problem().expect("it is sound"), lock)
            .expect("it goes on");
        let saved = fs::read(folder.path().join(format!("ledger.torn-{number}")));
        assert_eq!(saved.expect("the tail"), [number; 5]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..Default::default() })]

    /// Rubbish, and records whose hashes are right but whose payloads are not: errors, never panics.
    #[test]
    fn nothing_that_is_read_panics(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), any::<u8>()), 0..4),
        cut in proptest::option::of(any::<prop::sample::Index>()),
        rubbish in proptest::collection::vec(any::<u8>(), 0..300),
        with_heading in any::<bool>(),
        side in proptest::option::of(proptest::collection::vec(any::<u8>(), 0..5000)),
    ) {
        let (ledger, _) = small();
        let mut payloads: Vec<_> = frames(ledger).into_iter().map(|frame| frame.payload).collect();
        for (record, byte, value) in changes {
            let count = payloads.len();
            let payload = &mut payloads[record.index(count)];
            let length = payload.len();
            payload[byte.index(length)] = value;
        }
        if let Some(cut) = cut {
            let count = payloads.len();
            payloads.remove(cut.index(count));
        }
        let folder = in_memory();
        let mut bytes = if with_heading { ledger_of(payloads) } else { Vec::new() };
        bytes.extend(rubbish);
        fs::write(folder.path().join(LEDGER), bytes).expect("it can be written");
        if let Some(side) = side {
            fs::write(folder.path().join(DURABLE), side).expect("it can be written");
        }
        // Either is fine; what counts is to come back.
        let _ = Ledger::read(folder.path());
    }
}
