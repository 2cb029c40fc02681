//! Whatever bytes are taken for a message: an error or a message, no panic, and bounded memory.

#[path = "support/allocated.rs"]
mod allocated;

use allocated::most_bytes;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use roadmill::evaluate::Verdict;
use roadmill::img::{Job, Joined, Outcome, Setup, Task};
use roadmill::internal::wire;
use roadmill::model::{Asked, Scratch};
use roadmill::numbers::{NodeId, Ordinal, SetNumber, StrategyIndex};
use roadmill::problem::Problem;
use roadmill::roadmap::{Digest, Edge};
use roadmill_workers::message::{Bytes, Done, Entry, FromWorker, PROTOCOL, ToWorker};
use std::path::Path;
use std::sync::Arc;

/// One message of every kind, as bytes.
fn messages() -> Vec<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../problems/maze.toml");
    let problem = Problem::load(&path).expect("it ships");
    let setup = Setup::new(problem.clone());
    let generate = Task::Generate { strategy: StrategyIndex(0), ordinal: Ordinal(0), frozen: None };
    let increment = generate.run(&setup, &mut Scratch::new());
    assert!(matches!(increment, Outcome::Increment(Ok(_))));
    let edge = Edge::metric(NodeId(0), NodeId(1), 0, 1.0);
    let joined = Joined { edges: vec![edge; 3], asked: Asked::default() };
    let verdict =
        |parts: Vec<Verdict>| Verdict { parts, ..Verdict::at_least(1.0, 1.0, Asked::default()) };
    let nested = verdict(vec![verdict(Vec::new()), verdict(vec![verdict(Vec::new())])]);
    let job = Job::Join { number: SetNumber(3), strategy: StrategyIndex(0), ordinal: Ordinal(3) };
    let outcomes = [increment, Outcome::Joined(joined), Outcome::Verdict(Box::new(nested))];
    let (set, joins) = (wire::encode(&outcomes[0]), wire::encode(&outcomes[1]));
    let stored = Bytes::Stored { offset: 7, length: 9, digest: Digest([3; 32]) };
    let here = |bytes: &Vec<u8>| Bytes::Here(Arc::new(bytes.clone()));
    let entries = [Entry::Increment(here(&set)), Entry::Fold(vec![here(&joins), stored])];
    let done = |outcome| Done { job, micros: 7, outcome };
    let mut messages = vec![
        wire::encode(&FromWorker::Hello { protocol: PROTOCOL, build: Digest([1; 32]) }),
        wire::encode(&FromWorker::Ready { canary: Digest([2; 32]) }),
        wire::encode(&FromWorker::Done(vec![done(&set), done(&joins)])),
        wire::encode(&ToWorker::Problem(Box::new(problem))),
        wire::encode(&ToWorker::Refused("no".to_owned())),
        wire::encode(&ToWorker::Work { entries: entries.to_vec(), jobs: vec![job; 3] }),
    ];
    messages.extend(entries.iter().map(wire::encode));
    messages.extend(outcomes.iter().map(wire::encode));
    messages
}

fn decode_as_everything(bytes: &[u8]) {
    // Errors or not: what counts is to come back.
    let _ = wire::decode_borrowed::<FromWorker>(bytes);
    let _ = wire::decode::<ToWorker>(bytes);
    let _ = wire::decode::<Entry>(bytes);
    let _ = wire::decode::<Outcome>(bytes);
}

/// What `wire::decode` promises.
fn assert_bounded(bytes: &[u8]) {
    let most = most_bytes(|| decode_as_everything(bytes));
    assert!(most <= (1 << 20).max(64 * bytes.len()), "{most} bytes held for {}", bytes.len());
}

/// One test, for memory is counted in the whole process.
#[test]
fn hostile_messages_are_errors_and_take_bounded_memory() {
    let messages = messages();
    // Lengths that are claimed, wherever they may stand.
    for message in &messages {
        let step = (message.len() / 400).max(1);
        for at in (0..message.len().saturating_sub(8)).step_by(step) {
            for length in [u64::MAX, 1 << 40, 1 << 20, 70_000] {
                let mut hostile = message.clone();
                hostile[at..at + 8].copy_from_slice(&length.to_le_bytes());
                assert_bounded(&hostile);
            }
        }
    }
    let changes = proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8);
    let case = (0..messages.len(), changes, any::<prop::sample::Index>(), any::<bool>());
    let config = Config { cases: 2000, failure_persistence: None, ..Config::default() };
    let changed = TestRunner::new(config).run(&case, |(message, changes, cut, is_cut)| {
        let mut bytes = messages[message].clone();
        for (at, value) in changes {
            let length = bytes.len();
            bytes[at.index(length)] = value;
        }
        if is_cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        assert_bounded(&bytes);
        Ok(())
    });
    changed.unwrap_or_else(|error| panic!("{error}"));
}
